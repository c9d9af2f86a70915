//! Refusals of a question.

use frictcomp::diagnostic::{Diagnostic, UnknownName};
use frictcomp_host::HostError;
use serde::Serialize;

/// Reason why a question has no answer: a sentence, what to do, and the messages about a configuration.
#[derive(Debug, Serialize)]
pub(crate) struct Refusal {
    pub(crate) message: String,
    pub(crate) help: Option<String>,
    pub(crate) said: Vec<Diagnostic>,
}

impl Refusal {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: None,
            said: Vec::new(),
        }
    }

    pub(crate) fn with_help(self, help: impl Into<String>) -> Self {
        Self {
            help: Some(help.into()),
            ..self
        }
    }

    /// Returns a name that does not exist.
    pub(crate) fn unknown(message: impl Into<String>, unknown: &UnknownName) -> Self {
        Self {
            help: unknown.help("its axes are"),
            ..Self::new(message)
        }
    }
}

impl From<HostError> for Refusal {
    fn from(error: HostError) -> Self {
        Self {
            help: error.help(),
            said: error.diagnostics().to_vec(),
            ..Self::new(error.to_string())
        }
    }
}
