//! The two readings of a question.

/// One of the two readings of a question, in the order of [`QuestionFacts::readings`](super::QuestionFacts::readings).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Alternative {
    /// The first reading.
    First,
    /// The second reading.
    Second,
}
