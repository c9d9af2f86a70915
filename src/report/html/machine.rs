//! The axes of the machine, their parameters with numbers and origins, and their value lists.

use super::page::{Page, state_word};
use super::run::Given;
use super::story::RunStory;
use crate::comp::Change;
use crate::lists::{AxisType, Origin, Parameter};
use crate::machine::{AxisSet, Parameterisation};
use crate::report::lists::cells;
use crate::report::markup::escaped;
use crate::report::pictures::value_curve;
use crate::report::svg::Frame;

/// Writes what the user gave and what holds on each axis.
pub(super) fn render(page: &mut Page<'_>, story: &RunStory, given: &Given<'_>) {
    if !given.settings.is_empty() {
        page.open_table("Given for this run", &["setting", "value"]);
        for (name, value) in given.settings {
            page.row(name, &[escaped(value)]);
        }
        page.close_table();
    }
    if story.axis_set == AxisSet::AsTheyOccur {
        page.paragraph(
            "Without a configuration the axes are taken as they occur, with the documented \
             defaults of their parameters.",
        );
    }
    let columns = [
        "axis",
        "type",
        "FRICT configured (P-AXIS-00522)",
        "origin",
        "value list",
    ];
    page.open_table("Axes", &columns);
    for axis in story.axes.iter().filter(|axis| axis.listed) {
        let configured = if axis.configured { "1, yes" } else { "0, no" };
        let cells = [
            axis_type(axis.axis_type).to_owned(),
            configured.to_owned(),
            escaped(&origin(&axis.origin)),
            value_list(&axis.friction),
        ];
        page.row(&axis.name, &cells);
    }
    page.close_table();
    for report in given.parameters {
        let caption = format!("Parameters of axis {}", report.axis);
        parameters(page, &caption, &report.parameters);
    }
    parameters(page, "Programs and macros of the machine", given.programs);
}

/// Writes the curve of each axis with an accepted value list.
pub(super) fn render_curves(page: &mut Page<'_>, story: &RunStory) {
    for (number, accepted) in story.accepted.iter().enumerate() {
        let name = format!("curve{number}");
        page.figure(&value_curve(accepted).render(Frame::Inside(&name)));
    }
    if story.accepted.is_empty() {
        page.paragraph("No axis has a value list that the control would accept.");
    }
}

fn parameters(page: &mut Page<'_>, caption: &str, rows: &[Parameter]) {
    if rows.is_empty() {
        return;
    }
    page.open_table(caption, &["number", "key", "#value", "origin"]);
    for parameter in rows {
        let [number, key, value, origin] = cells(parameter);
        let key = format!("<code>{}</code>", escaped(&key));
        page.row(&number, &[key, escaped(&value), escaped(&origin)]);
    }
    page.close_table();
}

fn axis_type(axis_type: AxisType) -> &'static str {
    match axis_type {
        AxisType::Linear => "linear",
        AxisType::Rotary => "rotary",
        AxisType::Spindle => "spindle",
    }
}

fn origin(origin: &Origin) -> String {
    match origin {
        Origin::Default => "default".to_owned(),
        Origin::Assumed => "--enable".to_owned(),
        Origin::File { file, line } => format!("{file}:{line}"),
    }
}

fn value_list(friction: &Parameterisation) -> String {
    match friction {
        Parameterisation::Missing => "none".to_owned(),
        Parameterisation::Off => "its mode is 0, off".to_owned(),
        Parameterisation::Rejected { file, code } => {
            format!("{} is rejected ({})", escaped(file), escaped(code))
        }
        Parameterisation::Assumed => "assumed by --enable, its values are not known".to_owned(),
        Parameterisation::Accepted(list) => format!("accepted, {} points", list.table.len()),
    }
}

/// The words of a change of state.
pub(super) fn change_words(story: &RunStory, change: Change) -> String {
    let of = (change.axis, change.kind);
    let word = |state| state_word(state, story.standing(of, state));
    format!("{} \u{2192} {}", word(change.from), word(change.to))
}
