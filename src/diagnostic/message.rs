//! One statement about a program or a list.

use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use super::advice::{Advice, Wording};
use super::codes::Code;
use super::fix::Fix;
use super::severity::Severity;
use crate::text::{Place, Span};

/// A second place that explains the first.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
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
    /// What to do.
    pub advice: Vec<Advice>,
    /// Changes to the text, each of which alone does what is advised.
    pub fixes: Vec<Fix>,
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
            advice: Vec::new(),
            fixes: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// The same with a higher severity than that of its code, which no setting lowers.
    pub(crate) fn raised(mut self, severity: Severity) -> Self {
        self.severity = severity;
        self
    }

    /// Whether it is more severe than its code says, so that no setting lowers or silences it.
    pub fn is_raised(&self) -> bool {
        self.severity > self.code.severity()
    }

    /// The same with the axis that it is about.
    pub fn with_axis(mut self, axis: impl Into<String>) -> Self {
        self.axis = Some(axis.into());
        self
    }

    /// The same with one more piece of advice.
    pub fn with_help(mut self, advice: impl Into<Advice>) -> Self {
        self.advice.push(advice.into());
        self
    }

    /// The same with one more change that does what is advised.
    pub fn with_fix(mut self, fix: Fix) -> Self {
        self.fixes.push(fix);
        self
    }

    /// The same with the known word that may be meant where `found` stands in its place.
    pub(crate) fn with_near(self, found: &str, near: &str) -> Self {
        let mut place = self.place.clone();
        let start = place.span.of(&place.text).find(found);
        let said = self.with_help(Advice::DidYouMean(near.to_owned()));
        let Some(start) = start else {
            return said;
        };
        let start = place.span.start as usize + start;
        place.span = Span::new(start, start + found.len());
        said.with_fix(Fix::guess(place, near))
    }

    /// What to do, in words.
    pub fn help(&self) -> Vec<String> {
        self.advice.iter().map(Advice::to_string).collect()
    }

    /// Words its advice as a host does.
    pub fn reword(&mut self, wording: Option<Wording>) {
        let Some(wording) = wording else {
            return;
        };
        for advice in &mut self.advice {
            if let Some(words) = wording(advice) {
                *advice = words.into();
            }
        }
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

/// The keys of a diagnostic record (chapter 9.2), without those that say where it belongs.
impl Serialize for Diagnostic {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (start, end) = (self.place.start(), self.place.end());
        let mut object = serializer.serialize_struct("Diagnostic", 11)?;
        object.serialize_field("code", &self.code)?;
        object.serialize_field("severity", &self.severity)?;
        object.serialize_field("file", &self.place.file)?;
        object.serialize_field("line", &start.line)?;
        object.serialize_field("column", &start.column)?;
        object.serialize_field("end_line", &end.line)?;
        object.serialize_field("end_column", &end.column)?;
        object.serialize_field("axis", &self.axis)?;
        object.serialize_field("message", &self.message)?;
        object.serialize_field("help", &self.advice)?;
        if !self.fixes.is_empty() {
            object.serialize_field("fixes", &self.fixes)?;
        }
        object.end()
    }
}
