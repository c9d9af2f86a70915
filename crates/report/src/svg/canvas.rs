//! The elements of a picture, appended one after another.

use std::fmt::Write as _;

use unicode_width::UnicodeWidthStr;

use super::frame::{Frame, style};
use crate::wording::push_escaped;

/// The width of every chart in units of the picture.
pub(super) const WIDTH: f64 = 860.0;

/// The room left of headings and legends.
pub(super) const MARGIN: f64 = 16.0;

/// Alignment of a text relative to its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A rectangle in units of the picture, `y` down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) fn right(self) -> f64 {
        self.x + self.width
    }

    pub(super) fn bottom(self) -> f64 {
        self.y + self.height
    }
}

/// The words of a picture as a whole, and its role.
#[derive(Debug, Clone, Copy)]
pub(super) struct Head<'a> {
    /// The heading; empty if the page around the picture has one.
    pub(super) title: &'a str,
    /// The picture in a sentence or two, for those who do not see it.
    pub(super) description: &'a str,
    pub(super) role: PictureRole,
}

/// The role of a picture for a screen reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PictureRole {
    /// One image, described by title and description.
    Image,
    /// Parts that can be reached one by one.
    Group,
}

/// A picture while it is drawn.
#[derive(Debug)]
pub(super) struct Canvas<'a> {
    head: Head<'a>,
    body: String,
}

impl<'a> Canvas<'a> {
    /// Creates a picture with its heading.
    pub(super) fn headed(head: Head<'a>) -> Self {
        let mut canvas = Self {
            head,
            body: String::new(),
        };
        if !head.title.is_empty() {
            canvas.text("fc-title", (MARGIN, 26.0), Anchor::Start, head.title);
        }
        canvas
    }

    pub(super) fn line(&mut self, class: &str, (x1, y1): (f64, f64), (x2, y2): (f64, f64)) {
        let (x1, y1, x2, y2) = (px(x1), px(y1), px(x2), px(y2));
        self.raw(&format!(
            "<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>\n"
        ));
    }

    pub(super) fn rect(&mut self, class: &str, area: Area) {
        let (x, y) = (px(area.x), px(area.y));
        let (width, height) = (px(area.width), px(area.height));
        self.raw(&format!(
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>\n"
        ));
    }

    pub(super) fn circle(&mut self, class: &str, (x, y): (f64, f64), radius: f64) {
        let (x, y, radius) = (px(x), px(y), px(radius));
        self.raw(&format!(
            "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>\n"
        ));
    }

    pub(super) fn text(&mut self, class: &str, (x, y): (f64, f64), anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let (x, y) = (px(x), px(y));
        let class = if class.is_empty() {
            String::new()
        } else {
            format!(" class=\"{class}\"")
        };
        self.raw(&format!("<text{class} x=\"{x}\" y=\"{y}\"{anchor}>"));
        push_escaped(&mut self.body, text);
        self.raw("</text>\n");
    }

    /// Draws a line through points; one that is not finite interrupts it.
    pub(super) fn path(&mut self, class: &str, points: impl IntoIterator<Item = (f64, f64)>) {
        self.raw(&format!("<path class=\"{class}\" d=\""));
        let mut pen_is_down = false;
        for (x, y) in points {
            if x.is_finite() && y.is_finite() {
                let command = if pen_is_down { 'L' } else { 'M' };
                let _ = write!(self.body, "{command}{} {}", px(x), px(y));
                pen_is_down = true;
            } else {
                pen_is_down = false;
            }
        }
        self.raw("\"/>\n");
    }

    /// Draws a marker of the series with this number: circle, square, triangle, diamond.
    pub(super) fn marker(&mut self, series: usize, (x, y): (f64, f64)) {
        let class = format!("fc-m{}", series % SERIES);
        match series % SERIES {
            0 | 2 => self.circle(&class, (x, y), 3.4),
            1 | 3 => self.rect(
                &class,
                Area {
                    x: x - 3.2,
                    y: y - 3.2,
                    width: 6.4,
                    height: 6.4,
                },
            ),
            4 => self.path(
                &class,
                [(x, y - 4.4), (x + 4.2, y + 3.2), (x - 4.2, y + 3.2)],
            ),
            _ => self.path(
                &class,
                [(x, y - 4.6), (x + 4.2, y), (x, y + 4.6), (x - 4.2, y)],
            ),
        }
    }

