//! A document in a terminal, and as data.

use std::borrow::Cow;
use std::fmt::{self, Display};

use serde::{Serialize, Serializer};

use super::{
    Document, DocumentList, DocumentPart, DocumentSection, DrawnFigure, Headline, SectionExtent,
    Table, VerdictPlace,
};
use crate::wording::{Detail, visible_line};
use frictcomp_recordings::identify::TraceFinding;

/// Length at which a terminal shows tables and lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Length {
    /// The beginnings of tables and lists; the rest is counted.
    #[default]
    Folded,
    /// All rows and entries.
    Whole,
}

impl Length {
    pub(super) fn of(self, folded: usize) -> usize {
        match self {
            Self::Folded => folded,
            Self::Whole => usize::MAX,
        }
    }
}

/// A document in the extent that is asked for. A terminal shows it as it is displayed, the page without installation
/// renders its data.
#[derive(Debug, Serialize)]
pub struct ShownDocument<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    remark: Option<&'a str>,
    headline: &'a Headline,
    #[serde(rename = "blocks", serialize_with = "serialize_blocks")]
    sections: Vec<&'a DocumentSection<'a>>,
    #[serde(skip)]
    verdict: VerdictPlace,
    #[serde(skip)]
    length: Length,
}

impl<'a> ShownDocument<'a> {
    pub(super) fn new(document: &'a Document<'a>, detail: Detail) -> Self {
        let sections = document.sections.iter();
        let is_shown = |section: &&DocumentSection<'_>| {
            let is_brief = matches!(section.extent, SectionExtent::Brief | SectionExtent::Below);
            detail == Detail::Full || is_brief
        };
        Self {
            remark: document.remark.as_deref(),
            headline: &document.headline,
            sections: sections.filter(is_shown).collect(),
            verdict: document.verdict,
            length: Length::default(),
        }
    }

    /// Returns it with tables and lists of a length.
    #[must_use]
    pub fn with_length(self, length: Length) -> Self {
        Self { length, ..self }
    }
}

impl ShownDocument<'_> {
    fn write_part(&self, part: &DocumentPart<'_>, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match part {
            DocumentPart::Lines(text) | DocumentPart::Verbatim(text) => f.write_str(text),
            DocumentPart::Table(table) => table.write(self.length, f),
            DocumentPart::List(list) => list.write(self.length, f),
            DocumentPart::Finding(finding) => {
                let [said, help] = finding_lines(finding);
                writeln!(f, "\n{said}\n{help}")
            }
            DocumentPart::Figure(_) => Ok(()),
        }
    }
}

impl Display for ShownDocument<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(remark) = self.remark {
            writeln!(f, "{remark}\n")?;
        }
        if self.verdict == VerdictPlace::First {
            writeln!(f, "{}", self.headline)?;
        }
        let mut subject = None;
        for section in &self.sections {
            let before = std::mem::replace(&mut subject, section.subject.as_ref());
            if let Some(subject) = subject.filter(|it| before != Some(it)) {
                writeln!(f, "{subject}\n")?;
            }
            section
                .parts
                .iter()
                .try_for_each(|part| self.write_part(part, f))?;
        }
        if self.verdict == VerdictPlace::Last {
            writeln!(f, "{}", self.headline)?;
        }
        Ok(())
    }
}

/// Returns a finding with its severity, its code and what to do.
fn finding_lines(finding: &TraceFinding) -> [String; 2] {
    let (severity, code) = (finding.severity.as_str(), finding.code);
    [
        format!("{severity}[{code}]: {}", visible_line(&finding.message)),
        format!("  help: {}", visible_line(&finding.help)),
    ]
}

/// A table under its caption.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct CaptionedTable<'a> {
    pub(crate) caption: Option<&'a str>,
    #[serde(flatten)]
    pub(crate) table: &'a Table,
}

/// A line of a document, or what stands between lines.
#[derive(Debug, Clone, Copy)]
pub(crate) enum DocumentBlock<'a> {
    Line(&'a str),
    Table(CaptionedTable<'a>),
    List(&'a DocumentList),
    Finding(&'a TraceFinding),
    Verbatim(&'a str),
    Figure(&'a DrawnFigure<'a>),
}

/// Returns what sections consist of. A line right above a table is its caption.
pub(crate) fn blocks<'a>(
    sections: impl IntoIterator<Item = &'a DocumentSection<'a>>,
) -> Vec<DocumentBlock<'a>> {
    let mut blocks = Vec::new();
    for part in sections.into_iter().flat_map(|section| &section.parts) {
        match part {
            DocumentPart::Lines(lines) => blocks.extend(lines.lines().map(DocumentBlock::Line)),
            DocumentPart::Verbatim(text) => blocks.push(DocumentBlock::Verbatim(text)),
            DocumentPart::List(list) => blocks.push(DocumentBlock::List(list)),
            DocumentPart::Finding(finding) => blocks.push(DocumentBlock::Finding(finding)),
            DocumentPart::Figure(figure) => blocks.push(DocumentBlock::Figure(figure)),
            DocumentPart::Table(table) => {
                let caption = match blocks.last() {
                    Some(DocumentBlock::Line(line)) if !line.trim().is_empty() => Some(*line),
                    _ => None,
                };
                blocks.truncate(blocks.len() - usize::from(caption.is_some()));
                blocks.push(DocumentBlock::Table(CaptionedTable { caption, table }));
            }
        }
    }
    blocks.retain(|block| !matches!(block, DocumentBlock::Line(line) if line.trim().is_empty()));
    blocks
}

/// A block as data: what is no table is told in lines.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum BlockRecord<'a> {
    Line(Cow<'a, str>),
    Table(CaptionedTable<'a>),
}

fn serialize_blocks<S: Serializer>(
    sections: &[&DocumentSection<'_>],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let line = |line| BlockRecord::Line(Cow::Borrowed(line));
    let records = blocks(sections.iter().copied()).into_iter();
    serializer.collect_seq(records.flat_map(|block| match block {
        DocumentBlock::Line(text) => vec![line(text)],
        DocumentBlock::Verbatim(text) => text.lines().map(line).collect(),
        DocumentBlock::Table(table) => vec![BlockRecord::Table(table)],
        DocumentBlock::List(list) => {
            let lines = list.lines(Length::Whole);
            lines.map(|it| BlockRecord::Line(it.into())).collect()
        }
        DocumentBlock::Finding(finding) => {
            let lines = finding_lines(finding).map(|it| BlockRecord::Line(it.into()));
            lines.into()
        }
        DocumentBlock::Figure(_) => Vec::new(),
    }))
}
