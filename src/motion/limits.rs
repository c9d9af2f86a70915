//! What each axis can do, and what is assumed where the configuration does not say it.

use crate::machine::{Axis, AxisType};

/// The bounds of one axis: mm or degrees, per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisLimits {
    /// The highest velocity.
    pub velocity_per_s: f64,
    /// The greatest acceleration.
    pub acceleration_per_s2: f64,
    /// The greatest jerk.
    pub jerk_per_s3: f64,
    /// Which of them the configuration does not give.
    pub assumed: Assumed,
}

/// The bounds of an axis that are assumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Assumed {
    /// `max_velocity`.
    pub velocity: bool,
    /// `max_acceleration`.
    pub acceleration: bool,
    /// `max_jerk`.
    pub jerk: bool,
}

/// 10 m/min or 10 000 °/min: the default of the rapid velocity, P-AXIS-00209, is 166 666 µm/s or
/// 0.001 °/s.
const VELOCITY: f64 = 10_000.0 / 60.0;

/// 1 m/s² or 1000 °/s²: the default of P-AXIS-00001, in mm/s² or °/s².
const ACCELERATION: f64 = 1000.0;

/// 20 m/s³ or 20 000 °/s³: the default acceleration in the default ramp time of 50 ms,
/// P-AXIS-00195 to P-AXIS-00198.
const JERK: f64 = ACCELERATION / 0.05;

impl AxisLimits {
    /// The bounds of an axis (R5.2). What the configuration does not say is assumed to be the
    /// default of the control's parameters.
    pub fn of(axis: &Axis) -> Self {
        // Metres for linear axes, degrees for rotary ones.
        let unit = match axis.axis_type {
            AxisType::Linear => 1000.0,
            AxisType::Rotary | AxisType::Spindle => 1.0,
        };
        let (velocity, acceleration, jerk) = (
            axis.max_velocity_per_min,
            axis.max_acceleration_per_s2,
            axis.max_jerk_per_s3,
        );
        Self {
            velocity_per_s: velocity.map_or(VELOCITY, |per_minute| per_minute / 60.0),
            acceleration_per_s2: acceleration.map_or(ACCELERATION, |given| given * unit),
            jerk_per_s3: jerk.map_or(JERK, |given| given * unit),
            assumed: Assumed {
                velocity: velocity.is_none(),
                acceleration: acceleration.is_none(),
                jerk: jerk.is_none(),
            },
        }
    }
}