    /// Opens a link, or a group if there is none, with the text for a pointer and a screen reader.
    pub(super) fn open_link(&mut self, href: Option<&str>, title: &str) {
        match href {
            Some(href) => {
                self.raw("<a href=\"");
                push_escaped(&mut self.body, href);
                self.raw("\" aria-label=\"");
                push_escaped(&mut self.body, title);
                self.raw("\"><title>");
            }
            None => self.raw("<g><title>"),
        }
        push_escaped(&mut self.body, title);
        self.raw("</title>\n");
    }

    /// Closes what [`open_link`](Self::open_link) opened.
    pub(super) fn close_link(&mut self, href: Option<&str>) {
        self.raw(if href.is_some() { "</a>\n" } else { "</g>\n" });
    }

    /// Returns a length of the picture between two ticks, with its words; returns where they end.
    pub(super) fn scale_bar(&mut self, (left, y): (f64, f64), length: f64, text: &str) -> f64 {
        let right = left + length;
        self.line("fc-axis", (left, y), (right, y));
        for end in [left, right] {
            self.line("fc-axis", (end, y - 4.0), (end, y + 4.0));
        }
        self.text("", (right + 8.0, y + 4.0), Anchor::Start, text);
        right + 8.0 + widest_text(text)
    }

    /// Places another picture of the same width below what was drawn.
    pub(super) fn embed(&mut self, picture: &str, y: f64) {
        let y = px(y);
        self.raw(&format!(
            "<g transform=\"translate(0 {y})\">\n{picture}</g>\n"
        ));
    }

    /// Returns the whole picture.
    pub(super) fn finish(self, frame: Frame<'_>, height: f64) -> String {
        let (prefix, alone) = match frame {
            Frame::Alone => ("picture", true),
            Frame::Inside(name) => (name, false),
        };
        let (width, height) = (px(WIDTH), px(height));
        let Head {
            title,
            description,
            role,
        } = self.head;
        let title = if title.is_empty() { description } else { title };
        let role = match role {
            PictureRole::Image => "img",
            PictureRole::Group => "group",
        };
        let mut out = String::with_capacity(self.body.len() + 4096);
        out.push_str("<svg ");
        if alone {
            out.push_str("xmlns=\"http://www.w3.org/2000/svg\" ");
        }
        let _ = write!(
            out,
            "class=\"fc-picture\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\" role=\"{role}\" aria-labelledby=\"{prefix}-title\" \
             aria-describedby=\"{prefix}-desc\">\n<title id=\"{prefix}-title\">"
        );
        push_escaped(&mut out, title);
        let _ = write!(out, "</title>\n<desc id=\"{prefix}-desc\">");
        push_escaped(&mut out, description);
        out.push_str("</desc>\n");
        if alone {
            // The style is a constant of this crate and does not end the element.
            let _ = writeln!(out, "<style>\n{}</style>", style());
        }
        let _ = writeln!(
            out,
            "<rect class=\"fc-ground\" width=\"{width}\" height=\"{height}\"/>"
        );
        out.push_str(&self.body);
        out.push_str("</svg>\n");
        out
    }

    fn raw(&mut self, markup: &str) {
        self.body.push_str(markup);
    }
}

/// Number of series that look different.
pub(super) const SERIES: usize = 6;

/// Returns the class of the curve of the series with this number.
pub(super) fn curve_class(series: usize) -> String {
    format!("fc-curve fc-s{}", series % SERIES)
}

/// Returns the approximate width of a text.
pub(super) fn text_width(text: &str) -> f64 {
    f64::from(u32::try_from(text.width()).unwrap_or(u32::MAX)) * 6.5
}

/// Returns the approximate width of a text in the larger letters of narrow screens, in a wide font.
pub(super) fn widest_text(text: &str) -> f64 {
    text_width(text) * 1.45
}

/// Returns a length with at most one decimal.
pub(super) fn px(length: f64) -> String {
    let mut text = format!("{length:.1}");
    if let Some(whole) = text.strip_suffix(".0") {
        text.truncate(whole.len());
    }
    if text == "-0" {
        text.remove(0);
    }
    text
}
