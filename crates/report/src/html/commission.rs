//! The acceptance report of a commissioning (R16.5).

use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, PagePart};
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, figure};
use crate::commission::{AxisVerdict, PlantVerdict, ResultsReport, Round, list_on, parameters};
use crate::pictures::{friction_of_axis, glitches_by_feed};
use crate::svg::Frame;
use frictcomp::diagnostic::Rounded;
use frictcomp_physics::circle::MeasuredGlitch;
use frictcomp_recordings::commission::{
    CirclesFound, FrictionFound, MeasuredAxis, RecordingOutcome,
};

const VERDICT: PagePart = PagePart::new("verdict", "Verdict");
const CIRCLES: PagePart = PagePart::new("circles", "Before and after");
const GROUNDS: PagePart = PagePart::new("grounds", "What it rests on");
const FILES: PagePart = PagePart::new("files", "Files");
const AXES: [PagePart; 2] = [
    PagePart::new("axis-1", "First axis"),
    PagePart::new("axis-2", "Second axis"),
];

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

/// Writes the acceptance report as one page of a browser; on paper each axis has a separate page.
///
/// # Errors
/// Those of `out`.
pub fn render_acceptance(
    report: &ResultsReport,
    given: &Acceptance,
    out: &mut dyn Write,
) -> io::Result<()> {
    let title = format!(
        "Friction compensation of {}",
        given
            .machine
            .as_deref()
            .unwrap_or("a machine without a name")
    );
    let figures = if report.fitted.verdicts.is_empty() {
        "Every figure is recorded, none is predicted"
    } else {
        "What depends on the fitted plant is called predicted; every other figure is recorded"
    };
    let date = given.date.as_deref().unwrap_or("date not stated");
    let recorded = format!("Recordings: {date}. {figures}.");
    let axes: Vec<(PagePart, &AxisVerdict)> = AXES.into_iter().zip(&report.axes).collect();
    let parts: Vec<PagePart> = [VERDICT, CIRCLES]
        .into_iter()
        .chain(axes.iter().map(|it| it.0))
        .chain([GROUNDS, FILES])
        .collect();
    let mut page = Page::open(out, &title, &report.headline(), &parts)?;
    page.part(VERDICT, &html! { p { (recorded) } (verdict(report)) })?;
    page.part(CIRCLES, &circles(report))?;
    for (part, axis) in axes {
        page.raw("<div class=\"own-page\">");
        page.part(part, &axis_part(report, given, axis))?;
        page.raw("</div>\n");
    }
    page.raw("<div class=\"own-page\">");
    page.part(GROUNDS, &grounds(report))?;
    page.part(FILES, &files(report))?;
    page.raw("</div>\n");
    page.close()
}

fn verdict(report: &ResultsReport) -> Markup {
    let missing = report.missing();
    let refused = report.rounds.last().filter(|it| !it.is_accepted());
    html! {
        @if let Some((round, against)) = refused.and_then(|it| Some((it, it.against.as_deref()?))) {
            ul { @for reason in against.iter().chain(&round.not_shown) { li { (reason) } } }
        }
        @if let Some(plant) = report.fitted.verdicts.last().filter(|it| !it.rejected.is_empty()) {
            p { "The plant is rejected by the recordings, and the earlier lists stay:" }
            ul { @for reason in &plant.rejected { li { (reason) } } }
        }
        @if let Some(plant) = report.fitted.verdicts.last().filter(|it| !it.retired.is_empty()) {
            p { "The machine does better than the plant, with which nothing is predicted from now on:" }
            ul { @for reason in &plant.retired { li { (reason) } } }
        }
        @if !missing.is_empty() {
            p { "Not recorded, or not usable: " (missing.join(", ")) "." }
        }
    }
}

fn circles(report: &ResultsReport) -> Markup {
    let rounds = report.rounds.iter().filter(|it| !it.recorded.is_empty());
    let rounds: Vec<&Round> = rounds.collect();
    html! {
        @if rounds.is_empty() {
            p { "No feed is recorded both with compensation off and on." }
        }
        @for round in rounds { (round_circles(round)) }
        (iso_figures(report))
    }
}

