//! Physical lines, one after another.

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

    /// The line that [`advance`](Self::advance) went to.
    fn line(&self) -> PhysicalLine<'_>;

    /// The following lines that are available, each whole and with its end; none at the end of the text.
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
    /// The lines of `text`. A byte order mark at its start is skipped.
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
}
