//! A result as a document: the verdict, then sections of sentences, findings, lists, tables and figures.
//!
//! Each kind of result makes one; a terminal, a page and the page without installation each show it with one renderer.
//! A terminal shows no titles and no figures, and what is in detail only with `-v`.

mod headline;
mod list;
mod phrase;
mod shown;
mod table;

use std::fmt;

pub use headline::{Headline, Standing};
pub(crate) use list::DocumentList;
pub(crate) use phrase::{Phrase, PhrasePiece, ProgramLine, Tone};
pub(crate) use shown::{CaptionedTable, DocumentBlock, blocks};
pub use shown::{Length, ShownDocument};
pub use table::Table;

use super::svg::{BandChart, Frame, LineChart, PlaneChart, PolarChart};
use crate::wording::{Detail, fitted, visible_line};
use frictcomp_recordings::identify::TraceFinding;

/// A result: the verdict, then sections.
#[derive(Debug)]
pub struct Document<'a> {
    pub(crate) title: String,
    /// Remark that has to be known before the verdict.
    pub(crate) remark: Option<String>,
    pub(crate) headline: Headline,
    verdict: VerdictPlace,
    /// Remark that a command prints to standard error, and a page shows in its verdict.
    aside: Option<String>,
    pub(crate) sections: Vec<DocumentSection<'a>>,
}

/// Place of the verdict in a terminal. In a page it is always first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum VerdictPlace {
    First,
    /// Below everything else, as for each command that streams (R18.20).
    Last,
}

/// A section of a document, with a title in a page.
#[derive(Debug)]
pub(crate) struct DocumentSection<'a> {
    /// Empty for the one right below the verdict. A page joins sections of one title.
    pub(crate) title: String,
    /// Heading, in a terminal too, that tells it from others of its title.
    pub(crate) subject: Option<String>,
    pub(crate) extent: SectionExtent,
    pub(crate) parts: Vec<DocumentPart<'a>>,
}

/// The extent of output to which a section belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SectionExtent {
    /// All output.
    Brief,
    /// All output; a page shows the section below all others that are open.
    Below,
    /// A terminal shows it in full detail only.
    Full,
    /// A terminal shows it in full detail only, and a page folds it, below all others.
    Folded,
}

/// Part of a section.
#[derive(Debug)]
pub(crate) enum DocumentPart<'a> {
    /// Lines of text; empty ones divide paragraphs, indented ones are a list under the line above.
    Lines(String),
    /// A table; a line right above it is its caption.
    Table(Table),
    List(DocumentList),
    Finding(TraceFinding),
    /// Text whose line ends and blanks stay.
    Verbatim(String),
    Figure(DrawnFigure<'a>),
}

impl<'a> DocumentPart<'a> {
    fn figure<C: Into<Chart>>(draw: impl Fn() -> C + 'a) -> Self {
        Self::Figure(DrawnFigure(Box::new(move || draw().into())))
    }
}

/// A figure that is drawn where it is shown.
pub(crate) struct DrawnFigure<'a>(Box<dyn Fn() -> Chart + 'a>);

impl DrawnFigure<'_> {
    pub(crate) fn render(&self, frame: Frame<'_>) -> String {
        match (self.0)() {
            Chart::Bands(chart) => chart.render(frame),
            Chart::Lines(chart) => chart.render(frame),
            Chart::Plane(chart) => chart.render(frame),
            Chart::Polar(chart) => chart.render(frame),
        }
    }
}

impl fmt::Debug for DrawnFigure<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DrawnFigure").finish_non_exhaustive()
    }
}

/// A chart of any form.
#[derive(Debug)]
pub(crate) enum Chart {
    Bands(BandChart),
    Lines(LineChart),
    Plane(PlaneChart),
    Polar(PolarChart),
}

impl From<BandChart> for Chart {
    fn from(chart: BandChart) -> Self {
        Self::Bands(chart)
    }
}

impl From<LineChart> for Chart {
    fn from(chart: LineChart) -> Self {
        Self::Lines(chart)
    }
}

impl From<PlaneChart> for Chart {
    fn from(chart: PlaneChart) -> Self {
        Self::Plane(chart)
    }
}

impl From<PolarChart> for Chart {
    fn from(chart: PolarChart) -> Self {
        Self::Polar(chart)
    }
}

impl<'a> Document<'a> {
    pub(crate) fn new(title: impl Into<String>, headline: Headline) -> Self {
        let mut document = Self {
            title: title.into(),
            remark: None,
            headline,
            verdict: VerdictPlace::First,
            aside: None,
            sections: Vec::new(),
        };
        document.begin(String::new(), SectionExtent::Brief);
        document
    }

    /// Puts a remark above the verdict.
    pub(crate) fn remark(&mut self, remark: Option<&str>) {
        self.remark = remark.map(|it| visible_line(it).into_owned());
    }

