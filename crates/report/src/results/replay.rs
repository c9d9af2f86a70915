//! The report that compares a recording of a machine with the dry run (R15.21).

use crate::document::{Document, Headline, Table};
use crate::svg::{Band, BandChart, BandRow, BandState, ChartAxis, StartUpRelation};
use crate::wording::visible_line;
use frictcomp::comp::State;
use frictcomp::diagnostic::Rounded;

/// A recording of states compared with the dry run.
#[derive(Debug, Clone, Default)]
pub struct ReplayReport {
    /// Name of the recording.
    pub recording: String,
    /// The verdict.
    pub headline: Headline,
    /// Remarks on all axes, in sentences.
    pub remarks: Vec<String>,
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
    /// Each change in which both agree.
    pub changes: Vec<AgreedChange>,
    /// Number of changes that were compared by their order alone.
    pub by_order: usize,
    /// The time in s from which both disagree, and what contradicts an agreement, in sentences.
    pub against: Option<(f64, Vec<String>)>,
}

/// A change in which the recording and the dry run agree.
#[derive(Debug, Clone)]
pub struct AgreedChange {
    /// The time in s.
    pub time_s: f64,
    /// The block of the dry run.
    pub place: String,
    /// Whether friction compensation is active after it.
    pub active: bool,
}

/// The recorded states, the verdict on each axis with its changes, and remarks on the whole.
pub fn document(report: &ReplayReport) -> Document<'_> {
    let title = format!("{} compared with the dry run", report.recording);
    let mut out = Document::new(title, report.headline.clone());
    out.figure(|| chart(report));
    out.section("Changes");
    for axis in &report.axes {
        push_axis(&mut out, axis);
    }
    out.lines(&report.remarks);
    out
}

fn push_axis(out: &mut Document<'_>, axis: &ReplayReportAxis) {
    out.lines([format!("{}: {}", visible_line(&axis.name), axis.verdict)]);
    let at = |time_s: f64| format!("  {time_s:>10.3} s");
    let mut table = Table::plain(["time", "block of the dry run", "state"]);
    for change in &axis.changes {
        let state = state(change.active).as_str();
        table.row(&[&at(change.time_s), &change.place, &state]);
    }
    if !axis.changes.is_empty() {
        out.table(table);
    }
    if axis.by_order > 0 {
        out.lines([format!(
            "  {} of {} compared by the order alone: where the machine switched is not known",
            axis.by_order,
            axis.changes.len()
        )]);
    }
    if let Some((time_s, reasons)) = &axis.against {
        let mut reasons = reasons.iter();
        out.lines(
            reasons
                .next()
                .map(|first| format!("{}  {first}", at(*time_s))),
        );
        out.lines(reasons.map(|it| format!("  {it}")));
    }
}

fn state(active: bool) -> State {
    if active {
        State::Active
    } else {
        State::Inactive
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
        let state = state(active);
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
