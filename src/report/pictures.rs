//! What the results of the tool look like as charts.

use crate::current::Cycle;
use crate::lists::{AxisType, FrictionList};

use super::svg::{Axis, BandRow, Drawn, LineChart, Panel, Series};

/// The value list of one axis.
#[derive(Debug, Clone, Copy)]
pub struct ValueCurve<'a> {
    /// The name of the axis, empty when the list names none.
    pub axis: &'a str,
    /// Its type, for the unit of the velocity.
    pub axis_type: AxisType,
    /// The list.
    pub list: &'a FrictionList,
}

/// The curve of a value list with its points and the ends at which its value is held (R4.7), and
/// the scaled curve where P-COMP-00045 is not 100 %.
///
/// Velocities are in µm/s or 0.001°/s, outputs in drive units.
pub fn value_curve(curve: &ValueCurve<'_>) -> LineChart {
    let name = match curve.axis {
        "" => "Value list".to_owned(),
        axis => format!("Value list of axis {axis}"),
    };
    let table: Vec<[f64; 2]> = (curve.list.table.iter())
        .map(|point| [point.input, point.output])
        .collect();
    let mut series = vec![
        Series {
            name: "table".to_owned(),
            points: table.clone(),
            drawn: Drawn::Marked,
        },
        held_ends(&table),
    ];
    if curve.list.scaling_factor != 1000 {
        let factor = f64::from(curve.list.scaling_factor) / 1000.0;
        let scaled: Vec<_> = table.iter().map(|[x, y]| [*x, y * factor]).collect();
        series.push(Series {
            name: format!("scaled by {} %", factor * 100.0),
            points: scaled.clone(),
            drawn: Drawn::Marked,
        });
        series.push(held_ends(&scaled));
    }
    let points: Vec<String> = table.iter().map(|[x, y]| format!("{x}: {y}")).collect();
    let unit = velocity_unit(curve.axis_type);
    LineChart {
        title: name,
        description: format!(
            "Additive torque in drive units at velocities in {unit}: {}. Below the first and above \
             the last point the value is held.",
            points.join(", ")
        ),
        x: Axis::linear(format!("velocity in {unit}")),
        bands: Vec::new(),
        panels: vec![Panel {
            y: Axis::linear("additive torque in drive units, broken where it is held"),
            series,
        }],
    }
}

/// From standstill to the first point, and a piece beyond the last one.
fn held_ends(table: &[[f64; 2]]) -> Series {
    let mut points = Vec::new();
    if let (Some(&[first_x, first_y]), Some(&[last_x, last_y])) = (table.first(), table.last()) {
        let interruption = [f64::NAN, f64::NAN];
        points.extend([[0.0, first_y], [first_x, first_y], interruption]);
        points.extend([[last_x, last_y], [last_x + last_x.abs() * 0.12, last_y]]);
    }
    Series {
        name: "held".to_owned(),
        points,
        drawn: Drawn::Held,
    }
}

fn velocity_unit(axis_type: AxisType) -> &'static str {
    match axis_type {
        AxisType::Linear => "\u{b5}m/s",
        AxisType::Rotary | AxisType::Spindle => "0.001\u{b0}/s",
    }
}

/// A commanded trace of one axis and the current that is added to it, a value a CNC cycle.
#[derive(Debug, Clone, Copy)]
pub struct CurrentTrace<'a> {
    /// The name of the axis, empty when nothing names it.
    pub axis: &'a str,
    /// Seconds from the start.
    pub times: &'a [f64],
    /// Commanded velocities in µm/s or 0.001°/s.
    pub velocities: &'a [f64],
    /// Weights and currents.
    pub cycles: &'a [Cycle],
    /// The states of friction compensation over the time.
    pub states: &'a [BandRow],
}

/// The additive current over time, below it velocity and weights, above it the state of
/// compensation.
pub fn current_over_time(trace: &CurrentTrace<'_>) -> LineChart {
    let curve = |name: &str, value: &dyn Fn(&Cycle) -> f64| Series {
        name: name.to_owned(),
        points: (trace.times.iter().zip(trace.cycles))
            .map(|(&time, cycle)| [time, value(cycle)])
            .collect(),
        drawn: Drawn::Line,
    };
    let velocity = Series {
        name: "velocity".to_owned(),
        points: (trace.times.iter().zip(trace.velocities))
            .map(|(&time, &velocity)| [time, velocity])
            .collect(),
        drawn: Drawn::Line,
    };
    let panel = |label: &str, series| Panel {
        y: Axis::linear(label),
        series,
    };
    let of_axis = match trace.axis {
        "" => String::new(),
        axis => format!(" of axis {axis}"),
    };
    let largest = (trace.cycles.iter())
        .map(|cycle| cycle.current.abs())
        .fold(0.0, f64::max);
    let length = trace.times.last().copied().unwrap_or_default();
    LineChart {
        title: format!("Additive current{of_axis}"),
        description: format!(
            "{} CNC cycles in {length} s; the largest current is {largest} drive units. Below: the \
             commanded velocity and the weights before and after a reversal. Above: whether \
             compensation is active.",
            trace.cycles.len()
        ),
        x: Axis::linear("time in s"),
        bands: trace.states.to_vec(),
        panels: vec![
            panel(
                "additive current in drive units",
                vec![curve("current", &|cycle| cycle.current)],
            ),
            panel("velocity in \u{b5}m/s or 0.001\u{b0}/s", vec![velocity]),
            panel(
                "weights",
                vec![
                    curve("weight before a reversal", &|cycle| cycle.w_before),
                    curve("weight after a reversal", &|cycle| cycle.w_after),
                ],
            ),
        ],
    }
}
