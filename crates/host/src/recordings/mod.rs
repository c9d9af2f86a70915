//! Recordings of a machine in files.

mod recorded_files;
mod signatures;
mod trace_error;
mod traces;

pub(crate) use recorded_files::copies_among;
pub use recorded_files::{recordings_in, refuse_copies};
pub(crate) use signatures::{SignedAt, signatures_of, switches_of};
pub use trace_error::TraceError;
pub(crate) use traces::read_motion;
pub use traces::{
    channels_of, commanded_axes, is_recording, named_axes, read_axis, read_circles, read_commanded,
    read_trace, read_turns, sole_axis,
};
pub(crate) use traces::{lacks, numbers_of, position_column};
