//! The report of a session.
//!
//! It is no document: the source of each file is read once more while the page is written, and bars, messages and states
//! lead to its lines.

use std::fmt::Write as _;
use std::io::{self, Write};

use maud::{Markup, html};

use super::digest::{RunDigest, SummaryDigest};
use super::given::RunInputs;
use super::page::{Page, PagePart};
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, line_id, state_word};
use super::source::{self, Sources};
use super::{assumptions, machine, messages, states};
use crate::assumptions::SessionFacts;
use crate::document::{Headline, Standing};
use crate::wording::{FinalStates, counted, feed_moves_text, last_part};
use frictcomp::comp::Kind;
use frictcomp::diagnostic::Severity;
use frictcomp::timeline::ChangedBy;

const LEFT: PagePart = PagePart::new("left", "What is left");
const STATES: PagePart = PagePart::new("states", "States over the blocks");
const MESSAGES: PagePart = PagePart::new("messages", "Messages");
const SOURCE: PagePart = PagePart::new("source", "Source");
const MACHINE: PagePart = PagePart::new("machine", "Machine and parameters");
const CURVES: PagePart = PagePart::new("curves", "Value lists");
const READING: PagePart = PagePart::new("reading", "Assumptions");

/// Writes the report of a session as one page. The sources are read once more, line by line.
///
/// # Errors
/// The errors of `out`.
pub fn render_run(
    digest: &RunDigest,
    given: &RunInputs<'_>,
    sources: &mut dyn Sources,
    out: &mut dyn Write,
) -> io::Result<()> {
    let parts = [LEFT, STATES, MESSAGES, SOURCE, MACHINE, CURVES, READING];
    let mut page = Page::open(out, &title(digest), &lead(digest), &parts)?;
    page.part(LEFT, &left(digest))?;
    page.long_part(STATES, |page| states::render(page, digest))?;
    page.part(MESSAGES, &messages::render(digest))?;
    page.long_part(SOURCE, |page| source::render(page, digest, sources))?;
    page.part(MACHINE, &machine::render(digest, given))?;
    page.part(CURVES, &machine::render_curves(digest))?;
    page.part(
        READING,
        &assumptions::render(&met(digest), &digest.readings),
    )?;
    page.close()
}

/// Returns the facts of the session that decide its assumptions.
fn met(digest: &RunDigest) -> SessionFacts {
    let codes = digest.messages.iter().map(|it| it.diagnostic.code);
    let passed_over = digest
        .summary
        .iter()
        .flat_map(|it| it.opaque.values())
        .sum();
    SessionFacts {
        reported: codes.collect(),
        axis_set: digest.axis_set,
        passed_over,
        ended: digest.ended(),
    }
}

/// Number of programs that are named; further ones are counted.
const NAMED: usize = 3;

fn title(digest: &RunDigest) -> String {
    let mut names: Vec<&str> = Vec::new();
    for program in &digest.programs {
        let name = digest.files[program.file].name.as_str();
        names.push(last_part(name));
    }
    let total = digest.programs.len();
    names.truncate(NAMED);
    let mut title = format!("Friction compensation: {}", names.join(", "));
    if total > NAMED {
        let _ = write!(title, " and {} more", total - NAMED);
    }
    title
}

/// Returns the verdict, after the remark that no machine is described (R1.37).
fn lead(digest: &RunDigest) -> Headline {
    let Some(summary) = &digest.summary else {
        return Headline::new(Standing::Open, NOT_ENDED);
    };
    let count = |severity| summary.counts.get(&severity).copied().unwrap_or_default();
    let axes = summary.axes.iter();
    let states = FinalStates {
        axes: axes
            .map(|axis| (digest.axis_name(axis.axis), axis))
            .collect(),
        assumed: &summary.assumed,
        errors: count(Severity::Error),
        warnings: count(Severity::Warning),
        by: digest.ended(),
        assumption: digest.assumption.clone(),
        is_described: digest.remark.is_none(),
    };
    let found = states.headline();
    let found = found.unwrap_or_else(|| Headline::new(Standing::Open, counts(digest)));
    match &digest.remark {
        Some(remark) => found.after(remark),
        None => found,
    }
}

