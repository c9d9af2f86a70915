//! Text and places in it: spans, lines and columns, physical lines one after another.
//!
//! Nothing here knows what an NC block or a list entry is. Offsets are bytes in UTF-8 text; lines
//! and columns are made only when something is printed.

use std::fmt;

use serde::{Deserialize, Serialize};

const BYTE_ORDER_MARK: char = '\u{feff}';

/// A range of bytes in a text, `start..end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct Span {
    /// Offset of the first byte.
    pub start: u32,
    /// Offset behind the last byte.
    pub end: u32,
}

impl Span {
    /// A span from byte offsets. Offsets beyond 4 GiB are clamped, no text of that size is kept.
    #[inline]
    pub fn new(start: usize, end: usize) -> Self {
        let clamp = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Self {
            start: clamp(start),
            end: clamp(end.max(start)),
        }
    }

    /// The part of `text` that the span covers, empty when it lies outside.
    pub fn of(self, text: &str) -> &str {
        text.get(self.range()).unwrap_or_default()
    }

    /// The span as a range of indices.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }

    /// The smallest span that covers both.
    pub fn to(self, other: Self) -> Self {
        Self {
            start: self.start.min(other.start),
            end: self.end.max(other.end),
        }
    }

    /// The span moved towards the end of the text by `offset` bytes.
    pub fn shifted(self, offset: u32) -> Self {
        Self {
            start: self.start.saturating_add(offset),
            end: self.end.saturating_add(offset),
        }
    }
}

/// A line and a column for people: both count from 1, columns count characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Position {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Where the lines of a text begin.
#[derive(Debug, Clone)]
pub struct LineIndex {
    starts: Vec<u32>,
    /// The number of the first line.
    first: u32,
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

    /// The number of the line that holds a byte offset.
    pub fn line(&self, offset: u32) -> u32 {
        let before = self.starts.partition_point(|&start| start <= offset);
        let behind_first = u32::try_from(before.max(1) - 1).unwrap_or(u32::MAX);
        self.first.saturating_add(behind_first)
    }

    /// The span in `text` of the line with a number, without its line end.
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

    /// The number of the first line: 1, unless the text is the rest of a longer one.
    pub fn first(&self) -> u32 {
        self.first
    }

    /// How many lines the text has; a text without any line end has one.
    pub fn lines(&self) -> usize {
        self.starts.len()
    }
}

/// A named text in memory with its line index.
#[derive(Debug, Clone)]
pub struct SourceFile {
    name: std::sync::Arc<str>,
    text: std::sync::Arc<String>,
    lines: LineIndex,
}

