//! Friction identified on circles, as text and JSON.

use std::fmt::Write as _;

use serde::Serialize;

use super::PointRecord;
use crate::document::{Document, Headline, Standing, Table};
use crate::wording::{to_json, visible_line};
use frictcomp::diagnostic::{Rounded, Severity};
use frictcomp_recordings::identify::{AxisRecording, OnCircles, TraceFinding};
use frictcomp_recordings::value_lists::DRIVE_UNITS;

/// Recorded circles and the friction identified on them.
#[derive(Debug, Clone)]
pub struct OnCirclesReport {
    /// The names of the files.
    pub names: Vec<String>,
    /// The axis, if it is named.
    pub axis: Option<String>,
    /// The recordings.
    pub recordings: Vec<AxisRecording>,
    /// Result.
    pub found: OnCircles,
}

impl OnCirclesReport {
    /// Returns the unit of torque and friction.
    pub fn unit(&self) -> &str {
        let units = self
            .recordings
            .iter()
            .filter_map(|it| it.torque_unit.as_deref());
        units.into_iter().next().unwrap_or(DRIVE_UNITS)
    }

    /// Returns the verdict: the friction over the speeds (R18.20).
    pub fn headline(&self) -> Headline {
        let axis = self.axis.as_deref();
        let axis = axis.map_or(String::new(), |axis| format!(" of {axis}"));
        let points = &self.found.points;
        let (Some([slowest, at_slowest]), Some([fastest, at_fastest])) =
            (points.first(), points.last())
        else {
            return Headline::new(
                Standing::Bad,
                format!("no friction{axis} is found on circles"),
            );
        };
        let text = format!(
            "friction{axis} on circles, from {slowest:.2} to {fastest:.2} mm/s: {} to {} {}",
            Rounded(*at_slowest, 3),
            Rounded(*at_fastest, 3),
            self.unit(),
        );
        Headline::new(Standing::Plain, text).with_fault(self.findings())
    }

    /// Returns the faults of the recordings, one line each for the written list (R6.21).
    pub fn faults(&self) -> Vec<String> {
        let findings = self.findings().into_iter();
        let faults = findings.filter(|it| it.severity == Severity::Warning);
        faults
            .map(|it| format!("{}: {}", it.code, it.message))
            .collect()
    }

    /// Returns the findings about the channels, those of several files once, then those about the friction.
    fn findings(&self) -> Vec<&TraceFinding> {
        let mut findings: Vec<&TraceFinding> = Vec::new();
        let of_files = self.recordings.iter().flat_map(|it| &it.findings);
        for finding in of_files.chain(&self.found.findings) {
            if !findings.contains(&finding) {
                findings.push(finding);
            }
        }
        findings
    }
}

/// Returns the friction at each speed.
pub fn document(report: &OnCirclesReport) -> Document<'_> {
    let mut out = Document::new("Friction on circles", report.headline());
    let found = &report.found;
    let names: Vec<_> = report.names.iter().map(|name| visible_line(name)).collect();
    let _ = writeln!(out, "circles in {}\n", names.join(", "));
    let friction = format!("friction\n{}", report.unit());
    let mut table = Table::of_numbers(["speed\nmm/s", &friction]);
    for [speed, friction] in &found.points {
        table.row(&[&format_args!("{speed:.3}"), &Rounded(*friction, 3)]);
    }
    out.table(table);
    let _ = writeln!(
        out,
        "\noffset {}, inertia {} per mm/s²",
        Rounded(found.offset, 3),
        Rounded(found.inertia, 6)
    );
    if !found.left_out.is_empty() {
        let speeds: Vec<String> = found.left_out.iter().map(|it| format!("{it:.2}")).collect();
        let _ = writeln!(
            out,
            "left out for too few samples: {} mm/s",
            speeds.join(", ")
        );
    }
    out.findings(report.findings());
    out
}

#[derive(Serialize)]
struct OnCirclesDocument<'a> {
    schema: u32,
    headline: Headline,
    axis: Option<&'a str>,
    points: Vec<PointRecord>,
    offset: f64,
    inertia: f64,
    left_out: Vec<f64>,
    diagnostics: Vec<&'a TraceFinding>,
}

/// Returns the report as JSON; speeds in µm/s or 0.001°/s.
pub fn render_json(report: &OnCirclesReport) -> String {
    const PER_MM: f64 = 1000.0;
    let points = report
        .found
        .points
        .iter()
        .map(|[speed, friction]| PointRecord {
            input: speed * PER_MM,
            out: *friction,
        });
    to_json(&OnCirclesDocument {
        schema: 1,
        headline: report.headline(),
        axis: report.axis.as_deref(),
        points: points.collect(),
        offset: report.found.offset,
        inertia: report.found.inertia,
        left_out: report
            .found
            .left_out
            .iter()
            .map(|speed| speed * PER_MM)
            .collect(),
        diagnostics: report.findings(),
    })
}
