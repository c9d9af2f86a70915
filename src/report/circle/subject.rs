//! What is reported of a circular test.

use crate::circle::{
    CircularTest, Comparison, Diagnosis, Recording, Side, diagnose, diagnose_comparison,
};
use crate::current::Switched;

/// How the radial deviations were treated; stands beside the figures (R5.21).
pub(super) const TREATMENT: &str = "every point of the path for G, F and the glitch; H at 36000 fixed angles, \
                         linear between points; no filter, no mean";

/// Where the value list came from.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ListOrigin {
    /// It is the friction curve of the plant.
    Plant,
    /// A file of the user.
    File(String),
}

/// What is reported.
#[derive(Debug, Clone)]
pub struct CircleReport {
    /// What was driven.
    pub subject: Subject,
    /// The paths without and with compensation, or what was recorded.
    pub sides: Vec<NamedSide>,
}

/// What was driven.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Subject {
    /// A simulated test, with the origin of its value list and the cycles in which a force was limited.
    Simulated {
        /// The test.
        test: Box<CircularTest>,
        /// Where its list came from.
        origin: ListOrigin,
        /// Cycles of the speed loop in which a force was limited.
        saturated_cycles: u64,
    },
    /// Recorded circles.
    Recorded(Box<Recording>),
}

/// Paths under a name, with what they suggest.
#[derive(Debug, Clone)]
pub struct NamedSide {
    /// `off`, `on` or `recorded`.
    pub name: &'static str,
    /// The paths.
    pub side: Side,
    /// What their shapes suggest.
    pub advice: Vec<Diagnosis>,
}

impl CircleReport {
    /// The report of a simulated test.
    pub fn simulated(test: CircularTest, comparison: Comparison, origin: ListOrigin) -> Self {
        let side = |name, advice, side| NamedSide { name, side, advice };
        let without = diagnose(&comparison.off.paths, Some(Switched::Off));
        let with = diagnose_comparison(&comparison);
        Self {
            subject: Subject::Simulated {
                test: Box::new(test),
                origin,
                saturated_cycles: comparison.saturated_cycles,
            },
            sides: vec![
                side("off", without, comparison.off),
                side("on", with, comparison.on),
            ],
        }
    }

    /// The report of recorded circles.
    pub fn recorded(recording: Recording) -> Self {
        let side = recording.side.clone();
        Self {
            subject: Subject::Recorded(Box::new(recording)),
            sides: vec![NamedSide {
                name: "recorded",
                advice: diagnose(&side.paths, None),
                side,
            }],
        }
    }
}

/// A number of µm as it is written for machines.
pub(super) fn round(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
