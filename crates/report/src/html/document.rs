//! A document as a page.

use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, PagePart};
use super::parts::{
    Caption, ColumnHeading, Headings, HtmlRow, HtmlTable, figure, linked, with_code,
};
use crate::document::{
    CaptionedTable, Document, DocumentBlock, DocumentList, DocumentPart, DocumentSection, Phrase,
    PhrasePiece, ProgramLine, SectionExtent, Tone, blocks,
};
use crate::svg::Frame;
use frictcomp_recordings::identify::TraceFinding;

/// Rows of a folding table, and items of a list, that a page shows.
const ROWS: usize = 2000;

/// Items of a list that are not folded.
const OPEN_ITEMS: usize = 10;

/// Writes a document as one page, with what is folded below the rest.
///
/// # Errors
/// The errors of `out`.
pub fn render_document(document: &Document<'_>, out: &mut dyn Write) -> io::Result<()> {
    let page = DocumentPage {
        document,
        further: &[],
        link: &|_| None,
    };
    page.render(out, |_| Ok(()))
}

/// Sections that have one title, with their numbers in the page.
type TitledSections<'a, 's> = &'a [(usize, &'a DocumentSection<'s>)];

/// A document on its way to a page that may have further parts.
pub(super) struct DocumentPage<'a> {
    pub(super) document: &'a Document<'a>,
    /// The parts between what is open and what is folded.
    pub(super) further: &'a [PagePart<'a>],
    /// Gives the link to a line that these parts show.
    pub(super) link: &'a dyn Fn(&ProgramLine) -> Option<String>,
}

