//! Stiction compensation of the Heidenhain TNC 407, 415 and 425 (chapter 8): the formulas of machine
//! parameters MP1511 to MP1513, solved for any of their terms.
//!
//! The control adds to the commanded feed what the servo lag changed over one control loop cycle, times
//! a factor. [`solve`] takes the quantities that are known and computes those that follow.

mod formula;
mod quantity;
mod solve;

pub use formula::{FORMULAS, Formula};
pub use quantity::{Quantity, UnitError};
pub use solve::{Effect, Guideline, Solution, Solved, StictionError, solve};
