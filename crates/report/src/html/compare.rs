//! Two versions of a program side by side.

use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, PagePart};
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, with_code};
use crate::compare::{ContoursReport, VersionsReport, sign};
use crate::contour::places::ProgramBlock;
use frictcomp_physics::compare::{Agreement, BlockChange, PairedSwitch, Which};

const RESULT: PagePart = PagePart::new("result", "Result");
const CHANGES: PagePart = PagePart::new("changes", "Changes of state in both versions");
const CONTOURS: PagePart = PagePart::new("contours", "Where the new version deviates more");

/// Changes of state that a page shows at most (R9.52).
const MAX_CHANGES: usize = 4000;

/// Writes a comparison as one page.
///
/// # Errors
/// Those of `out`.
pub fn render_versions(report: &VersionsReport, out: &mut dyn Write) -> io::Result<()> {
    let title = format!("{} and {}", report.old, report.new);
    let contours = report.contours.as_ref();
    let mut parts = vec![RESULT, CHANGES];
    parts.extend(contours.map(|_| CONTOURS));
    let mut page = Page::open(out, &title, &report.headline(), &parts)?;
    page.part(RESULT, &result(report))?;
    page.part(CHANGES, &changes(report))?;
    if let Some(contours) = contours {
        page.part(CONTOURS, &contours_part(contours))?;
    }
    page.close()
}

/// The figures of both contours, and the blocks that deviate more.
fn contours_part(report: &ContoursReport) -> Markup {
    let comparison = &report.comparison;
    let figures = [Which::Old, Which::New].map(|which| {
        let deviations = comparison.deviations(which);
        let at = deviations
            .max_at()
            .map(|at| ProgramBlock::from(&**at).words());
        let cells = [
            html! { (format!("{:.2}", deviations.max_um())) },
            html! { (at.as_deref().unwrap_or("\u{2013}")) },
            html! { (format!("{:.2}", deviations.rms_um())) },
        ];
        HtmlRow::new(which.as_str(), cells)
    });
    let table = HtmlTable {
        caption: Caption::Shown("While cutting, in \u{b5}m"),
        columns: &[
            ColumnHeading::Text("version"),
            ColumnHeading::Number("largest deviation"),
            ColumnHeading::Text("at"),
            ColumnHeading::Number("root mean square"),
        ],
    };
    let changes = HtmlTable {
        caption: Caption::Shown("Blocks that deviate more, in \u{b5}m"),
        columns: &[
            ColumnHeading::Text("line"),
            ColumnHeading::Number("old"),
            ColumnHeading::Number("new"),
            ColumnHeading::Number("more"),
            ColumnHeading::Text("at"),
            ColumnHeading::Text("block"),
        ],
    };
    let more = comparison.more();
    let left = more.len().saturating_sub(MAX_CHANGES);
    html! {
        p {
            "Plane " (report.plane.concat()) ", plant " (report.plant) ": " (report.verdict()) "."
        }
        @for (which, obstacle) in comparison.obstacles() {
            p { "Not comparable: the contour of the " (which.as_str()) " version: " (obstacle.to_string()) "." }
        }
        (table.render(figures))
        @if !more.is_empty() {
            (changes.render(more.iter().take(MAX_CHANGES).map(|change| change_row(report, change))))
        }
        @if left > 0 { p { (left) " more blocks are left out." } }
    }
}

fn change_row(report: &ContoursReport, change: &BlockChange) -> HtmlRow {
    let old = change.old.map(|(_, um)| format!("{um:.2}"));
    let cells = [
        html! { (old.as_deref().unwrap_or("\u{2013}")) },
        html! { (format!("{:.2}", change.new.deviation_um)) },
        html! { (format!("{:.2}", change.more_um())) },
        html! { (report.place(change)) },
        html! { code { (change.block.text) } },
    ];
    HtmlRow::new(
        &format!("{}:{}", change.block.file, change.block.line),
        cells,
    )
}

fn result(report: &VersionsReport) -> Markup {
    let comparison = &report.comparison;
    let differences = comparison.differences().count();
    html! {
        @if let Some(remark) = &report.remark { p { (with_code(remark)) } }
        p {
            (differences) " of " (comparison.pairs().len())
            " changes of state are in only one version."
        }
        @if comparison.agreement() == Agreement::NotComparable {
            ul {
                @for (which, obstacle) in comparison.obstacles() {
                    li { (which.as_str()) " version: " (with_code(&obstacle.to_string())) }
                }
            }
        }
    }
}

/// A table of all changes; a sign marks those of one version.
fn changes(report: &VersionsReport) -> Markup {
    let table = HtmlTable {
        caption: Caption::Heard("Changes of state"),
        columns: &[
            ColumnHeading::Text("version"),
            ColumnHeading::Number("old line"),
            ColumnHeading::Number("new line"),
            ColumnHeading::Text("change"),
            ColumnHeading::Text("block"),
        ],
    };
    let pairs = report.comparison.pairs();
    let more = pairs.len().saturating_sub(MAX_CHANGES);
    html! {
        @if pairs.is_empty() {
            p { "Neither version changes a state." }
        } @else {
            (table.render(pairs.iter().take(MAX_CHANGES).map(row)))
        }
        @if more > 0 { p { (more) " more changes are left out." } }
    }
}

fn row(pair: &PairedSwitch) -> HtmlRow {
    let (heading, lines, switch) = match pair {
        PairedSwitch::Both { old, new } => (
            "both".to_owned(),
            [Some(old.place()), Some(new.place())],
            new,
        ),
        PairedSwitch::One(which, switch) => {
            let line = |of| (of == *which).then(|| switch.place());
            let heading = format!("{} {} only", sign(*which), which.as_str());
            (heading, [line(Which::Old), line(Which::New)], switch)
        }
    };
    let [old, new] = lines.map(|line| html! { @if let Some(line) = line { (line) } });
    let cells = [
        old,
        new,
        html! { (switch.to_string()) },
        html! { code { (switch.first_line()) } },
    ];
    HtmlRow::new(&heading, cells)
}
