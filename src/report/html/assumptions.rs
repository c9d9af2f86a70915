//! What the documents leave open and how this run read it.

use std::fmt::Write as _;

use super::page::Page;
use crate::report::assumptions::{Assumption, CHAPTERS, Met};
use crate::report::markup::{escaped, push_escaped};

const COLUMNS: [&str; 4] = ["rule", "assumption", "what it changes", "how it shows"];

/// Writes the assumptions that this run made, and folded all others.
pub(super) fn render(page: &mut Page<'_>, met: &Met) {
    page.paragraph(
        "The documents of the control leave things open. This run depends on or met these \
         assumptions:",
    );
    page.open_table("Assumptions of this run", &COLUMNS);
    let all = CHAPTERS.iter().flat_map(|chapter| chapter.assumptions);
    for used in all.filter(|assumption| assumption.is_met(met)) {
        row(page, used);
    }
    page.close_table();
    page.raw("<details><summary>All other assumptions that can change a result</summary>\n");
    for chapter in CHAPTERS {
        page.open_table(chapter.title, &COLUMNS);
        let others = chapter.assumptions.iter();
        for other in others.filter(|assumption| !assumption.is_met(met)) {
            row(page, other);
        }
        page.close_table();
    }
    page.raw("</details>\n");
}

fn row(page: &mut Page<'_>, assumption: &Assumption) {
    let texts = [assumption.sentence, assumption.changes, assumption.shows];
    page.row(assumption.rule, &texts.map(with_code));
}

/// A text whose words in backquotes become code.
pub(super) fn with_code(text: &str) -> String {
    let mut out = String::new();
    for (at, piece) in text.split('`').enumerate() {
        if at % 2 == 0 {
            push_escaped(&mut out, piece);
        } else {
            let _ = write!(out, "<code>{}</code>", escaped(piece));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backquotes_become_code() {
        assert_eq!(with_code("a `<b>` c"), "a <code>&lt;b&gt;</code> c");
    }
}
