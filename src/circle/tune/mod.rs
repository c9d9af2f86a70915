//! Tuning: the parameters of a value list that leave the smallest glitch (R5.25).
//!
//! The friction curve of the plant is the table of the list; four parameters are searched. Nothing
//! here knows of threads: the [`Search`] asks for trials and its host makes them, in any order.

mod candidate;
mod crossing;
mod search;
mod task;
mod tuned;

pub use candidate::{Candidate, Ranges};
pub use search::Search;
pub use task::{Task, Variant};
pub use tuned::{FeedResult, Tuned, tune};
