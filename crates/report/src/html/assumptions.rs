//! The points that the documents leave open, and their readings in this run.

use maud::{Markup, html};

use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, with_code};
use crate::assumptions::{Assumption, SessionFacts, chapters};
use frictcomp::comp::CncBuild;
use frictcomp::readings::{Basis, Question, Readings};

const COLUMNS: [ColumnHeading<'_>; 4] = [
    ColumnHeading::Text("rule"),
    ColumnHeading::Text("assumption"),
    ColumnHeading::Text("what it changes"),
    ColumnHeading::Text("how it shows"),
];

/// Returns the assumptions of this run, and all others in a fold.
pub(super) fn render(met: &SessionFacts, readings: &(Readings, Option<CncBuild>)) -> Markup {
    let made = |assumption: &&Assumption| assumption.is_met(met);
    let all = chapters().iter().flat_map(|chapter| &chapter.assumptions);
    html! {
        p {
            "The documents of the control leave things open. This run depends on or met these \
             assumptions. Each is assumed, unless it says that a control confirmed it:"
        }
        (table("Assumptions of this run", all.filter(made), readings))
        details {
            summary { "All other assumptions that can change a result" }
            "\n"
            @for chapter in chapters() {
                (table(&chapter.title, chapter.assumptions.iter().filter(|it| !made(it)), readings))
            }
        }
    }
}

/// Returns the setting of an assumption in the configuration: the selected reading, and the build
/// on which a control confirmed it (R15.3).
fn said_of(rule: &str, (readings, build): &(Readings, Option<CncBuild>)) -> String {
    let Some(question) = Question::of_rule(rule) else {
        return String::new();
    };
    let name = readings.name(question);
    match readings.basis(question, *build) {
        Basis::Assumed => String::new(),
        Basis::Selected => {
            format!(" (read as `{name}` by the configuration, not confirmed on this build)")
        }
        Basis::Confirmed(it) => format!(" (`{name}`, confirmed on {}, {})", it.build, it.date),
    }
}

fn table(
    caption: &str,
    assumptions: impl Iterator<Item = &'static Assumption>,
    readings: &(Readings, Option<CncBuild>),
) -> Markup {
    let table = HtmlTable {
        caption: Caption::Shown(caption),
        columns: &COLUMNS,
    };
    table.render(assumptions.map(|it| {
        let sentence = it.sentence.clone() + &said_of(&it.rule, readings);
        HtmlRow::new(
            &it.rule,
            [&*sentence, &it.changes, &it.shows].map(with_code),
        )
    }))
}
