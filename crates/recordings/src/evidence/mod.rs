//! Evidence in the recording of an axis for the questions that the documents leave open (R15.2).
//!
//! The current of every combination of readings is computed for the recorded motion. A question is decided
//! if the recorded current follows one combination, and deviates from every combination with its other
//! reading by more than noise.

mod answer;
mod currents;
mod doubts;
mod fit;
mod recorded;
mod stroke;
mod switching;

pub use answer::{Answer, AnswerVerdict, Conclusion, UnreadAnswer, contradicted, drop_answered};
pub use currents::judge_currents;
pub use recorded::{EvidenceRecording, Samples};
pub use switching::{LOOK_AHEAD_PARTS, WITH_MOTION_PARTS, judge_look_ahead, judge_with_motion};
