//! The comparison of a recording of the states of friction compensation with the dry run of the
//! programs (R15.20).

mod beside;
mod conditions;
mod course;
mod recorded;
mod replayed;

pub use beside::{Disagreement, MatchedChange, ReplayPlace, ReplayedAxis, ReplayedBy};
pub use conditions::TriedCondition;
pub(crate) use recorded::axis_of;
pub use recorded::{
    RecordedAxis, RecordedChange, RecordedGap, ReplayChannels, StateRecording, read_states,
};
pub use replayed::{Replay, Replayed};
