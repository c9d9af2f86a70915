//! The shares of the limits of an axis that a piece of the path may use.

use super::limits::AxisLimits;
use super::profile::{Bounds, RampForm};

/// Share of the limits for a piece of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Share {
    /// The whole limits.
    Whole,
    /// The share next to a kink at one of its ends.
    BesideKink,
}

/// Share of an axis' acceleration that a kink may take, and of its jerk twice this share: two kinks of opposite sign in
/// neighbouring cycles add up.
pub(super) const KINK_SHARE: f64 = 0.25;

impl Share {
    /// Returns the limits of an axis under this share.
    pub(super) fn of(self, limits: &AxisLimits) -> Bounds {
        let (acceleration, jerk) = match self {
            Self::Whole => (1.0, 1.0),
            Self::BesideKink => (1.0 - KINK_SHARE, 1.0 - 2.0 * KINK_SHARE),
        };
        Bounds {
            velocity: limits.velocity_per_s,
            acceleration: limits.acceleration_per_s2 * acceleration,
            jerk: limits.jerk_per_s3 * jerk,
            curve_jerk: limits.curve_jerk_per_s3 * jerk,
            ramps: RampForm::default(),
        }
    }
}
