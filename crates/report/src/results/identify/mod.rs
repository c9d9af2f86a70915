//! An identified friction curve as text and JSON.

pub mod on_circles;
pub mod states;

use std::fmt::Write as _;

use serde::Serialize;

use crate::document::{Document, Headline, Standing, Table};
use crate::pictures::{friction_curve, residuals_over_position, segments_on_trace};
use crate::wording::{counted, to_json, visible_line};
use frictcomp::diagnostic::{Rounded, Severity};
use frictcomp_recordings::identify::{
    AxisRecording, BranchPoint, DirectionBranches, Fit, FrictionCurve, Identified, TraceFinding,
};
use frictcomp_recordings::value_lists::DRIVE_UNITS;

/// A recording and the friction identified in it.
#[derive(Debug, Clone)]
pub struct IdentifyReport {
    /// The name of the file.
    pub name: String,
    /// The axis, if it is named.
    pub axis: Option<String>,
    /// The recording.
    pub recording: AxisRecording,
    /// Result.
    pub identified: Identified,
}

impl IdentifyReport {
    /// Returns the findings about the channels, then those about the friction.
    pub fn findings(&self) -> impl Iterator<Item = &TraceFinding> {
        self.recording
            .findings
            .iter()
            .chain(&self.identified.findings)
    }

    /// Returns the verdict: the friction over the speeds, and the first fault of the recording (R18.20).
    pub fn headline(&self) -> Headline {
        let found = &self.identified;
        let axis = self.axis.as_deref();
        let axis = axis.map_or(String::new(), |axis| format!(" of {axis}"));
        let (Some(slowest), Some(fastest)) = (found.pairs.first(), found.pairs.last()) else {
            return Headline::new(Standing::Bad, format!("no friction{axis} is found"))
                .with_fault(self.findings());
        };
        let text = format!(
            "friction{axis} from {:.2} to {:.2} mm/s: {} to {} {}",
            slowest.speed,
            fastest.speed,
            Rounded(slowest.friction, 3),
            Rounded(fastest.friction, 3),
            self.unit(),
        );
        let limits = self.limits_of_list().map(|it| format!("; {it}"));
        let text = text + &limits.collect::<String>();
        Headline::new(Standing::Plain, text).with_fault(self.findings())
    }

    /// Returns the limits of what the value list can hold, each a clause.
    fn limits_of_list(&self) -> impl Iterator<Item = String> {
        let found = &self.identified;
        let branches = found
            .branches()
            .map(|_| "it differs by direction, and the list is the mean of both".to_owned());
        let missed = found.missed_error.map(|asked| {
            format!(
                "{} are up to {} {} off, where {} was asked for",
                counted(found.points.len(), "point"),
                Rounded(found.point_error, 3),
                self.unit(),
                Rounded(asked, 3)
            )
        });
        branches.into_iter().chain(missed)
    }

    /// Returns a title with the name of the axis, if it has one.
    pub(crate) fn titled(&self, what: &str) -> String {
        match &self.axis {
            Some(axis) => format!("{what} of axis {axis}"),
            None => what.to_owned(),
        }
    }

    /// Returns the faults of the recording and the limits of the list, one line each for the written list (R6.21).
    pub fn faults(&self) -> Vec<String> {
        let faults = self
            .findings()
            .filter(|it| it.severity == Severity::Warning);
        let faults = faults.map(|it| format!("{}: {}", it.code, it.message));
        faults.chain(self.limits_of_list()).collect()
    }

    /// Returns the unit of torque and friction.
    pub fn unit(&self) -> &str {
        self.recording.torque_unit.as_deref().unwrap_or(DRIVE_UNITS)
    }
}

/// Returns the findings, then speeds, curve and points.
pub fn document(report: &IdentifyReport) -> Document<'_> {
    let mut out = Document::new(report.titled("Friction"), report.headline());
    out.figure(|| friction_curve(report));
    push_identified(&mut out, report);
    out.section("Residuals over the position");
    out.figure(|| residuals_over_position(report));
    out.section("Segments on the trace");
    out.figure(|| segments_on_trace(report));
    out
}

