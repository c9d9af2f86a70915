//! A named text in memory.

use std::sync::Arc;

use super::lines::{BYTE_ORDER_MARK, LineIndex, LineSource, PhysicalLine, TextLines};
use super::place::{Place, Span};

/// A named text in memory with its line index.
#[derive(Debug, Clone)]
pub struct SourceFile {
    name: Arc<str>,
    text: Arc<String>,
    lines: LineIndex,
}

impl SourceFile {
    /// A source under the name that diagnostics and records show. A byte order mark at the start
    /// of the text is not part of it.
    pub fn new(name: impl Into<Arc<str>>, text: impl Into<String>) -> Self {
        let mut text = text.into();
        if text.starts_with(BYTE_ORDER_MARK) {
            text.drain(..BYTE_ORDER_MARK.len_utf8());
        }
        Self {
            name: name.into(),
            lines: LineIndex::new(&text),
            text: text.into(),
        }
    }

    /// Makes the text the rest of a longer one, in which its first line has the number `first`.
    pub fn from_line(mut self, first: u32) -> Self {
        self.lines.first = first;
        self
    }

    /// The name that diagnostics and records show.
    pub fn name(&self) -> &Arc<str> {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The whole text, for callers that keep it separately from the file.
    pub(crate) fn shared_text(&self) -> Arc<String> {
        self.text.clone()
    }

    /// The line index of the text.
    pub fn lines(&self) -> &LineIndex {
        &self.lines
    }

    /// The span of a place in this file; `None` where the file does not hold the lines of the place.
    pub fn find(&self, place: &Place) -> Option<Span> {
        let (mut start, mut end) = (None, None);
        // The line ends of the place may differ from those of the file.
        let mut lines = TextLines::starting_at(&place.text, 0);
        for number in place.first_line.. {
            let more = lines.advance();
            if !more && start.is_some() {
                break;
            }
            let shown = if more {
                lines.line()
            } else {
                PhysicalLine::default()
            };
            let held = self.lines.line_span(&self.text, number);
            if self.lines.line(held.start) != number || !held.of(&self.text).starts_with(shown.text)
            {
                return None;
            }
            let inside = shown.offset..=shown.offset + shown.text.len();
            let found = |offset: u32| {
                let offset = offset as usize;
                let shift = offset.checked_sub(shown.offset)?;
                inside
                    .contains(&offset)
                    .then_some(held.start as usize + shift)
            };
            start = start.or_else(|| found(place.span.start));
            end = end.or_else(|| found(place.span.end));
            if let (Some(start), Some(end)) = (start, end) {
                return Some(Span::new(start, end));
            }
            if !more {
                break;
            }
        }
        None
    }

    /// The place of a span in this file, showing the lines that it touches.
    pub fn place(&self, span: Span) -> Place {
        let first_line = self.lines.line(span.start);
        let last_line = self.lines.line(span.end.max(span.start + 1) - 1);
        let lines = self
            .lines
            .line_span(&self.text, first_line)
            .to(self.lines.line_span(&self.text, last_line));
        // A span that extends past the end of its last line ends with it.
        let inside = |offset: u32| offset.clamp(lines.start, lines.end) - lines.start;
        Place {
            file: self.name.clone(),
            text: lines.of(&self.text).into(),
            first_line,
            span: Span {
                start: inside(span.start),
                end: inside(span.end),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Position;

    #[test]
    fn a_place_ends_with_its_last_line() {
        let file = SourceFile::new("a.nc", "N1 X\r\r\rY");
        for (start, end, text, span) in [(3, 6, "N1 X\r", (3, 5)), (4, 5, "N1 X", (4, 4))] {
            let place = file.place(Span::new(start, end));
            assert_eq!(&*place.text, text);
            assert_eq!(place.span, Span::new(span.0, span.1));
        }
    }

    #[test]
    fn a_place_is_found_again() {
        let text = "N1\r\n(\u{dc}) X[COMP \\\r\nON]\rN3\n";
        let file = SourceFile::new("a.nc", text);
        for (start, end) in [(0, 2), (8, 10), (4, 22), (19, 22), (23, 25), (24, 24)] {
            let span = Span::new(start, end);
            assert_eq!(file.find(&file.place(span)), Some(span), "{start}..{end}");
        }
        let other = SourceFile::new("a.nc", "N1\r\n(U) X[COMP]");
        assert_eq!(other.find(&file.place(Span::new(8, 10))), None);
        assert_eq!(other.find(&file.place(Span::new(23, 25))), None);
    }

    #[test]
    fn a_byte_order_mark_takes_no_column() {
        // R2.2
        let file = SourceFile::new("a.nc", "\u{feff}X[COMP]");
        let place = file.place(Span::new(1, 7));
        assert_eq!((&*place.text, place.start().column), ("X[COMP]", 2));
    }

    #[test]
    fn a_place_shows_its_lines_and_counts_characters() {
        let file = SourceFile::new("a.nc", "N1\r\n(\u{dc}) X[COMP]\r\nN3");
        let place = file.place(Span::new(9, 16));
        assert_eq!(&*place.text, "(\u{dc}) X[COMP]");
        assert_eq!(place.start(), Position { line: 2, column: 5 });
        assert_eq!(
            place.end(),
            Position {
                line: 2,
                column: 12
            }
        );
    }
}
