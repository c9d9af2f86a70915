//! The result of `frictcomp replay` as a report.

use super::shown::{against, at_place, headline, remarks, verdict_of};
use frictcomp_host::replay::{RecordedAxis, Replayed, ReplayedAxis, ReplayedBy, StateRecording};
use frictcomp_report::replay::{AgreedChange, ReplayReport, ReplayReportAxis};

/// Returns the contents of the report.
pub(super) fn report(
    replayed: &Replayed,
    recording: &StateRecording,
    recorded: String,
) -> ReplayReport {
    let axes = replayed.axes.iter().zip(&recording.axes);
    ReplayReport {
        recording: recorded,
        headline: headline(replayed),
        remarks: remarks(replayed),
        axes: axes
            .map(|(axis, recorded)| of_axis(axis, recorded, replayed))
            .collect(),
    }
}

fn of_axis(axis: &ReplayedAxis, recorded: &RecordedAxis, replayed: &Replayed) -> ReplayReportAxis {
    let changes = axis.changes.iter().map(|it| AgreedChange {
        time_s: it.t_s,
        place: at_place(&it.at),
        active: it.active,
    });
    let by_order = axis.changes.iter();
    let by_order = by_order.filter(|it| it.by == ReplayedBy::Order);
    let disagreement = axis.disagreement.as_ref();
    let switched = recorded.changes.iter().map(|it| (it.t_s, it.active));
    ReplayReportAxis {
        name: axis.name.clone(),
        verdict: verdict_of(axis, replayed),
        recorded: std::iter::once((recorded.start_s, recorded.start))
            .chain(switched)
            .collect(),
        end_s: recorded.end_s,
        by_order: by_order.count(),
        changes: changes.collect(),
        against: disagreement.map(|found| (found.t_s, against(found))),
    }
}
