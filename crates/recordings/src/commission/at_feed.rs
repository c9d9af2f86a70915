//! The feed of a recording compared with the planned one, and the glitches there.

use frictcomp_physics::circle::{Direction, MeasuredGlitch};

/// A measured speed is the planned one within this part.
pub(super) const ON_FEED: f64 = 0.02;

/// Two recordings are compared if the feeds that were driven differ by less than this part: v²/R by 5 %.
const SAME_FEED: f64 = 0.025;

/// A recording represents its planned feed if it was driven at no less than this part of it …
const SLOWEST: f64 = 0.8;

/// … and at no more than this.
const FASTEST: f64 = 1.25;

/// The glitches of a recording at a feed.
#[derive(Debug, Clone)]
pub(super) struct AtFeed {
    /// The planned feed.
    pub(super) feed: f64,
    pub(super) driven: f64,
    /// The glitch of each axis, by its place in the plan, in each direction of travel, if it has one.
    pub(super) glitches: Vec<(GlitchPlace, MeasuredGlitch)>,
}

/// An axis, by its place in the plan, and the direction of travel on a circle.
pub(super) type GlitchPlace = (usize, Option<Direction>);

impl AtFeed {
    pub(super) fn is_near(&self) -> bool {
        (SLOWEST..=FASTEST).contains(&(self.driven / self.feed))
    }

    /// The deviation from the planned feed as a part of it; 0 within 2 %.
    pub(super) fn beside(&self) -> f64 {
        let part = (self.driven / self.feed - 1.0).abs();
        if part <= ON_FEED { 0.0 } else { part }
    }

    /// Whether another recording of the planned feed was driven at about the same feed.
    pub(super) fn is_driven_as(&self, other: &Self) -> bool {
        self.feed.total_cmp(&other.feed).is_eq()
            && (other.driven / self.driven - 1.0).abs() < SAME_FEED
    }
}
