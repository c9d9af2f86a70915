//! The text above the rows of numbers, gathered until the first of them.

use super::cell::{Separator, is_data};
use super::columns::{FileLine, TableColumns};
use super::error::TraceProblem;
use super::plain;
use super::scope::{self, OpenRow};

/// The lines above the numbers.
#[derive(Debug, Default)]
pub(super) struct Head {
    above: Vec<FileLine>,
    /// Rows of numbers without a header, from which the columns of times are found.
    rows: Vec<FileLine>,
    bytes: usize,
    /// The separator, if the lines are those of Scope.
    separator: Option<Separator>,
    open: Option<OpenRow>,
}

/// Maximum size of a header.
pub(super) const MOST_HEADER: usize = 16 << 20;

/// Maximum number of lines of a header.
const MOST_LINES: usize = 4096;

/// Number of rows that are examined if the file has no header.
const ROWS: usize = 64;

/// Maximum number of columns of a table.
pub(super) const MOST_COLUMNS: usize = 20_000;

impl Head {
    /// Takes a line. Returns the columns, once they are known.
    pub(super) fn line(&mut self, line: FileLine) -> Result<Option<TableColumns>, TraceProblem> {
        self.bytes += line.bytes.len();
        if self.bytes > MOST_HEADER {
            return Err(TraceProblem::NoRows);
        }
        let is_filled = |line: &&mut FileLine| !line.bytes.trim_ascii().is_empty();
        let last = self.above.iter_mut().rfind(is_filled);
        if let (Some(open), Some(last)) = (&mut self.open, last)
            && open.continues(&line.bytes)
        {
            open.take(&line.bytes);
            last.bytes.push(b'\n');
            last.bytes.extend(&line.bytes);
            return Ok(None);
        }
        if self.rows.is_empty() && !is_data(&line.bytes, self.separator) {
            if self.above.len() == MOST_LINES {
                return Err(TraceProblem::NoRows);
            }
            if self.above.is_empty() && line.bytes.trim_ascii().is_empty() {
                return Ok(None);
            }
            self.above.push(line);
            self.separator = self.separator.or_else(|| scope::separator_of(&self.above));
            self.open = OpenRow::last(&self.above);
            return Ok(None);
        }
        self.rows.push(line);
        if self.has_header() || self.rows.len() == ROWS {
            return self.columns().map(Some);
        }
        Ok(None)
    }

    /// Ends the file; returns the columns of the rows that came.
    pub(super) fn end(&self) -> Result<TableColumns, TraceProblem> {
        if self.rows.is_empty() {
            return Err(TraceProblem::NoRows);
        }
        self.columns()
    }

    /// Returns the rows of numbers that have come so far.
    pub(super) fn rows(self) -> Vec<FileLine> {
        self.rows
    }

    fn has_header(&self) -> bool {
        scope::has_attributes(&self.above)
            || scope::separator_of(&self.above).is_none()
                && self
                    .above
                    .iter()
                    .any(|line| !line.bytes.trim_ascii().is_empty())
    }

    fn columns(&self) -> Result<TableColumns, TraceProblem> {
        let first = &self.rows[0];
        let columns = if scope::has_attributes(&self.above) {
            scope::columns(&self.above, first)?
        } else if self.has_header() {
            plain::columns(&self.above, first)?
        } else {
            plain::headless(
                &self.rows,
                scope::separator_of(&self.above).map(Separator::of_numbers),
            )
        };
        if columns.count > MOST_COLUMNS {
            return Err(TraceProblem::Long {
                line: first.number,
                most: MOST_COLUMNS,
            });
        }
        Ok(columns)
    }
}
