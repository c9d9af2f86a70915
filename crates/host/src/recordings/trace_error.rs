//! Failures in reading a trace.

use std::path::{Path, PathBuf};

use thiserror::Error;

use frictcomp::text::shown_path;
use frictcomp_physics::circle::RecordedError;
use frictcomp_physics::current::CyclesError;
use frictcomp_recordings::identify::TrackError;
use frictcomp_recordings::trace::{NotAligned, TraceProblem};

/// Reason why a trace cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TraceError {
    /// A file that is not a trace, or not the expected one.
    #[error("{}", said(.path, .problem))]
    Problem {
        /// Path of the file.
        path: PathBuf,
        /// The fault.
        problem: TraceProblem,
    },
    /// A project of TwinCAT Scope, whose format is not public.
    #[error("`{}` is a file of TwinCAT Scope that only Scope reads", shown_path(.0))]
    Closed(PathBuf),
    /// A Scope configuration, which lists the channels to record but holds no recorded values.
    #[error("`{}` says what TwinCAT Scope is to record; it holds no values", shown_path(.0))]
    WithoutValues(PathBuf),
    /// Channels that cannot be brought to one clock.
    #[error("the recording `{}`: {reason}", shown_path(.path))]
    Apart {
        /// Path of the file.
        path: PathBuf,
        /// The fault.
        reason: NotAligned,
    },
    /// Positions that do not follow from the velocities.
    #[error("the recording `{}`: {reason}", shown_path(.path))]
    Motion {
        /// Path of the file.
        path: PathBuf,
        /// The fault.
        reason: TrackError,
    },
    /// Rows that are not CNC cycles.
    #[error("the recording `{}`: {reason}", shown_path(.path))]
    Cycles {
        /// Path of the file.
        path: PathBuf,
        /// Fault of its times.
        reason: CyclesError,
    },
    /// Channels of a commanded trace that were not sampled together.
    #[error("the recording `{}`: its channels were sampled at different times", shown_path(.0))]
    SeveralClocks(PathBuf),
    /// A recording of states without times.
    #[error("the recording `{}` has no times", shown_path(.0))]
    NoTimes(PathBuf),
    /// A state that is neither 0 nor 1.
    #[error("the recording `{}`: channel `{channel}` holds {value}, which is not a state", shown_path(.path))]
    NoState {
        /// Path of the file.
        path: PathBuf,
        /// Name of the channel.
        channel: String,
        /// Value at that place.
        value: f64,
    },
    /// Points that do not form a circle.
    #[error("`{}`: {reason}", shown_path(.path))]
    Circle {
        /// Path of the file.
        path: PathBuf,
        /// The fault.
        reason: RecordedError,
    },
    /// Circles that do not belong together.
    #[error(transparent)]
    Circles(#[from] RecordedError),
}

impl TraceError {
    pub(super) fn problem(path: &Path, problem: TraceProblem) -> Self {
        Self::Problem {
            path: path.to_owned(),
            problem,
        }
    }
}

impl TraceError {
    /// Returns the advice.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            Self::Problem { problem, .. } => return problem.help(),
            Self::Closed(_) => {
                "export it as CSV, in Scope or with Beckhoff's export tool: \
                 `TC3ScopeExportTool.exe svd=FILE.svdx target=FILE.csv silent`"
            }
            Self::WithoutValues(_) => {
                "record with it in Scope, then export the recording: `Export`, format CSV"
            }
            Self::Apart { reason, .. } => return Some(reason.help().into_owned()),
            Self::Motion { reason, .. } => reason.help(),
            Self::Circle { reason, .. } | Self::Circles(reason) => reason.help(),
            Self::NoTimes(_) => "name the channel of the times",
            Self::NoState { .. } => "a state is 1 where friction compensation is active, else 0",
            // The advice is given where the option is known by its name.
            Self::Cycles { .. } | Self::SeveralClocks(_) => return None,
        };
        Some(help.to_owned())
    }
}

/// Returns a problem with its place.
fn said(path: &Path, problem: &TraceProblem) -> String {
    let path = shown_path(path);
    match (problem, problem.line()) {
        (TraceProblem::Select(error), _) => error.of_trace(&path),
        (_, Some(line)) => format!("{path}:{line}: {problem}"),
        _ => format!("the recording `{path}` cannot be read: {problem}"),
    }
}
