//! Tables in text.

use std::borrow::Cow;
use std::fmt::{self, Display};

use serde::Serialize;
use unicode_width::UnicodeWidthStr;

use super::Length;
use super::phrase::Phrase;
use crate::wording::counted;

/// Alignment of the cells of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Alignment {
    Left,
    Right,
}

/// A table whose columns are as wide as their widest cell, two blanks apart, without trailing blanks. The headings come
/// first, if there are any, each with its unit on a second line if it has one; a row may have fewer cells than there are
/// columns.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Table {
    headings: Vec<String>,
    alignments: Vec<Alignment>,
    rows: Vec<Vec<Phrase>>,
    /// Whether the headings are only for screen readers.
    #[serde(skip)]
    is_plain: bool,
    /// Noun of the rows that are counted where they are not shown.
    #[serde(skip)]
    noun: Option<&'static str>,
    /// Words of the cells with their meanings, the most important first.
    #[serde(skip)]
    legend: Vec<(Phrase, &'static str)>,
}

/// Number of rows above which a terminal folds a table.
const ROWS: usize = 40;

impl Table {
    /// Creates a table whose columns have numbers.
    pub fn of_numbers<const N: usize>(headings: [&str; N]) -> Self {
        headings.into_iter().fold(Self::default(), Self::right)
    }

    /// Creates a table of columns of words that explain themselves: only screen readers tell the headings.
    pub fn plain<const N: usize>(headings: [&str; N]) -> Self {
        let table = Self {
            is_plain: true,
            ..Self::default()
        };
        headings.into_iter().fold(table, Self::left)
    }

    /// Adds a column of numbers, right-aligned.
    pub fn right(self, heading: impl Display) -> Self {
        self.column(heading, Alignment::Right)
    }

    /// Adds a column of words.
    pub fn left(self, heading: impl Display) -> Self {
        self.column(heading, Alignment::Left)
    }

    fn column(mut self, heading: impl Display, alignment: Alignment) -> Self {
        self.headings.push(heading.to_string());
        self.alignments.push(alignment);
        self
    }

    /// Makes it fold if it is long; its further rows are counted with this noun.
    pub(crate) fn folding(self, noun: &'static str) -> Self {
        let noun = Some(noun);
        Self { noun, ..self }
    }

