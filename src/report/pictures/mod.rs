//! What the results of the tool look like as charts.

mod circle;
mod current;
mod lists;
mod tuning;

pub use circle::circle;
pub use current::{AxisPlot, CurrentPlot};
pub use lists::{value_curve, value_curves};
pub use tuning::tuning;

use crate::lists::AxisType;

/// The unit of the velocities of lists and traces.
fn velocity_unit(axis_type: AxisType) -> &'static str {
    match axis_type {
        AxisType::Linear => "\u{b5}m/s",
        AxisType::Rotary | AxisType::Spindle => "0.001\u{b0}/s",
    }
}
