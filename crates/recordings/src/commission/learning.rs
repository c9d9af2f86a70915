//! Learning from recorded circles: the file that keeps its rounds, and its result (R16.4).

use serde::{Deserialize, Serialize};

use super::plan_file::ValueListUsed;
use frictcomp::lists::FrictionList;
use frictcomp_physics::circle::RoundVerdict;
use frictcomp_physics::simulation::Plant;

/// The content of `learning.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct LearningFile {
    /// The version of the format of this file.
    pub schema: u32,
    /// The measured friction of X and Y, which bounds all lists.
    pub friction: [MeasuredFriction; 2],
    /// The rounds, first to last.
    pub rounds: Vec<LearningRound>,
}

/// Measured friction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MeasuredFriction {
    /// The file that it was read from, and its SHA-256.
    pub from: ValueListUsed,
    /// The list.
    pub list: FrictionList,
}

/// A round: the lists handed out for it, and the recordings made with them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct LearningRound {
    /// The lists of X and Y.
    pub lists: [ValueListUsed; 2],
    /// The predictions of the plant for X and Y.
    pub predictions: [Option<Prediction>; 2],
    /// The recordings on which the next round rests; none before.
    pub recordings: Vec<RecordedFile>,
}

/// The prediction for a list.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Prediction {
    /// The largest glitch.
    #[serde(rename = "predicted_glitch")]
    pub glitch_um: f64,
    /// Stiffness of the contact that fits the recordings, as a multiple of that of the plant.
    #[serde(rename = "predicted_contact")]
    pub contact: f64,
}

/// A recording with its SHA-256.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedFile {
    /// The file within the folder of its round.
    pub file: String,
    /// The SHA-256 of its bytes in hexadecimal digits.
    pub sha256: String,
}

impl LearningFile {
    /// The version that is written.
    pub const SCHEMA: u32 = 1;
}

impl Prediction {
    /// Creates a prediction with no more digits than are meaningful.
    pub fn of(glitch_um: f64, contact: f64) -> Self {
        let [glitch_um, contact] = [glitch_um, contact].map(|it| (it * 1e6).round() / 1e6);
        Self { glitch_um, contact }
    }

    /// Returns whether the recording misses the prediction by more than max(25 %, 0.5 µm) (R16.9).
    pub fn is_missed_by(&self, recorded_um: f64) -> bool {
        (recorded_um - self.glitch_um).abs() > f64::max(0.25 * self.glitch_um, 0.5)
    }
}

/// The progress of an axis.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct LearnedAxis {
    /// The axis.
    pub axis: &'static str,
    /// The judgement of each recorded round.
    pub rounds: Vec<RoundVerdict>,
    /// The number of the best round, from 1 on; `None` before the first is recorded.
    pub best_round: Option<usize>,
    /// The list of that round.
    pub list: Option<String>,
    /// Whether two rounds in succession brought no gain.
    pub is_over: bool,
}

/// The next step of the user.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum NextStep {
    /// Recordings needed in this folder, with these lists.
    Record {
        /// Path of the folder.
        folder: String,
        /// The lists of X and Y.
        lists: [String; 2],
    },
    /// The end: no further gain is possible.
    Done,
}

/// Report on a learning process.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct LearnReport {
    /// The reference plant.
    pub plant: Plant,
    /// Feeds of the circles in mm/min, as recorded.
    pub feeds: Vec<f64>,
    /// X and Y.
    pub axes: [LearnedAxis; 2],
    /// The predictions for the lists of each round, X and Y.
    pub predictions: Vec<[Option<Prediction>; 2]>,
    /// The next step.
    pub next: NextStep,
}
