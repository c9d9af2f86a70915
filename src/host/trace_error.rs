//! Why a trace cannot be read.

use std::path::PathBuf;

use thiserror::Error;

use crate::circle::RecordedError;
use crate::motion::CycleError;

/// Why a trace cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TraceError {
    /// A row that is too short.
    #[error("the trace `{}` cannot be read: {reason}", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: csv::Error,
    },
    /// A header without the columns that are needed.
    #[error("the trace `{}` has {lacks}, only {}", .path.display(), .found.join(", "))]
    Columns {
        /// The file.
        path: PathBuf,
        /// What is not there: no columns `x` and `y`.
        lacks: &'static str,
        /// The columns that are there.
        found: Vec<String>,
        /// How the columns are named.
        help: &'static str,
    },
    /// A trace that was recorded at a very high rate.
    #[error("`{}` has more than {most} rows", .path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// What it may have.
        most: usize,
    },
    /// `1,5` in quotes, or an empty cell.
    #[error("{}:{line}: column `{column}` holds `{text}`, which is not a number", .path.display())]
    Number {
        /// The file.
        path: PathBuf,
        /// The line of the file.
        line: u64,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
    },
    /// `yes` in the column of the compensation.
    #[error("{}:{line}: column `{column}` holds `{text}`", .path.display())]
    Switch {
        /// The file.
        path: PathBuf,
        /// The line of the file.
        line: u64,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
    },
    /// Times that are an hour apart.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// Points that make no circle.
    #[error("`{}`: {reason}", .path.display())]
    Circle {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: RecordedError,
    },
    /// Circles that do not belong together.
    #[error(transparent)]
    Circles(#[from] RecordedError),
}

impl TraceError {
    /// What to do about it.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            Self::Damaged { .. } => "a trace is a CSV file with a header and decimal points",
            Self::Columns { help, .. } => help,
            Self::TooLong { .. } => "record with a lower rate",
            Self::Number { .. } => "write numbers with a decimal point",
            Self::Switch { .. } => "write `on` or `off`",
            Self::Circle { reason, .. } | Self::Circles(reason) => reason.help(),
            Self::Cycle(_) => return None,
        };
        Some(help.to_owned())
    }
}
