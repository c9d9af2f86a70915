//! Hints in the text: where a state changes, and what the program leaves (R12.4).

use gen_lsp_types::{InlayHint, InlayHintParams, Position};

use super::analysis::ProgramRun;
use super::documents::{Kind, OpenDocument};
use super::states::Pass;
use super::view::RequestView;
use frictcomp::text::shown_path;

/// Returns the hints in a part of a text.
pub(super) fn inlay_hints(view: &RequestView, params: &InlayHintParams) -> Option<Vec<InlayHint>> {
    let document = view.document(&params.text_document.uri)?;
    if document.kind != Kind::Program || !view.client.settings.inlay_hints {
        return None;
    }
    let analysis = view.analysis(&document.uri)?;
    let run = analysis.run.as_ref()?;
    let lines = params.range.start.line..=params.range.end.line;
    let mut hints = Vec::new();
    let name = shown_path(&document.path);
    let changes = run.states.switching(&name);
    let changes = changes.map(|(line, passes)| (line, changes_of(run, &passes, &name)));
    for (line, words) in run.states.meeting(&name).chain(changes) {
        if !words.is_empty() && lines.contains(&(line - 1)) {
            hints.push(hint(view, document, line, &words));
        }
    }
    if let (Some(left), Some(line)) = (left(run, &name), run.states.last())
        && lines.contains(&(line - 1))
    {
        hints.push(hint(view, document, line, &left));
    }
    Some(hints)
}

/// Returns a hint at the end of the last line of a block.
fn hint(view: &RequestView, document: &OpenDocument, line: u32, label: &str) -> InlayHint {
    let mut last = line.saturating_sub(1);
    while document.line(last).trim_end().ends_with('\\') {
        last += 1;
    }
    let text = document.line(last);
    InlayHint {
        position: Position {
            line: last,
            character: view.client.encoding.column(text, text.len()),
        },
        label: label.to_owned().into(),
        kind: None,
        text_edits: None,
        tooltip: None,
        padding_left: Some(true),
        padding_right: None,
        data: None,
    }
}

/// Returns the changes by a block: `X: active → inactive`. Where they happen in some passes only,
/// `(2 of 5)`.
fn changes_of(run: &ProgramRun, passes: &[Pass<'_>], file: &str) -> String {
    let total: u64 = passes.iter().map(|pass| u64::from(pass.times)).sum();
    let mut words: Vec<(String, u64)> = Vec::new();
    for (at, axis) in run.states.axes().iter().enumerate() {
        for pass in passes {
            let (Some(from), Some(to)) = (pass.before.state(at), pass.after.told(at, file)) else {
                continue;
            };
            if pass.after.state(at) == Some(from) {
                continue;
            }
            let change = format!("{axis}: {from} \u{2192} {to}");
            match words.iter_mut().find(|(known, _)| *known == change) {
                Some((_, times)) => *times += u64::from(pass.times),
                None => words.push((change, u64::from(pass.times))),
            }
        }
    }
    let words = words.into_iter().map(|(change, times)| {
        if times == total {
            change
        } else {
            format!("{change} ({times} of {total})")
        }
    });
    words.collect::<Vec<_>>().join(", ")
}

/// Returns the states of axes at the end that differ from those at the start of the control, with names
/// as seen from a file: `leaves X inactive`. The end of a program that is not checked to its end is not known.
pub(super) fn left(run: &ProgramRun, file: &str) -> Option<String> {
    if run.is_cut {
        return Some("what it leaves is not known: it is not checked to its end".to_owned());
    }
    let away = run.ends.iter().filter(|axis| axis.end != axis.start_up);
    let left = run.states.at_end();
    let away: Vec<String> = away
        .map(|axis| {
            let told = left.told(axis.at, file);
            let end = told.unwrap_or_else(|| axis.end.to_string());
            format!("{} {end}", axis.axis)
        })
        .collect();
    (!away.is_empty()).then(|| format!("leaves {}", away.join(", ")))
}
