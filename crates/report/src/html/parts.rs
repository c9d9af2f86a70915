//! The parts of pages: tables, pictures, states, sentences.

use maud::{Markup, PreEscaped, html};

use crate::svg::StartUpRelation;
use frictcomp::comp::State;

/// A table with a heading in each row.
#[derive(Debug, Clone, Copy)]
pub(super) struct HtmlTable<'a> {
    pub(super) caption: Caption<'a>,
    /// The columns; the first is that of the headings.
    pub(super) columns: &'a [ColumnHeading<'a>],
}

/// Visibility of the headings of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Headings {
    Shown,
    /// Headings for screen readers only.
    Heard,
}

/// Columns of a table that fit on a narrow screen.
const MOST_COLUMNS: usize = 7;

/// Caption of a table.
#[derive(Debug, Clone, Copy)]
pub(super) enum Caption<'a> {
    /// Caption above the table.
    Shown(&'a str),
    /// Caption for screen readers only: the heading above the table has the same text.
    Heard(&'a str),
}

/// The name of a column.
#[derive(Debug, Clone, Copy)]
pub(super) enum ColumnHeading<'a> {
    /// Heading of a column of texts.
    Text(&'a str),
    /// Heading of a column of numbers.
    Number(&'a str),
    /// Heading of a column of single words.
    Word(&'a str),
}

impl<'a> ColumnHeading<'a> {
    fn name(self) -> &'a str {
        let (Self::Text(name) | Self::Number(name) | Self::Word(name)) = self;
        name
    }

    /// Returns the name, with the unit below it.
    fn heading(self) -> Markup {
        let (name, unit) = self.name().split_once('\n').unwrap_or((self.name(), ""));
        html! { (name) @if !unit.is_empty() { " " span.unit { (unit) } } }
    }

    fn class(self) -> Option<&'static str> {
        match self {
            Self::Text(_) | Self::Word(_) => None,
            Self::Number(_) => Some("num"),
        }
    }
}

/// A row of a table.
#[derive(Debug, Clone)]
pub(super) struct HtmlRow {
    heading: Markup,
    cells: Vec<Markup>,
}

impl HtmlRow {
    pub(super) fn new(heading: &str, cells: impl Into<Vec<Markup>>) -> Self {
        Self::under(html! { (heading) }, cells)
    }

    /// Returns a row with a heading of markup.
    pub(super) fn under(heading: Markup, cells: impl Into<Vec<Markup>>) -> Self {
        let cells = cells.into();
        Self { heading, cells }
    }
}

impl HtmlTable<'_> {
    /// Returns the table, in a frame that scrolls by itself on narrow screens; the rows of a wide one and of one of
    /// words become blocks there.
    pub(super) fn render(&self, rows: impl IntoIterator<Item = HtmlRow>) -> Markup {
        self.render_under(Headings::Shown, rows)
    }

    /// Returns the table with headings that are seen or heard.
    pub(super) fn render_under(
        &self,
        headings: Headings,
        rows: impl IntoIterator<Item = HtmlRow>,
    ) -> Markup {
        let (caption, class) = match self.caption {
            Caption::Shown(caption) => (caption, None),
            Caption::Heard(caption) => (caption, Some("unseen")),
        };
        html! {
            @let has_words = self.columns.iter().any(|it| matches!(it, ColumnHeading::Word(_)));
            @let is_wide = has_words || self.columns.len() > MOST_COLUMNS;
            @let leading = self.columns[0];
            div.wide tabindex="0" role="region" aria-label=(caption) {
                table.stacked[is_wide].words[has_words] {
                    caption class=[class] { (caption) }
                    thead.unseen[headings == Headings::Heard] {
                        tr {
                            @for column in self.columns {
                                th class=[column.class()] scope="col" { (column.heading()) }
                            }
                        }
                    }
                    "\n"
                    tbody {
                        @for row in rows {
                            tr {
                                th class=[leading.class()] scope="row" data-head=[is_wide.then_some(leading.name())] {
                                    (row.heading)
                                }
                                @for (cell, column) in row.cells.iter().zip(&self.columns[1..]) {
                                    td class=[column.class()] data-head=[is_wide.then_some(column.name())] {
                                        (cell)
                                    }
                                }
                            }
                            "\n"
                        }
                    }
                }
            }
            "\n"
        }
    }
}

/// Returns a picture.
pub(super) fn figure(svg: String) -> Markup {
    html! { figure.picture { (PreEscaped(svg)) } "\n" }
}

/// Returns a state, distinguished by more than colour, especially if it is away from its start-up state.
pub(super) fn state_word(state: State, relation: StartUpRelation) -> Markup {
    let word = state.as_str();
    html! { span.state.(word).away[relation == StartUpRelation::Away] { (word) } }
}

/// Returns a sentence whose words in backquotes become code.
pub(super) fn with_code(text: &str) -> Markup {
    html! {
        @for (at, piece) in text.split('`').enumerate() {
            @if at % 2 == 0 { (piece) } @else { code { (piece) } }
        }
    }
}

/// Returns a text that leads to a place of the page, if there is one.
pub(super) fn linked(text: &str, href: Option<String>) -> Markup {
    html! {
        @match href {
            Some(href) => a href=(href) { (text) },
            None => (text),
        }
    }
}

/// Renders a number of times, unless it is one.
pub(super) fn times(times: u64) -> Markup {
    html! { @if times > 1 { " " span.quiet { "(" (times) " times)" } } }
}

/// Returns the identifier of a line of source in the page.
pub(super) fn line_id(file: usize, line: u32) -> String {
    format!("f{file}l{line}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backquotes_become_code() {
        assert_eq!(with_code("a `<b>` c").0, "a <code>&lt;b&gt;</code> c");
    }

    #[test]
    fn numbers_stand_on_the_right() {
        let table = HtmlTable {
            caption: Caption::Heard("C"),
            columns: &[
                ColumnHeading::Text("a"),
                ColumnHeading::Text("b"),
                ColumnHeading::Number("c"),
            ],
        };
        let row = HtmlRow::new("<1>", [html! { "x" }, html! { "2" }]);
        let markup = table.render([row]).0;
        assert!(
            markup.contains("<th scope=\"row\">&lt;1&gt;</th><td>x</td><td class=\"num\">2</td>")
        );
        assert!(markup.contains("<caption class=\"unseen\">C</caption>"));
    }
}
