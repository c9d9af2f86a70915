//! Two versions of a program side by side, `diff`.

use std::fmt::Write as _;

use serde::Serialize;
use unicode_width::UnicodeWidthStr;

use super::contour::{ContourRecord, ContoursReport, push_contours};
use crate::headline::{Headline, Standing};
use crate::strings::{counted, to_pretty};
use crate::visible::visible_line;
use frictcomp::comp::{Kind, State};
use frictcomp_physics::compare::{
    Agreement, ChangedMoves, Obstacle, Reason, Switch, VersionComparison, Which,
};

/// A comparison, and its subjects.
#[derive(Debug)]
pub struct VersionsReport {
    /// The old version, as the user named it.
    pub old: String,
    /// The new version, as the user named it.
    pub new: String,
    /// Remark above the result: no machine is described.
    pub remark: Option<String>,
    /// The result.
    pub comparison: VersionComparison,
    /// The contours, if they are compared.
    pub contours: Option<ContoursReport>,
}

impl VersionsReport {
    /// The verdict: what changes at the end of the program, then whether the versions switch alike (R18.20, R18.22).
    pub fn headline(&self) -> Headline {
        let is_known = self.comparison.agreement() != Agreement::NotComparable;
        let ends = self.comparison.ends().iter().filter(|_| is_known);
        let ends = ends.map(|end| {
            let kind = match end.kind {
                Kind::Frict => String::new(),
                kind => format!(" {kind}"),
            };
            let [old, new] = [end.old, end.new].map(State::as_str);
            format!("{}{kind} is now {new} at the end (before: {old})", end.axis)
        });
        let standing = match self.comparison.agreement() {
            Agreement::Same => Standing::Good,
            Agreement::Different => Standing::Bad,
            Agreement::NotComparable => Standing::Open,
        };
        let contours = self.contours.iter();
        let contours = contours.map(|it| format!("contour: {}", it.verdict()));
        let moves = self.comparison.moves().iter().map(|it| {
            let ChangedMoves {
                axis, count, line, ..
            } = it;
            let verb = if *count == 1 { "is" } else { "are" };
            let of_axis = format!("{} of {axis}", counted(*count, "feed move"));
            match it.which {
                Which::New => format!("{of_axis} {verb} now without compensation, from line {line}"),
                Which::Old => format!(
                    "{of_axis} {verb} no longer without compensation, from line {line} of the old version"
                ),
            }
        });
        let parts = ends.chain(moves).chain(self.verdict()).chain(contours);
        let parts: Vec<String> = parts.collect();
        Headline::new(standing, parts.join("; "))
    }

    /// Returns the result of the comparison of the switches, a sentence without its end.
    fn verdict(&self) -> Option<String> {
        match self.comparison.agreement() {
            Agreement::Same => {
                let common = counted(self.comparison.common(), "change");
                Some(format!("no difference: {common} of state in both"))
            }
            Agreement::Different => {
                let switches = self.comparison.differences().next();
                switches.map(|_| "the versions switch differently".to_owned())
            }
            Agreement::NotComparable => {
                Some("the versions cannot be compared as a whole".to_owned())
            }
        }
    }
}

/// The sign of a difference.
pub(crate) fn sign(which: Which) -> char {
    match which {
        Which::Old => '-',
        Which::New => '+',
    }
}

/// Columns of a line number.
const LINE: usize = 6;

/// The blocks that switch in one version only, with the reasons why the versions cannot be compared.
pub fn render_text(report: &VersionsReport) -> String {
    let mut out = String::new();
    if let Some(remark) = &report.remark {
        let _ = writeln!(out, "{}\n", visible_line(remark));
    }
    let _ = writeln!(out, "{}", report.headline());
    let comparison = &report.comparison;
    let differences = folded(comparison);
    if !differences.is_empty() {
        let (old, new) = (visible_line(&report.old), visible_line(&report.new));
        let _ = writeln!(out, "\n--- {old}\n+++ {new}");
    }
    let places = differences.iter().map(|it| it.switch.place().width());
    let width = places.max().unwrap_or_default().max(LINE);
    for difference in differences {
        let switch = difference.switch;
        let (sign, place) = (sign(difference.which), switch.place());
        let place = visible_line(&place);
        let (what, text) = (switch.to_string(), visible_line(switch.first_line()));
        let _ = write!(out, "{sign} {place:>width$}  {what:<28}  {text}");
        let _ = match difference.times {
            1 => writeln!(out),
            times => writeln!(out, "  ({times} times)"),
        };
    }
    for (_, obstacle) in comparison.obstacles() {
        let told = obstacle.to_string();
        let _ = writeln!(out, "not comparable: {}", visible_line(&told));
    }
    if let Some(contours) = &report.contours {
        push_contours(&mut out, contours);
    }
    out
}

