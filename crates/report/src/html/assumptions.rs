//! What the documents leave open and how this run read it.

use maud::{Markup, html};

use super::parts::{Caption, Column, Row, Table, with_code};
use crate::assumptions::{Assumption, CHAPTERS, Met};

const COLUMNS: [Column<'_>; 4] = [
    Column::Text("rule"),
    Column::Text("assumption"),
    Column::Text("what it changes"),
    Column::Text("how it shows"),
];

/// The assumptions that this run made, and folded all others.
pub(super) fn render(met: &Met) -> Markup {
    let made = |assumption: &&Assumption| assumption.is_met(met);
    let all = CHAPTERS.iter().flat_map(|chapter| chapter.assumptions);
    html! {
        p {
            "The documents of the control leave things open. This run depends on or met these \
             assumptions:"
        }
        (table("Assumptions of this run", all.filter(made)))
        details {
            summary { "All other assumptions that can change a result" }
            "\n"
            @for chapter in CHAPTERS {
                (table(chapter.title, chapter.assumptions.iter().filter(|it| !made(it))))
            }
        }
    }
}

fn table(caption: &str, assumptions: impl Iterator<Item = &'static Assumption>) -> Markup {
    let table = Table {
        caption: Caption::Shown(caption),
        columns: &COLUMNS,
    };
    table.render(assumptions.map(|it| {
        let texts = [it.sentence, it.changes, it.shows];
        Row::new(it.rule, texts.map(with_code))
    }))
}
