//! The feed reached while cutting, compared with the programmed one (R11.23).

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::motion::{Cause, Movement, Sample, TraceSink};

/// The share of F below which a feed counts as not reached.
const REACHED: f64 = 0.8;

/// The share of the cutting time that may be slower because of assumed limits.
const TOLERATED: f64 = 0.1;

const MM_PER_S: f64 = 60.0;

/// The programmed feed and the reached one over all feed moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FeedReached {
    /// Cycles of feed moves.
    cutting: f64,
    /// The number of them below the share of F.
    slow: f64,
    /// The length of the path, in mm/s times cycles.
    way: f64,
    /// The cycles that this path would take at F throughout.
    at_feed: f64,
}

impl FeedReached {
    pub(super) fn push(&mut self, sample: &Sample<'_>) {
        let (reached, programmed) = (sample.path_velocity, sample.programmed_velocity);
        if sample.cause.movement != Movement::Feed {
            return;
        }
        self.cutting += 1.0;
        self.slow += f64::from(u8::from(reached < REACHED * programmed));
        self.way += reached;
        self.at_feed += reached / programmed;
    }

    /// Returns the programmed feed in mm/min: the path at F over its time; for several F their mean over the path.
    /// `None` if nothing is cut.
    pub fn programmed_mm_per_min(&self) -> Option<f64> {
        (self.at_feed > 0.0).then(|| self.way / self.at_feed * MM_PER_S)
    }

    /// Returns the reached feed in mm/min: the path over its time. `None` if nothing is cut.
    pub fn reached_mm_per_min(&self) -> Option<f64> {
        (self.cutting > 0.0).then(|| self.way / self.cutting * MM_PER_S)
    }

    /// Returns the share of the cutting time below 80 % of F.
    pub fn slow_share(&self) -> f64 {
        self.share(self.slow)
    }

    fn share(&self, cycles: f64) -> f64 {
        if self.cutting > 0.0 {
            cycles / self.cutting
        } else {
            0.0
        }
    }

    /// Returns the share of the cutting time that is below 80 % of F only because of the assumed limits. If F is a
    /// share of them (G194), that is all of it.
    pub(super) fn slow_share_against(&self, unlimited: &Self) -> f64 {
        if unlimited.at_feed < REACHED * self.at_feed {
            return 1.0;
        }
        self.share(self.slow - unlimited.slow).max(0.0)
    }
}

/// Returns whether this share of the cutting time is too large for a verdict on the contour.
pub(super) fn is_too_slow(share: f64) -> bool {
    share > TOLERATED
}

/// Takes only the feed from a trace.
#[derive(Debug, Default)]
pub(super) struct FeedOnly(pub(super) FeedReached);

impl TraceSink for FeedOnly {
    fn begin(&mut self, _: f64, _: &Arc<Cause>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.0.push(sample);
        ControlFlow::Continue(())
    }
}
