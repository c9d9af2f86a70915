//! The results of all recordings of a commissioning (R16.2, R16.9).

use serde::{Deserialize, Serialize};

use super::found::{CirclesFound, FrictionFound};

/// The greatest additive current as a part of the measured friction.
pub const MOST_CURRENT: f64 = 1.3;

/// Two circles are compared where v²/R differs by less than this part.
const SAME_ACCELERATION: f64 = 0.05;

/// A recording in the folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordingResult {
    /// The file.
    pub file: String,
    /// The SHA-256 of its bytes.
    pub sha256: String,
    /// The SHA-256 of the plan and the options that it was read with; with others it is read again.
    pub read_with: String,
    /// The number of its program.
    pub program: Option<u16>,
    /// Result.
    pub found: Found,
}

/// Result of a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Found {
    /// The friction of an axis.
    Friction(FrictionFound),
    /// Circles.
    Circles(CirclesFound),
    /// Nothing that is used, with the reason.
    Refused(String),
}

/// A circle with compensation off and on, as they were recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BeforeAfter {
    /// The planned feed in mm/min.
    pub feed: f64,
    /// The largest glitch with compensation off in µm.
    pub off_um: f64,
    /// The largest glitch with compensation on in µm.
    pub on_um: f64,
}

impl BeforeAfter {
    /// Whether compensation leaves more than there was without it.
    pub fn is_worse(&self) -> bool {
        self.on_um > self.off_um
    }
}

/// The feeds that were recorded with compensation off and on and that nothing speaks against, slowest
/// first. Programs are told by their numbers; of several recordings of a program the last one counts.
pub fn before_after(
    results: &[RecordingResult],
    is_off: impl Fn(u16) -> bool,
    is_on: impl Fn(u16) -> bool,
) -> Vec<BeforeAfter> {
    let circles = |is_so: &dyn Fn(u16) -> bool| {
        let found = results.iter().filter_map(|it| match &it.found {
            Found::Circles(found) if found.against.is_empty() && is_so(it.program?) => Some(found),
            _ => None,
        });
        found.collect::<Vec<&CirclesFound>>()
    };
    let on = circles(&is_on);
    let mut pairs: Vec<BeforeAfter> = Vec::new();
    for off in circles(&is_off) {
        let same = |on: &&&CirclesFound| {
            on.feed.total_cmp(&off.feed).is_eq()
                && (on.acceleration / off.acceleration - 1.0).abs() < SAME_ACCELERATION
        };
        if let Some(on) = on.iter().rev().find(same) {
            pairs.retain(|it| it.feed.total_cmp(&off.feed).is_ne());
            pairs.push(BeforeAfter {
                feed: off.feed,
                off_um: off.worst_um,
                on_um: on.worst_um,
            });
        }
    }
    pairs.sort_by(|one, other| one.feed.total_cmp(&other.feed));
    pairs
}
