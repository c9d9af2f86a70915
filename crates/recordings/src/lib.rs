//! Recorded traces of machines: their contents, and the friction that they show.
//!
//! A [`trace::TraceReader`] takes the bytes of a recording from Scope, SINUMERIK or a plain table and
//! returns its channels with their times. [`identify`] finds friction curves and value lists in them, and
//! judges a value list by them. [`commission`] plans the programs that are recorded. [`replay`] holds a recording of states beside
//! the dry run. [`evidence`] judges the
//! questions that the documents leave open. [`value_lists`] writes lists with remarks on their origin.
//!
//! ```
//! use frictcomp_recordings::trace::{Choice, TraceReader};
//!
//! let mut reader = TraceReader::new(1000, |channels| Ok(Choice::all(channels, None)));
//! reader.feed(b"t [s];torque [%]\n0.000;1.5\n0.001;1.7\n")?;
//! let recording = reader.finish()?;
//! assert_eq!(recording.kept().count(), 2);
//! # Ok::<(), frictcomp_recordings::trace::TraceProblem>(())
//! ```

pub mod commission;
pub mod evidence;
pub mod identify;
pub mod replay;
pub mod trace;
pub mod value_lists;
