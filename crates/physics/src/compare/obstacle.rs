//! The obstacles to a comparison of whole versions.

use std::fmt;

use frictcomp::comp::Kind;
use frictcomp::diagnostic::{Code, Diagnostic, Severity};

/// Obstacle to a comparison of the whole version, with its place: the rest is not known.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Obstacle {
    /// Path of the file, as it is shown.
    pub file: String,
    /// The line, from 1, if it is known.
    pub line: Option<u32>,
    /// Reason of the obstacle.
    pub reason: Reason,
}

/// Reason why a version cannot be compared as a whole.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// Program that an error or a budget stops.
    Stopped {
        /// Code.
        code: Code,
        /// Message.
        message: String,
    },
    /// Program that stops with an error whose message is silenced.
    StoppedSilently,
    /// State that depends on what only the machine knows.
    Unknown {
        /// Name of the axis.
        axis: String,
        /// The kind of compensation.
        kind: Kind,
    },
    /// The executed blocks depend on a value that only the machine knows; the dry run assumed a
    /// way.
    Assumed,
    /// The effect of a command depends on a machine that is not described.
    Undescribed,
}

impl Reason {
    /// Returns the word that stands for the reason in records.
    pub fn as_str(&self) -> &'static str {
        match self {
            Self::Stopped { .. } | Self::StoppedSilently => "stopped",
            Self::Unknown { .. } => "unknown",
            Self::Assumed => "assumed",
            Self::Undescribed => "undescribed",
        }
    }
}

impl Obstacle {
    /// Returns the obstacle of a message that stopped the program.
    pub(super) fn stop(said: &Diagnostic) -> Option<Self> {
        let code = said.code;
        (code.severity() == Severity::Error || code.is_budget()).then(|| {
            Self::at(
                said,
                Reason::Stopped {
                    code,
                    message: said.message.clone(),
                },
            )
        })
    }

    /// Returns the obstacle of a single message.
    pub(super) fn of(said: &Diagnostic) -> Option<Self> {
        match said.code {
            Code::Fc408 => Some(Self::at(said, Reason::Undescribed)),
            Code::Fc210 | Code::Fc325 | Code::Fc902 | Code::Fc908 => {
                Some(Self::at(said, Reason::Assumed))
            }
            _ => None,
        }
    }

    fn at(said: &Diagnostic, reason: Reason) -> Self {
        Self {
            file: said.place.file.to_string(),
            line: Some(said.place.start().line),
            reason,
        }
    }
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = match self.line {
            Some(line) => format!("{}:{line}", self.file),
            None => self.file.clone(),
        };
        match &self.reason {
            Reason::Stopped { code, message } => write!(f, "{at} stops with {code}: {message}"),
            Reason::StoppedSilently => {
                write!(f, "{at} stops with an error whose message is silenced")
            }
            Reason::Unknown { axis, kind } => {
                let kind = kind.as_str();
                write!(f, "from {at} on, {kind} of {axis} is not known offline")
            }
            Reason::Assumed => write!(
                f,
                "what the control does at {at} is not known offline, and was assumed"
            ),
            Reason::Undescribed => write!(
                f,
                "what {at} does depends on a machine that is not described"
            ),
        }
    }
}
