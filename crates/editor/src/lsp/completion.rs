//! Completions: words of a COMP command, axes, parameters and keys (R12.6, R12.11).
//!
//! An editor may accept the first completion on Enter. So only words are offered that begin as the typed
//! one and are longer, each with the range that it replaces; only inside a COMP bracket a blank is
//! enough, and on an empty line of a list or a configuration a request (R12.21).

use gen_lsp_types::{
    CompletionItem, CompletionItemKind, CompletionParams, CompletionTriggerKind, Documentation,
    MarkupContent, MarkupKind, Position, Range, TextEdit,
};

use super::documents::{Kind as TextKind, OpenDocument};
use super::parameters::{Page, keys_of, pages_for};
use super::view::RequestView;
use frictcomp::comp::Kind;
use frictcomp::syntax::{PieceKind, code_of, kind_at};

/// Returns the completions at a place.
pub(super) fn completion(
    view: &RequestView,
    params: &CompletionParams,
) -> Option<Vec<CompletionItem>> {
    let at = &params.text_document_position_params;
    let document = view.document(&at.text_document.uri)?;
    let line = document.line(at.position.line);
    let before = &line[..view.client.encoding.offset(line, at.position.character)];
    let trigger = params.context.as_ref().map(|context| context.trigger_kind);
    let is_asked = trigger == Some(CompletionTriggerKind::Invoked);
    let offer = match document.kind {
        // Nothing is offered in comments and strings.
        TextKind::Program if kind_at(line, before.len()) != PieceKind::Code => None,
        TextKind::Program => comp_words(before).or_else(|| axes(view, document, before)),
        TextKind::List | TextKind::Configuration if line.trim().is_empty() && !is_asked => None,
        TextKind::List => list_keys(document, before),
        TextKind::Configuration => toml_keys(document, at.position.line, before),
        TextKind::Other => None,
    };
    Some(offer.map_or_else(Vec::new, |offer| offer.items(at.position)))
}

/// Completions in place of a word that is being typed.
struct Offer<'t> {
    /// The part of the word that is typed so far.
    typed: &'t str,
    /// The words that are possible there, the likeliest first.
    items: Vec<CompletionItem>,
}

impl Offer<'_> {
    /// Returns the items that complete what is typed, each with the range that it replaces.
    fn items(self, cursor: Position) -> Vec<CompletionItem> {
        let Some(length) = u32::try_from(self.typed.len())
            .ok()
            .filter(|_| self.typed.is_ascii())
        else {
            return Vec::new();
        };
        let start = Position {
            line: cursor.line,
            character: cursor.character.saturating_sub(length),
        };
        let range = Range { start, end: cursor };
        let typed = self.typed.len();
        let goes_on = |label: &str| {
            label.len() > typed
                && label
                    .get(..typed)
                    .is_some_and(|begin| begin.eq_ignore_ascii_case(self.typed))
        };
        let items = self.items.into_iter().filter(|item| goes_on(&item.label));
        let items = items.enumerate().map(|(at, item)| CompletionItem {
            text_edit: Some(TextEdit::new(range, item.label.clone()).into()),
            sort_text: Some(format!("{at:04}")),
            filter_text: Some(item.label.clone()),
            ..item
        });
        items.collect()
    }
}

/// Splits off the letters of the word before the cursor.
fn split_word(before: &str) -> (&str, &str) {
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    before.split_at(before.trim_end_matches(is_name).len())
}

/// Returns the words that are possible in an open COMP bracket; `None` if none is open.
fn comp_words(before: &str) -> Option<Offer<'_>> {
    let code = code_of(before);
    let open = code.rfind('[')?;
    let inside = &code[open + 1..];
    if inside.contains(']') {
        return None;
    }
    let (above, typed) = split_word(inside);
    let words: Vec<&str> = above.split_whitespace().collect();
    let is = |at: usize, word: &str| {
        words
            .get(at)
            .is_some_and(|it| it.eq_ignore_ascii_case(word))
    };
    let items = if words.is_empty() {
        // A bracket may hold an index, too: only a letter shows that a command begins.
        if typed.is_empty() || !is_of_axis(&before[..open]) {
            return None;
        }
        vec![keyword("COMP", "switches compensations of the axis")]
    } else if !is(0, "COMP") || !above.ends_with([' ', '\t']) {
        return None;
    } else if words.len() == 1 {
        vec![
            keyword("ON", "selects the compensations that are named after it"),
            keyword("OFF", "deselects the compensations that are named after it"),
            keyword("OFF_ALL", "deselects every compensation of the axis"),
        ]
    } else if is(1, "ON") || is(1, "OFF") {
        let named = |kind: &Kind| {
            words[2..]
                .iter()
                .any(|word| word.eq_ignore_ascii_case(kind.as_str()))
        };
        let kinds = Kind::ALL.into_iter().filter(|kind| !named(kind));
        kinds
            .map(|kind| keyword(kind.as_str(), &about(kind)))
            .collect()
    } else {
        Vec::new()
    };
    let typed = &before[before.len() - typed.len()..];
    Some(Offer { typed, items })
}

/// Returns whether a bracket after this code belongs to a word of the block and does not hold an index.
fn is_of_axis(code: &str) -> bool {
    let (above, name) = split_word(code.trim_end());
    name.contains(|letter: char| letter.is_ascii_alphabetic()) && !above.ends_with(['.', '@', '='])
}

