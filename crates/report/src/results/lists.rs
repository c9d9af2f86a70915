//! The table of effective parameters, `lists --show`.

use crate::wording::visible_line;
use frictcomp::lists::{AxisType, Parameter};
use frictcomp::machine::{Axis, AxisReport};

/// Minimum width of an origin, however wide the other columns are.
const MIN_ORIGIN: usize = 16;

/// Returns one table per axis, and one of the programs: number, key, value with unit, origin. A parameter that does not
/// fit on a line of `width` columns takes two.
pub fn render_parameters(reports: &[AxisReport], programs: &[Parameter], width: usize) -> String {
    let axes = reports.iter().map(|report| {
        let name = match report.axis.as_str() {
            "" => "without a name".into(),
            name => visible_line(name),
        };
        let what = match report.axis_type {
            AxisType::Linear => "linear",
            AxisType::Rotary => "rotary",
            AxisType::Spindle => "spindle",
        };
        (
            format!("axis {name} ({what})"),
            report.parameters.as_slice(),
        )
    });
    let title = "programs and macros of the channel".to_owned();
    let programs = (!programs.is_empty()).then_some((title, programs));
    let tables = axes.chain(programs);
    let tables = tables.map(|(title, rows)| format!("{title}\n{}", render_rows(rows, width)));
    tables.collect::<Vec<_>>().join("\n")
}

fn render_rows(parameters: &[Parameter], room: usize) -> String {
    let rows: Vec<[String; 4]> = parameters.iter().map(cells).collect();
    let width = |column: usize| rows.iter().map(|row| columns(&row[column])).max();
    let [number, key, value] = [0, 1, 2].map(|column| width(column).unwrap_or_default());
    let taken = 2 + number + 2 + key + 2 + value + 2;
    let rows = rows.iter().map(|[n, k, v, origin]| {
        if room >= taken + MIN_ORIGIN {
            let origin = shortened(origin, room - taken);
            let line = format!("  {n:number$}  {k:key$}  {v:value$}  {origin}");
            return format!("{}\n", line.trim_end());
        }
        let gap = if 4 + columns(n) + columns(k) > room {
            "\n"
        } else {
            ""
        };
        let origin = shortened(origin, room.saturating_sub(6 + columns(v)).max(8));
        format!("  {n}{gap}  {k}\n    {v}  {origin}\n")
    });
    rows.collect()
}

/// Returns the origin of P-AXIS-00522 of an axis in words.
pub(crate) fn selector_origin(axis: &Axis) -> String {
    if axis.is_described() {
        visible_line(&axis.frict_comp_origin.to_string()).into_owned()
    } else {
        "not described".to_owned()
    }
}

/// Returns number, key, value with its unit, and origin of a parameter.
pub fn cells(row: &Parameter) -> [String; 4] {
    let value = if row.unit.is_empty() {
        row.value.clone()
    } else if row.unit.starts_with(|first: char| first.is_ascii_digit()) {
        format!("{} \u{d7} {}", row.value, row.unit)
    } else {
        format!("{} {}", row.value, row.unit)
    };
    let origin = visible_line(&row.origin.to_string()).into_owned();
    [
        row.number.to_owned(),
        row.key.clone(),
        visible_line(&value).into_owned(),
        origin,
    ]
}

/// Returns a text that fits into `room` columns; it loses its beginning, as the end of a path says more.
fn shortened(text: &str, room: usize) -> String {
    let length = columns(text);
    if length <= room {
        return text.to_owned();
    }
    let kept: String = text.chars().skip(length + 1 - room).collect();
    format!("\u{2026}{kept}")
}

fn columns(text: &str) -> usize {
    text.chars().count()
}
