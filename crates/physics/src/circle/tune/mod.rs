//! Tuning: the value lists, or the parameters of stiction compensation, that leave the smallest
//! glitch (R5.25, R8.6).
//!
//! The friction curve of the plant is the table of a list. First four parameters are searched, then
//! the shape of the table below 1 mm/s. The axes are independent: each is tuned at a single reversal, and
//! the final result is judged on whole circles. Nothing here uses threads: an implementation of
//! [`Simulations`] makes them in any order.

mod candidate;
mod check;
mod cma_es;
mod descent;
mod heights;
mod minimax;
mod ranges;
pub(super) mod reversal;
mod search;
mod shape;
mod space;
mod task;
mod tuned;

pub use candidate::Candidate;
pub use check::RemainingGlitch;
pub(crate) use cma_es::{CmaEs, POINTS, XorShift};
pub(crate) use heights::Heights;
pub use ranges::{FreeParameter, Ranges};
pub use task::{Shaping, Task, TuningAim};
pub use tuned::{FeedResult, Robust, Simulations, Tuned, TunedAxis, tune, tune_with};
