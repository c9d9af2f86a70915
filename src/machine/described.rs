//! Recognition of a file that is given in place of a list.

use crate::lists::{Entries, ListKind};
use crate::text::lines_of;

/// Returns the kind of a file with its article: `a value list`, `a program`.
pub(super) fn describe(entries: &Entries) -> &'static str {
    if let Some(kind) = ListKind::detect(entries) {
        return kind.noun();
    }
    let text = entries.source().text();
    let first = lines_of(text)
        .map(str::trim)
        .find(|line| !line.is_empty() && !line.starts_with('#'));
    let Some(first) = first else {
        return "an empty file";
    };
    let tables = ["[machine", "[[axis", "[variables", "[lint", "[check"];
    if let Some(what) = entries.unread_kind() {
        what
    } else if first.starts_with('<') {
        "an XML file"
    } else if tables.iter().any(|table| first.starts_with(table)) {
        "a `frictcomp.toml`"
    } else if is_block(first) {
        "a program"
    } else if entries.entries.is_empty() {
        "no list of the control"
    } else {
        "a list of a kind that is not known"
    }
}

/// Whether a list contains nothing before its `Ende` except comments, like a template.
pub(super) fn has_nothing(entries: &Entries) -> bool {
    let is_plain = entries.diagnostics.is_empty() && entries.entries.is_empty();
    is_plain && !entries.source().text().trim().is_empty()
}

/// Whether a line begins like an NC program: with a name, a comment or a letter with its number.
fn is_block(line: &str) -> bool {
    let word = line.split([' ', '\t', '[']).next().unwrap_or_default();
    let mut letters = word.chars();
    let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    match letters.next() {
        Some('%' | ';' | '(' | '$' | '/') => true,
        Some(first) => first.is_ascii_alphabetic() && letters.all(number),
        None => false,
    }
}
