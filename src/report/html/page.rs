//! The frame of a page: head, style, navigation; text goes out as it is made.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::comp::State;
use crate::report::markup::{escaped, push_escaped};
use crate::report::svg::{self, Standing};

/// How much text is gathered before it is written.
const CHUNK: usize = 64 * 1024;

/// A page on its way to a writer. What is appended as `raw` is markup of ours.
pub(super) struct Page<'a> {
    out: &'a mut dyn Write,
    buffer: String,
    /// The title of the part that is open.
    heading: &'static str,
    /// Which columns of the table that is open hold numbers.
    numbers: Vec<bool>,
}

/// Stands before the name of a column that holds numbers.
pub(super) const NUMBERS: char = '#';

/// A part of the page that the navigation leads to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub(super) id: &'static str,
    pub(super) title: &'static str,
}

impl<'a> Page<'a> {
    /// Opens a page with its title, its lead and links to its parts.
    pub(super) fn open(
        out: &'a mut dyn Write,
        title: &str,
        lead: &str,
        parts: &[Part],
    ) -> io::Result<Self> {
        let title = escaped(title);
        let mut page = Self {
            out,
            buffer: String::with_capacity(CHUNK + CHUNK / 4),
            heading: "",
            numbers: Vec::new(),
        };
        page.raw("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n");
        page.raw(concat!(
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ",
            "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\"/>\n",
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n",
            "<meta name=\"color-scheme\" content=\"light dark\"/>\n",
            "<meta name=\"referrer\" content=\"no-referrer\"/>\n",
            "<meta name=\"generator\" content=\"frictcomp ",
            env!("CARGO_PKG_VERSION"),
            "\"/>\n"
        ));
        page.raw(&format!("<title>{title}</title>\n<style>\n"));
        page.raw(STYLE);
        page.raw(svg::STYLE);
        page.raw("</style>\n</head>\n<body>\n");
        page.raw("<a class=\"skip\" href=\"#content\">Skip to the content</a>\n<header>\n");
        page.raw(&format!("<h1>{title}</h1>\n<p class=\"lead\">"));
        page.text(lead);
        page.raw("</p>\n<nav aria-label=\"Parts of the report\"><ul>\n");
        for part in parts {
            page.raw(&format!(
                "<li><a href=\"#{}\">{}</a></li>\n",
                part.id, part.title
            ));
        }
        page.raw("</ul></nav>\n</header>\n<main id=\"content\" tabindex=\"-1\">\n");
        page.settle()?;
        Ok(page)
    }

    /// Opens a part.
    pub(super) fn part(&mut self, part: Part) {
        let Part { id, title } = part;
        self.heading = title;
        self.raw(&format!(
            "<section id=\"{id}\" aria-labelledby=\"{id}-h\">\n<h2 id=\"{id}-h\">{title}</h2>\n"
        ));
    }

    /// Closes a part and writes what is there.
    pub(super) fn end_part(&mut self) -> io::Result<()> {
        self.raw("</section>\n");
        self.settle()
    }

    /// A sentence or two.
    pub(super) fn paragraph(&mut self, text: &str) {
        self.raw("<p>");
        self.text(text);
        self.raw("</p>\n");
    }

    /// A picture, which is markup already.
    pub(super) fn figure(&mut self, svg: &str) {
        self.raw("<figure class=\"picture\">\n");
        self.raw(svg);
        self.raw("</figure>\n");
    }

    /// Appends markup.
    pub(super) fn raw(&mut self, markup: &str) {
        self.buffer.push_str(markup);
    }

    /// Appends text, escaped.
    pub(super) fn text(&mut self, text: &str) {
        push_escaped(&mut self.buffer, text);
    }

    /// The buffer, for what appends itself.
    pub(super) fn buffer(&mut self) -> &mut String {
        &mut self.buffer
    }

