//! The results of all recordings of a commissioning (R16.2, R16.9).

use serde::{Deserialize, Serialize};

use super::actual::FollowedPosition;
use super::compared::AtFeed;
use super::found::{CirclesFound, FrictionFound};
use super::strokes::StrokesFound;
use super::switched::CompensationShown;
use frictcomp_physics::circle::MeasuredGlitch;

/// A recording in the folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordingResult {
    /// Name of the file.
    pub file: String,
    /// The SHA-256 of its bytes.
    pub sha256: String,
    /// The SHA-256 of the plan and the options that it was read with; if they change, it is read again.
    pub read_with: String,
    /// The number of its program.
    pub program: Option<u16>,
    /// Result.
    pub found: RecordingOutcome,
}

/// Result of a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum RecordingOutcome {
    /// The friction of an axis.
    Friction(FrictionFound),
    /// Circles.
    Circles(CirclesFound),
    /// Strokes of an axis alone.
    Strokes(StrokesFound),
    /// No usable result, with the reason.
    Refused(String),
}

impl RecordingOutcome {
    /// Reasons why nothing is concluded from it.
    pub fn against(&self) -> &[String] {
        match self {
            Self::Friction(found) => &found.against,
            Self::Circles(found) => &found.against,
            Self::Strokes(found) => &found.against,
            Self::Refused(reason) => std::slice::from_ref(reason),
        }
    }

    /// Remarks.
    pub fn notes(&self) -> &[String] {
        match self {
            Self::Friction(found) => &found.notes,
            Self::Circles(found) => &found.notes,
            Self::Strokes(found) => &found.notes,
            Self::Refused(_) => &[],
        }
    }

    /// Returns whether it counts for its program: there are no reasons against it, and it was driven at the planned
    /// feeds or near them. A first pass at 10 % override does not count.
    pub fn is_used(&self) -> bool {
        self.against().is_empty() && self.reversals().all(|it| it.is_near())
    }

    /// Returns the recorded feeds as a part of the planned ones, if they are known.
    pub fn driven_part(&self) -> Option<f64> {
        match self {
            Self::Friction(found) => found.override_part,
            _ => self.reversals().map(|it| it.driven / it.feed).next(),
        }
    }

    /// Refuses it with a reason.
    pub fn refuse(&mut self, reason: String) {
        match self {
            Self::Friction(found) => found.against.push(reason),
            Self::Circles(found) => found.against.push(reason),
            Self::Strokes(found) => found.against.push(reason),
            Self::Refused(_) => {}
        }
    }

    /// Adds a remark.
    pub fn note(&mut self, remark: String) {
        match self {
            Self::Friction(found) => found.notes.push(remark),
            Self::Circles(found) => found.notes.push(remark),
            Self::Strokes(found) => found.notes.push(remark),
            Self::Refused(_) => {}
        }
    }

    /// Returns the evidence on the compensation; constant speeds give none.
    pub fn compensation(&self) -> Option<&CompensationShown> {
        match self {
            Self::Circles(found) => Some(&found.compensation),
            Self::Strokes(found) => Some(&found.compensation),
            Self::Friction(_) | Self::Refused(_) => None,
        }
    }

    /// Returns the relation of the actual position of an axis, by its place in the plan, to the commanded one.
    pub(super) fn followed(&self, axis: usize) -> Option<FollowedPosition> {
        match self {
            Self::Circles(found) => found.followed[axis],
            Self::Strokes(found) => found.followed,
            Self::Friction(_) | Self::Refused(_) => None,
        }
    }

    /// Returns the time in s over which the positions of an axis are averages, if they are.
    pub(super) fn averaged_s(&self, axis: usize) -> Option<f64> {
        let of_axis = self.followed(axis).and_then(|it| it.averaged_s);
        match self {
            Self::Circles(found) => of_axis.or(found.averaged_s),
            _ => of_axis,
        }
    }

    /// Returns the unit of its glitches.
    pub(super) fn unit(&self) -> &str {
        match self {
            Self::Strokes(found) => &found.unit,
            _ => "µm",
        }
    }

    /// Returns the largest glitch in µm or 0.001° that it shows; 0 if none.
    pub(super) fn largest_glitch(&self) -> f64 {
        let reversals = self.reversals();
        let glitches = reversals.flat_map(|it| it.glitches);
        glitches.fold(0.0, |most, (_, it)| most.max(it.um))
    }

    /// Returns the evidence on the compensation, to add to it.
    pub fn compensation_mut(&mut self) -> Option<&mut CompensationShown> {
        match self {
            Self::Circles(found) => Some(&mut found.compensation),
            Self::Strokes(found) => Some(&mut found.compensation),
            Self::Friction(_) | Self::Refused(_) => None,
        }
    }

    /// Returns the results of reversals at each feed.
    pub(super) fn reversals(&self) -> impl Iterator<Item = AtFeed> {
        let circles = match self {
            Self::Circles(found) => found.at_feed(),
            _ => None,
        };
        let strokes = match self {
            Self::Strokes(found) => &found.reversals[..],
            _ => &[],
        };
        let strokes = strokes.iter().map(|it| AtFeed {
            feed: it.feed,
            driven: it.measured_feed,
            glitches: vec![((0, None), MeasuredGlitch::of(it.glitch, it.error))],
        });
        circles.into_iter().chain(strokes)
    }
}

/// Refuses recordings that cannot belong to the others: the same bytes twice, and circles about another centre
/// than those before them (R16.9).
pub fn refuse_strangers(results: &mut [RecordingResult]) {
    /// Largest distance of the centres of one machine, in mm.
    const SAME_CENTRE_MM: f64 = 1.0;
    let mut first: Option<([f64; 2], String)> = None;
    for at in 0..results.len() {
        let (earlier, rest) = results.split_at_mut(at);
        let Some(result) = rest.first_mut() else {
            return;
        };
        if let Some(same) = earlier.iter().find(|it| it.sha256 == result.sha256) {
            result
                .found
                .refuse(format!("it is a copy of `{}`", same.file));
            continue;
        }
        let RecordingOutcome::Circles(found) = &mut result.found else {
            continue;
        };
        if !found.against.is_empty() {
            continue;
        }
        let [x, y] = found.centre_mm;
        match &first {
            None => first = Some((found.centre_mm, result.file.clone())),
            Some(([first_x, first_y], file)) => {
                if (x - first_x).hypot(y - first_y) > SAME_CENTRE_MM {
                    found.against.push(format!(
                        "its centre is at {x:.1}, {y:.1} and that of `{file}` at {first_x:.1}, {first_y:.1}: it is of \
                         another place or machine"
                    ));
                }
            }
        }
    }
}
