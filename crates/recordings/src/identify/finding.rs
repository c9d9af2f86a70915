//! The remarks on a recording and on the values found in it.

use serde::Serialize;

use frictcomp::diagnostic::{Code, Severity};

/// A statement about a recording: a sentence in lower case, and advice.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TraceFinding {
    /// Number.
    pub code: Code,
    /// Severity.
    pub severity: Severity,
    /// Text of the finding.
    pub message: String,
    /// Advice.
    pub help: String,
}

impl TraceFinding {
    pub(super) fn new(code: Code, message: String, help: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message,
            help: help.into(),
        }
    }
}