    /// Opens a table that scrolls by itself on narrow screens.
    pub(super) fn open_table(&mut self, caption: &str, columns: &[&str]) {
        self.raw("<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"");
        self.text(caption);
        // A caption that repeats the heading above it is for those who listen.
        let repeats = self.heading == caption;
        self.raw(if repeats {
            "\"><table><caption class=\"unseen\">"
        } else {
            "\"><table><caption>"
        });
        self.text(caption);
        self.raw("</caption>\n<thead><tr>");
        self.numbers.clear();
        for column in columns {
            let number = column.strip_prefix(NUMBERS);
            self.numbers.push(number.is_some());
            let (class, name) = match number {
                Some(name) => (" class=\"num\"", name),
                None => ("", *column),
            };
            let _ = write!(self.buffer, "<th scope=\"col\"{class}>{name}</th>");
        }
        self.raw("</tr></thead>\n<tbody>\n");
    }

    /// Closes a table.
    pub(super) fn close_table(&mut self) {
        self.raw("</tbody></table></div>\n");
    }

    /// A row of a table: its first cell is the heading, the others are markup.
    pub(super) fn row(&mut self, heading: &str, cells: &[String]) {
        self.raw("<tr><th scope=\"row\">");
        self.text(heading);
        self.raw("</th>");
        for (column, cell) in (1..).zip(cells) {
            let number = self.numbers.get(column).copied().unwrap_or_default();
            let class = if number { " class=\"num\"" } else { "" };
            let _ = write!(self.buffer, "<td{class}>{cell}</td>");
        }
        self.raw("</tr>\n");
    }

    /// Writes what was gathered once it is enough.
    pub(super) fn settle(&mut self) -> io::Result<()> {
        if self.buffer.len() >= CHUNK {
            self.out.write_all(self.buffer.as_bytes())?;
            self.buffer.clear();
        }
        Ok(())
    }

    /// Ends the page.
    pub(super) fn close(mut self) -> io::Result<()> {
        self.raw(concat!(
            "</main>\n<footer><p>Made by frictcomp ",
            env!("CARGO_PKG_VERSION"),
            ", without a machine. If your control behaves differently, the control is right.</p>",
            "</footer>\n</body>\n</html>\n"
        ));
        self.out.write_all(self.buffer.as_bytes())?;
        self.out.flush()
    }
}

/// A state as markup: its word, told apart by more than colour, above all where it is away from home.
pub(super) fn state_word(state: State, standing: Standing) -> String {
    let word = state.word();
    let away = match standing {
        Standing::Away => " away",
        Standing::Home => "",
    };
    format!("<span class=\"state {word}{away}\">{word}</span>")
}

/// The style of a page.
const STYLE: &str = "\
:root{--ink:#1f2328;--quiet:#57606a;--paper:#fff;--panel:#f6f8fa;--rule:#d0d7de;--link:#0550ae;
--error:#a40e26;--warning:#7d4e00;--info:#0550ae;--mark:#fff1b8;--event:#eef6ff;--away:#a33f00}
@media (prefers-color-scheme:dark){:root{--ink:#e6edf3;--quiet:#9da7b3;--paper:#14181d;--panel:#1b2027;
--rule:#343b44;--link:#79b8ff;--error:#ff8f8f;--warning:#e8b455;--info:#79b8ff;--mark:#5c4a12;--event:#172433;--away:#ff9e5c}}
@media print{:root{--ink:#000;--quiet:#444;--paper:#fff;--panel:#fff;--rule:#bbb;--link:#000;
--error:#a40e26;--warning:#7d4e00;--info:#0550ae;--mark:#fff1b8;--event:#fff;--away:#a33f00}}
*{box-sizing:border-box}
html{background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans',sans-serif}
body{max-width:72rem;margin:0 auto;padding:1.5rem 1.25rem 4rem}
h1{font-size:1.55rem;line-height:1.25;margin:0 0 .25rem;overflow-wrap:anywhere}
h2{font-size:1.2rem;margin:2.6rem 0 .6rem;padding-bottom:.25rem;border-bottom:1px solid var(--rule)}
h3{font-size:1rem;margin:1.6rem 0 .5rem;overflow-wrap:anywhere}
p{margin:.5rem 0;max-width:46rem;overflow-wrap:anywhere}
.lead{font-size:1.05rem}.quiet,footer,caption{color:var(--quiet)}
a{color:var(--link);text-underline-offset:.15em}
a:focus-visible,summary:focus-visible,[tabindex]:focus-visible{outline:2px solid #d55e00;outline-offset:2px}
.skip{position:absolute;left:-99rem}.skip:focus{position:static;display:inline-block;margin-bottom:1rem}
nav ul{display:flex;flex-wrap:wrap;gap:.25rem 1.1rem;list-style:none;padding:0;margin:.9rem 0 0}
.wide{overflow-x:auto;margin:.6rem 0 1rem}
table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}
caption{text-align:left;padding:.2rem 0;font-size:.9rem}
caption.unseen{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%)}
.num{text-align:right}th.num{padding-left:.9rem}
th,td{text-align:left;vertical-align:top;padding:.28rem .9rem .28rem 0;border-bottom:1px solid var(--rule)}
thead th{color:var(--quiet);font-weight:600}tbody th{font-weight:600;white-space:nowrap}
td code,p code,li code{font-size:.92em}
code,pre{font-family:ui-monospace,SFMono-Regular,Consolas,'DejaVu Sans Mono',monospace}
.state{white-space:nowrap}.state.active::before{content:'\\25CF\\00A0';color:var(--link)}
.state.inactive::before{content:'\\25CB\\00A0'}.state.away{font-weight:700;color:var(--away)}
.state.away::before{content:'\\25B2\\00A0';color:var(--away)}.state.ineffective::before{content:'\\25E7\\00A0';color:#d55e00}
.state.unconfigured::before{content:'\\2013\\00A0'}.state.unknown::before{content:'?\\00A0';font-weight:700}
.sev{font-weight:600;white-space:nowrap}
.error .sev,.sev.error{color:var(--error)}.warning .sev,.sev.warning{color:var(--warning)}.info .sev,.sev.info{color:var(--info)}
.picture{margin:.8rem 0;overflow-x:auto}.picture svg{display:block;max-width:100%;height:auto}
.source{border:1px solid var(--rule);background:var(--panel);overflow-x:auto;font-size:.84rem}
.source pre{margin:0;padding:0 .6rem;line-height:1.5;unicode-bidi:isolate;tab-size:8;width:max-content;min-width:100%}
.source .head{color:var(--quiet);border-bottom:1px solid var(--rule)}
.source details{border-block:1px dashed var(--rule);margin:-1px 0;content-visibility:auto}
.source summary{cursor:pointer;padding:.1rem .6rem;color:var(--quiet);position:sticky;left:0;width:fit-content}
.ev{background:var(--event);border-block:1px solid var(--rule);margin-top:-1px}
.ev:target{outline:2px solid #d55e00;outline-offset:-2px}
.ev ul{margin:0;padding:.1rem .6rem .35rem 8.6rem;list-style:none;font-family:system-ui,-apple-system,'Segoe UI',Roboto,sans-serif;
max-width:60rem;font-size:.95em}
.ev ul ul{padding:0 0 0 1.2rem;color:var(--quiet)}
mark{background:var(--mark);color:inherit;text-decoration:underline 2px #d55e00;text-underline-offset:.2em}
.to-do{border-left:4px solid #d55e00;padding:.2rem 0 .2rem 1rem;margin:1rem 0}
.to-do ul{margin:0;padding-left:1.1rem}
@media (max-width:40rem){body{padding:1rem .75rem 3rem}.wide table{min-width:22rem}td{overflow-wrap:anywhere;min-width:5rem}.ev ul{padding-left:1.2rem}}
@media print{html{font-size:10.5pt}body{max-width:none;padding:0}nav,.skip{display:none}.wide,.picture,.source{overflow:visible}
.source pre{white-space:pre-wrap;width:auto}h2,h3,h2+p,h3+p,caption,thead,.source .head{break-after:avoid}thead{display:table-header-group}
tbody tr:first-child,figure{break-before:avoid}.picture,.ev,tr{break-inside:avoid}
.source details::details-content{content-visibility:visible;display:block;block-size:auto;overflow:visible}.source summary{display:none}.source details{content-visibility:visible}a{text-decoration:none}}
";