    /// Moves the verdict to the end of the text for a terminal.
    pub(crate) fn conclude_with_verdict(&mut self) {
        self.verdict = VerdictPlace::Last;
    }

    /// Adds what a command says on standard error.
    pub(crate) fn aside(&mut self, aside: Option<String>) {
        self.aside = aside;
    }

    /// Returns the verdict with all that a page says in it.
    pub(crate) fn whole_verdict(&self) -> Headline {
        let mut verdict = match &self.remark {
            None => self.headline.clone(),
            Some(remark) => self.headline.after(remark),
        };
        if let Some(aside) = &self.aside {
            verdict.text = format!("{}; {aside}", verdict.text);
        }
        verdict
    }

    /// Begins a section.
    pub(crate) fn section(&mut self, title: impl Into<String>) {
        self.begin(title.into(), SectionExtent::Brief);
    }

    /// Begins a section that a page shows below all others that are open.
    pub(crate) fn below(&mut self, title: impl Into<String>) {
        self.begin(title.into(), SectionExtent::Below);
    }

    /// Begins a section that a terminal shows in full detail only.
    pub(crate) fn detail(&mut self, title: impl Into<String>) {
        self.begin(title.into(), SectionExtent::Full);
    }

    /// Begins a section that is folded in a page, and shown by a terminal in full detail only.
    pub(crate) fn folded(&mut self, title: impl Into<String>) {
        self.begin(title.into(), SectionExtent::Folded);
    }

    fn begin(&mut self, title: String, extent: SectionExtent) {
        self.sections.push(DocumentSection {
            title,
            subject: None,
            extent,
            parts: Vec::new(),
        });
    }

    /// Returns the last section.
    fn last(&mut self) -> &mut DocumentSection<'a> {
        let last = self.sections.last_mut();
        last.expect("a document begins with a section")
    }

    /// Returns the parts of the last section.
    fn parts(&mut self) -> &mut Vec<DocumentPart<'a>> {
        &mut self.last().parts
    }

    /// Tells the last section from others of its title.
    pub(crate) fn subject(&mut self, subject: Option<String>) {
        self.last().subject = subject;
    }

    /// Appends a text.
    pub(crate) fn push_str(&mut self, text: &str) {
        match self.parts().last_mut() {
            Some(DocumentPart::Lines(lines)) => lines.push_str(text),
            _ => self.parts().push(DocumentPart::Lines(text.to_owned())),
        }
    }

    /// Appends lines.
    pub(crate) fn lines(&mut self, lines: impl IntoIterator<Item = impl AsRef<str>>) {
        for line in lines {
            self.push_str(line.as_ref());
            self.push_str("\n");
        }
    }

    /// Appends a table.
    pub(crate) fn table(&mut self, table: Table) {
        self.parts().push(DocumentPart::Table(table));
    }

    /// Appends a list, unless it is empty.
    pub(crate) fn list(&mut self, title: impl Into<String>, items: Vec<Phrase>) {
        let title = title.into();
        if !items.is_empty() {
            let list = DocumentList { title, items };
            self.parts().push(DocumentPart::List(list));
        }
    }

    /// Appends findings.
    pub(crate) fn findings<'f>(&mut self, findings: impl IntoIterator<Item = &'f TraceFinding>) {
        let findings = findings.into_iter().cloned().map(DocumentPart::Finding);
        self.parts().extend(findings);
    }

    /// Appends a text as it is.
    pub(crate) fn verbatim(&mut self, text: &str) {
        self.parts().push(DocumentPart::Verbatim(text.to_owned()));
    }

    /// Appends a figure.
    pub(crate) fn figure<C: Into<Chart>>(&mut self, draw: impl Fn() -> C + 'a) {
        self.parts().push(DocumentPart::figure(draw));
    }

    /// Puts a figure right below the verdict.
    pub(crate) fn leading_figure<C: Into<Chart>>(&mut self, draw: impl Fn() -> C + 'a) {
        if let Some(first) = self.sections.first_mut() {
            first.parts.insert(0, DocumentPart::figure(draw));
        }
    }

    /// Returns the document as it is shown in this extent.
    pub fn shown(&self, detail: Detail) -> ShownDocument<'_> {
        ShownDocument::new(self, detail)
    }

    /// Returns the text for a terminal of a width.
    pub fn text(&self, detail: Detail, width: usize) -> String {
        fitted(&self.shown(detail).to_string(), width)
    }

    /// Draws the first figure as a file of its own.
    pub fn picture(&self) -> Option<String> {
        let mut parts = self.sections.iter().flat_map(|section| &section.parts);
        parts.find_map(|part| match part {
            DocumentPart::Figure(figure) => Some(figure.render(Frame::Alone)),
            _ => None,
        })
    }
}

impl fmt::Write for Document<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.push_str(text);
        Ok(())
    }
}
