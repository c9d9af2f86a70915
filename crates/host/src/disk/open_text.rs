//! A text that stands in for a file (R12.2).

use std::path::PathBuf;
use std::sync::Arc;

/// A text, and the file that it stands in for, whose content may differ or which may not
/// exist.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct OpenText {
    /// Path of the file.
    pub path: PathBuf,
    /// The text as shown in the editor.
    pub text: Arc<String>,
}
