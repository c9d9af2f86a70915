//! The lines of a file of any size, in a buffer of one size.

use std::io::{self, Read};

use encoding_rs::WINDOWS_1252;

use crate::source::{LineSource, PhysicalLine};

/// Bytes that are read at once.
const BUFFER: usize = 256 * 1024;

/// A block is at most so long (R2.4 takes a line up to here); one more shows that it is longer.
const LONGEST: usize = 4000;

/// So many bytes hold at least one character more than the longest line.
const KEPT: usize = 4 * (LONGEST + 1);

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Reads lines without keeping them.
///
/// A line that is not UTF-8 is taken as code page 1252, and so is every later line of the same
/// file that is not ASCII.
pub(super) struct LineReader<R> {
    reader: R,
    buffer: Vec<u8>,
    /// The bytes that were read and not given yet.
    start: usize,
    end: usize,
    at_end: bool,
    /// The last line ended in CR; an LF that follows belongs to it.
    after_cr: bool,
    legacy: bool,
    decoded: String,
    /// The line that was given last stands in `decoded`.
    is_decoded: bool,
    /// The line that was given last.
    found: Found,
    failure: Option<io::Error>,
}

/// Where a line lies in the buffer.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    start: usize,
    end: usize,
    cut: bool,
}

impl<R: Read> LineReader<R> {
    /// The lines of a reader; a byte order mark at its start is passed over.
    pub(super) fn new(reader: R) -> Self {
        let mut lines = Self {
            reader,
            buffer: vec![0; BUFFER],
            start: 0,
            end: 0,
            at_end: false,
            after_cr: false,
            legacy: false,
            decoded: String::new(),
            is_decoded: false,
            found: Found::default(),
            failure: None,
        };
        while lines.end < BYTE_ORDER_MARK.len() && lines.fill() {}
        if lines.buffer[..lines.end].starts_with(BYTE_ORDER_MARK) {
            lines.start = BYTE_ORDER_MARK.len();
        }
        lines
    }

    /// The error that ended the lines before the end of the file.
    pub(super) fn take_failure(&mut self) -> Option<io::Error> {
        self.failure.take()
    }

    /// Reads more behind what is there. `false` when there is no more, or no room.
    fn fill(&mut self) -> bool {
        if self.at_end {
            return false;
        }
        if self.start > 0 && self.end == self.buffer.len() {
            self.buffer.copy_within(self.start..self.end, 0);
            self.end -= self.start;
            self.start = 0;
        }
        loop {
            match self.reader.read(&mut self.buffer[self.end..]) {
                Ok(0) => {
                    self.at_end = self.end < self.buffer.len();
                    return false;
                }
                Ok(count) => {
                    self.end += count;
                    return true;
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.failure = Some(error);
                    self.at_end = true;
                    return false;
                }
            }
        }
    }

    fn skip_line_feed(&mut self) {
        if !self.after_cr {
            return;
        }
        if self.start < self.end || self.fill() {
            self.after_cr = false;
            if self.buffer[self.start] == b'\n' {
                self.start += 1;
            }
        }
    }

    fn find(&mut self) -> Option<Found> {
        self.skip_line_feed();
        let mut searched = 0;
        loop {
            let rest = &self.buffer[self.start + searched..self.end];
            if let Some(at) = memchr::memchr2(b'\n', b'\r', rest) {
                let found = Found {
                    start: self.start,
                    end: self.start + searched + at,
                    cut: false,
                };
                self.after_cr = self.buffer[found.end] == b'\r';
                self.start = found.end + 1;
                return Some(found);
            }
            searched = self.end - self.start;
            if searched >= BUFFER / 2 {
                return Some(self.cut());
            }
            if !self.fill() {
                break;
            }
        }
        if self.failure.is_some() || self.start == self.end {
            return None;
        }
        let found = Found {
            start: self.start,
            end: self.end,
            cut: false,
        };
        self.start = self.end;
        Some(found)
    }

    /// Keeps the beginning of a line that has no end in sight, and passes over the rest.
    fn cut(&mut self) -> Found {
        self.buffer.copy_within(self.start..self.start + KEPT, 0);
        self.end = KEPT;
        loop {
            self.start = KEPT;
            self.end = KEPT;
            if !self.fill() {
                break;
            }
            let rest = &self.buffer[self.start..self.end];
            if let Some(at) = memchr::memchr2(b'\n', b'\r', rest) {
                self.after_cr = rest[at] == b'\r';
                self.start += at + 1;
                break;
            }
        }
        Found {
            start: 0,
            end: KEPT,
            cut: true,
        }
    }