/// Appends findings, speeds, curve and points.
pub(crate) fn push_identified(out: &mut Document<'_>, report: &IdentifyReport) {
    let found = &report.identified;
    let track = &report.recording.track;
    let length = track.times_s.last().unwrap_or(&0.0) - track.times_s.first().unwrap_or(&0.0);
    let _ = writeln!(
        out,
        "{}: {} segments of constant speed in {length:.1} s",
        visible_line(&report.name),
        found.segments.len()
    );
    // Faults come before the list (R6.21).
    out.findings(report.findings());
    out.section("Speeds");
    out.push_str("\n");
    push_pairs(out, found);
    if let Some(branches) = found.branches() {
        push_branches(out, &branches, report.unit());
    } else {
        let _ = writeln!(
            out,
            "\noffset (weight, asymmetry): {} {}",
            Rounded(found.offset, 3),
            report.unit()
        );
        out.push_str(offset_words(found));
    }
    push_curve(out, found);
    out.section("Value list");
    let mut table = Table::of_numbers(["in\nµm/s"]).right(format!("out\n{}", report.unit()));
    for point in &found.points {
        table.row(&[&point.input, &Rounded(point.output, 3)]);
    }
    let _ = write!(
        out,
        "\nvalue list: {}, straight lines at most {:.3} from the curve\n\n",
        counted(found.points.len(), "point"),
        found.point_error,
    );
    out.table(table);
    for remark in &report.recording.remarks {
        let _ = writeln!(out, "\nnote: {}", visible_line(remark));
    }
}

fn push_pairs(out: &mut Document<'_>, found: &Identified) {
    let mut table = Table::of_numbers([
        "speed\nmm/s",
        "friction",
        "±",
        "offset",
        "residual",
        "visits",
    ]);
    for pair in &found.pairs {
        let offset = pair.offset.map_or("one-sided".to_owned(), |offset| {
            Rounded(offset, 3).to_string()
        });
        table.row(&[
            &format_args!("{:.3}", pair.speed),
            &Rounded(pair.friction, 3),
            &format_args!("{:.3}", pair.error),
            &offset,
            &Rounded(pair.friction - found.curve.at(pair.speed), 3),
            &pair.visits.len(),
        ]);
    }
    out.table(table);
}

/// Adds both directions, where an offset does not make them one (R6.25).
fn push_branches(out: &mut Document<'_>, branches: &DirectionBranches, unit: &str) {
    let table = Table::of_numbers(["speed\nmm/s"]);
    let mut table = ["forth", "back"]
        .map(|way| format!("{way}\n{unit}"))
        .into_iter()
        .fold(table, Table::right);
    for point in &branches.points {
        table.row(&[
            &format_args!("{:.3}", point.speed),
            &Rounded(point.forth, 3),
            &Rounded(point.back, 3),
        ]);
    }
    let _ = write!(
        out,
        "\nfriction depends on the direction: the common part of both changes by {} ± {} {unit} from the slowest to \
         the fastest speed\n\n",
        Rounded(branches.change, 3),
        Rounded(branches.error, 3),
    );
    out.table(table);
    out.push_str(
        "\nNeither a value list nor `getriebe[i].torque_offset` (P-AXIS-00324) can hold that: the list has one output \
         for both directions, and the offset does not change with the speed. The list below is the compromise, \
         their mean.",
    );
    if let Some((speed, cost)) = branches.cost() {
        let [forth, back] = if cost > 0.0 {
            ["little", "much"]
        } else {
            ["much", "little"]
        };
        let _ = write!(
            out,
            " It costs most at {speed:.3} mm/s: {} {unit} too {forth} forth, as many too {back} back.",
            Rounded(cost.abs(), 3)
        );
    }
    out.push_str("\n");
}

/// Returns the use of an offset, in words.
fn offset_words(found: &Identified) -> &'static str {
    if found.is_offset_small() {
        return "It is too small to be set anywhere.\n";
    }
    if found.offset < 0.0 {
        "It is not part of the list. `getriebe[i].torque_offset` (P-AXIS-00324) is documented from 0 on, so \
         a negative one cannot be set there.\n"
    } else {
        "It is not part of the list; it may belong in `getriebe[i].torque_offset` (P-AXIS-00324).\n"
    }
}

fn push_curve(out: &mut Document<'_>, found: &Identified) {
    match &found.curve {
        FrictionCurve::Fit(fit) => {
            let _ = writeln!(
                out,
                "\ncurve: Fc {:.3}, Fs {:.3}, vs {:.3} mm/s, δ {}, fv {:.5} per mm/s (reduced χ² {:.2})",
                fit.coulomb, fit.breakaway, fit.stribeck, fit.shape, fit.viscous, fit.chi_square
            );
        }
        FrictionCurve::Lines(_) => out.push_str("\ncurve: straight lines through the speeds\n"),
    }
}

