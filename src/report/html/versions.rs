//! Two versions of a program side by side.

use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, Part};
use super::parts::{Caption, Column, Row, Table, with_code};
use crate::report::versions::{VersionsReport, sign};
use crate::versions::{Agreement, Paired, Which};

const RESULT: Part = Part::new("result", "Result");
const CHANGES: Part = Part::new("changes", "Changes of state in both versions");

/// Changes of state that a page shows at most (R9.52).
const MAX_CHANGES: usize = 4000;

/// Writes a comparison as one page.
///
/// # Errors
/// Those of `out`.
pub fn render_versions(report: &VersionsReport, out: &mut dyn Write) -> io::Result<()> {
    let title = format!("{} and {}", report.old, report.new);
    let mut page = Page::open(out, &title, &lead(report), &[RESULT, CHANGES])?;
    page.part(RESULT, &result(report))?;
    page.part(CHANGES, &changes(report))?;
    page.close()
}

fn lead(report: &VersionsReport) -> String {
    let verdict = report.verdict();
    let (first, rest) = verdict.split_at(1);
    format!("{}{rest}.", first.to_ascii_uppercase())
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

/// A table of all changes, those of one version marked by their sign.
fn changes(report: &VersionsReport) -> Markup {
    let table = Table {
        caption: Caption::Heard("Changes of state"),
        columns: &[
            Column::Text("version"),
            Column::Number("old line"),
            Column::Number("new line"),
            Column::Text("change"),
            Column::Text("block"),
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

fn row(pair: &Paired) -> Row {
    let (heading, lines, switch) = match pair {
        Paired::Both { old, new } => ("both".to_owned(), [Some(old.line), Some(new.line)], new),
        Paired::One(which, switch) => {
            let line = |of| (of == *which).then_some(switch.line);
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
    Row::new(&heading, cells)
}
