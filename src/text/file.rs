//! A named text in memory, its physical lines, one after another, and where each begins.

use std::sync::Arc;

use super::place::{Place, Span};

/// A named text in memory with its line index.
#[derive(Debug, Clone)]
pub struct SourceFile {
    name: Arc<str>,
    text: Arc<String>,
    lines: LineIndex,
}

impl SourceFile {
    /// Returns a source under the name that diagnostics and records show. A byte order mark at the start of the text is
    /// not part of it.
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

    /// Returns the name that diagnostics and records show.
    pub fn name(&self) -> &Arc<str> {
        &self.name
    }

    /// Returns the whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the whole text, for callers that keep it separately from the file.
    pub(crate) fn shared_text(&self) -> Arc<String> {
        self.text.clone()
    }

    /// Returns the line index of the text.
    pub fn lines(&self) -> &LineIndex {
        &self.lines
    }

    /// Returns the span of a place in this file; `None` where the file does not hold the lines of the place.
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

    /// Returns the place of a span in this file, showing the lines that it touches.
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

/// Byte order mark that some editors write at the start of a text; not part of the text.
pub(super) const BYTE_ORDER_MARK: char = '\u{feff}';

/// A line of text without its line end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PhysicalLine<'a> {
    /// The characters of the line.
    pub text: &'a str,
    /// Whether characters were left out because the line is longer than any block may be.
    pub cut: bool,
    /// Offset of the line in bytes from the start of the text; 0 for a stream, which is not reread.
    pub offset: usize,
}

/// Returns the length in bytes of the line end at the start of a text: LF, CRLF, CR, or none at its end.
pub fn line_end(text: &[u8]) -> usize {
    match text {
        [b'\r', b'\n', ..] => 2,
        [_, ..] => 1,
        [] => 0,
    }
}

/// Gives physical lines one after another.
pub trait LineSource {
    /// Goes to the next line; `false` at the end of the text.
    fn advance(&mut self) -> bool;

    /// Returns the line that [`advance`](Self::advance) went to.
    fn line(&self) -> PhysicalLine<'_>;

    /// Returns the following lines that are available, each whole and with its end; none at the end of the text.
    fn ahead(&mut self) -> &str;

    /// Goes to the first line of [`ahead`](Self::ahead), which has so many bytes without its end, and
    /// returns it.
    fn take(&mut self, length: usize) -> PhysicalLine<'_>;

    /// Appends the lines to come, each with a line end. A source that may have no end stops where
    /// the text is too big to be kept.
    fn append_rest(&mut self, text: &mut String) {
        while self.advance() {
            text.push_str(self.line().text);
            text.push('\n');
        }
    }
}

impl<S: LineSource + ?Sized> LineSource for &mut S {
    fn advance(&mut self) -> bool {
        (**self).advance()
    }

    fn line(&self) -> PhysicalLine<'_> {
        (**self).line()
    }

    fn ahead(&mut self) -> &str {
        (**self).ahead()
    }

    fn take(&mut self, length: usize) -> PhysicalLine<'_> {
        (**self).take(length)
    }

    fn append_rest(&mut self, text: &mut String) {
        (**self).append_rest(text);
    }
}

/// The lines of a text in memory, ended by LF, CRLF or CR; a last line without an end counts.
#[derive(Debug, Clone)]
pub struct TextLines<'a> {
    text: &'a str,
    line: std::ops::Range<usize>,
    next: usize,
}

impl<'a> TextLines<'a> {
    /// Returns the lines of `text`. A byte order mark at its start is skipped.
    pub fn new(text: &'a str) -> Self {
        let start = text.len() - text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text).len();
        Self::starting_at(text, start)
    }

    /// Returns the lines of `text` from a byte offset on, which begins a line.
    pub fn starting_at(text: &'a str, offset: usize) -> Self {
        Self {
            text,
            line: 0..0,
            next: offset,
        }
    }
}

/// Returns the lines of a text without their ends: LF, CRLF, CR.
pub(crate) fn lines_of(text: &str) -> impl Iterator<Item = &str> {
    let mut lines = TextLines::starting_at(text, 0);
    std::iter::from_fn(move || lines.advance().then(|| &text[lines.line.clone()]))
}

impl LineSource for TextLines<'_> {
    fn advance(&mut self) -> bool {
        let start = self.next;
        let bytes = self.text.as_bytes();
        let Some(rest) = bytes.get(start..).filter(|rest| !rest.is_empty()) else {
            return false;
        };
        let length = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        self.take(length);
        true
    }

    fn line(&self) -> PhysicalLine<'_> {
        PhysicalLine {
            text: &self.text[self.line.clone()],
            cut: false,
            offset: self.line.start,
        }
    }

    fn ahead(&mut self) -> &str {
        self.text.get(self.next..).unwrap_or_default()
    }

    fn take(&mut self, length: usize) -> PhysicalLine<'_> {
        let end = self.text.len().min(self.next + length);
        self.line = self.next..end;
        self.next = end + line_end(&self.text.as_bytes()[end..]);
        Self::line(self)
    }
}

/// A position in a text as editors count it (Language Server Protocol, `Position`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub struct Utf16Position {
    /// The line, from 0.
    pub line: u32,
    /// The units of UTF-16 before it in the line.
    pub column: u32,
}

