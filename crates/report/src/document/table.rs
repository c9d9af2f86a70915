//! Tables in text.

use std::fmt::{self, Display};

use serde::Serialize;
use unicode_width::UnicodeWidthStr;

/// Whether the cells of a column are aligned at their ends or at their beginnings.
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
    rows: Vec<Vec<String>>,
    /// Whether the headings are only for screen readers.
    #[serde(skip)]
    is_plain: bool,
}

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

    /// Adds a row.
    pub fn row(&mut self, cells: &[&dyn Display]) {
        self.cells(cells.iter().map(ToString::to_string).collect());
    }

    /// Adds a row whose number of cells depends on the data.
    pub fn cells(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// Whether the headings are only for screen readers.
    pub(crate) fn is_plain(&self) -> bool {
        self.is_plain
    }

    /// Returns the headings, each with whether its column has numbers.
    pub(crate) fn headings(&self) -> impl Iterator<Item = (&str, bool)> {
        let numbers = self.alignments.iter().map(|it| *it == Alignment::Right);
        self.headings.iter().map(String::as_str).zip(numbers)
    }

    /// Returns the rows below the headings.
    pub(crate) fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    fn lines(&self) -> Vec<Vec<&str>> {
        let of_headings = |at: usize| -> Vec<&str> {
            let headings = self.headings.iter();
            let lines = headings.map(|heading| heading.lines().nth(at).unwrap_or_default());
            lines.collect()
        };
        let headings = [0, 1].map(of_headings).into_iter();
        let headings = headings.filter(|line| {
            let has_words = line.iter().any(|it| !it.is_empty());
            has_words && !self.is_plain
        });
        let rows = self.rows.iter();
        let rows = rows.map(|cells| cells.iter().map(String::as_str).collect());
        headings.chain(rows).collect()
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.lines();
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
                    Alignment::Left => line.extend([*cell, &blanks]),
                    Alignment::Right => line.extend([blanks.as_str(), cell]),
                }
                line.push_str("  ");
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
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
}
