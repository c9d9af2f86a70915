//! Recordings that are not a circle.

use thiserror::Error;

use super::limits::{MIN_POINTS, MOST_MM, WIDEST_GAP_DEG};
use crate::circle::geometry::Direction;
use frictcomp::diagnostic::ReadableNumber;

/// A recording that is not a circle.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordedError {
    /// A file of ten rows.
    #[error("{0} different points are too few for a circle; at least {MIN_POINTS} are needed")]
    TooFew(usize),
    /// A straight line, or a point.
    #[error("the points are not on a circle")]
    NoCircle,
    /// A quarter of a circle.
    #[error(
        "the points cover {covered_deg:.0}\u{b0} of a circle of {radius_mm:.3} mm around \
         ({:.3}, {:.3}) mm; a full turn is needed", .centre_mm[0], .centre_mm[1]
    )]
    NotATurn {
        /// The angle of the longest path along the circle.
        covered_deg: f64,
        /// The radius that was found.
        radius_mm: f64,
        /// The centre that was found.
        centre_mm: [f64; 2],
    },
    /// A circle with a part that was not recorded.
    #[error(
        "points are missing: {0:.0}\u{b0} of the circle are in gaps of more than {WIDEST_GAP_DEG}\u{b0}, or of more \
         than 1\u{b0} where an axis reverses"
    )]
    Gaps(f64),
    /// An egg.
    #[error(
        "the path is not a circle: it deviates by {deviation_mm:.3} mm from one of {radius_mm:.3} mm \
         around ({:.3}, {:.3}) mm, more than {MOST_MM} mm", .centre_mm[0], .centre_mm[1]
    )]
    NotRound {
        /// Distance from the innermost to the outermost point.
        deviation_mm: f64,
        /// The radius that was found.
        radius_mm: f64,
        /// The centre that was found.
        centre_mm: [f64; 2],
    },
    /// Two recordings between which the zero point was moved.
    #[error("the centres of both paths are {distance_mm:.3} mm apart, more than {MOST_MM} mm")]
    Apart {
        /// The distance of the least-squares centres.
        distance_mm: f64,
    },
    /// Three recordings.
    #[error("{0} recordings were given")]
    Count(usize),
    /// A radius of 0 mm.
    #[error(
        "a radius of {} mm is not possible; it must be between 0.001 and 1000000 mm", ReadableNumber(*.0)
    )]
    CommandedRadius(f64),
    /// A feed of 0 mm/min.
    #[error(
        "a feed of {} mm/min is not possible; it must be between 0.1 and 1000000 mm/min", ReadableNumber(*.0)
    )]
    CommandedFeed(f64),
    /// Two counter-clockwise circles.
    #[error("both recordings run {}", .0.as_str())]
    SameDirection(Direction),
    /// A radius of 50 mm that was given for a circle of 100 mm.
    #[error("the recorded circle has a radius of {found_mm:.3} mm, not {commanded_mm} mm")]
    Radius {
        /// The radius that was given.
        commanded_mm: f64,
        /// The radius of the points.
        found_mm: f64,
    },
    /// Two directions at different feeds, in mm/min.
    #[error(
        "the directions were driven at {:.0} and {:.0} mm/min, so they cannot be compared", .0[0], .0[1]
    )]
    OtherFeeds([f64; 2]),
    /// A feed of 4000 mm/min that was given for a circle at 2000 mm/min.
    #[error(
        "by its times the recorded circle was driven at {found:.0} mm/min, not at {commanded} mm/min"
    )]
    Feed {
        /// The feed in mm/min that was given.
        commanded: f64,
        /// The feed in mm/min by the times.
        found: f64,
    },
}

impl RecordedError {
    /// Returns advice for the user.
    pub fn help(&self) -> &'static str {
        match self {
            Self::TooFew(_) | Self::NotATurn { .. } | Self::Gaps(_) => {
                "record one full turn with some overlap, without pauses of the recorder"
            }
            Self::NoCircle => "check that the columns hold the actual positions of two axes",
            Self::NotRound { .. } => "check the columns and their unit, and that both axes moved",
            Self::Apart { .. } => {
                "record both directions with the same zero point, or compare the shapes alone, each \
                 about its own centre"
            }
            Self::Count(_) => "give one of each direction, two at most",
            Self::CommandedRadius(_) => "give the commanded radius in mm",
            Self::CommandedFeed(_) => "give the commanded feed in mm/min",
            Self::OtherFeeds(_) => "give recordings of both directions at the same feed",
            Self::SameDirection(_) => "give one recording of each direction",
            Self::Feed { .. } => "check the commanded feed and the unit of the times",
            Self::Radius { .. } => "check the commanded radius and the unit of the columns",
        }
    }
}
