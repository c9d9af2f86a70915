//! Value lists as curves.

use crate::svg::{ChartAxis, CurveNote, Drawn, LineChart, Panel, Series, number};
use crate::wording::rounded;
use frictcomp::machine::AcceptedList;

use super::units::{minute_unit, velocity_unit};

/// Returns the curve of a value list with its points and the ends at which its value is held (R4.7), and the scaled
/// curve if P-COMP-00045 is not 100 %.
///
/// Velocities are in µm/s or 0.001°/s, outputs in drive units.
pub fn value_curve(accepted: &AcceptedList) -> LineChart {
    value_curves(&[accepted])
}

/// Returns the curves of several value lists, one below the other.
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
    let bend = (accepted.iter())
        .flat_map(|list| &list.list.table)
        .map(|point| point.input)
        .filter(|input| *input > 0.0)
        .fold(f64::INFINITY, f64::min);
    let end = (accepted.iter())
        .filter_map(|list| list.list.table.last())
        .map(|point| point.input * BEYOND)
        .fold(0.0, f64::max);
    let mut minutes: Vec<&str> = (accepted.iter())
        .map(|list| minute_unit(list.axis_type))
        .collect();
    minutes.dedup();
    let per_minute = match minutes[..] {
        [unit] => unit,
        _ => "mm/min or \u{b0}/min",
    };
    let x = if bend.is_finite() {
        format!("velocity in {unit}, logarithmic from {} on", number(bend))
    } else {
        format!("velocity in {unit}")
    };
    LineChart {
        title: match accepted {
            [one] if one.axis.is_empty() => "Value list".to_owned(),
            [one] => format!("Value list of axis {}", one.axis),
            _ => "Value lists".to_owned(),
        },
        description: format!(
            "Additive current in drive units at velocities in {unit}. {} Below the first and above \
             the last point the value is held.",
            told.join(" ")
        ),
        x: ChartAxis::logarithmic_from_zero(x)
            .with_second(format!("velocity in {per_minute}"), PER_MINUTE),
        panels: (accepted.iter())
            .map(|list| list_panel(list, accepted.len(), end))
            .collect(),
        ..LineChart::default()
    }
}

/// mm/min per µm/s, and °/min per 0.001°/s.
const PER_MINUTE: f64 = 0.06;

fn describe_list(accepted: &AcceptedList) -> String {
    let points = accepted.list.table.iter();
    let points: Vec<String> = points
        .map(|point| format!("{} at {}", rounded(point.output), point.input))
        .collect();
    match accepted.axis.as_str() {
        "" => format!("{}.", points.join(", ")),
        axis => format!("Axis {axis}: {}.", points.join(", ")),
    }
}

fn list_panel(accepted: &AcceptedList, panels: usize, end: f64) -> Panel {
    let list = &accepted.list;
    let table: Vec<[f64; 2]> = (list.table.iter())
        .map(|point| [point.input, point.output])
        .collect();
    let mut series = curve("table", &table, end).to_vec();
    let factor = f64::from(list.scaling_factor) / 1000.0;
    let scaled: Vec<_> = table.iter().map(|[x, y]| [*x, y * factor]).collect();
    if list.scaling_factor != 1000 {
        let name = format!("scaled by {} %", f64::from(list.scaling_factor) / 10.0);
        series.extend(curve(&name, &scaled, end));
    }
    let quantity = "additive current in drive units";
    Panel {
        y: ChartAxis::linear(match accepted.axis.as_str() {
            axis if panels > 1 && !axis.is_empty() => format!("axis {axis}: {quantity}"),
            _ => quantity.to_owned(),
        })
        .from_zero(),
        series,
        notes: held_notes(&table, end),
        ..Panel::default()
    }
}

/// Returns the ranges in which values of a list are held, in words.
fn held_notes(table: &[[f64; 2]], end: f64) -> Vec<CurveNote> {
    let mut notes = Vec::new();
    if let (Some(&[first_x, first_y]), Some(&[last_x, last_y])) = (table.first(), table.last()) {
        if first_x > 0.0 {
            notes.push(CurveNote {
                at: [first_x / 2.0, first_y],
                text: format!("held below {}", number(first_x)),
            });
        }
        notes.push(CurveNote {
            at: [end, last_y],
            text: format!("held above {}", number(last_x)),
        });
    }
    notes
}

/// Returns a table as a curve: lines, which are straight in velocities but not in their logarithms, its points, and the
/// ends at which its value is held.
fn curve(name: &str, table: &[[f64; 2]], end: f64) -> [Series; 3] {
    let series = |name: &str, points, drawn| Series {
        name: name.to_owned(),
        points,
        drawn,
    };
    let between = table.windows(2).flat_map(|pair| {
        let ([from, low], [to, high]) = (pair[0], pair[1]);
        // Up to the first point above 0 the axis is linear.
        let pieces = if from > 0.0 { PIECES } else { 1 };
        (0..pieces).map(move |piece| {
            let share = f64::from(piece) / f64::from(pieces);
            [from + share * (to - from), low + share * (high - low)]
        })
    });
    [
        series(
            name,
            between.chain(table.last().copied()).collect(),
            Drawn::Line,
        ),
        series(name, table.to_vec(), Drawn::Points),
        held_ends(table, end),
    ]
}

/// Number of pieces into which a line between two points is cut.
const PIECES: u32 = 16;

/// Length of the last value drawn beyond the last point of all.
const BEYOND: f64 = 3.0;

/// Returns the series from standstill to the first point, and from the last one to the end of the chart.
fn held_ends(table: &[[f64; 2]], end: f64) -> Series {
    let mut points = Vec::new();
    if let (Some(&[first_x, first_y]), Some(&[last_x, last_y])) = (table.first(), table.last()) {
        let interruption = [f64::NAN, f64::NAN];
        points.extend([[0.0, first_y], [first_x, first_y], interruption]);
        points.extend([[last_x, last_y], [end, last_y]]);
    }
    Series {
        name: "held".to_owned(),
        points,
        drawn: Drawn::Held,
    }
}