/// A difference, and how often the version has it.
struct FoldedDifference<'a> {
    which: Which,
    switch: &'a Switch,
    times: u64,
}

/// Returns the differences, equal ones as one.
fn folded(comparison: &VersionComparison) -> Vec<FoldedDifference<'_>> {
    let mut folded: Vec<FoldedDifference<'_>> = Vec::new();
    for (which, switch) in comparison.differences() {
        let is_same = |it: &&mut FoldedDifference<'_>| it.which == which && it.switch == switch;
        match folded.iter_mut().find(is_same) {
            Some(same) => same.times += 1,
            None => folded.push(FoldedDifference {
                which,
                switch,
                times: 1,
            }),
        }
    }
    folded
}

#[derive(Serialize)]
struct ComparisonDocument<'a> {
    schema: u32,
    old: &'a str,
    new: &'a str,
    remark: Option<&'a str>,
    headline: Headline,
    verdict: &'static str,
    common: usize,
    differences: Vec<DifferenceRecord<'a>>,
    moves: Vec<MovesRecord<'a>>,
    obstacles: Vec<Hindrance<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    contour: Option<ContourRecord<'a>>,
}

#[derive(Serialize)]
struct MovesRecord<'a> {
    version: &'static str,
    axis: &'a str,
    count: u64,
    line: u32,
}

#[derive(Serialize)]
struct DifferenceRecord<'a> {
    version: &'static str,
    file: &'a str,
    line: u32,
    n: Option<i64>,
    text: &'a str,
    axis: &'a str,
    kind: &'static str,
    from: &'static str,
    to: &'static str,
    times: u64,
}

#[derive(Serialize)]
struct Hindrance<'a> {
    version: &'static str,
    reason: &'static str,
    file: &'a str,
    line: Option<u32>,
    code: Option<&'static str>,
    axis: Option<&'a str>,
    kind: Option<&'static str>,
    message: String,
}

impl<'a> DifferenceRecord<'a> {
    fn new(difference: &FoldedDifference<'a>) -> Self {
        let switch = difference.switch;
        Self {
            version: difference.which.as_str(),
            file: &switch.file,
            line: switch.line,
            n: switch.number,
            text: &switch.text,
            axis: &switch.axis,
            kind: switch.kind.as_str(),
            from: switch.from.as_str(),
            to: switch.to.as_str(),
            times: difference.times,
        }
    }
}

impl<'a> Hindrance<'a> {
    fn new((which, obstacle): (Which, &'a Obstacle)) -> Self {
        let (code, subject) = match &obstacle.reason {
            Reason::Stopped { code, .. } => (Some(code.as_str()), None),
            Reason::Unknown { axis, kind } => (None, Some((axis.as_str(), kind.as_str()))),
            _ => (None, None),
        };
        Self {
            version: which.as_str(),
            reason: obstacle.reason.as_str(),
            file: &obstacle.file,
            line: obstacle.line,
            code,
            axis: subject.map(|(axis, _)| axis),
            kind: subject.map(|(_, kind)| kind),
            message: obstacle.to_string(),
        }
    }
}

/// The comparison as a JSON document.
pub fn render_json(report: &VersionsReport) -> String {
    let comparison = &report.comparison;
    let moves = comparison.moves().iter().map(|it| MovesRecord {
        version: it.which.as_str(),
        axis: &it.axis,
        count: it.count,
        line: it.line,
    });
    let document = ComparisonDocument {
        schema: 1,
        old: &report.old,
        new: &report.new,
        remark: report.remark.as_deref(),
        headline: report.headline(),
        verdict: comparison.agreement().as_str(),
        common: comparison.common(),
        differences: folded(comparison)
            .iter()
            .map(DifferenceRecord::new)
            .collect(),
        moves: moves.collect(),
        obstacles: comparison.obstacles().map(Hindrance::new).collect(),
        contour: report.contours.as_ref().map(ContourRecord::new),
    };
    to_pretty(&document) + "\n"
}
