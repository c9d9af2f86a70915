//! Two versions of a program side by side, `diff`.

use serde::Serialize;
use unicode_width::UnicodeWidthStr;

use super::contour::{ContourRecord, ContoursReport, push_contours};
use crate::document::{Document, Headline, Standing, Table};
use crate::wording::{counted, to_json, visible_line};
use frictcomp::comp::{Kind, State};
use frictcomp_physics::compare::{
    Agreement, ChangedMoves, Obstacle, PairedSwitch, Reason, Switch, VersionComparison, Which,
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
    /// Returns the verdict: what changes at the end of the program, then whether the versions switch alike (R18.20,
    /// R18.22).
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
        let mut parts: Vec<String> = ends.chain(moves).collect();
        if parts.is_empty() || self.comparison.agreement() != Agreement::Different {
            parts.extend(self.verdict());
        }
        parts.extend(contours);
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

/// Returns the sign of a difference.
fn sign(which: Which) -> char {
    match which {
        Which::Old => '-',
        Which::New => '+',
    }
}

/// Columns of a line number.
const LINE: usize = 6;

/// Changes of state that a table has at most (R9.52).
const MAX_CHANGES: usize = 4000;

/// Returns the blocks that switch in one version only, with the reasons why the versions cannot be compared; then the
/// contours, and all changes of both versions.
pub fn document(report: &VersionsReport) -> Document<'_> {
    let title = format!("{} and {}", report.old, report.new);
    let mut out = Document::new(title, report.headline());
    out.remark(report.remark.as_deref());
    let comparison = &report.comparison;
    push_differences(&mut out, report);
    let obstacles = comparison.obstacles();
    let obstacles = obstacles.map(|(_, obstacle)| obstacle.to_string());
    out.lines(obstacles.map(|it| format!("not comparable: {}", visible_line(&it))));
    if let Some(contours) = &report.contours {
        push_contours(&mut out, contours, &report.new);
    }
    push_changes(&mut out, comparison);
    out
}

fn push_differences(out: &mut Document<'_>, report: &VersionsReport) {
    let differences = folded(&report.comparison);
    if differences.is_empty() {
        return;
    }
    let (old, new) = (visible_line(&report.old), visible_line(&report.new));
    out.verbatim(&format!("\n--- {old}\n+++ {new}\n"));
    let places = differences.iter().map(|it| it.switch.place().width());
    let width = places.max().unwrap_or_default().max(LINE);
    let mut table = Table::plain(["line", "change", "block", "times"]);
    for FoldedDifference {
        which,
        switch,
        times,
    } in differences
    {
        let place = format!("{} {:>width$}", sign(which), visible_line(&switch.place()));
        let text = visible_line(switch.first_line());
        let times = match times {
            1 => String::new(),
            _ => format!("({times} times)"),
        };
        table.row(&[&place, switch, &text, &times]);
    }
    out.table(table);
}

/// Appends the changes of both versions; a sign marks those of one.
fn push_changes(out: &mut Document<'_>, comparison: &VersionComparison) {
    let pairs = comparison.pairs();
    if comparison.common() == 0 {
        return;
    }
    out.detail("Changes of state in both versions");
    let differences = comparison.differences().count();
    out.lines([format!(
        "\n{differences} of {} changes of state are in only one version.\n",
        pairs.len()
    )]);
    let table = Table::default().left("version").right("old line");
    let mut table = table.right("new line").left("change").left("block");
    for pair in pairs.iter().take(MAX_CHANGES) {
        let (version, [old, new], switch) = match pair {
            PairedSwitch::Both { old, new } => ("both".to_owned(), [Some(old), Some(new)], new),
            PairedSwitch::One(which, switch) => {
                let of = |it| (it == *which).then_some(switch);
                let version = format!("{} {} only", sign(*which), which.as_str());
                (version, [of(Which::Old), of(Which::New)], switch)
            }
        };
        let [old, new] = [old, new].map(|it| it.map_or(String::new(), Switch::place));
        let text = visible_line(switch.first_line());
        table.row(&[&version, &old, &new, switch, &text]);
    }
    out.table(table);
    let more = pairs.len().saturating_sub(MAX_CHANGES);
    if more > 0 {
        out.lines([format!("… {more} more changes")]);
    }
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

/// Returns the comparison as a JSON document.
pub fn render_json(report: &VersionsReport) -> String {
    to_json(&record(report))
}

/// Returns the comparisons of the programs that changed since a revision as one JSON document.
pub fn render_json_since(reports: &[VersionsReport], revision: &str) -> String {
    #[derive(Serialize)]
    struct ComparisonsDocument<'a> {
        schema: u32,
        revision: &'a str,
        programs: Vec<ComparisonDocument<'a>>,
    }
    to_json(&ComparisonsDocument {
        schema: 1,
        revision,
        programs: reports.iter().map(record).collect(),
    })
}

fn record(report: &VersionsReport) -> ComparisonDocument<'_> {
    let comparison = &report.comparison;
    let moves = comparison.moves().iter().map(|it| MovesRecord {
        version: it.which.as_str(),
        axis: &it.axis,
        count: it.count,
        line: it.line,
    });
    ComparisonDocument {
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
    }
}
