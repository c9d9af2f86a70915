//! A document as a page.

use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, PagePart};
use super::parts::{Caption, ColumnHeading, Headings, HtmlRow, HtmlTable, figure, with_code};
use crate::document::{
    CaptionedTable, Document, DocumentBlock, DocumentSection, SectionExtent, blocks,
};
use crate::svg::Frame;
use frictcomp_recordings::identify::TraceFinding;

/// Writes a document as one page, with what is folded below the rest.
///
/// # Errors
/// Those of `out`.
pub fn render_document(document: &Document<'_>, out: &mut dyn Write) -> io::Result<()> {
    render_with(document, &[], out, |_| Ok(()))
}

/// Writes a document as one page, with further parts between what is open and what is folded.
pub(super) fn render_with(
    document: &Document<'_>,
    further: &[PagePart<'_>],
    out: &mut dyn Write,
    write: impl FnOnce(&mut Page<'_>) -> io::Result<()>,
) -> io::Result<()> {
    let sections = document.sections.iter();
    let shown = sections.filter(|section| !section.parts.is_empty());
    let (folded, open): (Vec<_>, Vec<_>) =
        shown.partition(|section| section.extent == SectionExtent::Folded);
    let [first, last] = [&open, &folded].map(|sections| ids(sections));
    let [first, last] = [&first, &last].map(|ids| {
        let parts = ids.iter().map(|(id, title)| PagePart::new(id, title));
        parts.collect::<Vec<_>>()
    });
    let parts = [&first, further, &last].concat();
    let verdict = match &document.remark {
        None => document.headline.clone(),
        Some(remark) => document.headline.after(remark),
    };
    let mut page = Page::open(out, &document.title, &verdict, &parts)?;
    for (number, section) in open.iter().enumerate() {
        page.push(&render_section(number, section))?;
    }
    write(&mut page)?;
    for (number, section) in (open.len()..).zip(folded) {
        page.push(&render_section(number, section))?;
    }
    page.close()
}

/// Returns the titles of sections, each after its identifier.
fn ids<'a>(sections: &[&'a DocumentSection<'_>]) -> Vec<(String, &'a str)> {
    let titles = sections.iter().map(|section| &*section.title);
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

fn render_section(number: usize, section: &DocumentSection<'_>) -> Markup {
    let DocumentSection { title, extent, .. } = section;
    let id = id(title);
    let heading = html! { h2 id={ (id) "-h" } { (title) } "\n" };
    let content = content(number, section);
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

fn content(section: usize, content: &DocumentSection<'_>) -> Markup {
    let blocks = blocks([content]);
    let groups = blocks.chunk_by(|one, other| item(one).is_some() && item(other).is_some());
    html! {
        @for (at, group) in groups.enumerate() {
            @match group {
                [DocumentBlock::Line(line)] if item(&group[0]).is_none() => p { (with_code(line)) },
                [DocumentBlock::Table(captioned)] => (table(*captioned, &content.title)),
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

/// Renders a table under its caption, or under the title of its section; empty rows only part others in a terminal.
fn table(CaptionedTable { caption, table }: CaptionedTable<'_>, title: &str) -> Markup {
    let columns: Vec<ColumnHeading<'_>> = table
        .headings()
        .map(|(name, is_number)| {
            if is_number {
                ColumnHeading::Number(name)
            } else {
                ColumnHeading::Text(name)
            }
        })
        .collect();
    let first = table.headings().next().map_or("", |(name, _)| name);
    let unseen = if title.is_empty() { first } else { title };
    let shown = HtmlTable {
        caption: caption.map_or(Caption::Heard(unseen), Caption::Shown),
        columns: &columns,
    };
    let rows = table.rows().iter().filter(|row| !row.is_empty());
    let headings = if table.is_plain() {
        Headings::Heard
    } else {
        Headings::Shown
    };
    shown.render_under(
        headings,
        rows.map(|row| {
            let cells: Vec<Markup> = row[1..].iter().map(|cell| with_code(cell)).collect();
            HtmlRow::new(&row[0], cells)
        }),
    )
}
