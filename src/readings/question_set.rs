//! Sets of questions.

use serde::{Deserialize, Serialize};

use super::question::Question;

/// A set of questions, such as those on whose answers a result rests (R15.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct QuestionSet(u32);

impl QuestionSet {
    /// Adds a question.
    pub fn insert(&mut self, question: Question) {
        self.0 |= 1 << question as u32;
    }

    /// Returns whether a question is in the set.
    pub fn contains(self, question: Question) -> bool {
        self.0 & 1 << question as u32 != 0
    }

    /// Returns the questions of either set.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the questions, in the order of their rules.
    pub fn iter(self) -> impl Iterator<Item = Question> {
        Question::ALL
            .into_iter()
            .filter(move |it| self.contains(*it))
    }
}
