//! What the results of the tool look like as charts.

use crate::current::Cycle;
use crate::lists::AxisType;
use crate::machine::AcceptedList;

use super::svg::{Axis, BandRow, Drawn, LineChart, Panel, Series};

/// The curve of a value list with its points and the ends at which its value is held (R4.7), and
/// the scaled curve where P-COMP-00045 is not 100 %.
///
/// Velocities are in µm/s or 0.001°/s, outputs in drive units.
pub fn value_curve(accepted: &AcceptedList) -> LineChart {
    value_curves(&[accepted])
}

/// The curves of several value lists, one below the other.
pub fn value_curves(accepted: &[&AcceptedList]) -> LineChart {
    let mut units: Vec<&str> = (accepted.iter())
        .map(|list| velocity_unit(list.axis_type))
        .collect();
    units.dedup();
    let unit = match units[..] {
        [unit] => unit,
        _ => "\u{b5}m/s or 0.001\u{b0}/s",
    };
    let told: Vec<String> = accepted.iter().map(|list| describe_list(list)).collect();
    LineChart {
        title: match accepted {
            [one] if one.axis.is_empty() => "Value list".to_owned(),
            [one] => format!("Value list of axis {}", one.axis),
            _ => "Value lists".to_owned(),
        },
        description: format!(
            "Additive torque in drive units at velocities in {unit}. {} Below the first and above \
             the last point the value is held.",
            told.join(" ")
        ),
        x: Axis::linear(format!("velocity in {unit}")),
        bands: Vec::new(),
        panels: (accepted.iter())
            .map(|list| list_panel(list, accepted.len()))
            .collect(),
    }
}

fn describe_list(accepted: &AcceptedList) -> String {
    let points = accepted.list.table.iter();
    let points: Vec<String> = points
        .map(|point| format!("{} at {}", point.output, point.input))
        .collect();
    match accepted.axis.as_str() {
        "" => format!("{}.", points.join(", ")),
        axis => format!("Axis {axis}: {}.", points.join(", ")),
    }
}

fn list_panel(accepted: &AcceptedList, panels: usize) -> Panel {
    let list = &accepted.list;
    let table: Vec<[f64; 2]> = (list.table.iter())
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
    if list.scaling_factor != 1000 {
        let factor = f64::from(list.scaling_factor) / 1000.0;
        let scaled: Vec<_> = table.iter().map(|[x, y]| [*x, y * factor]).collect();
        series.push(Series {
            name: format!("scaled by {} %", f64::from(list.scaling_factor) / 10.0),
            points: scaled.clone(),
            drawn: Drawn::Marked,
        });
        series.push(held_ends(&scaled));
    }
    let quantity = "additive torque in drive units, broken where it is held";
    Panel {
        y: Axis::linear(match accepted.axis.as_str() {
            axis if panels > 1 && !axis.is_empty() => format!("axis {axis}: {quantity}"),
            _ => quantity.to_owned(),
        }),
        series,
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

/// The glitch at the reversals of a circle at one feed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedGlitches {
    /// The feed in mm/min.
    pub feed: f64,
    /// Peak to peak in µm without compensation.
    pub off: f64,
    /// Peak to peak in µm with the tuned value list.
    pub on: f64,
    /// The same, with 20 % less friction than the list was tuned for.
    pub friction_minus20: f64,
    /// The same, with 20 % more.
    pub friction_plus20: f64,
}

/// The glitch over the feed before and after tuning, with its sensitivity to the friction (R5.25).
pub fn tuning(title: &str, feeds: &[FeedGlitches]) -> LineChart {
    let series = |name: &str, value: fn(&FeedGlitches) -> f64| Series {
        name: name.to_owned(),
        points: feeds.iter().map(|it| [it.feed, value(it)]).collect(),
        drawn: Drawn::Marked,
    };
    let told: Vec<String> = feeds
        .iter()
        .map(|it| format!("{:.1} and {:.1} at {}", it.off, it.on, it.feed))
        .collect();
    LineChart {
        title: title.to_owned(),
        description: format!(
            "The largest glitch in \u{b5}m without and with compensation at feeds in mm/min: {}.",
            told.join("; ")
        ),
        x: Axis::logarithmic("feed in mm/min"),
        bands: Vec::new(),
        panels: vec![Panel {
            y: Axis::linear("largest glitch in \u{b5}m, peak to peak"),
            series: vec![
                series("without compensation", |it| it.off),
                series("tuned", |it| it.on),
                series("tuned, friction \u{2212}20 %", |it| it.friction_minus20),
                series("tuned, friction +20 %", |it| it.friction_plus20),
            ],
        }],
    }
}
