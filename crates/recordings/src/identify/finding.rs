//! What there is to say about a recording and what was found in it.

use serde::Serialize;

use frictcomp::diagnostic::{Code, Severity};

/// A statement about a recording: a sentence in lower case, and what to do.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TraceFinding {
    /// Its number.
    pub code: Code,
    /// How much it counts.
    pub severity: Severity,
    /// What was found.
    pub message: String,
    /// What to do about it.
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
