//! The questions that the documents leave open, and how a machine reads them.
//!
//! A question has two readings. One of them is assumed, unless `[reading]` in `frictcomp.toml` selects the other;
//! `[confirmed]` names the build of the control on which it was observed.

mod facts;
mod question;

pub use facts::{QuestionFacts, Way};
pub use question::{Alternative, Basis, Confirmation, Question, QuestionSet, Readings};
