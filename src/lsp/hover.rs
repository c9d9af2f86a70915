//! What is said about the block under the pointer (R12.3).

use std::fmt::Write as _;

use gen_lsp_types::{Hover, HoverParams, MarkupContent, MarkupKind};

use super::documents::Kind;
use super::states::{Pass, StateBook};
use super::view::View;
use crate::comp::State;

/// What is said about the place under the pointer.
pub(super) fn hover(view: &View, params: &HoverParams) -> Option<Hover> {
    let at = &params.text_document_position_params;
    let document = view.document(&at.text_document.uri)?;
    if document.kind != Kind::Program {
        return None;
    }
    let line = View::block_at(document, at.position);
    let mut text = String::new();
    for (main, run, name) in view.runs(document) {
        let passes = run.states.passes(&name, line);
        if passes.is_empty() {
            continue;
        }
        if main.uri != document.uri {
            let caller = main.path.display();
            let _ = writeln!(text, "\nCalled from `{caller}`:\n");
        }
        text += &table(&run.states, &passes);
    }
    (!text.is_empty()).then(|| Hover {
        contents: MarkupContent {
            kind: MarkupKind::Markdown,
            value: text,
        }
        .into(),
        range: None,
    })
}

/// The states of each axis before and after a block, in all passes.
fn table(states: &StateBook, passes: &[Pass<'_>]) -> String {
    let total: u64 = passes.iter().map(|pass| u64::from(pass.times)).sum();
    let mut text = String::from("| axis | before | after |\n|---|---|---|\n");
    for (at, axis) in states.axes().iter().enumerate() {
        let before = of_all(passes, |pass| pass.before[at]);
        let after = of_all(passes, |pass| pass.after[at]);
        if after.is_empty() {
            continue;
        }
        let (before, after) = (words(&before, total), words(&after, total));
        let _ = writeln!(text, "| {axis} | {before} | {after} |");
    }
    if total > 1 {
        let _ = writeln!(text, "\nexecuted {total} times");
    }
    text
}

/// Each state with how often it occurs, the first one first.
fn of_all<'a>(
    passes: &[Pass<'a>],
    state: impl Fn(&Pass<'a>) -> Option<State>,
) -> Vec<(State, u64)> {
    let mut found: Vec<(State, u64)> = Vec::new();
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

fn words(states: &[(State, u64)], total: u64) -> String {
    let words = states.iter().map(|(state, times)| {
        if *times == total {
            state.to_string()
        } else {
            format!("{state} ({times} of {total})")
        }
    });
    words.collect::<Vec<_>>().join(", ")
}
