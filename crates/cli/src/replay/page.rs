//! The result of `frictcomp replay` as a page.

use super::shown::{against, at_place, headline, remarks, verdict_of, word};
use frictcomp_host::replay::{RecordedAxis, Replayed, ReplayedAxis, StateRecording};
use frictcomp_report::html::{ReplayReport, ReplayReportAxis};

/// Returns the contents of the page.
pub(super) fn report(
    replayed: &Replayed,
    recording: &StateRecording,
    recorded: String,
) -> ReplayReport {
    let axes = replayed.axes.iter().zip(&recording.axes);
    ReplayReport {
        recording: recorded,
        headline: headline(replayed),
        verdicts: remarks(replayed),
        axes: axes
            .map(|(axis, recorded)| of_axis(axis, recorded, replayed))
            .collect(),
    }
}

fn of_axis(axis: &ReplayedAxis, recorded: &RecordedAxis, replayed: &Replayed) -> ReplayReportAxis {
    let changes = axis.changes.iter().map(|it| {
        [
            format!("{:.3}", it.t_s),
            at_place(&it.at),
            word(it).to_owned(),
            it.by.as_str().to_owned(),
        ]
    });
    let mut reasons = axis.disagreement.as_ref().map(against).unwrap_or_default();
    if let (Some(found), Some(first)) = (&axis.disagreement, reasons.first_mut()) {
        *first = format!("{:.3} s, {first}", found.t_s);
    }
    let switched = recorded.changes.iter().map(|it| (it.t_s, it.active));
    ReplayReportAxis {
        name: axis.name.clone(),
        verdict: verdict_of(axis, replayed),
        recorded: std::iter::once((recorded.start_s, recorded.start))
            .chain(switched)
            .collect(),
        end_s: recorded.end_s,
        changes: changes.collect(),
        against: reasons,
    }
}
