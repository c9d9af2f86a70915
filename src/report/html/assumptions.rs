//! What the documents leave open and how this run read it, from the one list of assumptions.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::page::Page;
use crate::codes::Code;
use crate::machine::AxisSet;
use crate::report::markup::{escaped, push_escaped};

/// The list that the documentation shows.
const LIST: &str = include_str!("../../../docs/assumptions.md");

/// One assumption: rule, assumption, what it changes, how it shows.
struct Assumption {
    heading: &'static str,
    cells: [&'static str; 4],
}

fn assumptions() -> impl Iterator<Item = Assumption> {
    let mut heading = "";
    LIST.lines().filter_map(move |line| {
        if let Some(title) = line.strip_prefix("## ") {
            heading = title;
        }
        let inner = line.strip_prefix("| ")?.strip_suffix(" |")?;
        let mut cells = inner.split(" | ");
        let cells = [cells.next()?, cells.next()?, cells.next()?, cells.next()?];
        (cells[0] != "rule").then_some(Assumption { heading, cells })
    })
}

impl Assumption {
    /// Whether it is made only where no machine is described.
    fn needs_no_configuration(&self) -> bool {
        self.cells[1].starts_with("without a configuration")
    }

    /// Whether one of the codes tells that the assumption was made. The rules that every session
    /// rests on tell it in its first record.
    fn is_used(&self, said: &BTreeSet<Code>) -> bool {
        let shows = self.cells[3];
        let names = shows.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '-');
        let codes = names.filter_map(Code::find);
        let mut codes = codes.chain(ranges(shows));
        codes.any(|code| said.contains(&code)) || shows.starts_with("the session record")
    }
}

/// The codes between two that are named as `FC910 to FC914`.
fn ranges(text: &str) -> impl Iterator<Item = Code> {
    let ends = text.split_once(" to ").and_then(|(before, behind)| {
        let first = Code::find(before.rsplit(' ').next()?)?;
        let last = Code::find(behind.split([' ', ',']).next()?)?;
        Some(first.text()..=last.text())
    });
    let all = Code::ALL.iter().copied();
    all.filter(move |code| {
        let within = ends.as_ref();
        within.is_some_and(|range| range.contains(&code.text()))
    })
}

/// Writes the assumptions that this run made, and folded all others.
pub(super) fn render(page: &mut Page<'_>, said: &BTreeSet<Code>, axes: AxisSet) {
    let made = |it: &Assumption| {
        it.is_used(said) && (axes == AxisSet::AsTheyOccur || !it.needs_no_configuration())
    };
    let columns = ["rule", "assumption", "what it changes", "how it shows"];
    page.paragraph(
        "The documents of the control leave things open. This run depends on or met these \
         assumptions:",
    );
    page.open_table("Assumptions of this run", &columns);
    for used in assumptions().filter(made) {
        row(page, &used);
    }
    page.close_table();
    page.raw("<details><summary>All other assumptions that can change a result</summary>\n");
    let mut heading = "";
    for other in assumptions().filter(|assumption| !made(assumption)) {
        if other.heading != heading {
            if !heading.is_empty() {
                page.close_table();
            }
            heading = other.heading;
            page.open_table(heading, &columns);
        }
        row(page, &other);
    }
    if !heading.is_empty() {
        page.close_table();
    }
    page.raw("</details>\n");
}

fn row(page: &mut Page<'_>, assumption: &Assumption) {
    let cells: Vec<String> = assumption.cells[1..]
        .iter()
        .map(|cell| with_code(cell))
        .collect();
    page.row(assumption.cells[0], &cells);
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
    fn every_row_of_the_list_is_read() {
        let rows = LIST.lines().filter(|line| line.starts_with("| "));
        let rows = rows.filter(|line| !line.starts_with("| rule")).count();
        assert_eq!(assumptions().count(), rows);
    }

    #[test]
    fn what_was_said_tells_what_was_assumed() {
        let rules = |code: Code| -> Vec<&str> {
            let said = BTreeSet::from([code]);
            let used = assumptions().filter(|assumption| assumption.is_used(&said));
            used.map(|assumption| assumption.cells[0]).collect()
        };
        assert!(rules(Code::Fc303).contains(&"R1.26"));
        assert!(rules(Code::Fc912).contains(&"R2.60"));
        assert!(rules(Code::Fc402).contains(&"R1.29"));
        assert!(!rules(Code::Fc402).contains(&"R2.60"));
    }

    #[test]
    fn backquotes_become_code() {
        assert_eq!(with_code("a `<b>` c"), "a <code>&lt;b&gt;</code> c");
    }
}
