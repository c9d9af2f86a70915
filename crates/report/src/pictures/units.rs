//! The units of the axes of charts.

use frictcomp::lists::AxisType;

/// Returns the unit of the velocities of lists and traces.
pub(super) fn velocity_unit(axis_type: AxisType) -> &'static str {
    match axis_type {
        AxisType::Linear => "\u{b5}m/s",
        AxisType::Rotary | AxisType::Spindle => "0.001\u{b0}/s",
    }
}

/// Returns the unit of feeds.
pub(super) fn minute_unit(axis_type: AxisType) -> &'static str {
    match axis_type {
        AxisType::Linear => "mm/min",
        AxisType::Rotary | AxisType::Spindle => "\u{b0}/min",
    }
}
