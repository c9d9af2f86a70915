//! The report that compares a recording of a machine with the dry run (R15.21).

use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, PagePart};
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, figure};
use crate::document::Headline;
use crate::svg::{Band, BandChart, BandRow, BandState, ChartAxis, Frame, StartUpRelation};
use frictcomp::comp::State;
use frictcomp::diagnostic::Rounded;

const VERDICT: PagePart = PagePart::new("verdict", "Verdict");
const STATES: PagePart = PagePart::new("states", "Recorded states");
const CHANGES: PagePart = PagePart::new("changes", "Changes");

/// A recording of states compared with the dry run.
#[derive(Debug, Clone, Default)]
pub struct ReplayReport {
    /// Name of the recording.
    pub recording: String,
    /// The verdict.
    pub headline: Headline,
    /// The verdicts on the whole, in sentences.
    pub verdicts: Vec<String>,
    /// Each axis of the recording.
    pub axes: Vec<ReplayReportAxis>,
}

/// An axis of the recording.
#[derive(Debug, Clone, Default)]
pub struct ReplayReportAxis {
    /// Its name.
    pub name: String,
    /// The verdict in a sentence.
    pub verdict: String,
    /// The times in s from which friction compensation is active or not; the first sample first.
    pub recorded: Vec<(f64, bool)>,
    /// The time of the last sample in s.
    pub end_s: f64,
    /// Time, place, state and evidence of each change in which both agree.
    pub changes: Vec<[String; 4]>,
    /// What contradicts an agreement, in sentences.
    pub against: Vec<String>,
}

/// Writes the report of a replay as one page.
///
/// # Errors
/// Those of `out`.
pub fn render_replay(report: &ReplayReport, out: &mut dyn Write) -> io::Result<()> {
    let title = format!("{} compared with the dry run", report.recording);
    let mut page = Page::open(out, &title, &report.headline, &[VERDICT, STATES, CHANGES])?;
    page.part(VERDICT, &verdict(report))?;
    page.part(
        STATES,
        &figure(chart(report).render(Frame::Inside("states"))),
    )?;
    page.part(
        CHANGES,
        &html! { @for axis in &report.axes { (changes(axis)) } },
    )?;
    page.close()
}

fn verdict(report: &ReplayReport) -> Markup {
    html! {
        ul {
            @for axis in &report.axes { li { (axis.name) ": " (axis.verdict) } }
        }
        @for said in &report.verdicts { p { (said) } }
    }
}

fn chart(report: &ReplayReport) -> BandChart {
    BandChart {
        description: "The recorded state of friction compensation of each axis over the time."
            .to_owned(),
        x: ChartAxis {
            label: "time in s".to_owned(),
            ..ChartAxis::default()
        },
        rows: report.axes.iter().map(row).collect(),
        ..BandChart::default()
    }
}

fn row(axis: &ReplayReportAxis) -> BandRow {
    let ends = axis.recorded.iter().skip(1).map(|it| it.0);
    let ends = ends.chain([axis.end_s]);
    let bands = axis.recorded.iter().zip(ends).map(|(&(from, active), to)| {
        let state = if active {
            State::Active
        } else {
            State::Inactive
        };
        Band {
            from,
            to,
            state: BandState::One(state),
            relation: StartUpRelation::default(),
            title: format!(
                "{} from {} s to {} s",
                state.as_str(),
                Rounded(from, 3),
                Rounded(to, 3)
            ),
            href: None,
        }
    });
    BandRow {
        label: axis.name.clone(),
        bands: bands.collect(),
    }
}

fn changes(axis: &ReplayReportAxis) -> Markup {
    let caption = format!("Changes of {} in which both agree", axis.name);
    let table = HtmlTable {
        caption: Caption::Heard(&caption),
        columns: &[
            ColumnHeading::Text("time in s"),
            ColumnHeading::Text("block of the dry run"),
            ColumnHeading::Text("state"),
            ColumnHeading::Text("compared by"),
        ],
    };
    html! {
        h3 { "Axis " (axis.name) }
        @if axis.changes.is_empty() {
            p { "No change agrees." }
        } @else {
            (table.render(axis.changes.iter().map(|[time, rest @ ..]| {
                HtmlRow::new(time, rest.each_ref().map(|cell| html! { (cell) }))
            })))
        }
        @if !axis.against.is_empty() {
            div.to-do { ul { @for said in &axis.against { li { (said) } } } }
        }
    }
}
