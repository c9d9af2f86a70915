//! Positions as the client counts them (R12.1).

use gen_lsp_types::{ClientCapabilities, Position, PositionEncodingKind, Range};

use frictcomp::text::{LineIndex, Place};

/// Unit of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16, which every client supports.
    Utf16,
}

impl Encoding {
    /// Bytes if the client offers them, otherwise UTF-16.
    pub(super) fn negotiated(client: &ClientCapabilities) -> Self {
        let general = client.general.as_ref();
        let offered = general.and_then(|general| general.position_encodings.as_ref());
        let has_bytes = offered.is_some_and(|it| it.contains(&PositionEncodingKind::UTF8));
        if has_bytes { Self::Utf8 } else { Self::Utf16 }
    }

    /// Returns its name in the protocol.
    pub(super) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
        }
    }

    /// Returns the number of units of a character.
    fn units(self, letter: char) -> u32 {
        let units = match self {
            Self::Utf8 => letter.len_utf8(),
            Self::Utf16 => letter.len_utf16(),
        };
        u32::try_from(units).unwrap_or(u32::MAX)
    }

    /// Returns the column of a byte offset in a line; inside a character, that of its beginning.
    pub(super) fn column(self, line: &str, offset: usize) -> u32 {
        let letters = line.char_indices();
        let before = letters.take_while(|(at, letter)| at + letter.len_utf8() <= offset);
        before.map(|(_, letter)| self.units(letter)).sum()
    }

    /// Returns the byte offset of a column in a line: inside a character, that of its beginning; past the end of the
    /// line, its end.
    pub(super) fn offset(self, line: &str, column: u32) -> usize {
        let mut left = column;
        let before = line.chars().take_while(|letter| {
            let units = self.units(*letter);
            let fits = units <= left;
            left = left.saturating_sub(units);
            fits
        });
        before.map(char::len_utf8).sum()
    }

    /// Returns the position of a byte offset in a text.
    pub(super) fn position(self, text: &str, lines: &LineIndex, offset: u32) -> Position {
        let line = lines.line(offset);
        let span = lines.line_span(text, line);
        let inside = offset.saturating_sub(span.start) as usize;
        Position {
            line: line.saturating_sub(lines.first()),
            character: self.column(span.of(text), inside),
        }
    }

    /// Returns the byte offset of a position in a text; past its last line, its end.
    pub(super) fn place(self, text: &str, lines: &LineIndex, position: Position) -> usize {
        let span = lines.line_span(text, lines.first().saturating_add(position.line));
        span.start as usize + self.offset(span.of(text), position.character)
    }

    /// Returns the range of a place in the units of the client.
    pub(super) fn range(self, place: &Place) -> Range {
        let lines = LineIndex::new(&place.text);
        let at = |offset: u32| {
            let position = self.position(&place.text, &lines, offset);
            Position {
                line: position
                    .line
                    .saturating_add(place.first_line.saturating_sub(1)),
                ..position
            }
        };
        Range {
            start: at(place.span.start),
            end: at(place.span.end),
        }
    }
}

/// Returns the whole of a line, including its end.
pub(super) fn whole_line(line: u32) -> Range {
    let at = |line| Position { line, character: 0 };
    Range {
        start: at(line),
        end: at(line.saturating_add(1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::text::{SourceFile, Span};

    #[test]
    fn columns_count_what_was_agreed_on() {
        // R12.1
        let line = "(\u{dc}\u{1f600}) X";
        for (encoding, columns) in [
            (Encoding::Utf16, [0, 1, 1, 2, 2, 4, 5, 6, 7]),
            (Encoding::Utf8, [0, 1, 1, 3, 3, 7, 8, 9, 10]),
        ] {
            let offsets = [0, 1, 2, 3, 5, 7, 8, 9, 99];
            assert_eq!(offsets.map(|offset| encoding.column(line, offset)), columns);
            for (at, _) in line.char_indices() {
                assert_eq!(encoding.offset(line, encoding.column(line, at)), at);
            }
            assert_eq!(encoding.offset(line, 99), line.len());
        }
        assert_eq!(Encoding::Utf16.offset(line, 3), 3);
    }

    #[test]
    fn places_are_where_their_lines_are() {
        // R12.2
        let text = "N1\r\n(\u{dc}) X[COMP \\\r\nON]\rN3";
        let file = SourceFile::new("a.nc", text);
        for encoding in [Encoding::Utf8, Encoding::Utf16] {
            for (start, end) in [(0, 2), (8, 10), (4, 22), (19, 22), (23, 25)] {
                let range = encoding.range(&file.place(Span::new(start, end)));
                let back = |position| encoding.place(text, file.lines(), position);
                assert_eq!((back(range.start), back(range.end)), (start, end));
            }
        }
    }
}
