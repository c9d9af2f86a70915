//! Conclusions from recordings, and answers of a control to the questions that the documents leave open.

use serde::Serialize;

use frictcomp::comp::CncBuild;
use frictcomp::readings::{Alternative, Question};

/// The answer to one question on one axis.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Answer {
    /// The question.
    pub question: Question,
    /// The axis that was asked.
    pub axis: String,
    /// The build for which the programs were written.
    pub build: Option<CncBuild>,
    /// Conclusion from the answer.
    pub verdict: AnswerVerdict,
    /// Evidence for the conclusion, or the reason for none.
    pub evidence: String,
}

/// A line that is marked as an answer but cannot be read as one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct UnreadAnswer {
    /// The name of the file.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The reason.
    pub reason: String,
}

/// Conclusion from an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum AnswerVerdict {
    /// The control follows the reading.
    Reading(Alternative),
    /// The answer does not decide the question.
    Undecidable,
}

impl Answer {
    /// Returns `confirmed`, `refuted`, `answered` where nothing was assumed, or `not decidable`.
    pub fn word(&self) -> &'static str {
        match (self.verdict, self.question.facts().assumed) {
            (AnswerVerdict::Undecidable, _) => "not decidable",
            (AnswerVerdict::Reading(_), None) => "answered",
            (AnswerVerdict::Reading(found), Some(assumed)) if found == assumed => "confirmed",
            (AnswerVerdict::Reading(_), Some(_)) => "refuted",
        }
    }
}

/// Returns the first question that two answers decide differently.
pub fn contradicted(answers: &[Answer]) -> Option<Question> {
    let decided = |answer: &&Answer| answer.verdict != AnswerVerdict::Undecidable;
    let mut all = answers.iter().filter(decided);
    let is_contradicted = |answer: &&Answer| {
        let mut others = answers.iter().filter(decided);
        others.any(|it| it.question == answer.question && it.verdict != answer.verdict)
    };
    all.find(is_contradicted).map(|it| it.question)
}

/// Drops what one answer does not decide but another one does, and puts the others in the order of the questions.
pub fn drop_answered(answers: &mut Vec<Answer>) {
    let decided = |answer: &Answer| answer.verdict != AnswerVerdict::Undecidable;
    let found = answers.iter().filter(|it| decided(it));
    let found: Vec<Question> = found.map(|it| it.question).collect();
    answers.retain(|it| decided(it) || !found.contains(&it.question));
    answers.sort_by_key(|it| it.question);
}

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
