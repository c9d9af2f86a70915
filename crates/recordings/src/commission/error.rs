//! Failures in making a plan.

use thiserror::Error;

/// Reason why a plan cannot be made (R16.8).
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlanError {
    /// No axis, or more than two.
    #[error("{0} axes were given; one alone or two linear axes are measured at a time")]
    Axes(usize),
    /// Two axes with one name.
    #[error("axis `{0}` was given twice")]
    Twice(String),
    /// Degrees and mm in one plan, or two rotary axes.
    #[error("`{rotary}` turns, and a circle needs two linear axes: degrees and mm are never mixed")]
    Mixed {
        /// The rotary axis.
        rotary: String,
    },
    /// A circle is programmed in G17, G18 or G19.
    #[error(
        "`{first}` and `{second}` are not a plane: circles are planned for X and Y, Z and X, Y and Z"
    )]
    Plane {
        /// The first axis.
        first: String,
        /// The second axis.
        second: String,
    },
    /// A travel without an extent.
    #[error("the travel of `{0}` ends where it begins, or is not a finite number")]
    FreeTravel(String),
    /// A value that is not positive.
    #[error("{what} of {value} cannot be used")]
    NotPositive {
        /// The value.
        what: &'static str,
        /// Number.
        value: f64,
    },
    /// Too few feeds for the plant.
    #[error("the number of different feeds is {0}; a plan needs at least 4 and takes at most 12")]
    Feeds(usize),
    /// An axis that cannot move as fast.
    #[error("{feed} {unit}/min is faster than `{axis}` moves, {limit} {unit}/min")]
    TooFast {
        /// Name of the axis.
        axis: String,
        /// The requested feed.
        feed: f64,
        /// The feed that it reaches.
        limit: f64,
        /// mm or degrees.
        unit: &'static str,
    },
    /// The travel of a run is longer than that of the axis.
    #[error(
        "at {feed:.0} {unit}/min `{axis}` needs {needed:.1} {unit}: {ramp:.1} {unit} at each end to \
         accelerate, with 10 % to spare, and {steady:.1} {unit} at constant speed; the inner 90 % of its \
         travel are {room:.1} {unit}"
    )]
    NoRoom {
        /// Name of the axis.
        axis: String,
        /// The feed in mm/min or °/min.
        feed: f64,
        /// The travel of one run.
        needed: f64,
        /// The travel to accelerate, with the spare part.
        ramp: f64,
        /// The travel at constant speed.
        steady: f64,
        /// The available travel.
        room: f64,
        /// mm or degrees.
        unit: &'static str,
    },
    /// A circle that does not fit.
    #[error(
        "a circle of {radius} mm radius needs {needed:.1} mm of `{axis}`; the inner 90 % of its travel are {room:.1} mm"
    )]
    Radius {
        /// The radius.
        radius: f64,
        /// The axis with the shortest travel.
        axis: String,
        /// The travel that the circle takes.
        needed: f64,
        /// The available travel.
        room: f64,
    },
    /// A circle that an axis cannot follow at a feed.
    #[error(
        "{feed} mm/min on a radius of {radius} mm needs {needed:.1} {quantity} of `{axis}`, which has {limit:.1}"
    )]
    TooTight {
        /// The feed in mm/min.
        feed: f64,
        /// The radius.
        radius: f64,
        /// Name of the axis.
        axis: String,
        /// Acceleration or jerk, with the unit.
        quantity: &'static str,
        /// The value at that feed.
        needed: f64,
        /// The bound.
        limit: f64,
    },
    /// A slowest speed that is not below the fastest feed, both in mm/s or °/s.
    #[error(
        "the slowest speed, {slowest} mm/s or °/s, is not below the fastest feed, {fastest:.1} mm/s or °/s"
    )]
    Slowest {
        /// The slowest speed.
        slowest: f64,
        /// The fastest feed.
        fastest: f64,
    },
    /// More rounds than signatures can distinguish.
    #[error("{0} rounds are more than signatures can tell apart")]
    Rounds(u16),
    /// Stage 2 on an axis that takes no list.
    #[error(
        "friction compensation of `{0}` is not configured (P-AXIS-00522 is 0), so a list has no effect there"
    )]
    Unconfigured(String),
}

impl PlanError {
    /// Returns the advice.
    pub fn help(&self) -> String {
        match self {
            Self::Axes(_) => "plan two axes in one folder, further ones in another".to_owned(),
            Self::Twice(_) => "name each axis once".to_owned(),
            Self::Mixed { rotary } => {
                format!("plan `{rotary}` alone: strokes show its following error")
            }
            Self::Plane { first, .. } => {
                format!("plan `{first}` alone: strokes show its following error")
            }
            Self::FreeTravel(axis) => format!("give both ends, the lower one first: {axis}0..300"),
            Self::NotPositive { .. } => "write a number above 0".to_owned(),
            Self::Feeds(_) => "give feeds over a decade: 500,1000,2000,5000".to_owned(),
            Self::TooFast { .. } => {
                "leave that feed out, or correct `max_velocity` of the axis".to_owned()
            }
            Self::NoRoom { .. } => {
                "leave the fastest feeds out, or give more of the travel".to_owned()
            }
            Self::Radius { .. } => "give a smaller radius, or more of the travel".to_owned(),
            Self::TooTight { .. } => "give a larger radius, or leave that feed out".to_owned(),
            Self::Slowest { .. } => {
                "leave `slowest` out, or give the speed at which the curve begins".to_owned()
            }
            Self::Rounds(_) => "continue in a separate folder".to_owned(),
            Self::Unconfigured(axis) => format!(
                "set `lr_param.frict_comp 1` in the axis list of {axis}, restart the control, and describe it in `frictcomp.toml`"
            ),
        }
    }
}
