//! The frame of a page: head, style, navigation; markup is written as it is made.

use std::io::{self, Write};

use maud::{Markup, PreEscaped, html};

use super::parts::with_code;
use crate::document::Headline;
use crate::svg;
use crate::wording::visible;

/// Number of bytes of markup gathered before they are written.
const CHUNK: usize = 64 * 1024;

/// Beginning of every page. Elements without content are closed, so that a page is XML too.
const HEAD: &str = concat!(
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n",
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ",
    "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\"/>\n",
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n",
    "<meta name=\"color-scheme\" content=\"light dark\"/>\n",
    "<meta name=\"referrer\" content=\"no-referrer\"/>\n",
    "<meta name=\"generator\" content=\"frictcomp ",
    env!("CARGO_PKG_VERSION"),
    "\"/>\n",
);

/// The style of states, and that of a page.
const STYLE: &str = concat!(include_str!("../states.css"), include_str!("style.css"));

/// A page that is being written.
pub(super) struct Page<'a> {
    out: &'a mut dyn Write,
    buffer: String,
}

/// A part of the page that the navigation leads to.
#[derive(Debug, Clone, Copy)]
pub(super) struct PagePart<'a> {
    id: &'a str,
    pub(super) title: &'a str,
}

impl<'a> PagePart<'a> {
    pub(super) const fn new(id: &'a str, title: &'a str) -> Self {
        Self { id, title }
    }
}

impl<'a> Page<'a> {
    /// Opens a page with its title, the verdict and links to its parts.
    pub(super) fn open(
        out: &'a mut dyn Write,
        title: &str,
        headline: &Headline,
        parts: &[PagePart<'_>],
    ) -> io::Result<Self> {
        let mut page = Self {
            out,
            buffer: String::with_capacity(CHUNK + CHUNK / 4),
        };
        page.buffer.push_str(HEAD);
        page.push(&html! {
            title { (title) } "\n"
            style { (PreEscaped(svg::COLOURS)) (PreEscaped(STYLE)) (PreEscaped(svg::style())) }
        })?;
        page.buffer.push_str("\n</head>\n<body>\n");
        page.push(&html! {
            a.skip href="#content" { "Skip to the content" } "\n"
            header {
                h1 { (title) }
                p class={ "lead " (headline.standing.as_str()) } { (with_code(&headline.sentence())) }
                nav aria-label="Parts of the report" {
                    @if !parts.is_empty() {
                        ul {
                            @for part in parts {
                                li { a href={ "#" (part.id) } { (part.title) } }
                            }
                        }
                    }
                }
            }
        })?;
        page.buffer
            .push_str("\n<main id=\"content\" tabindex=\"-1\">\n");
        Ok(page)
    }

    /// Appends markup, and writes what was gathered once it fills a chunk.
    pub(super) fn push(&mut self, markup: &Markup) -> io::Result<()> {
        self.buffer.push_str(&markup.0);
        if self.buffer.len() >= CHUNK {
            self.write()?;
        }
        Ok(())
    }

    /// Writes a part whose content is made at once.
    pub(super) fn part(&mut self, part: PagePart<'_>, content: &Markup) -> io::Result<()> {
        self.long_part(part, |page| page.push(content))
    }

    /// Writes a part whose content comes piece by piece.
    pub(super) fn long_part(
        &mut self,
        part: PagePart<'_>,
        content: impl FnOnce(&mut Self) -> io::Result<()>,
    ) -> io::Result<()> {
        let PagePart { id, title } = part;
        self.raw(&format!("<section id=\"{id}\" aria-labelledby=\"{id}-h\">"));
        self.push(&html! { h2 id={ (id) "-h" } { (title) } "\n" })?;
        content(self)?;
        self.raw("</section>\n");
        Ok(())
    }

    /// Appends a tag of an element whose content comes piece by piece: no template closes it.
    pub(super) fn raw(&mut self, tag: &str) {
        self.buffer.push_str(tag);
    }

    /// Ends the page.
    pub(super) fn close(mut self) -> io::Result<()> {
        self.buffer.push_str("</main>\n");
        self.push(&html! {
            footer {
                p {
                    "Made by frictcomp " (env!("CARGO_PKG_VERSION")) ", without a machine. If your \
                     control behaves differently, the control is right."
                }
            }
        })?;
        self.buffer.push_str("\n</body>\n</html>\n");
        self.write()?;
        self.out.flush()
    }

    /// Writes all gathered markup: whatever a program contains, nothing invisible leaves here (R9.76).
    fn write(&mut self) -> io::Result<()> {
        self.out.write_all(visible(&self.buffer).as_bytes())?;
        self.buffer.clear();
        Ok(())
    }
}
