//! A report in sentences and tables, for terminals and for pages.

use std::fmt::{self, Display};

use crate::table::Table;

/// Part of a report.
#[derive(Debug, Clone)]
pub(crate) enum ReportPart {
    /// Lines of text; empty ones divide paragraphs.
    Lines(String),
    /// A table.
    Table(Table),
}

/// A report in sentences and tables: a terminal shows it as it is displayed, a page renders its parts.
#[derive(Debug, Clone, Default)]
pub(crate) struct ReportText {
    parts: Vec<ReportPart>,
}

impl ReportText {
    /// Appends a text.
    pub(crate) fn push_str(&mut self, text: &str) {
        match self.parts.last_mut() {
            Some(ReportPart::Lines(lines)) => lines.push_str(text),
            _ => self.parts.push(ReportPart::Lines(text.to_owned())),
        }
    }

    /// Appends a table.
    pub(crate) fn table(&mut self, table: Table) {
        self.parts.push(ReportPart::Table(table));
    }

    pub(crate) fn parts(&self) -> &[ReportPart] {
        &self.parts
    }
}

impl fmt::Write for ReportText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.push_str(text);
        Ok(())
    }
}

impl Display for ReportText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.parts.iter().try_for_each(|part| match part {
            ReportPart::Lines(lines) => f.write_str(lines),
            ReportPart::Table(table) => table.fmt(f),
        })
    }
}
