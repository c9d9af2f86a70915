//! The hover on a block (R12.3).

use std::fmt::Write as _;

use gen_lsp_types::{Hover, HoverParams, MarkupContent, MarkupKind, Position};

use super::completion::{about, toml_header};
use super::documents::{Kind, OpenDocument};
use super::markdown::{code, plain};
use super::moving::{AxisMoves, moves};
use super::parameters::{page_of, page_of_toml};
use super::states::{Pass, StateBook};
use super::view::RequestView;
use frictcomp::comp::{CompCommand, Selection};
use frictcomp::syntax::ast::Item;
use frictcomp::syntax::parse_block;
use frictcomp::text::shown_path;

/// Returns the hover at a place.
pub(super) fn hover(view: &RequestView, params: &HoverParams) -> Option<Hover> {
    let at = &params.text_document_position_params;
    let document = view.document(&at.text_document.uri)?;
    let text = match document.kind {
        Kind::Program => program(view, document, at.position),
        Kind::List => page_of(document.line(at.position.line)).map(|page| page.text),
        Kind::Configuration => {
            let line = document.line(at.position.line);
            let offset = view.client.encoding.offset(line, at.position.character);
            let header = toml_header(document, at.position.line);
            page_of_toml(line, offset, header).map(|page| page.text)
        }
        Kind::Other => None,
    };
    Some(Hover {
        contents: MarkupContent {
            kind: MarkupKind::Markdown,
            value: text?,
        }
        .into(),
        range: None,
    })
}

/// Returns the states at a block, its COMP commands and its motion.
fn program(view: &RequestView, document: &OpenDocument, position: Position) -> Option<String> {
    let line = RequestView::block_at(document, position);
    let mut text = String::new();
    for (main, run, name) in view.runs(document) {
        let passes = run.states.passes(&name, line);
        if passes.is_empty() {
            continue;
        }
        if main.uri != document.uri {
            let caller = code(&shown_path(&main.path));
            let _ = writeln!(text, "\nCalled from {caller}:\n");
        }
        let rows = rows(&run.states, &passes, &name);
        text += &table(&rows, &passes);
        if main.uri == document.uri {
            for moves in moves(view, document, line) {
                let row = rows.iter().find(|row| row.axis == moves.axis);
                let _ = writeln!(text, "\n{}", moving(&moves, row));
            }
        }
    }
    let shown = document.line(position.line);
    let offset = view.client.encoding.offset(shown, position.character);
    if let Some(command) = command_at(shown, offset) {
        let _ = writeln!(text, "\n---\n{}", meaning(&command));
    }
    (!text.is_empty()).then_some(text)
}

/// Returns the COMP command around an offset of a line.
fn command_at(line: &str, offset: usize) -> Option<CompCommand> {
    let commands = parse_block(line)
        .items
        .into_iter()
        .filter_map(|item| match item {
            Item::Comp(command) => Some(command),
            _ => None,
        });
    let mut around = commands.filter(|command| {
        let place = command.span.range();
        (place.start..=place.end).contains(&offset)
    });
    around.next()
}

/// Returns the documented effect of a COMP command.
fn meaning(command: &CompCommand) -> String {
    let axis = plain(&command.axis);
    let (verb, kinds) = match command.selection {
        Selection::On(kinds) => ("selects", kinds),
        Selection::Off(kinds) => ("deselects", kinds),
        _ => {
            let whole = code(&format!("{}[COMP OFF_ALL]", command.axis));
            return format!(
                "{whole} deselects every compensation of axis {axis}, until a program selects it again or the control restarts; M30 does not."
            );
        }
    };
    let mut text = format!(
        "The command {verb} compensations of axis {axis}, until a program switches them again or the control restarts; M30 does not.\n"
    );
    for kind in kinds.iter() {
        let _ = writeln!(text, "\n`{kind}`: {}", about(kind));
    }
    text
}

/// Returns the motion of an axis in the block, in the state that its row shows.
fn moving(moves: &AxisMoves, row: Option<&HoverRow<'_>>) -> String {
    let AxisMoves {
        axis,
        times,
        reversals,
        is_unsure,
    } = moves;
    let state = row.map(|row| format!(" with friction compensation {}", row.after));
    let reversal = match (*reversals, is_unsure) {
        (0, false) => "does not reverse".to_owned(),
        (0, true) => "whether it reverses is not known".to_owned(),
        (1, _) if *times == 1 => "reverses".to_owned(),
        (count, _) => format!("reverses {count} times"),
    };
    format!(
        "{} moves{}; {reversal}",
        plain(axis),
        state.unwrap_or_default()
    )
}

/// Friction compensation of an axis in a block, in words.
struct HoverRow<'a> {
    axis: &'a str,
    before: String,
    after: String,
}

/// Returns the states of each axis before and after a block, in all passes.
fn rows<'a>(states: &'a StateBook, passes: &[Pass<'_>], file: &str) -> Vec<HoverRow<'a>> {
    let total = passes.iter().map(|pass| u64::from(pass.times)).sum();
    let axes = states.axes().iter().enumerate();
    let rows = axes.map(|(at, axis)| HoverRow {
        axis,
        before: words(&of_all(passes, |pass| pass.before.told(at, file)), total),
        after: words(&of_all(passes, |pass| pass.after.told(at, file)), total),
    });
    rows.filter(|row| !row.after.is_empty()).collect()
}

fn table(rows: &[HoverRow<'_>], passes: &[Pass<'_>]) -> String {
    let mut text = String::from("| axis | before | after |\n|---|---|---|\n");
    for HoverRow {
        axis,
        before,
        after,
    } in rows
    {
        let _ = writeln!(text, "| {} | {before} | {after} |", plain(axis));
    }
    let total: u64 = passes.iter().map(|pass| u64::from(pass.times)).sum();
    if total > 1 {
        let _ = writeln!(text, "\nexecuted {total} times");
    }
    text
}

/// Returns each state with its number of passes, the first one first.
fn of_all<'a>(
    passes: &[Pass<'a>],
    state: impl Fn(&Pass<'a>) -> Option<String>,
) -> Vec<(String, u64)> {
    let mut found: Vec<(String, u64)> = Vec::new();
    for pass in passes {
        let Some(state) = state(pass) else { continue };
        let times = u64::from(pass.times);
        match found.iter_mut().find(|(known, _)| *known == state) {
            Some((_, count)) => *count += times,
            None => found.push((state, times)),
        }
    }
    found
}

fn words(states: &[(String, u64)], total: u64) -> String {
    let words = states.iter().map(|(state, times)| {
        let state = plain(state);
        if *times == total {
            state
        } else {
            format!("{state} ({times} of {total})")
        }
    });
    words.collect::<Vec<_>>().join(", ")
}
