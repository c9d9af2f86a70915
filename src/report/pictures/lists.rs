//! Value lists as curves.

use crate::machine::AcceptedList;
use crate::report::svg::{ChartAxis, Drawn, LineChart, Panel, Series};

use super::units::velocity_unit;

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
        x: ChartAxis::linear(format!("velocity in {unit}")),
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
        y: ChartAxis::linear(match accepted.axis.as_str() {
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
