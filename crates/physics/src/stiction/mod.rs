//! Stiction compensation of the Heidenhain TNC 407, 415 and 425 (chapter 8): the formulas of machine
//! parameters MP1511 to MP1513, solved for any of their terms.
//!
//! The control adds to the commanded feed the change of the servo lag over one control loop cycle, times
//! a factor. [`solve`] takes the known quantities and computes those that follow;
//! [`StictionParameters`] is what a simulated drive needs of them.

mod formula;
mod guideline;
mod parameters;
mod quantity;
mod solve;

pub use formula::{FORMULAS, Formula};
pub use guideline::{Guideline, MP1511_GUIDELINE_US, MP1511_RANGE_US, MP1512_GUIDELINE};
pub use parameters::StictionParameters;
pub use quantity::{Quantity, UnitError};
pub use solve::{FeedEffect, Solution, Solved, StictionError, solve};