/// Returns the requirements of a kind.
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

/// Returns the axes of the machine whose names complete the typed letters, where a word of a block may begin. A word
/// with a digit is an address with its value: `X1` moves X, even if there is an axis X10.
fn axes<'t>(view: &RequestView, document: &OpenDocument, before: &'t str) -> Option<Offer<'t>> {
    let run = view.analysis(&document.uri)?.run.as_ref()?;
    let (above, typed) = split_word(before);
    let begins_a_word = above.is_empty() || above.ends_with([' ', '\t']);
    let is_plain = !above.contains(['$', '#', '%', '"']) && !calls(above);
    let in_expression = above
        .trim_end()
        .ends_with(['=', '+', '-', '*', '/', '[', ',', '.']);
    let is_letters = typed
        .chars()
        .all(|it| it.is_ascii_alphabetic() || it == '_');
    if typed.is_empty() || !begins_a_word || !is_plain || in_expression || !is_letters {
        return None;
    }
    let axes = run.states.axes().iter();
    if axes.clone().any(|axis| axis.eq_ignore_ascii_case(typed)) {
        return None;
    }
    let items = axes.map(|axis| CompletionItem {
        label: axis.clone(),
        kind: Some(CompletionItemKind::Variable),
        detail: Some("axis".to_owned()),
        ..CompletionItem::default()
    });
    Some(Offer {
        typed,
        items: items.collect(),
    })
}

/// Returns whether the name of a program is expected: after `L` and `LL`.
fn calls(above: &str) -> bool {
    let last = above.split_whitespace().next_back().unwrap_or_default();
    ["L", "LL"].iter().any(|it| last.eq_ignore_ascii_case(it))
}

/// Returns the parameters that a line of a list may give.
fn list_keys<'t>(document: &OpenDocument, before: &'t str) -> Option<Offer<'t>> {
    let typed = before.trim_start();
    if typed.contains([' ', '\t', '(', '#']) {
        return None;
    }
    let items = pages_for(typed, document.text()).into_iter();
    Some(Offer {
        typed,
        items: items.map(documented).collect(),
    })
}

/// Returns the keys of the table of `frictcomp.toml` that a line belongs to.
fn toml_keys<'t>(document: &OpenDocument, line: u32, before: &'t str) -> Option<Offer<'t>> {
    let (above, typed) = split_word(before);
    if !above.trim().is_empty() {
        return None;
    }
    let keys = keys_of(toml_header(document, line)).into_iter();
    let items = keys.map(documented).collect();
    Some(Offer { typed, items })
}

/// Returns the header of the table that a line of a `frictcomp.toml` belongs to; empty above the first one.
pub(super) fn toml_header(document: &OpenDocument, line: u32) -> &str {
    let above = (0..line).rev().map(|line| document.line(line).trim());
    let mut headers = above.filter(|line| line.starts_with('['));
    let header = headers.next().unwrap_or_default();
    header.split('#').next().unwrap_or_default().trim()
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

    fn words(before: &str) -> Option<String> {
        let offer = comp_words(before)?;
        let end = u32::try_from(before.len()).expect("a short line");
        let items = offer.items(Position {
            line: 0,
            character: end,
        });
        let labels: Vec<String> = items.into_iter().map(|item| item.label).collect();
        Some(labels.join(" "))
    }

    #[test]
    fn comments_before_a_bracket_do_not_count() {
        // R12.6
        let is_code = |line: &str, at: usize| kind_at(line, at) == PieceKind::Code;
        assert!(is_code("V.P.A=\"(\" X[", 12) && words("V.P.A=\"(\" X[C").is_some());
        assert!(is_code("X1 (;) Y[", 9) && words("X1 (;) Y[C").is_some());
        assert!(words("X[COMP (all [of] them) ON ").is_some());
        assert!(!is_code("#MSG [\"X[COMP ON\"]", 10));
        assert!(!is_code("(X[COMP ", 8) && !is_code("; X[COMP ", 9) && !is_code("(a (b) X[", 9));
    }

    #[test]
    fn a_bracket_offers_what_may_follow() {
        // R12.6, R12.11
        for (before, offered) in [
            ("N10 X[C", "COMP"),
            ("N10X[co", "COMP"),
            ("N10 X[COMP", ""),
            ("N10 X[comp ", "ON OFF OFF_ALL"),
            ("N10 X[COMP OF", "OFF OFF_ALL"),
            ("N10 X[COMP OFF", "OFF_ALL"),
            ("N10 X[COMP ON", ""),
            (
                "X[COMP ON FRICT LEAD ",
                "BACKLASH CROSS PLANE TEMP CROSSTALK",
            ),
            ("X[COMP ON c", "CROSS CROSSTALK"),
            ("X[COMP OFF_ALL ", ""),
        ] {
            assert_eq!(words(before).as_deref(), Some(offered), "{before}");
        }
        for none in [
            "X[COMP ON FRICT] ",
            "N10 G1 X",
            "N10 X[",
            "N10 X[ ",
            "P1 = V.P.A[",
            "P1 = V.P.A[C",
            "P1 = V.P.A[1 ",
            "P1 = [C",
            "(X[COMP) ",
            "",
        ] {
            assert_eq!(words(none), None, "{none}");
        }
    }
}
