//! The contours of two versions side by side.

use std::fmt::Write as _;

use serde::Serialize;
use serde_json::Value;

use crate::document::{Document, Table};
use crate::results::contour::places::{ProgramBlock, record};
use crate::wording::visible_line;
use frictcomp_physics::compare::{BlockChange, ContourAgreement, ContourComparison, Which};

/// Blocks that are listed, and those of the folded list (R9.52).
const LISTED: usize = 25;
const MAX_CHANGES: usize = 4000;

/// A comparison of contours, and the conditions of the motion.
#[derive(Debug)]
pub struct ContoursReport {
    /// The axes of the plane.
    pub plane: [String; 2],
    /// The plant, as the user named it.
    pub plant: String,
    /// The result.
    pub comparison: ContourComparison,
}

impl ContoursReport {
    /// Returns the result of the comparison, a sentence without its end.
    pub(super) fn verdict(&self) -> String {
        let comparison = &self.comparison;
        let known = match comparison.agreement() {
            ContourAgreement::NotComparable => "not comparable as a whole; in what is known ",
            ContourAgreement::NoMore | ContourAgreement::More => "",
        };
        let less = match comparison.less() {
            0 => String::new(),
            less => format!("; {less} less"),
        };
        let tolerance = comparison.tolerance_um();
        match comparison.more() {
            [] => format!("{known}no block deviates more by more than {tolerance} µm{less}"),
            [worst, ..] => format!(
                "{known}{} more by more than {tolerance} µm, line {} of {} most, by {:.1} µm{less}",
                match comparison.more().len() {
                    1 => "1 block deviates".to_owned(),
                    count => format!("{count} blocks deviate"),
                },
                worst.block.line,
                visible_line(&worst.block.file),
                worst.more_um()
            ),
        }
    }

    /// Returns the blocks that deviate more, at most `most`; those of called programs with their files.
    fn changes(&self, most: usize, program: &str) -> Table {
        let table = Table::of_numbers(["line", "old", "new", "more"]);
        let mut table = table.left("at").left("block");
        for change in self.comparison.more().iter().take(most) {
            let old = change.old.map(|(_, um)| format!("{um:.2}"));
            let (file, line) = (&*change.block.file, change.block.line);
            let line = if file == program {
                line.to_string()
            } else {
                format!("{}:{line}", visible_line(file))
            };
            table.row(&[
                &line,
                &old.as_deref().unwrap_or("-"),
                &format_args!("{:.2}", change.new.deviation_um),
                &format_args!("{:.2}", change.more_um()),
                &self.place(change),
                &visible_line(&change.block.text),
            ]);
        }
        table
    }

    /// Returns the place at which a block deviates more.
    fn place(&self, change: &BlockChange) -> String {
        let axes = self.plane.iter().zip(change.new.place);
        let places: Vec<String> = axes.map(|(axis, at)| format!("{axis}{at:.3}")).collect();
        visible_line(&places.join(" ")).into_owned()
    }
}

/// Adds the figures of both contours, then the blocks that deviate more.
pub(super) fn push_contours(out: &mut Document<'_>, report: &ContoursReport, program: &str) {
    let comparison = &report.comparison;
    let [old, new] = [Which::Old, Which::New].map(|which| comparison.deviations(which));
    let mut table = Table::default()
        .left("while cutting")
        .right("old")
        .right("new");
    for (name, values) in [
        ("largest deviation", [old.max_um(), new.max_um()]),
        ("root mean square", [old.rms_um(), new.rms_um()]),
    ] {
        let [old, new] = values.map(|it| format!("{it:.2}"));
        table.row(&[&name, &old, &new]);
    }
    out.section("Where the new version deviates more");
    let _ = writeln!(
        out,
        "\ncontour in the plane {}{}, plant {}, in µm",
        report.plane[0],
        report.plane[1],
        visible_line(&report.plant),
    );
    out.table(table);
    for (which, deviations) in [(Which::Old, old), (Which::New, new)] {
        if let Some(at) = deviations.max_at() {
            let (version, at) = (which.as_str(), ProgramBlock::from(&**at).words());
            let _ = writeln!(out, "largest deviation of the {version} version at {at}");
        }
    }
    let more = comparison.more();
    let left = more.len().saturating_sub(LISTED);
    if !more.is_empty() {
        out.push_str("\n");
        out.table(report.changes(LISTED, program));
    }
    if left > 0 {
        let _ = writeln!(out, "… {left} more blocks");
    }
    for (which, obstacle) in comparison.obstacles() {
        let _ = writeln!(
            out,
            "not comparable: the contour of the {} version: {obstacle}",
            which.as_str()
        );
    }
    if left > 0 {
        out.folded("All blocks that deviate more");
        out.push_str("\n");
        out.table(report.changes(MAX_CHANGES, program));
    }
}

/// The contours as data: µm and mm.
#[derive(Serialize)]
pub(super) struct ContourRecord<'a> {
    plane: &'a [String; 2],
    plant: &'a str,
    verdict: &'static str,
    tolerance: f64,
    old: FiguresRecord,
    new: FiguresRecord,
    more: Vec<ChangeRecord<'a>>,
    less: usize,
    obstacles: Vec<ContourHindrance>,
}

#[derive(Serialize)]
struct FiguresRecord {
    max: f64,
    max_at: Value,
    rms: f64,
}

#[derive(Serialize)]
struct ChangeRecord<'a> {
    file: &'a str,
    line: u32,
    old_line: Option<u32>,
    n: Option<i64>,
    text: &'a str,
    old: Option<f64>,
    new: f64,
    position: [f64; 2],
}

#[derive(Serialize)]
struct ContourHindrance {
    version: &'static str,
    message: String,
}

impl<'a> ChangeRecord<'a> {
    fn new(change: &'a BlockChange) -> Self {
        let BlockChange { block, old, new } = change;
        Self {
            file: &block.file,
            line: block.line,
            old_line: old.map(|(line, _)| line),
            n: block.number,
            text: &block.text,
            old: old.map(|(_, um)| um),
            new: new.deviation_um,
            position: new.place,
        }
    }
}

impl<'a> ContourRecord<'a> {
    pub(super) fn new(report: &'a ContoursReport) -> Self {
        let comparison = &report.comparison;
        let [old, new] = [Which::Old, Which::New].map(|which| {
            let deviations = comparison.deviations(which);
            FiguresRecord {
                max: deviations.max_um(),
                max_at: record(deviations.max_at().map(|at| &**at)),
                rms: deviations.rms_um(),
            }
        });
        let obstacles = comparison
            .obstacles()
            .map(|(which, obstacle)| ContourHindrance {
                version: which.as_str(),
                message: obstacle.to_string(),
            });
        Self {
            plane: &report.plane,
            plant: &report.plant,
            verdict: comparison.agreement().as_str(),
            tolerance: comparison.tolerance_um(),
            old,
            new,
            more: comparison.more().iter().map(ChangeRecord::new).collect(),
            less: comparison.less(),
            obstacles: obstacles.collect(),
        }
    }
}