impl SourceFile {
    /// A source under the name that diagnostics and records show. A byte order mark at the start
    /// of the text is no part of it.
    pub fn new(name: impl Into<std::sync::Arc<str>>, text: impl Into<String>) -> Self {
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

    /// The same text as the rest of a longer one, whose first line here has a number there.
    pub fn from_line(mut self, first: u32) -> Self {
        self.lines.first = first;
        self
    }

    /// The name that diagnostics and records show.
    pub fn name(&self) -> &std::sync::Arc<str> {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The whole text, for who keeps it beside the file.
    pub(crate) fn shared_text(&self) -> std::sync::Arc<String> {
        self.text.clone()
    }

    /// The line index of the text.
    pub fn lines(&self) -> &LineIndex {
        &self.lines
    }

    /// The place of a span in this file, showing the lines that it touches.
    pub fn place(&self, span: Span) -> crate::diagnostic::Place {
        let first_line = self.lines.line(span.start);
        let last_line = self.lines.line(span.end.max(span.start + 1) - 1);
        let lines = self
            .lines
            .line_span(&self.text, first_line)
            .to(self.lines.line_span(&self.text, last_line));
        // A span that goes on behind the end of its last line ends with it.
        let inside = |offset: u32| offset.clamp(lines.start, lines.end) - lines.start;
        crate::diagnostic::Place {
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

/// A line of text without its line end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PhysicalLine<'a> {
    /// The characters of the line.
    pub text: &'a str,
    /// Whether characters were left out because the line is longer than any block may be.
    pub cut: bool,
    /// Where the line begins, in bytes from the start of the text; 0 for a stream, to which nobody
    /// goes back.
    pub offset: usize,
}

/// How many bytes the line end takes that a text begins with: LF, CRLF, CR, or none at the end.
pub(crate) fn line_end(text: &[u8]) -> usize {
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

    /// The line that [`advance`](Self::advance) went to.
    fn line(&self) -> PhysicalLine<'_>;

    /// The lines to come that are at hand, each whole and with its end; none at the end of the text.
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
    /// The lines of `text`. A byte order mark at its start is passed over.
    pub fn new(text: &'a str) -> Self {
        let start = text.len() - text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text).len();
        Self::starting_at(text, start)
    }

    /// The lines of `text` from a byte offset on, which begins a line.
    pub fn starting_at(text: &'a str, offset: usize) -> Self {
        Self {
            text,
            line: 0..0,
            next: offset,
        }
    }
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

/// Looks through the bytes of a program, piece by piece, for anything that needs the whole text at
/// once: a `$` statement, `#IF`, a local subprogram (`%L name`), a part of the program (`L SEQUENCE`).
#[derive(Debug, Clone, Default)]
pub struct FlowScan {
    found: bool,
}

impl FlowScan {
    /// Looks through the next piece.
    pub fn feed(&mut self, piece: &[u8]) {
        let mut from = 0;
        while !self.found {
            let found = memchr::memchr3(b'$', b'%', b'Q', &piece[from..]);
            let Some(at) = found.map(|at| from + at) else {
                break;
            };
            self.found = match piece[at] {
                b'$' => true,
                b'%' => Self::opens_subprogram(&piece[at + 1..]),
                _ => Self::calls_part(&piece[..at], &piece[at + 1..]),
            };
            from = at + 1;
        }
        // Three bytes are found at once, a fourth is not.
        let mut commands = memchr::memchr_iter(b'#', piece);
        self.found |= commands.any(|at| Self::opens_branch(&piece[at + 1..]));
    }

    /// Whether the whole text is needed.
    pub fn needs_whole_text(&self) -> bool {
        self.found
    }

    /// The word `SEQUENCE` around its `Q`; what lies in another piece is taken as fitting. In lower
    /// case it is rare, and said where a block of it was not kept.
    fn calls_part(before: &[u8], after: &[u8]) -> bool {
        let before = before.iter().rev().zip(b"ES");
        let after = after.iter().zip(b"UENCE");
        before
            .chain(after)
            .all(|(found, wanted)| found.eq_ignore_ascii_case(wanted))
    }

    /// `#IF`; a piece that ends before that is taken as one.
    fn opens_branch(behind: &[u8]) -> bool {
        let letters = behind.iter().zip(b"IF");
        letters
            .into_iter()
            .all(|(found, letter)| found.eq_ignore_ascii_case(letter))
    }

    /// `%L` with a separator behind it; a piece that ends before that is taken as one.
    fn opens_subprogram(behind: &[u8]) -> bool {
        let mut rest = behind
            .iter()
            .skip_while(|byte| matches!(byte, b' ' | b'\t'));
        match (rest.next(), rest.next()) {
            (None, _) | (Some(b'L' | b'l'), None) => true,
            (Some(b'L' | b'l'), Some(next)) => matches!(next, b' ' | b'\t'),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_place_ends_with_its_last_line() {
        let file = SourceFile::new("a.nc", "N1 X\r\r\rY");
        for (start, end, text, span) in [(3, 6, "N1 X\r", (3, 5)), (4, 5, "N1 X", (4, 4))] {
            let place = file.place(Span::new(start, end));
            assert_eq!(&*place.text, text);
            assert_eq!(place.span, Span::new(span.0, span.1));
        }
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