fn counts(digest: &RunDigest) -> String {
    let Some(summary) = &digest.summary else {
        return NOT_ENDED.to_owned();
    };
    let count = |severity| summary.counts.get(&severity).copied().unwrap_or_default();
    format!(
        "{}, {}, {}, {}",
        counted(u64::from(summary.programs), "program"),
        counted(summary.blocks, "executed block"),
        counted(count(Severity::Error), "error"),
        counted(count(Severity::Warning), "warning"),
    )
}

const NOT_ENDED: &str = "the session did not run to its end";

fn left(digest: &RunDigest) -> Markup {
    let Some(summary) = &digest.summary else {
        return html! {};
    };
    let table = HtmlTable {
        caption: Caption::Heard(LEFT.title),
        columns: &[
            ColumnHeading::Text("axis"),
            ColumnHeading::Text("at start"),
            ColumnHeading::Text("at end"),
            ColumnHeading::Text("changed by"),
        ],
    };
    let rows = summary.axes.iter().map(|axis| {
        let relation = |state| digest.relation(axis.axis, Kind::Frict, state);
        let state = |state| state_word(state, relation(state));
        let changed = changed_by(digest, &axis.changed_by, axis.changes);
        let ways = summary.ways.iter().find(|(at, _)| *at == axis.axis);
        let end = html! {
            (state(axis.end))
            @if let Some((_, ways)) = ways { ": " (digest.ways.text(*ways)) }
        };
        let cells = [state(axis.start), end, changed];
        HtmlRow::new(digest.axis_name(axis.axis), cells)
    });
    html! {
        p {
            "Friction compensation (FRICT) by axis, after the last program. The start-up state is the one \
             after a start of the control; \u{25b2} marks what is away from it \
             and remains so."
        }
        (table.render(rows))
        p { (counts(digest)) "." }
        (uncompensated(digest, summary))
        @if !summary.opaque.is_empty() {
            p {
                "Passed over: "
                @for (at, (word, count)) in summary.opaque.iter().enumerate() {
                    @if at > 0 { ", " }
                    code { (word) } "\u{a0}\u{d7}" (count)
                }
            }
        }
    }
}

fn uncompensated(digest: &RunDigest, summary: &SummaryDigest) -> Markup {
    let moves = summary.axes.iter().filter_map(|axis| {
        let of = digest.axes.get(axis.axis.get())?;
        let text = feed_moves_text(&axis.feed_moves, of.axis_type)?;
        Some(format!("{}{text}.", of.name))
    });
    let moves: Vec<String> = moves.collect();
    html! {
        @if !moves.is_empty() {
            div.to-do { ul { @for text in &moves { li { (text) } } } }
        }
    }
}

/// The blocks that a summary names in a cell.
const NAMED_BLOCKS: usize = 8;

fn changed_by(digest: &RunDigest, blocks: &[ChangedBy], total: u64) -> Markup {
    let mut named: Vec<&ChangedBy> = Vec::new();
    for block in blocks {
        // A block of a loop is named once.
        let same = |known: &&ChangedBy| known.line == block.line && known.file == block.file;
        if named.len() < NAMED_BLOCKS && !named.iter().any(same) {
            named.push(block);
        }
    }
    let unnamed = total.saturating_sub(u64::try_from(named.len()).unwrap_or(u64::MAX));
    html! {
        @if blocks.is_empty() {
            "\u{2013}"
        } @else {
            @for (at, block) in named.into_iter().enumerate() {
                @if at > 0 { ", " }
                (changing_block(digest, block))
            }
            @if unnamed > 0 { " and " (unnamed) " more" }
        }
    }
}

/// Returns the name of a block, as a link if the page shows its line.
fn changing_block(digest: &RunDigest, block: &ChangedBy) -> Markup {
    let name = match block.number {
        Some(number) => format!("N{number} ({}:{})", block.file, block.line),
        None => format!("{}:{}", block.file, block.line),
    };
    let file = digest.files.iter().position(|file| file.name == block.file);
    let shown = file.filter(|&file| digest.files[file].events.contains_key(&block.line));
    html! {
        @match shown {
            Some(file) => a href={ "#" (line_id(file, block.line)) } { (name) },
            None => (name),
        }
    }
}
