//! The limits of each axis, and the values assumed where the configuration has none.

use super::trace::Movement;
use frictcomp::lists::{AxisType, SlopeProfile};
use frictcomp::machine::{Axis, Machine};

/// The bounds of one axis: mm or degrees, per second.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AxisLimits {
    /// The highest velocity.
    pub velocity_per_s: f64,
    /// The greatest acceleration.
    pub acceleration_per_s2: f64,
    /// The greatest jerk.
    pub jerk_per_s3: f64,
    /// The greatest jerk that the curvature of the path may take.
    pub curve_jerk_per_s3: f64,
    /// The share of the acceleration by which the axis may jump in a corner, P-AXIS-00013; `None` if
    /// its ramps limit that.
    pub corner_share: Option<f64>,
    /// Limits that the configuration does not give.
    pub assumed: Assumed,
}

/// The assumed bounds of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Assumed {
    /// `max_velocity`.
    pub velocity: bool,
    /// `max_acceleration`.
    pub acceleration: bool,
    /// `max_jerk`.
    pub jerk: bool,
}

/// The assumed bounds of an axis, in the form of its configuration.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AssumedLimits {
    /// The name of the axis.
    pub axis: String,
    /// Type.
    pub axis_type: AxisType,
    /// `max_velocity` in mm/min or °/min, if it is assumed.
    pub max_velocity: Option<f64>,
    /// `max_acceleration` in m/s² or °/s², if it is assumed.
    pub max_acceleration: Option<f64>,
    /// `max_jerk` in m/s³ or °/s³, if it is assumed.
    pub max_jerk: Option<f64>,
}

impl AssumedLimits {
    /// Returns the assumed bounds of an axis; `None` if the configuration gives all of them.
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
    /// Returns the bounds of an axis at feed with ramps of the acceleration (R5.2). `frictcomp.toml` takes precedence
    /// over the axis list; what neither gives is assumed to be the default of the control's parameters.
    pub fn of(axis: &Axis) -> Self {
        Self::with(axis, SlopeProfile::Trapez, 0.0)
    }

    /// Returns the bounds of an axis at feed under a profile of the acceleration (P-CHAN-00071, `#SLOPE`), with a given
    /// CNC cycle in seconds: steps of the acceleration take one cycle.
    fn with(axis: &Axis, slope: SlopeProfile, cycle_s: f64) -> Self {
        let unit = unit(axis.axis_type);
        let listed = &axis.listed;
        let per_minute = axis.max_velocity_per_min.map(|velocity| velocity / 60.0);
        let velocity = per_minute.or(listed.velocity_per_s);
        let steps = slope == SlopeProfile::Step;
        let listed_acceleration = if steps {
            listed.stage_acceleration_per_s2
        } else {
            listed.acceleration_per_s2
        };
        let acceleration = axis.max_acceleration_per_s2.map(|given| given * unit);
        let acceleration = acceleration.or(listed_acceleration);
        let known = acceleration.unwrap_or(ACCELERATION);
        let jerk = axis.max_jerk_per_s3.map(|given| given * unit);
        let ramp = if steps { Some(cycle_s) } else { listed.ramp_s };
        let jerk = jerk.or(ramp.map(|ramp| known / ramp));
        let bound = jerk.unwrap_or(JERK);
        let curve = listed.curve_ramp_s.map(|ramp| known / ramp);
        let curve = curve.filter(|_| axis.max_jerk_per_s3.is_none());
        Self {
            velocity_per_s: velocity.unwrap_or(VELOCITY),
            acceleration_per_s2: known,
            jerk_per_s3: bound,
            curve_jerk_per_s3: curve.unwrap_or(bound),
            corner_share: listed.corner_share,
            assumed: Assumed {
                velocity: velocity.is_none(),
                acceleration: acceleration.is_none(),
                jerk: jerk.is_none(),
            },
        }
    }

