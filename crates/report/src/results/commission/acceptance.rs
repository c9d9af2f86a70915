//! Requirements for the acceptance of a commissioning beyond its results (R16.5).

use std::fmt::Write as _;

use super::picture::friction_of_axis;
use super::plants::lacking;
use crate::document::{Document, Table};
use crate::wording::visible_line;
use frictcomp::diagnostic::Rounded;
use frictcomp_recordings::commission::{
    AxisVerdict, CirclesFound, FrictionFound, MeasuredAxis, PlantVerdict, RecordingOutcome,
    ResultsReport, TunedList,
};

/// Contents of the report beyond the results.
#[derive(Debug, Clone, Default)]
pub struct Acceptance {
    /// The name of the machine; `None` if it was not stated.
    pub machine: Option<String>,
    /// The date of the recordings; `None` if it was not stated.
    pub date: Option<String>,
    /// The axes with the changes from their earlier list to that of stage 2, in the form of a patch.
    pub changes: Vec<(String, String)>,
}

/// Appends the figures of the circles, the friction of each axis, and the grounds.
pub(super) fn push_acceptance<'a>(
    out: &mut Document<'a>,
    report: &'a ResultsReport,
    given: &Acceptance,
) {
    push_iso_figures(out, report);
    for axis in &report.axes {
        push_axis(out, report, axis);
        let mut changes = given.changes.iter();
        match changes.find(|it| it.0 == axis.axis) {
            Some((_, change)) => {
                out.push_str("The earlier list and that of stage 2:\n");
                out.verbatim(change);
            }
            None => out.push_str("No earlier list was given to compare with.\n"),
        }
    }
    push_grounds(out, report, given);
}

/// Appends the figures of ISO 230-4 of each used circle, in the order of the programs.
fn push_iso_figures(out: &mut Document<'_>, report: &ResultsReport) {
    let used = report.results.iter().filter(|it| it.found.is_used());
    let circles = used.filter_map(|it| match &it.found {
        RecordingOutcome::Circles(circles) => Some((it.program?, circles)),
        _ => None,
    });
    let mut circles: Vec<(u16, &CirclesFound)> = circles.collect();
    circles.sort_by_key(|it| it.0);
    if circles.is_empty() {
        return;
    }
    let table = Table::default().left("program").left("list");
    let figures = ["feed", "G ccw", "G cw", "G(b)", "H"];
    let mut table = figures.into_iter().fold(table, Table::right);
    for (number, circles) in circles {
        let iso = circles.iso;
        let feed = Rounded(circles.measured_feed.unwrap_or(circles.feed), 0);
        let figures = [iso.g_ccw, iso.g_cw, iso.g_b, iso.h];
        let figures = figures.map(|um| um.map_or("-".to_owned(), |it| Rounded(it, 1).to_string()));
        let list = report.compensation_of(number);
        let mut cells = vec![number.to_string(), list, feed.to_string()];
        cells.extend(figures);
        table.cells(cells);
    }
    out.detail("Figures of ISO 230-4");
    out.push_str(
        "\nFigures of ISO 230-4 in µm, recorded; a row for each circle, with the feed in mm/min\n",
    );
    out.table(table);
    out.push_str(
        "G about the centre of the minimum zone, G(b) and H about the mean centre of both directions.\n",
    );
}

/// Appends the friction of an axis.
fn push_axis<'a>(out: &mut Document<'a>, report: &'a ResultsReport, verdict: &AxisVerdict) {
    let name = visible_line(&verdict.axis);
    out.detail(format!("Axis {name}"));
    let mut measured = report.plans.iter().flat_map(|it| &it.plan.axes);
    let measured = measured.find(|it| it.name == verdict.axis);
    out.lines(measured.map(|axis| format!("\n{name}: {}", described(axis))));
    match report.friction_of(verdict) {
        Some(friction) => push_friction(out, friction),
        None => out.push_str("No friction is known.\n"),
    }
}