/// The figures of ISO 230-4 of each used circle, in the order of the programs.
fn iso_figures(report: &ResultsReport) -> Markup {
    let used = report.results.iter().filter(|it| it.found.is_used());
    let circles = used.filter_map(|it| match &it.found {
        RecordingOutcome::Circles(circles) => Some((it.program?, circles)),
        _ => None,
    });
    let mut circles: Vec<(u16, &CirclesFound)> = circles.collect();
    circles.sort_by_key(|it| it.0);
    if circles.is_empty() {
        return html! {};
    }
    let table = HtmlTable {
        caption: Caption::Shown(
            "Figures of ISO 230-4 in µm, recorded; a row for each circle, with the feed in mm/min",
        ),
        columns: &[
            ColumnHeading::Text("program"),
            ColumnHeading::Text("list"),
            ColumnHeading::Number("feed"),
            ColumnHeading::Number("G ccw"),
            ColumnHeading::Number("G cw"),
            ColumnHeading::Number("G(b)"),
            ColumnHeading::Number("H"),
        ],
    };
    let rows = circles.into_iter().map(|(number, circles)| {
        let iso = circles.iso;
        let feed = Rounded(circles.measured_feed.unwrap_or(circles.feed), 0);
        let figures = [iso.g_ccw, iso.g_cw, iso.g_b, iso.h].map(number_or_dash);
        let cells = [report.compensation_of(number), feed.to_string()];
        let cells = cells.into_iter().chain(figures);
        let cells = cells.map(|text| html! { (text) });
        HtmlRow::new(&number.to_string(), cells.collect::<Vec<_>>())
    });
    html! {
        (table.render(rows))
        p { "G about the centre of the minimum zone, G(b) and H about the mean centre of both directions." }
    }
}

fn number_or_dash(um: Option<f64>) -> String {
    um.map_or("-".to_owned(), |it| Rounded(it, 1).to_string())
}

fn round_circles(round: &Round) -> Markup {
    let caption = format!("Round {}: recorded {}", round.number, round.figure());
    let [off, on] = ["off", "on"].map(|it| format!("{it} in {}", round.unit));
    let table = HtmlTable {
        caption: Caption::Shown(&caption),
        columns: &[
            ColumnHeading::Text("feed /min"),
            ColumnHeading::Text("axis"),
            ColumnHeading::Number("driven"),
            ColumnHeading::Number(&off),
            ColumnHeading::Number(&on),
            ColumnHeading::Number("left in %"),
        ],
    };
    let rows = round.recorded.iter().flat_map(|feed| {
        feed.places.iter().map(|it| {
            let direction = it.direction.as_deref().unwrap_or_default();
            let place = format!("{} {direction}", it.axis);
            let part = Rounded(100.0 * it.on.um / it.off.um, 1).to_string();
            let with_error = |it: &MeasuredGlitch| {
                format!("{} ± {}", Rounded(it.um, 1), Rounded(it.error_um, 1))
            };
            let driven = Rounded(feed.driven, 0).to_string();
            let cells = [place, driven, with_error(&it.off), with_error(&it.on), part];
            let cells = cells.map(|text| html! { (text) });
            HtmlRow::new(&Rounded(feed.feed, 0).to_string(), cells.to_vec())
        })
    });
    let id = format!("round-{}", round.number);
    html! {
        (figure(glitches_by_feed(round).render(Frame::Inside(&id))))
        (table.render(rows))
    }
}