    /// Returns the bounds of an axis in rapid motions: those of its list, otherwise those at feed.
    fn rapid(axis: &Axis, at_feed: Self) -> Self {
        let listed = &axis.listed;
        let own = |listed: Option<f64>, configured: Option<f64>, at_feed: f64| {
            listed.filter(|_| configured.is_none()).unwrap_or(at_feed)
        };
        let acceleration = own(
            listed.rapid_acceleration_per_s2,
            axis.max_acceleration_per_s2,
            at_feed.acceleration_per_s2,
        );
        let jerk = listed.rapid_ramp_s.map(|ramp| acceleration / ramp);
        let jerk = own(jerk, axis.max_jerk_per_s3, at_feed.jerk_per_s3);
        Self {
            velocity_per_s: own(
                listed.rapid_velocity_per_s,
                axis.max_velocity_per_min,
                at_feed.velocity_per_s,
            ),
            acceleration_per_s2: acceleration,
            jerk_per_s3: jerk,
            curve_jerk_per_s3: jerk,
            ..at_feed
        }
    }
}

/// The bounds of all axes, under each profile of the acceleration.
#[derive(Debug, Clone)]
pub(super) struct MachineLimits {
    /// The profile if a program selects none: P-CHAN-00071, otherwise ramps of constant jerk.
    channel: SlopeProfile,
    steps: ByMovement,
    ramps: ByMovement,
}

/// The bounds of all axes in feed and in rapid motions.
#[derive(Debug, Clone)]
struct ByMovement {
    feed: Vec<AxisLimits>,
    rapid: Vec<AxisLimits>,
}

impl MachineLimits {
    /// Returns the bounds of the axes of a machine, with a given CNC cycle in seconds.
    pub(super) fn of(machine: &Machine, cycle_s: f64) -> Self {
        let under = |slope| {
            let axes = machine.axes.iter();
            let both = axes.map(|axis| {
                let at_feed = AxisLimits::with(axis, slope, cycle_s);
                (at_feed, AxisLimits::rapid(axis, at_feed))
            });
            let (feed, rapid) = both.unzip();
            ByMovement { feed, rapid }
        };
        Self {
            channel: machine.channel.slope.unwrap_or(SlopeProfile::Trapez),
            steps: under(SlopeProfile::Step),
            ramps: under(SlopeProfile::Trapez),
        }
    }

    /// Returns the bounds in a movement, under the profile that the program selects.
    pub(super) fn during(&self, movement: Movement, slope: Option<SlopeProfile>) -> &[AxisLimits] {
        let by_movement = match self.profile(slope) {
            SlopeProfile::Step => &self.steps,
            _ => &self.ramps,
        };
        match movement {
            Movement::Rapid => &by_movement.rapid,
            _ => &by_movement.feed,
        }
    }

    /// Returns the profile that a program selects, otherwise that of the channel.
    pub(super) fn profile(&self, slope: Option<SlopeProfile>) -> SlopeProfile {
        slope.unwrap_or(self.channel)
    }
}

/// The factor by which [`without_assumed_limits`] exceeds the assumed bounds.
const BEYOND: f64 = 1e6;

/// Returns the machine with bounds far beyond any motion in place of the assumed ones: what is slow on
/// it is slow for another reason (R11.23). `None` if nothing is assumed.
pub(crate) fn without_assumed_limits(machine: &Machine) -> Option<Machine> {
    machine.axes.iter().find_map(AssumedLimits::of)?;
    let mut machine = machine.clone();
    for axis in &mut machine.axes {
        let unit = unit(axis.axis_type);
        let is_assumed = AxisLimits::of(axis).assumed;
        for (bound, is_assumed, assumed) in [
            (
                &mut axis.max_velocity_per_min,
                is_assumed.velocity,
                VELOCITY * 60.0,
            ),
            (
                &mut axis.max_acceleration_per_s2,
                is_assumed.acceleration,
                ACCELERATION / unit,
            ),
            (&mut axis.max_jerk_per_s3, is_assumed.jerk, JERK / unit),
        ] {
            if is_assumed {
                *bound = Some(assumed * BEYOND);
            }
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
