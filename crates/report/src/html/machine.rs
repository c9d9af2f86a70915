//! The axes of the machine, their parameters with numbers and origins, and their value lists.

use maud::{Markup, html};

use super::digest::{AxisDigest, RunDigest};
use super::given::RunInputs;
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, figure};
use crate::pictures::value_curve;
use crate::results::lists::cells;
use crate::svg::Frame;
use crate::wording::counted;
use frictcomp::lists::{AxisType, Parameter};
use frictcomp::machine::{AxisSet, Parameterisation};

/// The assumption of a configuration about an axis.
const ENABLED: &str = "`enable = true`";

/// Renders the user's options and the effective values of each axis.
pub(super) fn render(digest: &RunDigest, given: &RunInputs<'_>) -> Markup {
    html! {
        (settings(&given.given.settings()))
        @if digest.axis_set == AxisSet::AsTheyOccur {
            p {
                "Without a configuration the axes are taken as they occur, with the documented \
                 defaults of their parameters."
            }
        }
        (axes(digest))
        @for report in given.parameters {
            (parameters(&format!("Parameters of axis {}", report.axis), &report.parameters))
        }
        (parameters("Programs and macros of the machine", given.programs))
    }
}

/// Returns the curve of each axis with an accepted value list.
pub(super) fn render_curves(digest: &RunDigest) -> Markup {
    html! {
        @for (number, accepted) in digest.accepted.iter().enumerate() {
            @let name = format!("curve{number}");
            (figure(value_curve(accepted).render(Frame::Inside(&name))))
        }
        @if digest.accepted.is_empty() {
            p { "No axis has a value list that the control would accept." }
        }
    }
}

fn settings(settings: &[(&str, String)]) -> Markup {
    let table = HtmlTable {
        caption: Caption::Shown("Given for this run"),
        columns: &[ColumnHeading::Text("setting"), ColumnHeading::Text("value")],
    };
    let rows = settings.iter();
    table.render(rows.map(|(name, value)| HtmlRow::new(name, [html! { (value) }])))
}

fn axes(digest: &RunDigest) -> Markup {
    let table = HtmlTable {
        caption: Caption::Shown("Axes"),
        columns: &[
            ColumnHeading::Text("axis"),
            ColumnHeading::Text("type"),
            ColumnHeading::Text("FRICT configured (P-AXIS-00522)"),
            ColumnHeading::Text("origin"),
            ColumnHeading::Text("value list"),
        ],
    };
    let listed = digest.axes.iter().filter(|axis| axis.listed);
    table.render(listed.map(|axis| {
        let configured = if axis.configured { "1, yes" } else { "0, no" };
        let cells = [
            html! { (axis_type(axis.axis_type)) },
            html! { (configured) },
            html! { (axis.origin) },
            html! { (value_list(axis)) },
        ];
        HtmlRow::new(&axis.name, cells)
    }))
}

fn parameters(caption: &str, parameters: &[Parameter]) -> Markup {
    if parameters.is_empty() {
        return html! {};
    }
    let table = HtmlTable {
        caption: Caption::Shown(caption),
        columns: &[
            ColumnHeading::Text("number"),
            ColumnHeading::Text("key"),
            ColumnHeading::Number("value"),
            ColumnHeading::Text("origin"),
        ],
    };
    table.render(parameters.iter().map(|parameter| {
        let [number, key, value, origin] = cells(parameter);
        let cells = [
            html! { code { (key) } },
            html! { (value) },
            html! { (origin) },
        ];
        HtmlRow::new(&number, cells)
    }))
}

fn axis_type(axis_type: AxisType) -> &'static str {
    match axis_type {
        AxisType::Linear => "linear",
        AxisType::Rotary => "rotary",
        AxisType::Spindle => "spindle",
    }
}

fn value_list(axis: &AxisDigest) -> String {
    match &axis.friction {
        Parameterisation::Missing => "none".to_owned(),
        Parameterisation::Off => "its mode is 0, off".to_owned(),
        Parameterisation::Rejected { file, code } => format!("{file} is rejected ({code})"),
        Parameterisation::Assumed if axis.origin.contains(ENABLED) => {
            format!("assumed by {ENABLED}, its values are not known")
        }
        Parameterisation::Assumed => "assumed by --enable, its values are not known".to_owned(),
        Parameterisation::Accepted(list) => {
            format!("accepted, {}", counted(list.table.len(), "point"))
        }
    }
}