/// The friction of an axis, its list and what changed in it.
fn axis_part(report: &ResultsReport, given: &Acceptance, verdict: &AxisVerdict) -> Markup {
    let name = &verdict.axis;
    let change = given.changes.iter().find(|it| it.0 == *name);
    html! {
        h3 { "Axis " (name) }
        @if let Some(axis) = report.plans.iter().flat_map(|it| &it.plan.axes).find(|it| it.name == *name) {
            (described(axis))
        }
        @match report.friction_of(verdict) {
            Some(friction) => (friction_part(verdict, friction)),
            None => p { "No friction is known." },
        }
        @if !verdict.notes.is_empty() {
            ul { @for note in &verdict.notes { li { (note) } } }
        }
        @if let Some(plant) = report.fitted.verdicts.last() { (plant_part(plant, name)) }
        @if let Some((_, change)) = change {
            p { "The earlier list and that of stage 2:" }
            pre { (change) }
        } @else {
            p { "No earlier list was given to compare with." }
        }
    }
}

fn described(axis: &MeasuredAxis) -> Markup {
    let (travel, dynamics, unit) = (axis.travel, axis.dynamics, axis.unit());
    html! {
        p {
            "Travel " (travel.low) " to " (travel.high) " " (unit) ", "
            (Rounded(dynamics.velocity_per_s * 60.0, 0).to_string()) " " (unit) "/min, "
            (Rounded(dynamics.acceleration_per_s2, 0).to_string()) " " (unit) "/s²."
        }
    }
}

fn friction_part(verdict: &AxisVerdict, friction: &FrictionFound) -> Markup {
    let table = HtmlTable {
        caption: Caption::Shown("Friction at each speed, recorded"),
        columns: &[
            ColumnHeading::Text("speed per s"),
            ColumnHeading::Number("friction in drive units"),
            ColumnHeading::Number("standard error"),
        ],
    };
    let rows = friction.speeds.iter().map(|[speed, value, error]| {
        let cells = [value, error].map(|number| html! { (Rounded(*number, 2).to_string()) });
        HtmlRow::new(&Rounded(*speed, 3).to_string(), cells.to_vec())
    });
    let id = format!("friction-{}", verdict.axis);
    html! {
        (figure(friction_of_axis(friction).render(Frame::Inside(&id))))
        (table.render(rows))
        p { "Offset, the same in both directions: " (Rounded(friction.offset, 2).to_string()) " drive units, not part of the list." }
        @if !friction.notes.is_empty() {
            ul { @for note in &friction.notes { li { (note) } } }
        }
    }
}

/// The fitted parameters of an axis, and the glitches that are predicted with them.
fn plant_part(plant: &PlantVerdict, name: &str) -> Markup {
    let found = &plant.found;
    let Some(axis) = found.axes.iter().find(|it| it.axis == name) else {
        return html! {};
    };
    let fitted = HtmlTable {
        caption: Caption::Shown("Plant, predicted from circles off and on"),
        columns: &[
            ColumnHeading::Text("parameter"),
            ColumnHeading::Number("value"),
            ColumnHeading::Number("95 % range"),
            ColumnHeading::Text("unit"),
        ],
    };
    let rows = parameters(axis).map(|it| {
        let cells = [it.value, it.range, it.unit.to_owned()].map(|text| html! { (text) });
        HtmlRow::new(it.name, cells.to_vec())
    });
    let glitches = HtmlTable {
        caption: Caption::Shown("Predicted glitch"),
        columns: &[
            ColumnHeading::Text("feed in mm/min"),
            ColumnHeading::Number("off in µm"),
            ColumnHeading::Number("tuned list in µm"),
            ColumnHeading::Text("held out"),
        ],
    };
    let tuned = plant.lists().iter().find(|it| it.axis == name);
    let predicted = found.feeds().into_iter().map(|feed| {
        let off = found.predicted(name, feed, None);
        let on = tuned.and_then(|it| found.predicted(name, feed, Some(&it.sha256)));
        let held_out = if found.is_held_out(feed) { "yes" } else { "" };
        let cells = [number_or_dash(off), number_or_dash(on), held_out.to_owned()];
        let cells = cells.map(|text| html! { (text) });
        HtmlRow::new(&Rounded(feed, 0).to_string(), cells.to_vec())
    });
    html! {
        (fitted.render(rows))
        p {
            (Rounded(axis.left, 2).to_string()) " µm are left of " (axis.reversals)
            " recorded reversals at the feeds that were not held out."
        }
        (compared_part(plant, name))
        (glitches.render(predicted))
        p { "Not modelled: " (plant.not_modelled.join(", ")) "." }
        @if let Some(list) = tuned {
            p { "Tuned list " (list.file) ", SHA-256 " code { (list.sha256) } "; no recording has shown it yet." }
            @if !list.against.is_empty() {
                ul { @for reason in &list.against { li { "Not to be recorded: " (reason) } } }
            }
        }
    }
}

