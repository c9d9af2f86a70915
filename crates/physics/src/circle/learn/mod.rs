//! Learning: recorded circles with a value list give the next list (R16.4).
//!
//! A [`LearnedRound`] holds the motion of an axis at its reversals with one list, recorded twice. A reference
//! plant gives only the direction: the path that another list is predicted to leave is the recorded one of the
//! best list so far, plus the difference of the plant between both lists. [`LearningProgress`] judges
//! the rounds only by their recordings.

mod bounds;
mod learner;
mod progress;
mod round;

pub use learner::{Learner, Proposal};
pub use progress::{LearningProgress, RoundVerdict};
pub use round::{LearnedCircle, LearnedRound, RecordedTwice, TooMuchCurrent};