impl DocumentPage<'_> {
    /// Writes the page; `write` writes the further parts.
    pub(super) fn render(
        &self,
        out: &mut dyn Write,
        write: impl FnOnce(&mut Page<'_>) -> io::Result<()>,
    ) -> io::Result<()> {
        let sections = self.document.sections.iter();
        let mut shown: Vec<_> = sections.filter(|it| !blocks([*it]).is_empty()).collect();
        shown.sort_by_key(|section| match section.extent {
            SectionExtent::Brief | SectionExtent::Full => 0,
            SectionExtent::Below => 1,
            SectionExtent::Folded => 2,
        });
        let shown: Vec<_> = shown.into_iter().enumerate().collect();
        let is_open =
            |(_, section): &(usize, &DocumentSection<'_>)| section.extent != SectionExtent::Folded;
        let (open, folded) = shown.split_at(shown.partition_point(is_open));
        let [open, folded] = [open, folded].map(titled);
        let [first, last] = [&open, &folded].map(|sections| ids(sections));
        let [first, last] = [&first, &last].map(|ids| {
            let parts = ids.iter().map(|(id, title)| PagePart::new(id, title));
            parts.collect::<Vec<_>>()
        });
        let parts = [&first, self.further, &last].concat();
        let verdict = self.document.whole_verdict();
        let mut page = Page::open(out, &self.document.title, &verdict, &parts)?;
        for sections in open {
            page.push(&self.sections(sections))?;
        }
        write(&mut page)?;
        for sections in folded {
            page.push(&self.sections(sections))?;
        }
        page.close()
    }

    fn sections(&self, sections: TitledSections<'_, '_>) -> Markup {
        let (_, DocumentSection { title, extent, .. }) = sections[0];
        let id = id(title);
        let heading = html! { h2 id={ (id) "-h" } { (title) } "\n" };
        let content = html! {
            @for (number, section) in sections {
                @if let Some(subject) = &section.subject { h3 { (subject) } "\n" }
                (self.content(*number, section))
            }
        };
        html! {
            @if title.is_empty() {
                section #result aria-label="Result" { (content) }
            } @else {
                @let own_page = *extent == SectionExtent::Full;
                section.own-page[own_page] id=(id) aria-labelledby={ (id) "-h" } {
                    @if *extent == SectionExtent::Folded {
                        details { summary { (heading) } (content) }
                    } @else {
                        (heading) (content)
                    }
                }
            }
            "\n"
        }
    }

    fn content(&self, section: usize, content: &DocumentSection<'_>) -> Markup {
        let blocks = blocks([content]);
        let groups = blocks.chunk_by(|one, other| item(one).is_some() && item(other).is_some());
        html! {
            @for (at, group) in groups.enumerate() {
                @match group {
                    [DocumentBlock::Line(line)] if item(&group[0]).is_none() => p { (with_code(line)) },
                    [DocumentBlock::Table(captioned)] => (self.table(*captioned, &content.title)),
                    [DocumentBlock::List(it)] => (self.list(it)),
                    [DocumentBlock::Finding(it)] => (finding(it)),
                    [DocumentBlock::Verbatim(text)] => pre { (text.trim_matches('\n')) },
                    [DocumentBlock::Figure(it)] => {
                        @let name = format!("figure-{section}-{at}");
                        (figure(it.render(Frame::Inside(&name))))
                    },
                    items => ul { @for item in items.iter().filter_map(item) { li { (with_code(item)) } "\n" } },
                }
                "\n"
            }
        }
    }

    /// Renders a table under its caption, or under the title of its section; empty rows only part others in a terminal.
    fn table(&self, CaptionedTable { caption, table }: CaptionedTable<'_>, title: &str) -> Markup {
        let mut legend = table.legend().peekable();
        let is_explained = legend.peek().is_some();
        let headings = table.headings().enumerate();
        let columns: Vec<ColumnHeading<'_>> = headings
            .map(|(at, (name, is_number))| match at {
                _ if is_number => ColumnHeading::Number(name),
                1.. if is_explained => ColumnHeading::Word(name),
                _ => ColumnHeading::Text(name),
            })
            .collect();
        let first = table.headings().next().map_or("", |(name, _)| name);
        let unseen = if title.is_empty() { first } else { title };
        let shown = HtmlTable {
            caption: caption.map_or(Caption::Heard(unseen), Caption::Shown),
            columns: &columns,
        };
        let headings = if table.is_plain() {
            Headings::Heard
        } else {
            Headings::Shown
        };
        let (rows, more) = table.rows(ROWS);
        let rows = rows.iter().filter_map(|row| row.split_first());
        let rows = rows.map(|(first, cells)| {
            let cells: Vec<Markup> = cells.iter().map(|cell| self.phrase(cell)).collect();
            HtmlRow::under(self.phrase(first), cells)
        });
        html! {
            @if is_explained {
                dl.legend {
                    @for (word, meaning) in legend { dt { (self.phrase(word)) } dd { (meaning) } "\n" }
                }
            }
            (shown.render_under(headings, rows))
            @if let Some(more) = more { p { (more) } }
        }
    }

    fn list(&self, list: &DocumentList) -> Markup {
        let (items, more) = list.items(ROWS);
        html! {
            details.list open[list.items.len() <= OPEN_ITEMS] {
                summary { (list.title.trim_end_matches(':')) " " span.quiet { "(" (list.items.len()) ")" } }
                ul {
                    @for item in items { li { (self.phrase(item)) } "\n" }
                    @if let Some(more) = more { li { (more) } }
                }
            }
        }
    }

    fn phrase(&self, Phrase { pieces, tone }: &Phrase) -> Markup {
        let content = html! {
            @for piece in pieces {
                @match piece {
                    PhrasePiece::Plain(text) => (with_code(text)),
                    PhrasePiece::Code(text) => code { (text) },
                    PhrasePiece::Leading(text, line) => (linked(text, (self.link)(line))),
                }
            }
        };
        match tone {
            Some(Tone::Away) => html! { span.state.away { (content) } },
            Some(Tone::State(state)) => html! { span.state.(state.as_str()) { (content) } },
            Some(Tone::Quiet) => html! { span.quiet { (content) } },
            None => content,
        }
    }
}

/// Returns the lines to which a page of the document leads.
pub(super) fn leading<'a>(document: &'a Document<'_>) -> impl Iterator<Item = &'a ProgramLine> {
    let parts = document.sections.iter().flat_map(|it| &it.parts);
    let phrases = parts.flat_map(|part| -> Box<dyn Iterator<Item = &Phrase>> {
        match part {
            DocumentPart::Table(table) => Box::new(table.rows(ROWS).0.iter().flatten()),
            DocumentPart::List(list) => Box::new(list.items(ROWS).0.iter()),
            _ => Box::new(std::iter::empty()),
        }
    });
    phrases.flat_map(Phrase::lines)
}

/// Returns sections by their titles.
fn titled<'a, 's>(sections: TitledSections<'a, 's>) -> Vec<TitledSections<'a, 's>> {
    sections
        .chunk_by(|(_, one), (_, other)| one.title == other.title)
        .collect()
}

/// Returns the titles of sections, each after its identifier.
fn ids<'a>(sections: &[TitledSections<'a, '_>]) -> Vec<(String, &'a str)> {
    let titles = sections.iter().map(|of_title| &*of_title[0].1.title);
    let titles = titles.filter(|title| !title.is_empty());
    titles.map(|title| (id(title), title)).collect()
}

/// Returns the identifier of a title: its words in lower case.
fn id(title: &str) -> String {
    let is_letter = |it: char| it.is_alphanumeric();
    let words = title.split(|it| !is_letter(it));
    let words: Vec<String> = words
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect();
    words.join("-")
}

/// Returns the text of a line that belongs to a list.
fn item<'a>(block: &DocumentBlock<'a>) -> Option<&'a str> {
    match block {
        DocumentBlock::Line(line) => line.strip_prefix("  ").map(str::trim),
        _ => None,
    }
}

fn finding(finding: &TraceFinding) -> Markup {
    let severity = finding.severity.as_str();
    html! {
        p.finding {
            span.sev.(severity) { (severity) "[" (finding.code.as_str()) "]" }
            ": " (with_code(&finding.message)) ". " (with_code(&finding.help)) "."
        }
    }
}
