//! Reasons for which a COMP command is refused.

use thiserror::Error;

use super::kind::Kind;
use crate::diagnostic::Code;

/// The reason for which the control, or this tool in its place, refuses a COMP command.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CompensationError {
    /// `X[COMP ON FRICT]` while P-AXIS-00522 of X is 0 (R1.24), and any other kind that the axis
    /// list does not select (R1.41).
    #[error(
        "{} of axis `{axis}` is switched on, but {} is not set",
        named(*.kind),
        .kind.facts().parameter
    )]
    NotConfigured {
        /// The axis of the command.
        axis: String,
        /// The kind that is not configured.
        kind: Kind,
    },
    /// `Q[COMP ON FRICT]` on a machine without an axis Q.
    #[error("the machine has no axis `{axis}`")]
    UnknownAxis {
        /// The name before the bracket.
        axis: String,
    },
    /// `X[COMP ON FRICT]` between `#ENABLE AX LINK` and `#DISABLE AX LINK` of a coupling with X.
    #[error("axis `{axis}` is in an active coupling; COMP is not allowed")]
    Coupled {
        /// The axis of the command.
        axis: String,
    },
    /// A command that the documents leave open and that the configuration reads as refused (R15.2).
    #[error("by the selected reading ({rule}) the control refuses {what} of axis `{axis}`")]
    ReadAsRefused {
        /// The axis of the command.
        axis: String,
        /// The refused item.
        what: &'static str,
        /// The rule of the question.
        rule: &'static str,
    },
    /// `S[COMP ON FRICT]`.
    #[error("`{axis}` is a spindle; spindles have no COMP")]
    Spindle {
        /// The spindle's name.
        axis: String,
    },
}

impl CompensationError {
    /// Returns the control's error number, or ours if the control documents none.
    pub fn code(&self) -> Code {
        match self {
            Self::NotConfigured { kind, .. } => kind.facts().refusal,
            Self::UnknownAxis { .. } => Code::PErr21947,
            Self::Coupled { .. } => Code::PErr21403,
            Self::ReadAsRefused { .. } => Code::Fc306,
            Self::Spindle { .. } => Code::Fc302,
        }
    }

    /// Returns the axis that the command names.
    pub fn axis(&self) -> &str {
        match self {
            Self::NotConfigured { axis, .. }
            | Self::UnknownAxis { axis }
            | Self::Coupled { axis }
            | Self::ReadAsRefused { axis, .. }
            | Self::Spindle { axis } => axis,
        }
    }
}

/// Returns the name of a kind for messages.
fn named(kind: Kind) -> String {
    match kind {
        Kind::Frict => "friction compensation".to_owned(),
        other => format!("`{other}`"),
    }
}
