//! The following error of an axis alone after the reversals of its strokes: motor side, not contour (R16.1).

use serde::{Deserialize, Serialize};

use super::actual::FollowedPosition;
use super::compared::ON_FEED;
use super::following::{Following, NotFollowed, PassedReversal};
use super::switched::CompensationShown;
use crate::identify::{Track, count};

/// Reversals without a stop at each feed: the ends of four strokes back and forth, without the last one.
const REVERSALS: usize = 7;

/// Part within which a feed and the fastest one differ equally from the plan, so that the feed belongs to the program.
const ONE_RATIO: f64 = 0.05;

/// Number of standard errors above which a glitch is visible.
const SEEN: f64 = 5.0;

/// Smallest visible glitch in µm or 0.001°: the smallest that is named on circles, too (R5.28).
const LEAST_SEEN: f64 = 0.5;

/// The strokes of a recorded program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StrokesFound {
    /// Name of the axis.
    pub axis: String,
    /// The unit of the glitches: µm, or 0.001° of a rotary axis.
    pub unit: String,
    /// The reversals at each feed, slowest first.
    pub reversals: Vec<FeedReversals>,
    /// Evidence on the compensation, besides the following error.
    pub compensation: CompensationShown,
    /// Relation of the actual position to the commanded one, where both were recorded.
    pub followed: Option<FollowedPosition>,
    /// Remarks.
    pub notes: Vec<String>,
    /// Reasons why nothing is concluded from it.
    pub against: Vec<String>,
}

/// The reversals of strokes at one feed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FeedReversals {
    /// The planned feed in mm/min or °/min.
    pub feed: f64,
    /// The recorded one.
    pub measured_feed: f64,
    /// The number of reversals.
    pub count: usize,
    /// The largest part of the following error after a reversal that is not the answer of the loops, mean of all
    /// reversals in the same direction.
    pub glitch: f64,
    /// The standard error of that mean, over all times after the reversals.
    pub error: f64,
}

/// A recording of strokes.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedStrokes<'a> {
    /// The motion.
    pub track: &'a Track,
    /// Commanded less actual position in 0.1 µm or 0.0001°.
    pub following_errors: &'a [f64],
}

impl StrokesFound {
    /// Judges the strokes of an axis, named with its unit of length, at these planned feeds.
    ///
    /// # Errors
    /// The following error is missing, or is not that of this motion.
    pub fn of(
        (axis, unit): (&str, &str),
        recorded: RecordedStrokes<'_>,
        feeds: &[f64],
    ) -> Result<Self, NotFollowed> {
        let turns = Following::of(recorded.track, recorded.following_errors)?.turns();
        let fastest = turns.iter().fold(0.0_f64, |most, it| most.max(it.speed));
        let part = fastest * 60.0 / feeds.last().copied().unwrap_or(f64::NAN);
        let mut found = Self {
            axis: axis.to_owned(),
            unit: if unit == "mm" { "µm" } else { "0.001°" }.to_owned(),
            reversals: Vec::new(),
            compensation: CompensationShown::default(),
            followed: None,
            notes: Vec::new(),
            against: Vec::new(),
        };
        for &feed in feeds {
            let is_at = |turn: &&PassedReversal| {
                let ratio = turn.speed * 60.0 / (feed * part);
                (ratio - 1.0).abs() <= ONE_RATIO
            };
            let at_feed: Vec<&PassedReversal> = turns.iter().filter(is_at).collect();
            if at_feed.len() < REVERSALS {
                found.against.push(format!(
                    "at F{feed} it has {} of {REVERSALS} reversals: it ends early, or is of another program",
                    at_feed.len()
                ));
                continue;
            }
            found.reversals.push(FeedReversals::of(feed, &at_feed));
        }
        let strange = turns.len().saturating_sub(found.counted());
        if strange > 0 && found.against.is_empty() {
            found.against.push(format!(
                "{strange} of its reversals are at no feed of the program"
            ));
        }
        if (part - 1.0).abs() > ON_FEED {
            found.notes.push(format!(
                "driven at {:.1} % of the planned feeds, which count as they were driven",
                part * 100.0
            ));
        }
        Ok(found)
    }

    fn counted(&self) -> usize {
        self.reversals.iter().map(|it| it.count).sum()
    }

    /// Returns the largest glitch of all feeds.
    pub fn worst(&self) -> f64 {
        self.reversals
            .iter()
            .map(|it| it.glitch)
            .fold(0.0, f64::max)
    }

    /// Returns whether friction is visible at any reversal.
    pub fn is_seen(&self) -> bool {
        let mut reversals = self.reversals.iter();
        reversals.any(|it| it.glitch > (SEEN * it.error).max(LEAST_SEEN))
    }
}

impl FeedReversals {
    fn of(feed: f64, turns: &[&PassedReversal]) -> Self {
        let mut worst = (0.0_f64, 0.0_f64);
        for sign in [1.0, -1.0] {
            let same = turns.iter().filter(|it| it.sign * sign > 0.0);
            let same: Vec<&PassedReversal> = same.copied().collect();
            let samples = same.iter().map(|it| it.left.len()).min().unwrap_or(0);
            let mean_at =
                |at: usize| same.iter().map(|it| it.left[at]).sum::<f64>() / count(same.len());
            let mean: Vec<f64> = (0..samples).map(mean_at).collect();
            let most = mean.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
            if most > worst.0 {
                let squares = same.iter().flat_map(|it| it.left.iter().zip(&mean));
                let squares: f64 = squares.map(|(one, mean)| (one - mean).powi(2)).sum();
                let freedom = count(samples) * count(same.len().saturating_sub(1)).max(1.0);
                worst = (most, (squares / freedom / count(same.len())).sqrt());
            }
        }
        let speeds = turns.iter().map(|it| it.speed * 60.0);
        Self {
            feed,
            measured_feed: speeds.sum::<f64>() / count(turns.len()),
            count: turns.len(),
            glitch: worst.0 * 1000.0,
            error: worst.1 * 1000.0,
        }
    }
}
