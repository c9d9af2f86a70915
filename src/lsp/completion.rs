//! What may be written next: words of a COMP command, axes, parameters and keys (R12.6).

use gen_lsp_types::{
    CompletionItem, CompletionItemKind, CompletionParams, Documentation, MarkupContent, MarkupKind,
};

use super::documents::{Document, Kind as TextKind};
use super::parameters::{Page, keys_of, pages};
use super::view::View;
use crate::comp::Kind;
use crate::syntax::{PieceKind, code_of, kind_at};

/// What may stand at a place.
pub(super) fn completion(view: &View, params: &CompletionParams) -> Option<Vec<CompletionItem>> {
    let at = &params.text_document_position_params;
    let document = view.document(&at.text_document.uri)?;
    let line = document.line(at.position.line);
    let before = &line[..view.client.encoding.offset(line, at.position.character)];
    Some(match document.kind {
        // Nothing is offered in comments and strings.
        TextKind::Program if kind_at(line, before.len()) != PieceKind::Code => Vec::new(),
        TextKind::Program => match comp_words(before) {
            Some(words) => words,
            None => axes(view, document, before),
        },
        TextKind::List => list_keys(before),
        TextKind::Configuration => toml_keys(document, at.position.line, before),
    })
}

/// The words that may stand in an open COMP bracket; `None` where none is open.
fn comp_words(before: &str) -> Option<Vec<CompletionItem>> {
    let code = code_of(before);
    let open = code.rfind('[')?;
    let inside = &code[open + 1..];
    if inside.contains(']') {
        return None;
    }
    let ends_word = inside.is_empty() || inside.ends_with([' ', '\t']);
    let mut words: Vec<&str> = inside.split_whitespace().collect();
    if !ends_word {
        words.pop();
    }
    let is = |at: usize, word: &str| {
        words
            .get(at)
            .is_some_and(|it| it.eq_ignore_ascii_case(word))
    };
    if words.is_empty() {
        return Some(vec![keyword("COMP", "switches compensations of the axis")]);
    }
    if !is(0, "COMP") {
        return None;
    }
    if words.len() == 1 {
        return Some(vec![
            keyword("ON", "selects the compensations that are named after it"),
            keyword("OFF", "deselects the compensations that are named after it"),
            keyword("OFF_ALL", "deselects every compensation of the axis"),
        ]);
    }
    if !is(1, "ON") && !is(1, "OFF") {
        return Some(Vec::new());
    }
    let named = |kind: &Kind| {
        words[2..]
            .iter()
            .any(|word| word.eq_ignore_ascii_case(kind.as_str()))
    };
    let kinds = Kind::ALL.into_iter().filter(|kind| !named(kind));
    Some(
        kinds
            .map(|kind| keyword(kind.as_str(), &about(kind)))
            .collect(),
    )
}

/// What a kind needs.
pub(super) fn about(kind: Kind) -> String {
    let facts = kind.facts();
    let (parameter, selector, since) = (facts.parameter, facts.selector, facts.since);
    format!("configured by {parameter} (`{selector}`), known from CNC build {since}")
}

fn keyword(word: &str, about: &str) -> CompletionItem {
    CompletionItem {
        label: word.to_owned(),
        kind: Some(CompletionItemKind::Keyword),
        detail: Some(about.to_owned()),
        ..CompletionItem::default()
    }
}

/// The axes of the machine, where a word of a block may begin.
fn axes(view: &View, document: &Document, before: &str) -> Vec<CompletionItem> {
    let run = view.analysis(&document.uri).and_then(|it| it.run.as_ref());
    let Some(run) = run else {
        return Vec::new();
    };
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let typed = before.trim_end_matches(is_name);
    let is_block = !before.trim_start().starts_with(['$', '#', '%']);
    if !is_block || typed.ends_with(['.', '@', '[', '=']) {
        return Vec::new();
    }
    let axes = run.states.axes().iter();
    axes.map(|axis| CompletionItem {
        label: axis.clone(),
        kind: Some(CompletionItemKind::Variable),
        detail: Some("axis".to_owned()),
        ..CompletionItem::default()
    })
    .collect()
}

/// The parameters that a line of a list may give.
fn list_keys(before: &str) -> Vec<CompletionItem> {
    let typed = before.trim_start();
    if typed.contains([' ', '\t', '(', '#']) {
        return Vec::new();
    }
    pages().into_iter().map(documented).collect()
}

/// The keys of the table of `frictcomp.toml` that a line belongs to.
fn toml_keys(document: &Document, line: u32, before: &str) -> Vec<CompletionItem> {
    if before.contains(['=', '#', '[']) {
        return Vec::new();
    }
    let above = (0..line).rev().map(|line| document.line(line).trim());
    let mut headers = above.filter(|line| line.starts_with('['));
    let header = headers.next().unwrap_or_default();
    let header = header.split('#').next().unwrap_or_default().trim();
    keys_of(header).into_iter().map(documented).collect()
}

fn documented(page: Page) -> CompletionItem {
    let documentation = MarkupContent {
        kind: MarkupKind::Markdown,
        value: page.text,
    };
    CompletionItem {
        label: page.key,
        kind: Some(CompletionItemKind::Property),
        documentation: Some(Documentation::MarkupContent(documentation)),
        ..CompletionItem::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(before: &str) -> Option<Vec<String>> {
        let items = comp_words(before)?.into_iter();
        Some(items.map(|item| item.label).collect())
    }

    #[test]
    fn comments_before_a_bracket_do_not_count() {
        // R12.6
        let is_code = |line: &str, at: usize| kind_at(line, at) == PieceKind::Code;
        assert!(is_code("V.P.A=\"(\" X[", 12) && words("V.P.A=\"(\" X[").is_some());
        assert!(is_code("X1 (;) Y[", 9) && words("X1 (;) Y[").is_some());
        assert!(words("X[COMP (all [of] them) ON ").is_some());
        assert!(!is_code("#MSG [\"X[COMP ON\"]", 10));
        assert!(!is_code("(X[COMP ", 8) && !is_code("; X[COMP ", 9) && !is_code("(a (b) X[", 9));
    }

    #[test]
    fn a_bracket_offers_what_may_follow() {
        // R12.6
        let all = |before: &str| words(before).map(|it| it.join(" "));
        assert_eq!(all("N10 X[").as_deref(), Some("COMP"));
        assert_eq!(all("N10 X[CO").as_deref(), Some("COMP"));
        assert_eq!(all("N10 X[comp ").as_deref(), Some("ON OFF OFF_ALL"));
        assert_eq!(all("N10 X[COMP OF").as_deref(), Some("ON OFF OFF_ALL"));
        assert_eq!(
            all("X[COMP ON FRICT LEAD ").as_deref(),
            Some("BACKLASH CROSS PLANE TEMP CROSSTALK")
        );
        assert_eq!(all("X[COMP OFF_ALL ").as_deref(), Some(""));
        for none in [
            "X[COMP ON FRICT] ",
            "N10 G1 X",
            "P1 = V.P.A[1 ",
            "(X[COMP) ",
            "",
        ] {
            assert_eq!(words(none), None, "{none}");
        }
    }
}
