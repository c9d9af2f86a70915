//! The questions that the documents leave open, and how a machine reads them.
//!
//! A question has two readings. One of them is assumed, unless `[reading]` in `frictcomp.toml` selects the other;
//! `[confirmed]` names the build of the control on which it was observed.

mod alternative;
mod facts;
mod question;
mod question_set;
mod selected;

pub use alternative::Alternative;
pub use facts::{QuestionFacts, Way};
pub use question::Question;
pub use question_set::QuestionSet;
pub use selected::{Basis, Confirmation, Readings};
