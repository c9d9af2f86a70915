//! What the results of the tool look like as charts.

mod circle;
mod current;
mod lists;
mod tuning;
mod units;

pub use circle::circle;
pub use current::{AxisPlot, CurrentPlot};
pub use lists::{value_curve, value_curves};
pub use tuning::tuning;
