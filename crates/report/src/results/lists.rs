//! The table of effective parameters, `lists --show`.

use std::fmt;

use crate::wording::visible_line;
use frictcomp::lists::{AxisType, Parameter};
use frictcomp::machine::{Axis, AxisReport};

/// Minimum width of an origin, however wide the other columns are.
const MIN_ORIGIN: usize = 16;

/// Writes one table per axis, and one of the programs: number, key, value with unit, origin. A
/// parameter that does not fit on a line of `width` columns takes two.
///
/// # Errors
/// Only those of `out`.
pub fn render_parameters(
    reports: &[AxisReport],
    programs: &[Parameter],
    width: usize,
    out: &mut dyn fmt::Write,
) -> fmt::Result {
    for (at, report) in reports.iter().enumerate() {
        if at > 0 {
            writeln!(out)?;
        }
        render_axis(report, width, out)?;
    }
    if !programs.is_empty() {
        if !reports.is_empty() {
            writeln!(out)?;
        }
        writeln!(out, "programs and macros of the channel")?;
        render_rows(programs, width, out)?;
    }
    Ok(())
}

fn render_axis(report: &AxisReport, room: usize, out: &mut dyn fmt::Write) -> fmt::Result {
    let name = if report.axis.is_empty() {
        "without a name"
    } else {
        &visible_line(&report.axis)
    };
    let what = match report.axis_type {
        AxisType::Linear => "linear",
        AxisType::Rotary => "rotary",
        AxisType::Spindle => "spindle",
    };
    writeln!(out, "axis {name} ({what})")?;
    render_rows(&report.parameters, room, out)
}

fn render_rows(parameters: &[Parameter], room: usize, out: &mut dyn fmt::Write) -> fmt::Result {
    let rows: Vec<[String; 4]> = parameters.iter().map(cells).collect();
    let width = |column: usize| rows.iter().map(|row| columns(&row[column])).max();
    let [number, key, value] = [0, 1, 2].map(|column| width(column).unwrap_or_default());
    let taken = 2 + number + 2 + key + 2 + value + 2;
    if room < taken + MIN_ORIGIN {
        for [n, k, v, origin] in &rows {
            let gap = if 4 + columns(n) + columns(k) > room {
                "\n"
            } else {
                ""
            };
            writeln!(out, "  {n}{gap}  {k}")?;
            writeln!(
                out,
                "    {v}  {}",
                shortened(origin, room.saturating_sub(6 + columns(v)).max(8))
            )?;
        }
        return Ok(());
    }
    let room = room - taken;
    for [n, k, v, origin] in &rows {
        let origin = shortened(origin, room);
        let line = format!("  {n:number$}  {k:key$}  {v:value$}  {origin}");
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

/// Returns the origin of P-AXIS-00522 of an axis in words.
pub(crate) fn selector_origin(axis: &Axis) -> String {
    if axis.is_described() {
        visible_line(&axis.frict_comp_origin.to_string()).into_owned()
    } else {
        "not described".to_owned()
    }
}

/// Number, key, value with its unit, and origin of a parameter.
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

/// A text that fits into `room` columns; it loses its beginning, as the end of a path says more.
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
