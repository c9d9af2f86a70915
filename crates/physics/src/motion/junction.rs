//! Block transitions: the velocity at which one piece of the path may turn into the next (R5.2).

use super::limits::AxisLimits;
use super::segment::PathSegment;
use super::share::{KINK_SHARE, Share};
use frictcomp::interpreter::BlockEnd;

/// Change of slope below which it is due only to the decimals of the program.
const STRAIGHT: f64 = 1e-7;

/// Change of the slope of an axis from which the path stops: 5.7° between two lines.
const SHARP: f64 = 0.1;

/// The transition from one piece of the path to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Junction {
    /// A smooth transition, at which only the bounds of the motion change.
    Smooth,
    /// A smooth transition with a path velocity set by the program.
    Paced {
        /// The highest path velocity in it.
        velocity: f64,
    },
    /// A kink that may be passed while the path speeds up or slows down.
    Bend {
        /// The highest path velocity in it.
        velocity: f64,
    },
    /// A kink that is passed without path acceleration.
    Corner {
        /// The highest path velocity in it.
        velocity: f64,
    },
    /// Stop of the path.
    Stop,
}

impl Junction {
    /// Returns the transition between two pieces of the path. In a CNC cycle, in which the path turns from one slope to
    /// another, the velocity of an axis jumps by `v·Δx'` and its acceleration by `v²·Δx'' + a·Δx'`; the jumps stay
    /// within a share of the acceleration and the jerk of the axis in that cycle.
    pub(super) fn between(
        before: &PathSegment,
        after: &PathSegment,
        limits: &[AxisLimits],
        cycle: f64,
    ) -> Self {
        if before.end == BlockEnd::ExactStop {
            return Self::Stop;
        }
        let mut junction = Self::Smooth;
        let bounds = [before, after].map(|segment| segment.bounds(limits, Share::BesideKink));
        let pull = bounds[0].acceleration.min(bounds[1].acceleration);
        for (axis, limits) in limits.iter().enumerate().take(before.axes()) {
            let turn = (after.slope(axis, 0.0) - before.slope(axis, before.length)).abs();
            let bow = (after.bend(axis, 0.0) - before.bend(axis, before.length)).abs();
            if turn >= SHARP && limits.corner_share.is_none() {
                return Self::Stop;
            }
            // A bow over one length unit changes the slope by as much.
            if turn < STRAIGHT && bow < STRAIGHT {
                continue;
            }
            // The jerk that the kink may take; a jump of velocity counts over two cycles.
            let jump = limits.acceleration_per_s2 / cycle;
            let budget = match limits.corner_share {
                Some(share) => share * jump,
                None => KINK_SHARE * limits.jerk_per_s3.min(jump),
            };
            let pulled = pull * turn / cycle;
            let passing = pulled <= budget / 2.0;
            let left = if passing { budget - pulled } else { budget };
            let (linear, square) = (turn / (cycle * cycle), bow / cycle);
            let velocity = 2.0 * left / (linear + (linear * linear + 4.0 * square * left).sqrt());
            let velocity = velocity.min(before.length.min(after.length) / cycle);
            junction = junction.and(velocity, passing);
        }
        junction.paced(before.end_velocity)
    }

    /// Returns the transition at a velocity that the program sets (E).
    fn paced(self, asked: f64) -> Self {
        let velocity = asked.min(self.velocity());
        match self {
            Self::Smooth if asked.is_finite() => Self::Paced { velocity },
            Self::Bend { .. } => Self::Bend { velocity },
            Self::Corner { .. } => Self::Corner { velocity },
            kept => kept,
        }
    }

    /// Returns the stricter of the known bound and one more kink.
    fn and(self, velocity: f64, passing: bool) -> Self {
        let velocity = velocity.min(self.velocity());
        match self {
            Self::Stop => Self::Stop,
            Self::Smooth | Self::Bend { .. } if passing => Self::Bend { velocity },
            _ => Self::Corner { velocity },
        }
    }

    /// Returns the highest path velocity in it.
    pub(super) fn velocity(self) -> f64 {
        match self {
            Self::Smooth => f64::INFINITY,
            Self::Paced { velocity } | Self::Bend { velocity } | Self::Corner { velocity } => {
                velocity
            }
            Self::Stop => 0.0,
        }
    }

    /// Returns the transition without path acceleration.
    pub(super) fn fixed(self) -> Self {
        match self {
            Self::Stop => Self::Stop,
            open => Self::Corner {
                velocity: open.velocity(),
            },
        }
    }

    /// Returns whether the axes turn in it while they move.
    pub(super) fn is_kink(self) -> bool {
        matches!(self, Self::Bend { .. } | Self::Corner { .. })
    }

    /// Returns whether the path must be without acceleration in it.
    pub(super) fn is_fixed(self) -> bool {
        matches!(self, Self::Corner { .. } | Self::Stop)
    }
}
