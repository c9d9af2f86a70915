//! A verified value list as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use super::identify::json_of_axes;
use crate::document::{Document, Headline, Standing, Table};
use crate::wording::visible_line;
use frictcomp::diagnostic::Rounded;
use frictcomp_recordings::identify::{AxisRecording, CONTACT_MM, Timing, TraceFinding, Verified};

/// A recording, and the fit of a value list to it.
#[derive(Debug, Clone)]
pub struct VerifyReport {
    /// The axis, if it is named.
    pub axis: Option<String>,
    /// The name of the trace.
    pub trace: String,
    /// The name of the value list.
    pub list: String,
    /// The recording.
    pub recording: AxisRecording,
    /// The fit of the list.
    pub verified: Verified,
}

impl VerifyReport {
    /// Returns the verdict: whether the list fits, and at which speeds (R18.20).
    pub fn headline(&self) -> Headline {
        let verified = &self.verified;
        let mut said = verified.verdict();
        if let Timing::Other(_) = verified.timing {
            said.push(verified.timing.sentence());
        }
        let axis = self.axis.as_deref();
        let axis = axis.map_or(String::new(), |axis| format!(" of {axis}"));
        let ends = [verified.ranges.first(), verified.ranges.last()];
        let verdict = match ends {
            [Some(first), Some(last)] if verified.agrees() => Headline::new(
                if verified.not_judged.is_empty() {
                    Standing::Good
                } else {
                    Standing::Open
                },
                format!(
                    "{} fits the recorded torque{axis} from {:.2} to {:.2} mm/s",
                    self.list, first.from, last.to
                ),
            ),
            _ => Headline::new(
                Standing::Bad,
                format!(
                    "{} does not fit the recorded torque{axis}: {}",
                    self.list,
                    said.join("; ")
                ),
            ),
        };
        verdict.with_fault(&self.recording.findings)
    }
}

/// Returns the verdict, then the figures that it is based on.
pub fn document(report: &VerifyReport) -> Document<'_> {
    let verified = &report.verified;
    let title = format!("{} against {}", report.list, report.trace);
    let mut out = Document::new(title, report.headline());
    for gap in &verified.not_judged {
        let _ = writeln!(
            out,
            "not judged: {:.2} to {:.2} mm/s, where the recording has too little motion",
            gap.start(),
            gap.end()
        );
    }
    if !matches!(verified.timing, Timing::Other(_)) {
        let _ = writeln!(out, "{}", verified.timing.sentence());
    }
    let mut table = Table::of_numbers(["from mm/s", "to mm/s", "recorded/predicted"]);
    for range in &verified.ranges {
        table.row(&[
            &format_args!("{:.2}", range.from),
            &format_args!("{:.2}", range.to),
            &Rounded(range.scale, 3),
        ]);
    }
    out.section("Speeds");
    out.push_str("\n");
    out.table(table);
    let _ = writeln!(
        out,
        "\nall speeds {}, offset {}, inertia {} per mm/s², residual {:.3}",
        Rounded(verified.scale, 3),
        Rounded(verified.offset, 3),
        Rounded(verified.inertia, 6),
        verified.residual
    );
    if verified.is_away_from_reversals && !verified.reversals.is_empty() {
        out.folded("Conditions");
        let _ = writeln!(
            out,
            "the scales are those of the motion from {CONTACT_MM} mm after each reversal on: nearer, the contact still \
             builds up its friction, which is no error of the list"
        );
    }
    if !verified.reversals.is_empty() {
        const SHOWN: usize = 20;
        let mut table = Table::of_numbers(["reversal s", "recorded", "predicted"]);
        for turn in verified.reversals.iter().take(SHOWN) {
            table.row(&[
                &format_args!("{:.3}", turn.time_s),
                &Rounded(turn.recorded, 3),
                &Rounded(turn.predicted, 3),
            ]);
        }
        out.section("Reversals");
        out.push_str("\n");
        out.table(table);
        let more = verified.reversals.len().saturating_sub(SHOWN);
        if more > 0 {
            let _ = writeln!(out, "and {more} more");
        }
    }
    out.section("What to look at");
    for remark in &report.recording.remarks {
        let _ = writeln!(out, "\nnote: {}", visible_line(remark));
    }
    out.findings(&report.recording.findings);
    out
}

#[derive(Serialize)]
struct VerifyRecord<'a> {
    schema: u32,
    axis: Option<&'a str>,
    headline: Headline,
    verdict: Vec<String>,
    scale: f64,
    ranges: Vec<RangeRecord>,
    not_judged: Vec<[f64; 2]>,
    offset: f64,
    inertia: f64,
    timing: Timing,
    step_s: f64,
    residual: f64,
    reversals: Vec<ReversalRecord>,
    remarks: &'a [String],
    diagnostics: &'a [TraceFinding],
}

#[derive(Serialize)]
struct RangeRecord {
    from: f64,
    to: f64,
    scale: f64,
}

#[derive(Serialize)]
struct ReversalRecord {
    t: f64,
    recorded: f64,
    predicted: f64,
}

/// Returns the report of an axis, or those of several, as JSON; speeds in µm/s or 0.001°/s, times in s.
pub fn render_json(reports: &[VerifyReport]) -> String {
    json_of_axes(reports.iter().map(record))
}

fn record(report: &VerifyReport) -> VerifyRecord<'_> {
    const PER_MM: f64 = 1000.0;
    let verified = &report.verified;
    let ranges = verified.ranges.iter().map(|range| RangeRecord {
        from: range.from * PER_MM,
        to: range.to * PER_MM,
        scale: range.scale,
    });
    let not_judged = verified.not_judged.iter();
    let reversals = verified.reversals.iter().map(|turn| ReversalRecord {
        t: turn.time_s,
        recorded: turn.recorded,
        predicted: turn.predicted,
    });
    VerifyRecord {
        schema: 1,
        axis: report.axis.as_deref(),
        headline: report.headline(),
        verdict: verified.verdict(),
        scale: verified.scale,
        ranges: ranges.collect(),
        not_judged: not_judged
            .map(|gap| [gap.start() * PER_MM, gap.end() * PER_MM])
            .collect(),
        offset: verified.offset,
        inertia: verified.inertia,
        timing: verified.timing,
        step_s: verified.step_s,
        residual: verified.residual,
        reversals: reversals.collect(),
        remarks: &report.recording.remarks,
        diagnostics: &report.recording.findings,
    }
}
