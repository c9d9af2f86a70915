//! The requirements on a plan, and the machine that it is made for.

use serde::{Deserialize, Serialize};

use frictcomp::lists::AxisType;

/// Requirements on a plan, and the machine that it is made for.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRequest {
    /// The axes that are measured: one alone, or two linear ones.
    pub axes: Vec<MeasuredAxis>,
    /// The feeds of circles or strokes in mm/min or °/min.
    pub feeds: Vec<f64>,
    /// The feed of all other motions in mm/min or °/min.
    pub approach: f64,
    /// The radius of the circles in mm; `None` for the largest that fits, up to 100 mm.
    pub radius: Option<f64>,
    /// The slowest speed in mm/s or °/s.
    pub slowest: f64,
    /// 1 for stage 1, from 2 on for each set of lists in stage 2: no two rounds have a number in common.
    pub round: u16,
}

/// An axis of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredAxis {
    /// Name in programs.
    pub name: String,
    /// Linear or rotary.
    pub axis_type: AxisType,
    /// The travel that may be used.
    pub travel: FreeTravel,
    /// Velocity, acceleration and jerk.
    pub dynamics: Dynamics,
    /// Friction compensation at the start of the control.
    pub installed: Installed,
    /// The period of the torque along the travel, a pitch of the screw, in mm or degrees.
    pub pitch: Option<f64>,
    /// The axes of a gantry that follow it.
    pub followers: Vec<String>,
}

impl MeasuredAxis {
    /// Returns the unit of its lengths.
    pub fn unit(&self) -> &'static str {
        if self.axis_type == AxisType::Linear {
            "mm"
        } else {
            "\u{b0}"
        }
    }
}

/// The ends of a travel in mm or degrees, the lower first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FreeTravel {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// Friction compensation of an axis at the start of the control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Installed {
    /// Compensation not configured, P-AXIS-00522 is 0: no command changes anything.
    Unconfigured,
    /// Compensation on from the start of the control, or with the first valid list.
    On,
    /// Configured, switched on only by programs.
    Off,
}

/// Bounds of an axis in mm or degrees, and seconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Dynamics {
    /// The highest velocity.
    pub velocity_per_s: f64,
    /// The greatest acceleration.
    pub acceleration_per_s2: f64,
    /// The greatest jerk.
    pub jerk_per_s3: f64,
}

impl Dynamics {
    /// Returns the seconds from standstill to a speed, with ramps of the acceleration.
    pub fn time_to(&self, speed: f64) -> f64 {
        let (most, jerk) = (self.acceleration_per_s2, self.jerk_per_s3);
        if speed * jerk >= most * most {
            speed / most + most / jerk
        } else {
            2.0 * (speed / jerk).sqrt()
        }
    }

    /// Returns the travel from standstill to a speed.
    pub fn way_to(&self, speed: f64) -> f64 {
        self.time_to(speed) * speed / 2.0
    }
}
