//! A report: the verdict, then sentences and tables, for terminals and for pages.

use std::fmt::{self, Display};

use serde::{Serialize, Serializer};

use crate::headline::Headline;
use crate::table::Table;

/// Part of a report.
#[derive(Debug, Clone)]
enum ReportPart {
    /// Lines of text; empty ones divide paragraphs.
    Lines(String),
    Table(Table),
}

/// A table under its caption.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct CaptionedTable<'a> {
    pub(crate) caption: Option<&'a str>,
    #[serde(flatten)]
    pub(crate) table: &'a Table,
}

/// A line of a report, or a table.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ReportBlock<'a> {
    Line(&'a str),
    Table(CaptionedTable<'a>),
}

/// A report: the verdict, then sentences and tables. A terminal shows it as it is displayed, a page renders its blocks.
#[derive(Debug, Clone, Serialize)]
pub struct ReportText {
    headline: Headline,
    #[serde(rename = "blocks", serialize_with = "serialize_blocks")]
    parts: Vec<ReportPart>,
}

impl ReportText {
    pub(crate) fn new(headline: Headline) -> Self {
        let parts = Vec::new();
        Self { headline, parts }
    }

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

    /// Returns what follows the verdict. A line right above a table is its caption.
    pub(crate) fn blocks(&self) -> Vec<ReportBlock<'_>> {
        blocks(&self.parts)
    }
}

fn blocks(parts: &[ReportPart]) -> Vec<ReportBlock<'_>> {
    let mut blocks = Vec::new();
    for part in parts {
        match part {
            ReportPart::Lines(lines) => blocks.extend(lines.lines().map(ReportBlock::Line)),
            ReportPart::Table(table) => {
                let caption = match blocks.last() {
                    Some(ReportBlock::Line(line)) if !line.trim().is_empty() => Some(*line),
                    _ => None,
                };
                blocks.truncate(blocks.len() - usize::from(caption.is_some()));
                blocks.push(ReportBlock::Table(CaptionedTable { caption, table }));
            }
        }
    }
    blocks.retain(|block| !matches!(block, ReportBlock::Line(line) if line.trim().is_empty()));
    blocks
}

fn serialize_blocks<S: Serializer>(parts: &[ReportPart], serializer: S) -> Result<S::Ok, S::Error> {
    blocks(parts).serialize(serializer)
}

impl fmt::Write for ReportText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.push_str(text);
        Ok(())
    }
}

impl Display for ReportText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.headline)?;
        self.parts.iter().try_for_each(|part| match part {
            ReportPart::Lines(lines) => f.write_str(lines),
            ReportPart::Table(table) => table.fmt(f),
        })
    }
}
