//! The state of a kind on an axis, and its change.

use serde::{Deserialize, Serialize};

use super::axis::AxisIndex;
use super::kind::Kind;

crate::words! {
    /// State of one kind on one axis, as a user sees it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum State {
        /// Selected, configured and parameterised: it works.
        Active = "active",
        /// Selected, but no value list was accepted: it does nothing.
        Ineffective = "ineffective",
        /// Configured, but not selected.
        Inactive = "inactive",
        /// The axis parameter that enables it is 0.
        Unconfigured = "unconfigured",
        /// The command that decides it depends on a value that only the machine knows.
        Unknown = "unknown",
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