    /// Adds the meanings of words of the cells, the most important first: a fold counts its rows by them.
    pub(crate) fn explaining(self, legend: Vec<(Phrase, &'static str)>) -> Self {
        Self { legend, ..self }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: &[&dyn Display]) {
        self.cells(cells.iter().map(ToString::to_string));
    }

    /// Adds a row whose number of cells depends on the data, or whose cells have tones or lead to lines.
    pub(crate) fn cells(&mut self, cells: impl IntoIterator<Item = impl Into<Phrase>>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Returns whether the headings are only for screen readers.
    pub(crate) fn is_plain(&self) -> bool {
        self.is_plain
    }

    /// Returns the headings, each with whether its column has numbers.
    pub(crate) fn headings(&self) -> impl Iterator<Item = (&str, bool)> {
        let numbers = self.alignments.iter().map(|it| *it == Alignment::Right);
        self.headings.iter().map(String::as_str).zip(numbers)
    }

    /// Returns the rows below the headings, at most `most` of them if the table folds, and the line that counts the
    /// others.
    pub(crate) fn rows(&self, most: usize) -> (&[Vec<Phrase>], Option<String>) {
        let split = self.noun.zip(self.rows.split_at_checked(most));
        let Some((noun, (shown, more @ [_, ..]))) = split else {
            return (&self.rows, None);
        };
        let mut left: Vec<&Vec<Phrase>> = more.iter().collect();
        let counts = self.legend.iter().map(|(word, _)| {
            let before = left.len();
            left.retain(|row| !has(row, word));
            (before - left.len(), word)
        });
        let counts: Vec<String> = counts
            .filter(|(count, _)| *count > 0)
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        let separator = if counts.is_empty() { "" } else { ": " };
        let more = counted(more.len(), &format!("more {noun}"));
        let line = format!("… {more}{separator}{}", counts.join(", "));
        (shown, Some(line))
    }

    /// Returns the words of its cells that are explained.
    pub(crate) fn legend(&self) -> impl Iterator<Item = &(Phrase, &'static str)> {
        let is_met = |word: &Phrase| self.rows.iter().any(|row| has(row, word));
        self.legend.iter().filter(move |(word, _)| is_met(word))
    }

    /// Writes it at a length.
    pub(super) fn write(&self, length: Length, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (rows, more) = self.rows(length.of(ROWS));
        self.write_rows(rows, f)?;
        if let Some(more) = more {
            writeln!(f, "{more}")?;
        }
        if self.legend.is_empty() {
            return Ok(());
        }
        let widths = self.legend.iter().map(|(word, _)| word.text().width());
        let width = widths.max().unwrap_or(0);
        writeln!(f)?;
        self.legend()
            .try_for_each(|(word, meaning)| writeln!(f, "  {:width$}  {meaning}", word.text()))
    }

    fn lines<'a>(&'a self, rows: &'a [Vec<Phrase>]) -> Vec<Vec<Cow<'a, str>>> {
        let of_headings = |at: usize| -> Vec<Cow<'_, str>> {
            let headings = self.headings.iter();
            let lines = headings.map(|heading| heading.lines().nth(at).unwrap_or_default());
            lines.map(Cow::Borrowed).collect()
        };
        let headings = [0, 1].map(of_headings).into_iter();
        let headings = headings.filter(|line| {
            let has_words = line.iter().any(|it| !it.is_empty());
            has_words && !self.is_plain
        });
        let rows = rows.iter();
        let rows = rows.map(|cells| cells.iter().map(Phrase::text).collect());
        headings.chain(rows).collect()
    }

    fn write_rows(&self, rows: &[Vec<Phrase>], f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.lines(rows);
        let columns = self.alignments.iter().enumerate();
        let columns: Vec<(Alignment, usize)> = columns
            .map(|(at, alignment)| {
                let cells = lines.iter().filter_map(|cells| cells.get(at));
                let width = cells.map(|cell| cell.width()).max();
                (*alignment, width.unwrap_or(0))
            })
            .collect();
        for cells in &lines {
            let mut line = String::new();
            for (cell, (alignment, width)) in cells.iter().zip(&columns) {
                let blanks = " ".repeat(width - cell.width());
                match alignment {
                    Alignment::Left => line.extend([&**cell, &blanks]),
                    Alignment::Right => line.extend([&*blanks, cell]),
                }
                line.push_str("  ");
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// Returns whether a row has a word, and not a name that reads like it.
fn has(row: &[Phrase], word: &Phrase) -> bool {
    let is_word = |cell: &Phrase| (cell.tone, cell.text()) == (word.tone, word.text());
    row.iter().any(is_word)
}

impl Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(Length::Whole, f)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Tone;
    use super::*;

    #[test]
    fn columns_are_as_wide_as_what_stands_in_them() {
        let mut table = Table::of_numbers(["µm"]).left("axis").right("at\nmm");
        table.row(&[&1.25, &"X", &7]);
        table.row(&[&"-", &"軸", &1000]);
        table.row(&[&12]);
        assert_eq!(
            table.to_string(),
            "  µm  axis    at\n              mm\n1.25  X        7\n   -  軸    1000\n  12\n"
        );
    }

    #[test]
    fn a_long_table_counts_the_rows_that_it_folds() {
        // R10.5
        let word = |word: &str| Phrase::from(word).toned(Tone::Quiet);
        let legend = ["both", "leaves", "keeps"].map(|it| (word(it), "means it"));
        let table = Table::default().left("program").left("X").left("Y");
        let mut table = table.folding("program").explaining(legend.into());
        for (name, words) in [
            ("a", ["leaves", "keeps"]),
            ("both", ["keeps", "leaves"]),
            ("c", ["keeps", "keeps"]),
        ] {
            table.cells([Phrase::from(name)].into_iter().chain(words.map(word)));
        }
        let (shown, more) = table.rows(1);
        assert_eq!(shown.len(), 1);
        assert_eq!(
            more.as_deref(),
            Some("… 2 more programs: 1 leaves, 1 keeps")
        );
        assert_eq!(table.rows(3).1, None);
        let text = table.to_string();
        let (_, legend) = text.split_once("\n\n").expect("a legend");
        assert_eq!(legend, "  leaves  means it\n  keeps   means it\n");
    }
}
