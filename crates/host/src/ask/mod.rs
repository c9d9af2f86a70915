//! The open questions, put to a control (R15.1), and its answers (R15.2).
//!
//! A program leaves its answers with `#MSG SAVE EXCLUSIVE` (TF5200 programming manual, 207171211), which
//! appends a line to `message.txt` when its block is decoded. A read of `V.A.FRICT_COMP_ACTIVE`
//! (308731019) in the block before waits until the blocks before it are executed. Plain `#MSG` is not
//! used: ten unread ones stop the control (507845131).

mod answers;
mod control;
mod motion;
mod programs;
mod recording;
mod written;

pub use control::{AskError, AskedAxis, AskedControl, ReadAnswers, RecordedAnswers, TRAVEL};