/// Beginnings of the lines of a text.
#[derive(Debug, Clone)]
pub struct LineIndex {
    starts: Vec<u32>,
    /// The number of the first line.
    pub(super) first: u32,
}

impl LineIndex {
    /// Indexes a text whose lines end in LF, CRLF or CR.
    pub fn new(text: &str) -> Self {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for at in memchr::memchr2_iter(b'\n', b'\r', bytes) {
            let crlf = bytes[at] == b'\r' && bytes.get(at + 1) == Some(&b'\n');
            if !crlf {
                starts.push(Span::new(at + 1, at + 1).start);
            }
        }
        Self { starts, first: 1 }
    }

    /// Returns the number of the line that holds a byte offset.
    pub fn line(&self, offset: u32) -> u32 {
        let before = self.starts.partition_point(|&start| start <= offset);
        let behind_first = u32::try_from(before.max(1) - 1).unwrap_or(u32::MAX);
        self.first.saturating_add(behind_first)
    }

    /// Returns the span in `text` of the line with a number, without its line end.
    pub fn line_span(&self, text: &str, line: u32) -> Span {
        let index = line.saturating_sub(self.first) as usize;
        let Some(&start) = self.starts.get(index) else {
            return Span::new(text.len(), text.len());
        };
        let end = self
            .starts
            .get(index + 1)
            .map_or(text.len(), |&next| next as usize);
        let line = text.get(start as usize..end).unwrap_or_default();
        let trimmed = line.trim_end_matches(['\r', '\n']);
        Span::new(start as usize, start as usize + trimmed.len())
    }

    /// Returns the position of a byte offset of `text` as editors count it: the line from 0, the column from 0 in units
    /// of UTF-16. An offset inside a character is that of its beginning, one past the end of the line its end.
    pub fn utf16_position(&self, text: &str, offset: u32) -> Utf16Position {
        let line = self.line(offset);
        let span = self.line_span(text, line);
        let before = span.of(text).char_indices().take_while(|(at, letter)| {
            let end = span.start as usize + at + letter.len_utf8();
            end <= offset as usize
        });
        let column: usize = before.map(|(_, letter)| letter.len_utf16()).sum();
        Utf16Position {
            line: line.saturating_sub(self.first),
            column: u32::try_from(column).unwrap_or(u32::MAX),
        }
    }

    /// Returns the byte offset in `text` of a position of an editor. A column inside a character is that of its
    /// beginning, one past the end of the line its end; a line past the last is the end of the text.
    pub fn utf16_offset(&self, text: &str, position: Utf16Position) -> u32 {
        let span = self.line_span(text, self.first.saturating_add(position.line));
        let mut left = position.column;
        let inside = span.of(text).chars().take_while(|letter| {
            let units = u32::try_from(letter.len_utf16()).unwrap_or(u32::MAX);
            let fits = units <= left;
            left = left.saturating_sub(units);
            fits
        });
        let length: usize = inside.map(char::len_utf8).sum();
        Span::new(span.start as usize + length, text.len()).start
    }

    /// Returns the number of the first line: 1, unless the text is the rest of a longer one.
    pub fn first(&self) -> u32 {
        self.first
    }

    /// Returns the number of lines; a text without a line end has one.
    pub fn lines(&self) -> usize {
        self.starts.len()
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

    #[test]
    fn lines_end_in_any_manner() {
        // R2.1
        let mut lines = TextLines::new("\u{feff}a\r\nb\rc\n\nd");
        let mut found = Vec::new();
        while lines.advance() {
            found.push(lines.line().text.to_owned());
        }
        assert_eq!(found, ["a", "b", "c", "", "d"]);
    }

    #[test]
    fn editors_count_from_zero_in_units_of_utf_16() {
        let text = "X1\r\n(\u{dc}\u{1f600}) Y2\rZ";
        let index = LineIndex::new(text);
        let at = |offset| {
            let position = index.utf16_position(text, offset);
            (position.line, position.column)
        };
        assert_eq!([at(0), at(2), at(4)], [(0, 0), (0, 2), (1, 0)]);
        // The umlaut takes two bytes and one unit, the picture four bytes and two units.
        assert_eq!([at(5), at(7), at(11)], [(1, 1), (1, 2), (1, 4)]);
        assert_eq!([at(6), at(9)], [(1, 1), (1, 2)]);
        assert_eq!(
            [at(15), at(16), at(17), at(99)],
            [(1, 8), (2, 0), (2, 1), (2, 1)]
        );
        for (offset, _) in text.char_indices() {
            let offset = Span::new(offset, offset).start;
            // Inside a line end, an editor knows only the end of the line.
            if !matches!(text.as_bytes()[offset as usize], b'\n') {
                let position = index.utf16_position(text, offset);
                assert_eq!(index.utf16_offset(text, position), offset, "{position:?}");
            }
        }
        let back = |line, column| index.utf16_offset(text, Utf16Position { line, column });
        // In the middle of the picture, after the line, after the text.
        assert_eq!([back(1, 3), back(0, 9), back(7, 0)], [7, 2, 17]);
    }

    #[test]
    fn the_rest_of_a_longer_text_begins_at_its_own_line() {
        let text = "X1\nY2";
        let mut index = LineIndex::new(text);
        index.first = 100;
        let position = index.utf16_position(text, 4);
        assert_eq!(position, Utf16Position { line: 1, column: 1 });
        assert_eq!(index.utf16_offset(text, position), 4);
    }
}