#[derive(Serialize)]
struct IdentifyDocument<'a> {
    schema: u32,
    headline: Headline,
    axis: Option<&'a str>,
    points: Vec<PointRecord>,
    /// `None` where both directions differ by more than it.
    offset: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    branches: Vec<BranchRecord>,
    fit: Option<FitRecord>,
    pairs: Vec<PairRecord>,
    unit: &'a str,
    point_error: f64,
    drift: Option<f64>,
    ripple: Option<RippleRecord>,
    segments: Vec<SegmentRecord>,
    remarks: &'a [String],
    diagnostics: Vec<&'a TraceFinding>,
}

/// A point in the form of a value list.
#[derive(Serialize)]
pub(crate) struct PointRecord {
    #[serde(rename = "in")]
    pub(crate) input: f64,
    pub(crate) out: f64,
}

#[derive(Serialize)]
#[allow(non_snake_case)] // the names of the parameters as they are written
struct FitRecord {
    Fc: f64,
    Fs: f64,
    vs: f64,
    delta: f64,
    fv: f64,
    chi_square: f64,
}

#[derive(Serialize)]
struct PairRecord {
    v: f64,
    friction: f64,
    offset: Option<f64>,
    error: f64,
    residual: f64,
}

#[derive(Serialize)]
struct BranchRecord {
    v: f64,
    forth: f64,
    back: f64,
}

#[derive(Serialize)]
struct RippleRecord {
    period_mm: f64,
    amplitude: f64,
}

#[derive(Serialize)]
struct SegmentRecord {
    from_s: f64,
    to_s: f64,
    v: f64,
}

/// Returns the report of an axis, or those of several, as JSON: speeds in µm/s or 0.001°/s, the rest in the unit of the
/// torque.
pub fn render_json(reports: &[IdentifyReport]) -> String {
    json_of_axes(reports.iter().map(record))
}

/// Returns the record of an identification.
pub(crate) fn record(report: &IdentifyReport) -> impl Serialize + '_ {
    const PER_MM: f64 = 1000.0;
    let found = &report.identified;
    let fit = |fit: &Fit| FitRecord {
        Fc: fit.coulomb,
        Fs: fit.breakaway,
        vs: fit.stribeck * PER_MM,
        delta: fit.shape,
        fv: fit.viscous,
        chi_square: fit.chi_square,
    };
    let branches = found.branches();
    let branch = |point: &BranchPoint| BranchRecord {
        v: point.speed * PER_MM,
        forth: point.forth,
        back: point.back,
    };
    IdentifyDocument {
        schema: 1,
        headline: report.headline(),
        axis: report.axis.as_deref(),
        points: found
            .points
            .iter()
            .map(|point| PointRecord {
                input: point.input,
                out: point.output,
            })
            .collect(),
        offset: branches.is_none().then_some(found.offset),
        branches: branches
            .map(|it| it.points)
            .unwrap_or_default()
            .iter()
            .map(branch)
            .collect(),
        fit: found.used_fit().map(fit),
        pairs: found
            .pairs
            .iter()
            .map(|pair| PairRecord {
                v: pair.speed * PER_MM,
                friction: pair.friction,
                offset: pair.offset,
                error: pair.error,
                residual: pair.friction - found.curve.at(pair.speed),
            })
            .collect(),
        unit: report.unit(),
        point_error: found.point_error,
        drift: found.drift.map(|drift| drift.part),
        ripple: found.ripple.map(|ripple| RippleRecord {
            period_mm: ripple.period,
            amplitude: ripple.amplitude,
        }),
        segments: found
            .segments
            .iter()
            .map(|segment| SegmentRecord {
                from_s: segment.from_s,
                to_s: segment.to_s,
                v: segment.velocity * PER_MM,
            })
            .collect(),
        remarks: &report.recording.remarks,
        diagnostics: report.findings().collect(),
    }
}

#[derive(Serialize)]
struct AxesDocument<T> {
    schema: u32,
    axes: Vec<T>,
}

/// Returns the record of an axis, or a document with those of several.
pub(crate) fn json_of_axes<T: Serialize>(records: impl Iterator<Item = T>) -> String {
    let records: Vec<T> = records.collect();
    match &records[..] {
        [only] => to_json(only),
        _ => to_json(&AxesDocument {
            schema: 1,
            axes: records,
        }),
    }
}
