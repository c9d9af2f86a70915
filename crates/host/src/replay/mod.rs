//! The comparison of a recording of the states of friction compensation with the dry run of the
//! programs (R15.20).

mod beside;
mod conditions;
mod course;
mod recorded;
mod replayed;

pub(crate) use recorded::axis_of;
pub use recorded::{ReplayChannels, read_states};
pub use replayed::Replay;