    /// Decodes the line into `decoded` where it is not UTF-8, and cuts it where it is too long.
    fn decode(&mut self, mut found: Found) {
        if found.end - found.start > KEPT {
            found.end = found.start + KEPT;
            found.cut = true;
        }
        if found.cut {
            found.end = found.start + whole_characters(&self.buffer[found.start..found.end]).len();
        }
        let bytes = &self.buffer[found.start..found.end];
        self.is_decoded = match std::str::from_utf8(bytes) {
            Ok(text) => self.legacy && !text.is_ascii(),
            Err(_) => true,
        };
        if self.is_decoded {
            self.legacy = true;
            self.decoded.clear();
            // A byte of this code page has at most three bytes in UTF-8.
            self.decoded.reserve(bytes.len() * 3 + 16);
            let mut decoder = WINDOWS_1252.new_decoder_without_bom_handling();
            let _ = decoder.decode_to_string(bytes, &mut self.decoded, true);
        }
        self.found = found;
        let text = self.text();
        if text.len() > LONGEST {
            let end = text.char_indices().nth(LONGEST + 1).map(|(end, _)| end);
            let cut = end.is_some() || text.chars().count() > LONGEST;
            if let Some(end) = end {
                if self.is_decoded {
                    self.decoded.truncate(end);
                } else {
                    self.found.end = self.found.start + end;
                }
            }
            self.found.cut |= cut;
        }
    }

    fn text(&self) -> &str {
        if self.is_decoded {
            &self.decoded
        } else {
            let bytes = &self.buffer[self.found.start..self.found.end];
            std::str::from_utf8(bytes).unwrap_or_default()
        }
    }
}

impl<R: Read> LineSource for LineReader<R> {
    fn advance(&mut self) -> bool {
        match self.find() {
            Some(found) => {
                self.decode(found);
                true
            }
            None => false,
        }
    }

    fn line(&self) -> PhysicalLine<'_> {
        PhysicalLine {
            text: self.text(),
            cut: self.found.cut,
        }
    }
}

/// Bytes without a character that was cut at their end.
fn whole_characters(bytes: &[u8]) -> &[u8] {
    match std::str::from_utf8(bytes) {
        Err(error) if error.error_len().is_none() => &bytes[..error.valid_up_to()],
        _ => bytes,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::source::TextLines;

    /// Gives its bytes in pieces of one size.
    struct Pieces<'a>(&'a [u8], usize);

    impl Read for Pieces<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = self.1.min(self.0.len()).min(buffer.len());
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    fn lines(source: &mut dyn LineSource) -> Vec<(String, bool)> {
        let mut found = Vec::new();
        while let Some(line) = source.next_line() {
            found.push((line.text.to_owned(), line.cut));
        }
        found
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn the_same_lines_as_from_memory(
            parts in prop::collection::vec("[a-zÜ軸 ]{0,9}(\n|\r|\r\n|)", 0..40),
            piece in 1usize..20,
        ) {
            let text = parts.concat();
            let mut reader = LineReader::new(Pieces(text.as_bytes(), piece));
            prop_assert_eq!(lines(&mut reader), lines(&mut TextLines::new(&text)));
        }
    }

    #[test]
    fn big_files_pass_through_the_one_buffer() {
        let line = "N10 G01 X1.5 Y2.5 (Ü)";
        let text = format!("{line}\r\n").repeat(40_000);
        let mut reader = LineReader::new(Pieces(text.as_bytes(), 100_003));
        let mut count = 0;
        while let Some(found) = reader.next_line() {
            assert_eq!(found.text, line);
            count += 1;
        }
        assert_eq!(count, 40_000);
    }

    #[test]
    fn a_line_beyond_the_limit_is_cut() {
        for length in [3999, 4000, 4001, 4002, 20_000, 300_000, 900_000] {
            let text = format!("A\n{}\r\nB", "Ü".repeat(length));
            let mut reader = LineReader::new(text.as_bytes());
            let found = lines(&mut reader);
            assert_eq!(found.len(), 3, "{length}");
            assert_eq!(found[1].0.chars().count(), length.min(4001), "{length}");
            assert_eq!(found[1].1, length > 4000, "{length}");
            assert_eq!(found[2].0, "B", "{length}");
        }
    }

    #[test]
    fn old_files_are_code_page_1252() {
        // R2.2
        let bytes = b"\xef\xbb\xbfN1 (\xc3\x9c)\nN2 (\xdc)\nN3 (\xc3\x9c)\nN4";
        let found = lines(&mut LineReader::new(&bytes[..]));
        let texts: Vec<&str> = found.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(texts, ["N1 (Ü)", "N2 (Ü)", "N3 (Ãœ)", "N4"]);
    }

    #[test]
    fn an_error_ends_the_lines_and_is_kept() {
        struct Broken;
        impl Read for Broken {
            fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
                Err(io::ErrorKind::TimedOut.into())
            }
        }
        let mut reader = LineReader::new(b"N1\nN2".chain(Broken));
        assert_eq!(lines(&mut reader), [("N1".to_owned(), false)]);
        assert_eq!(
            reader.take_failure().map(|error| error.kind()),
            Some(io::ErrorKind::TimedOut)
        );
    }
}
