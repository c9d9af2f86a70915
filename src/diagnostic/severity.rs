//! The weight of a diagnostic.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Weight of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Severity {
    /// Worth knowing.
    Info,
    /// Likely a mistake, or an effect that outlives the program.
    Warning,
    /// The control stops here, or does not take the list.
    Error,
}

impl Severity {
    /// The word of the records: `error`, `warning`, `info`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}
