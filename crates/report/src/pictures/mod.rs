//! The results of the tool as charts.

mod contour;
mod current;
mod friction;
mod identification;
mod lists;
mod trace;
mod tuning;
mod units;

pub use contour::{BlockStretch, ContourPicture, FollowedContour, WorstReversal};
pub use current::{AxisPlot, AxisSample, CurrentPlot};
pub use friction::{friction_states, friction_trend};
pub use identification::{friction_curve, residuals_over_position, segments_on_trace};
pub use lists::{value_curve, value_curves};
pub use trace::channels;
pub use tuning::tuning;
