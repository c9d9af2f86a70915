//! What each axis can do, and what is assumed where the configuration does not say it.

use crate::machine::{Axis, AxisType, Machine};

/// The bounds of one axis: mm or degrees, per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisLimits {
    /// The highest velocity.
    pub velocity_per_s: f64,
    /// The greatest acceleration.
    pub acceleration_per_s2: f64,
    /// The greatest jerk.
    pub jerk_per_s3: f64,
    /// The greatest jerk that the curvature of the path may take.
    pub curve_jerk_per_s3: f64,
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

/// The bounds of an axis that are assumed, as its configuration would give them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AssumedLimits {
    /// The name of the axis.
    pub axis: String,
    /// Its type.
    pub axis_type: AxisType,
    /// `max_velocity` in mm/min or °/min, where it is assumed.
    pub max_velocity: Option<f64>,
    /// `max_acceleration` in m/s² or °/s², where it is assumed.
    pub max_acceleration: Option<f64>,
    /// `max_jerk` in m/s³ or °/s³, where it is assumed.
    pub max_jerk: Option<f64>,
}

impl AssumedLimits {
    /// The assumed bounds of an axis; `None` where the configuration gives all of them.
    pub fn of(axis: &Axis) -> Option<Self> {
        let limits = AxisLimits::of(axis);
        let Assumed {
            velocity,
            acceleration,
            jerk,
        } = limits.assumed;
        let unit = unit(axis.axis_type);
        (velocity || acceleration || jerk).then(|| Self {
            axis: axis.name.clone(),
            axis_type: axis.axis_type,
            max_velocity: velocity.then_some(limits.velocity_per_s * 60.0),
            max_acceleration: acceleration.then_some(limits.acceleration_per_s2 / unit),
            max_jerk: jerk.then_some(limits.jerk_per_s3 / unit),
        })
    }
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
        let unit = unit(axis.axis_type);
        let (velocity, acceleration, jerk) = (
            axis.max_velocity_per_min,
            axis.max_acceleration_per_s2,
            axis.max_jerk_per_s3,
        );
        Self {
            velocity_per_s: velocity.map_or(VELOCITY, |per_minute| per_minute / 60.0),
            acceleration_per_s2: acceleration.map_or(ACCELERATION, |given| given * unit),
            jerk_per_s3: jerk.map_or(JERK, |given| given * unit),
            curve_jerk_per_s3: jerk.map_or(JERK, |given| given * unit),
            assumed: Assumed {
                velocity: velocity.is_none(),
                acceleration: acceleration.is_none(),
                jerk: jerk.is_none(),
            },
        }
    }
}

/// The factor by which [`without_assumed_limits`] exceeds the assumed bounds.
const BEYOND: f64 = 1e6;

/// The same machine with bounds far beyond any motion in place of the assumed ones: what is slow on
/// it is slow for another reason (R11.23). `None` where nothing is assumed.
pub(crate) fn without_assumed_limits(machine: &Machine) -> Option<Machine> {
    machine.axes.iter().find_map(AssumedLimits::of)?;
    let mut machine = machine.clone();
    for axis in &mut machine.axes {
        let unit = unit(axis.axis_type);
        for (bound, assumed) in [
            (&mut axis.max_velocity_per_min, VELOCITY * 60.0),
            (&mut axis.max_acceleration_per_s2, ACCELERATION / unit),
            (&mut axis.max_jerk_per_s3, JERK / unit),
        ] {
            bound.get_or_insert(assumed * BEYOND);
        }
    }
    Some(machine)
}

/// Metres for linear axes, degrees for rotary ones.
fn unit(axis_type: AxisType) -> f64 {
    match axis_type {
        AxisType::Linear => 1000.0,
        AxisType::Rotary | AxisType::Spindle => 1.0,
    }
}
