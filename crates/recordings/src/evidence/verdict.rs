//! Conclusion from a recording.

use frictcomp::readings::{Alternative, Question};

/// Conclusion on one question from a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Conclusion {
    /// The question.
    pub question: Question,
    /// The reading that the recording shows; `None` if it decides nothing.
    pub reading: Option<Alternative>,
    /// The evidence for it, or the reason why there is none.
    pub words: String,
}

impl Conclusion {
    /// Returns the conclusion that nothing is decided, with a reason.
    pub fn none(question: Question, reason: impl Into<String>) -> Self {
        Self {
            question,
            reading: None,
            words: reason.into(),
        }
    }

    pub(super) fn of(question: Question, shown: Result<(Alternative, String), String>) -> Self {
        match shown {
            Ok((reading, words)) => Self {
                question,
                reading: Some(reading),
                words,
            },
            Err(reason) => Self::none(question, reason),
        }
    }
}