/// Returns text such as "travel 0 to 500 mm, 30000 mm/min, 5000 mm/s²".
fn described(axis: &MeasuredAxis) -> String {
    let (travel, dynamics, unit) = (axis.travel, axis.dynamics, axis.unit());
    format!(
        "travel {} to {} {unit}, {} {unit}/min, {} {unit}/s²",
        travel.low,
        travel.high,
        Rounded(dynamics.velocity_per_s * 60.0, 0),
        Rounded(dynamics.acceleration_per_s2, 0)
    )
}

fn push_friction<'a>(out: &mut Document<'a>, friction: &'a FrictionFound) {
    out.figure(|| friction_of_axis(friction));
    let headings = ["speed per s", "friction in drive units", "standard error"];
    let mut table = Table::of_numbers(headings);
    for [speed, value, error] in &friction.speeds {
        table.row(&[
            &Rounded(*speed, 3),
            &Rounded(*value, 2),
            &Rounded(*error, 2),
        ]);
    }
    out.push_str("Friction at each speed, recorded\n");
    out.table(table);
    let _ = writeln!(
        out,
        "Offset, the same in both directions: {} drive units, not part of the list.",
        Rounded(friction.offset, 2)
    );
    let notes = friction.notes.iter();
    out.lines(notes.map(|note| format!("  {}", visible_line(note))));
}

/// Appends the assumptions, the statements of the user, and the files.
fn push_grounds(out: &mut Document<'_>, report: &ResultsReport, given: &Acceptance) {
    let figures = if report.fitted.verdicts.is_empty() {
        "Every figure is recorded, none is predicted"
    } else {
        "What depends on the fitted plant is called predicted; every other figure is recorded"
    };
    let date = given.date.as_deref().unwrap_or("date not stated");
    out.detail("Basis");
    out.lines([format!("\nRecordings: {date}. {figures}.")]);
    out.lines([
        "  The programs switch compensation themselves; a recording of its state was compared where there is one, \
         and is named with the recording.",
        "  That the lists of stage 2 were loaded is what the operator confirmed; no recording shows it.",
        "  The positions of the circles are those of the recorded channels: motor or load, as the operator noted.",
    ]);
    let lacking = lacking(&report.fitted).into_iter();
    out.lines(lacking.map(|reason| format!("  No plant was fitted: {}.", visible_line(reason))));
    out.push_str("  Feeds, loads and temperatures that were not recorded are not judged.\n");
    let said = report.said.iter();
    out.lines(said.map(|said| format!("  Stated, but shown by no recording: {said}.")));
    push_files(out, report);
}

/// Appends the recordings and all other files that were read or written, with their SHA-256.
fn push_files(out: &mut Document<'_>, report: &ResultsReport) {
    let table = Table::default().left("file").left("program").left("used");
    let mut recordings = table.left("SHA-256");
    for result in &report.results {
        let against = result.found.against().join("; ");
        let number = result.program.map(|it| it.to_string());
        let used = match &*against {
            "" => "yes".to_owned(),
            against => format!("no: {}", visible_line(against)),
        };
        let sum = format!("`{}`", result.sha256);
        let file = visible_line(&result.file);
        recordings.row(&[
            &file,
            &number.as_deref().unwrap_or("not known"),
            &used,
            &sum,
        ]);
    }
    out.push_str("\nRecordings with their SHA-256\n");
    out.table(recordings);
    let mut inputs = Table::default().left("file").left("is the").left("SHA-256");
    for it in &report.inputs {
        let sum = format!("`{}`", it.sha256);
        inputs.row(&[&visible_line(&it.file), &it.what, &sum]);
    }
    let plant = report.fitted.verdicts.last();
    for TunedList {
        axis, file, sha256, ..
    } in plant.into_iter().flat_map(PlantVerdict::lists)
    {
        let what = format!("tuned list of {}", visible_line(axis));
        inputs.row(&[&visible_line(file), &what, &format!("`{sha256}`")]);
    }
    out.push_str("\nPlans, lists and plants with their SHA-256\n");
    out.table(inputs);
}
