//! The channels of the recordings of a commissioning.

use serde::Serialize;

use frictcomp_physics::circle::Circle;
use frictcomp_recordings::commission::Plan;
use frictcomp_recordings::identify::TorqueKind;
use frictcomp_recordings::trace::ChannelSelection;

/// The channels of the recordings of a commissioning, and what the user says about them.
#[derive(Debug, Clone, Default, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CommissionChannels {
    /// The channels of each axis and of each other motor of a gantry.
    pub axes: Vec<(String, ChannelSelection)>,
    /// Whether the torque of each motor has a channel of its own.
    pub has_each_torque: bool,
    /// The CNC cycle in s, if it is known.
    pub cycle_s: Option<f64>,
    /// The kind of the recorded torque, if it is known.
    pub torque_kind: Option<TorqueKind>,
    /// Recordings without a signature, with the numbers of their programs.
    pub roles: Vec<(String, u16)>,
}

impl CommissionChannels {
    /// Returns the channels of an axis with its actual position or its following error.
    pub(super) fn followed(&self, axis: &str) -> ChannelSelection {
        let own = self.axes.iter().find(|it| it.0 == axis);
        own.map_or_else(
            || ChannelSelection {
                axis: Some(axis.to_owned()),
                ..ChannelSelection::default()
            },
            |it| it.1.clone(),
        )
    }

    /// Returns the channels of an axis.
    pub(super) fn selection(&self, axis: &str) -> ChannelSelection {
        ChannelSelection {
            actual_position: None,
            following_error: None,
            ..self.followed(axis)
        }
    }

    /// Returns the channels of circles, whose positions are the actual ones.
    pub fn of_circles(&self, plan: &Plan) -> [ChannelSelection; 2] {
        [0, 1].map(|at| {
            let Some(axis) = plan.axes.get(at) else {
                return ChannelSelection::default();
            };
            let followed = self.followed(&axis.name);
            ChannelSelection {
                position: followed.actual_position,
                actual_position: None,
                ..followed
            }
        })
    }

    /// Returns the CNC cycle in s.
    pub fn cycle_time_s(&self) -> f64 {
        self.cycle_s.unwrap_or(Circle::default().cycle_time_s)
    }
}
