//! Recordings of a machine in files.

mod recorded_files;
mod signatures;
mod switches;
mod trace_error;
mod traces;

pub use recorded_files::{copies_among, recordings_in, refuse_copies};
pub use signatures::{SignedAt, signatures_of};
pub use switches::switches_of;
pub use trace_error::TraceError;
pub use traces::{
    is_recording, read_axis, read_circles, read_commanded, read_motion, read_trace, read_turns,
};
pub(crate) use traces::{lacks, numbers_of, position_column};
