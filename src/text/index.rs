//! The beginnings of the lines of a text.

use super::span::Span;

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

    /// The position of a byte offset of `text` as editors count it: the line from 0, the column from
    /// 0 in units of UTF-16. An offset inside a character is that of its beginning, one past the end
    /// of the line its end.
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

    /// The byte offset in `text` of a position of an editor. A column inside a character is that of
    /// its beginning, one past the end of the line its end; a line past the last is the end of the
    /// text.
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

    /// The number of the first line: 1, unless the text is the rest of a longer one.
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
