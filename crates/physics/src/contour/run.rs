//! One of the runs: drives that follow the commanded trace with their own additive current.

use super::options::{ContourAxis, ContourOptions, MOST_AXES};
use super::path::Places;
use crate::simulation::{Drives, Setpoint};

const MM_PER_M: f64 = 1000.0;

/// Distance in mm from its commanded place beyond which a drive is unstable.
const LOST_MM: f64 = 100.0;

/// The drives of one run.
pub(super) struct DrivenRun {
    drives: Vec<Drives<1>>,
    /// The commanded velocities of the cycle before, in m/s.
    slopes: Places,
    /// The number of the nearest point of the path.
    pub(super) near: u64,
}

impl DrivenRun {
    /// Drives at rest at a place.
    pub(super) fn at_rest(options: &ContourOptions, place: &Places) -> Self {
        let settle = |(at, axis): (usize, &ContourAxis)| {
            let setpoint = Setpoint {
                position_m: place[at] / MM_PER_M,
                ..Setpoint::default()
            };
            Drives::settled(
                [&axis.drive],
                options.model,
                [setpoint],
                options.planner.cycle_s,
            )
        };
        Self {
            drives: options.axes.iter().enumerate().map(settle).collect(),
            slopes: Places::default(),
            near: 0,
        }
    }

    /// Drives a CNC cycle from one commanded place to the next with additive currents in units of
    /// the drive. Returns the positions of the loads at its end, `None` if a drive is unstable.
    pub(super) fn follow(
        &mut self,
        (from, to): (&Places, &Places),
        added: &Places,
        cycle_s: f64,
    ) -> Option<Places> {
        let mut reached = [0.0; MOST_AXES];
        for (at, drive) in self.drives.iter_mut().enumerate() {
            let velocity = (to[at] - from[at]) / MM_PER_M / cycle_s;
            let setpoint = Setpoint {
                position_m: from[at] / MM_PER_M,
                velocity_m_per_s: velocity,
                acceleration_m_per_s2: (velocity - self.slopes[at]) / cycle_s,
                added_units: added[at],
            };
            self.slopes[at] = velocity;
            let mut place = 0.0;
            drive.follow([setpoint], |[position]| place = position);
            reached[at] = place * MM_PER_M;
            let is_near = (reached[at] - to[at]).abs() <= LOST_MM;
            if !is_near {
                return None;
            }
        }
        Some(reached)
    }
}