/// The recorded glitches of an axis with their predictions.
fn compared_part(plant: &PlantVerdict, name: &str) -> Markup {
    let table = HtmlTable {
        caption: Caption::Shown(
            "Glitches that the plant was not fitted to, recorded and predicted; each a mean over 8 ms",
        ),
        columns: &[
            ColumnHeading::Text("feed in mm/min"),
            ColumnHeading::Text("list"),
            ColumnHeading::Number("predicted in µm"),
            ColumnHeading::Number("recorded in µm"),
        ],
    };
    let compared = plant.compared.iter();
    let of_axis = compared.filter(|it| it.recorded.axis == name);
    let rows = of_axis.map(|it| {
        let [predicted, recorded] =
            [it.predicted_um, it.recorded.um].map(|um| Rounded(um, 1).to_string());
        let cells = [list_on(it).to_owned(), predicted, recorded];
        let cells = cells.map(|text| html! { (text) });
        HtmlRow::new(&Rounded(it.recorded.feed, 0).to_string(), cells.to_vec())
    });
    html! { @if !plant.compared.is_empty() { (table.render(rows)) } }
}

/// Renders the assumptions, and the statements of the user.
fn grounds(report: &ResultsReport) -> Markup {
    html! {
        ul {
            li { "The programs switch compensation themselves; a recording of its state was compared where there is one, and is named with the recording." }
            li { "That the lists of stage 2 were loaded is what the operator confirmed; no recording shows it." }
            li { "The positions of the circles are those of the recorded channels: motor or load, as the operator noted." }
            @for reason in &report.fitted.lacking { li { "No plant was fitted: " (reason) "." } }
            li { "Feeds, loads and temperatures that were not recorded are not judged." }
            @for said in &report.said { li { "Stated, but shown by no recording: " (said) "." } }
        }
    }
}

/// The recordings and all other files that were read, with their SHA-256.
fn files(report: &ResultsReport) -> Markup {
    html! {
        (recordings(report))
        (inputs(report))
    }
}

fn inputs(report: &ResultsReport) -> Markup {
    let table = HtmlTable {
        caption: Caption::Shown("Plans, lists and plants with their SHA-256"),
        columns: &[
            ColumnHeading::Text("file"),
            ColumnHeading::Text("is the"),
            ColumnHeading::Text("SHA-256"),
        ],
    };
    let rows = report.inputs.iter().map(|it| {
        let cells = [html! { (it.what) }, html! { code { (it.sha256) } }];
        HtmlRow::new(&it.file, cells.to_vec())
    });
    table.render(rows)
}

fn recordings(report: &ResultsReport) -> Markup {
    let table = HtmlTable {
        caption: Caption::Shown("Recordings with their SHA-256"),
        columns: &[
            ColumnHeading::Text("file"),
            ColumnHeading::Text("program"),
            ColumnHeading::Text("used"),
            ColumnHeading::Text("SHA-256"),
        ],
    };
    let rows = report.results.iter().map(|result| {
        let against = result.found.against().join("; ");
        let program = result
            .program
            .map_or("not known".to_owned(), |it| it.to_string());
        let used = if against.is_empty() {
            "yes".to_owned()
        } else {
            format!("no: {against}")
        };
        let cells = [
            html! { (program) },
            html! { (used) },
            html! { code { (result.sha256) } },
        ];
        HtmlRow::new(&result.file, cells.to_vec())
    });
    table.render(rows)
}
