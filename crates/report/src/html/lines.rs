//! The page of a document, with the lines of programs to which it leads.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

use maud::html;

use super::document::{DocumentPage, leading};
use super::page::{Page, PagePart};
use super::parts::line_id;
use super::source::{SourceText, Sources};
use crate::document::{Document, ProgramLine};
use frictcomp::text::LineSource;

const LINES: PagePart<'_> = PagePart::new("lines", "Lines");

/// Lines that are shown with their surroundings.
const MARKS: usize = 4000;

/// Lines around a marked one.
const AROUND: u32 = 2;

/// Writes a document as one page, with the lines of programs to which it leads. The programs are read once more, line by
/// line.
///
/// # Errors
/// The errors of `out`.
pub fn render_with_lines(
    document: &Document<'_>,
    sources: &mut dyn Sources,
    out: &mut dyn Write,
) -> io::Result<()> {
    let marks = Marks::of(document);
    let page = DocumentPage {
        document,
        further: if marks.files.is_empty() {
            &[]
        } else {
            &[LINES]
        },
        link: &|line| marks.link(line),
    };
    page.render(out, |page| match marks.files.len() {
        0 => Ok(()),
        _ => page.long_part(LINES, |page| marks.render(page, sources)),
    })
}

/// The marked lines, by file.
#[derive(Default)]
struct Marks<'a> {
    files: BTreeMap<&'a str, (usize, BTreeSet<u32>)>,
    left_out: BTreeSet<(&'a str, u32)>,
}

impl<'a> Marks<'a> {
    fn of(document: &'a Document<'_>) -> Self {
        let mut marks = Self::default();
        let mut count = 0;
        for ProgramLine { file, line } in leading(document) {
            let is_known = marks
                .files
                .get(&**file)
                .is_some_and(|(_, lines)| lines.contains(line));
            if is_known {
                continue;
            }
            if count == MARKS {
                marks.left_out.insert((file, *line));
                continue;
            }
            let next = marks.files.len();
            let (_, lines) = marks
                .files
                .entry(file)
                .or_insert_with(|| (next, BTreeSet::new()));
            lines.insert(*line);
            count += 1;
        }
        marks
    }

    fn link(&self, ProgramLine { file, line }: &ProgramLine) -> Option<String> {
        let (number, lines) = self.files.get(&**file)?;
        let is_shown = lines.contains(line);
        is_shown.then(|| format!("#{}", line_id(*number, *line)))
    }

    /// Writes the marked lines, with their surroundings.
    fn render(&self, page: &mut Page<'_>, sources: &mut dyn Sources) -> io::Result<()> {
        for (file, (number, lines)) in &self.files {
            page.push(&html! { h3 { (file) } "\n" })?;
            let label = html! { "Lines of " (file) }.0;
            page.raw(&format!(
                "<div class=\"source\" role=\"group\" aria-label=\"{label}\" tabindex=\"0\"><pre>"
            ));
            render_file(page, (*number, lines), sources.open(file))?;
            page.raw("</pre></div>\n");
        }
        if !self.left_out.is_empty() {
            page.push(&html! { p { "… " (self.left_out.len()) " more lines are not shown." } })?;
        }
        Ok(())
    }
}

fn render_file(
    page: &mut Page<'_>,
    (file, lines): (usize, &BTreeSet<u32>),
    source: Option<Box<dyn LineSource + '_>>,
) -> io::Result<()> {
    let last = lines.last().copied().unwrap_or_default() + AROUND;
    let mut at = 0;
    let mut written = 0;
    if let Some(mut source) = source {
        while at < last && source.advance() {
            at += 1;
            let near = lines.range(at.saturating_sub(AROUND)..=at + AROUND).next();
            if near.is_none() {
                continue;
            }
            if written + 1 != at {
                page.push(&html! { "      …\n" })?;
            }
            written = at;
            let text = source.line().text;
            page.push(&html! {
                (format!("{at:>6}  "))
                @if lines.contains(&at) {
                    mark id=(line_id(file, at)) { (SourceText(text)) }
                } @else {
                    (SourceText(text))
                }
                "\n"
            })?;
        }
    }
    // A program that cannot be read again, or that has become shorter.
    for line in lines.range(at + 1..) {
        page.push(&html! { (format!("{line:>6}  ")) mark id=(line_id(file, *line)) {} "\n" })?;
    }
    Ok(())
}
