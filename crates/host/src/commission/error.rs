//! Failures that stop a commissioning.

use std::path::{Path, PathBuf};

use thiserror::Error;

use frictcomp::text::shown_path;
use frictcomp_physics::circle::{CircleError, TooMuchCurrent};
use frictcomp_recordings::commission::{LearnError, PlanError, PlanFile};

/// Reason why a commissioning cannot go on: one sentence in lower case.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CommissionError {
    /// A file that holds no plan.
    #[error("`{}` is not a plan: {reason}", shown_path(.path))]
    NotAPlan {
        /// Path of the file.
        path: PathBuf,
        /// Fault in words.
        reason: String,
    },
    /// A plan of another version.
    #[error("`{}` has the form {found}, and {} is read", shown_path(.path), PlanFile::SCHEMA)]
    PlanForm {
        /// Path of the file.
        path: PathBuf,
        /// Form.
        found: u32,
    },
    /// A folder without a plan.
    #[error("the folder `{}` has no `plan-1.json`", shown_path(.0))]
    NoPlan(PathBuf),
    /// A machine whose coordinates are in inch.
    #[error(
        "the coordinates of the machine are in inch (P-CHAN-00054 is 1), and what G71 does there is not documented"
    )]
    Inch,
    /// An axis that the machine does not have, or a spindle.
    #[error("the machine has no linear or rotary axis `{name}`")]
    NoAxis {
        /// The name.
        name: String,
        /// The linear and rotary axes of the machine.
        axes: Vec<String>,
    },
    /// A limit that a plan needs and that the machine does not say.
    #[error("`{key}` of axis `{axis}` is not known")]
    NoLimit {
        /// Name of the axis.
        axis: String,
        /// The key of `frictcomp.toml`.
        key: &'static str,
    },
    /// Programs that do not fit.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A plan that would replace another one, whose recordings would count for it.
    #[error("`{}` holds another plan", shown_path(.0))]
    OtherPlan(PathBuf),
    /// A plant that an earlier run kept, and that cannot be read.
    #[error("the plant in `results.json` cannot be read: {0}")]
    FittedPlant(String),
    /// A file that does not keep the rounds of learning.
    #[error("`{}` is not a file that `commission learn` wrote", shown_path(.0))]
    NotLearning(PathBuf),
    /// A folder in which learning has not begun.
    #[error("`{}` has no `learning.json`", shown_path(.0))]
    NotBegun(PathBuf),
    /// A folder in which learning cannot begin once more.
    #[error("learning has begun in `{}` already", shown_path(.0))]
    Begun(PathBuf),
    /// A list of a round that is another one now.
    #[error("`{}` is not the list that was handed out for this round", shown_path(.path))]
    OtherList {
        /// Path of the list.
        path: PathBuf,
        /// The SHA-256 that it had.
        sha256: String,
    },
    /// A file where a list of the next round is to be.
    #[error("`{}` already exists and is a different list", shown_path(.0))]
    ListThere(PathBuf),
    /// Recordings that are not those from which a round was made.
    #[error(
        "`{}` was added, changed or removed after round {round} was made from the recordings", shown_path(.path)
    )]
    ChangedRecording {
        /// Path of the recording.
        path: PathBuf,
        /// The round that was made from it.
        round: usize,
    },
    /// A recording that occurs twice: as two recordings of one list it would show no spread.
    #[error("`{}` is a copy of `{}`", shown_path(.path), shown_path(.of))]
    RecordedTwice {
        /// Path of the recording.
        path: PathBuf,
        /// The one that it repeats.
        of: PathBuf,
    },
    /// A first list that adds too much.
    #[error("`{}` cannot be the first list: {reason}", shown_path(.path))]
    FirstList {
        /// Path of the list.
        path: PathBuf,
        /// The speed at which it adds too much.
        reason: TooMuchCurrent,
    },
    /// A list that is no friction.
    #[error("`{}` is not a measured friction: an output or the scaling is not above 0", shown_path(.0))]
    NotFriction(PathBuf),
    /// A best list before a round is recorded.
    #[error("no round is recorded yet, so there is no best list")]
    NoBestList,
    /// Recordings that do not make a round.
    #[error("in `{}`: {reason}", shown_path(.folder))]
    Learn {
        /// The folder of the round.
        folder: PathBuf,
        /// The fault.
        reason: LearnError,
    },
    /// A circle that cannot be simulated.
    #[error(transparent)]
    Circle(#[from] CircleError),
    /// Too few recordings with a date for a trend.
    #[error(
        "{} of the {recordings} recordings in `{}` give the friction at a date; a trend needs two",
        .dates, shown_path(.folder)
    )]
    NoTrend {
        /// The folder.
        folder: PathBuf,
        /// The number of recordings with a friction and a date.
        dates: usize,
        /// The number of all recordings.
        recordings: usize,
        /// The other ones, each with its reason.
        left_out: Vec<(String, String)>,
    },
}

impl CommissionError {
    /// Returns the file or the folder at fault.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::NotAPlan { path, .. }
            | Self::PlanForm { path, .. }
            | Self::NoPlan(path)
            | Self::OtherPlan(path)
            | Self::NotLearning(path)
            | Self::NotBegun(path)
            | Self::Begun(path)
            | Self::OtherList { path, .. }
            | Self::ListThere(path)
            | Self::ChangedRecording { path, .. }
            | Self::RecordedTwice { path, .. }
            | Self::FirstList { path, .. }
            | Self::NotFriction(path)
            | Self::Learn { folder: path, .. }
            | Self::NoTrend { folder: path, .. } => Some(path),
            _ => None,
        }
    }

    /// Returns the advice, unless it depends on the calling program.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            Self::Inch => {
                "the programs are metric; a machine whose programs say G70 themselves is planned as any other, its \
                 travel in mm"
            }
            Self::NoAxis { axes, .. } => return Some(format!("its axes are {}", axes.join(", "))),
            Self::Plan(reason) => return Some(reason.help()),
            Self::PlanForm { .. } => "plan again with this version",
            Self::FittedPlant(_) => "remove `results.json`, and run it again",
            Self::NotLearning(_) => "begin again in another folder",
            Self::OtherList { sha256, .. } => {
                return Some(format!(
                    "its SHA-256 was {sha256}; put that list back, and record the round again if another one was loaded"
                ));
            }
            Self::ListThere(_) => "move it to another folder",
            Self::ChangedRecording { round, .. } => {
                return Some(format!(
                    "put the recordings back as they were, or remove the folder of round {round} and later ones: they \
                     are made again"
                ));
            }
            Self::RecordedTwice { .. } => "record each circle twice, and again in each round",
            Self::FirstList { .. } => "begin with the list of the measured friction",
            Self::NotFriction(_) => "give the list that `identify` wrote",
            Self::Learn { reason, .. } => reason.help(),
            Self::Circle(reason) => reason.help(),
            _ => return None,
        };
        Some(help.to_owned())
    }
}
