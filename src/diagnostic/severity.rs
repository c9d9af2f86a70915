//! The severity of a diagnostic.

use serde::{Deserialize, Serialize};

crate::words! {
    /// Severity of a diagnostic.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum Severity {
        /// For information.
        Info = "info",
        /// Likely a mistake, or an effect that outlives the program.
        Warning = "warning",
        /// The control stops here, or rejects the list.
        Error = "error",
    }
}
