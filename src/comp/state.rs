//! The state of a kind on an axis, and its change.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::axis::AxisIndex;
use super::kind::Kind;

/// State of one kind on one axis, as a user sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum State {
    /// Selected, configured and parameterised: it works.
    Active,
    /// Selected, but no value list was accepted: it does nothing.
    Ineffective,
    /// Configured, but not selected.
    Inactive,
    /// The axis parameter that enables it is 0.
    Unconfigured,
    /// The command that decides it depends on a value that only the machine knows.
    Unknown,
}

impl State {
    /// The word of the records.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Active => "active",
            Self::Ineffective => "ineffective",
            Self::Inactive => "inactive",
            Self::Unconfigured => "unconfigured",
            Self::Unknown => "unknown",
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// One state that a command changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Change {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// Kind of compensation.
    pub kind: Kind,
    /// The state before the command.
    pub from: State,
    /// The state after it.
    pub to: State,
}
