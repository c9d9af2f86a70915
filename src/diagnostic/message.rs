//! One statement about a program or a list.

use super::codes::Code;
use super::severity::Severity;
use crate::text::Place;

/// A second place that explains the first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub place: Place,
    /// What is there, in a few words.
    pub text: String,
}

/// One statement about a program or a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// The control's number, or one of ours.
    pub code: Code,
    /// Its weight, already changed by `[lint]` where the user did so.
    pub severity: Severity,
    /// One sentence in lower case.
    pub message: String,
    /// What is meant.
    pub place: Place,
    /// The axis that it is about.
    pub axis: Option<String>,
    /// What to do, one piece of advice each.
    pub help: Vec<String>,
    /// Further places.
    pub labels: Vec<Label>,
}

impl Diagnostic {
    /// A diagnostic with the code's own severity and nothing but a message.
    pub fn new(code: Code, place: Place, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            place,
            axis: None,
            help: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// The same with the axis that it is about.
    pub fn with_axis(mut self, axis: impl Into<String>) -> Self {
        self.axis = Some(axis.into());
        self
    }

    /// The same with one more piece of advice.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }

    /// The same with one more place.
    pub fn with_label(mut self, place: Place, text: impl Into<String>) -> Self {
        self.labels.push(Label {
            place,
            text: text.into(),
        });
        self
    }
}
