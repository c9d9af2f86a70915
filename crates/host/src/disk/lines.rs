//! The lines of a file of any size, in a buffer of fixed size.

use std::io::{self, Read, Seek};
use std::ops::Range;

use super::decode::{decode_lines, wide};
use super::read::{MOST_KEPT, too_big};
use frictcomp::syntax::{FlowScan, MAX_LINE};
use frictcomp::text::{LineSource, PhysicalLine, line_end};

/// Number of bytes read at once.
const BUFFER: usize = 128 * 1024;

/// Number of bytes with at least one character more than the longest line.
const KEPT: usize = 4 * (MAX_LINE + 1);

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Number of bytes that show UTF-16 without a byte order mark: one of them is zero.
const TELLING: usize = 4;

/// Form of line ends.
#[derive(Debug, Clone, Copy)]
enum LineEnds {
    /// LF, CRLF or CR.
    Any,
    /// LF only; one byte is found faster than two.
    Lf,
}

/// Reads lines without keeping them: as many whole lines as the buffer holds are decoded at once.
///
/// A line that is not UTF-8 is taken as code page 1252, and so is every later line of the same
/// file that is not ASCII.
pub(crate) struct LineReader<R> {
    reader: R,
    buffer: Vec<u8>,
    /// The bytes read but not decoded yet.
    unread: Range<usize>,
    at_end: bool,
    legacy: bool,
    /// Whole lines, decoded.
    text: String,
    /// The last line returned, in `text`.
    line: Range<usize>,
    /// Whether that line was cut.
    cut: bool,
    /// Offset of the next line in `text`.
    next: usize,
    /// Form of the line ends in `text`.
    ends: LineEnds,
    failure: Option<io::Error>,
    /// Limit of the bytes kept of the lines to come.
    most_kept: usize,
}

impl<R: Read> LineReader<R> {
    /// Reads the lines of a reader; a byte order mark at its start is passed over.
    pub(crate) fn new(reader: R) -> Self {
        Self::with_buffer(reader, BUFFER)
    }

    /// Reads the lines of a reader of known length. A short one gets a small buffer: large ones for each of
    /// many files would be returned to the system in between, which takes longer than reading
    /// them.
    pub(crate) fn of_length(reader: R, length: u64) -> Self {
        let length = usize::try_from(length).unwrap_or(BUFFER);
        Self::with_buffer(reader, length.saturating_add(1).clamp(KEPT, BUFFER))
    }

    fn with_buffer(reader: R, size: usize) -> Self {
        let mut lines = Self {
            reader,
            buffer: vec![0; size],
            unread: 0..0,
            at_end: false,
            legacy: false,
            text: String::with_capacity(size),
            line: 0..0,
            cut: false,
            next: 0,
            ends: LineEnds::Any,
            failure: None,
            most_kept: MOST_KEPT,
        };
        while lines.is_undecided() && !lines.at_end {
            lines.fill();
        }
        if lines.buffer[lines.unread.clone()].starts_with(BYTE_ORDER_MARK) {
            lines.unread.start += BYTE_ORDER_MARK.len();
        }
        lines
    }

    /// Returns whether more bytes are needed to find how the text is encoded.
    fn is_undecided(&self) -> bool {
        let first = &self.buffer[self.unread.clone()];
        first.len() < BYTE_ORDER_MARK.len() || first.len() < TELLING && first.contains(&0)
    }

    /// Returns whether the text is UTF-16.
    pub(crate) fn is_wide(&self) -> bool {
        wide(&self.buffer[self.unread.clone()]).is_some()
    }

    /// Checks that a text can be passed on as it arrives.
    ///
    /// # Errors
    /// It is UTF-16.
    pub(crate) fn narrow(&self) -> io::Result<()> {
        if self.is_wide() {
            let reason = "it is UTF-16, which is not read from a pipe; save it as UTF-8";
            return Err(io::Error::other(reason));
        }
        Ok(())
    }

    /// Returns the reader at its current position.
    pub(crate) fn into_reader(self) -> R {
        self.reader
    }

    /// Boxes the reader, so that all kinds have one type.
    pub(crate) fn boxed<'a>(self) -> LineReader<Box<dyn Read + 'a>>
    where
        R: 'a,
    {
        LineReader {
            reader: Box::new(self.reader),
            buffer: self.buffer,
            unread: self.unread,
            at_end: self.at_end,
            legacy: self.legacy,
            text: self.text,
            line: self.line,
            cut: self.cut,
            next: self.next,
            ends: self.ends,
            failure: self.failure,
            most_kept: self.most_kept,
        }
    }

    /// Returns the error that ended the lines before the end of the file.
    pub(crate) fn take_failure(&mut self) -> Option<io::Error> {
        self.failure.take()
    }

    /// Reads once more after the unread bytes; there must be room.
    fn fill(&mut self) {
        self.buffer.copy_within(self.unread.clone(), 0);
        self.unread = 0..self.unread.len();
        loop {
            match self.reader.read(&mut self.buffer[self.unread.end..]) {
                Ok(0) => self.at_end = true,
                Ok(count) => self.unread.end += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => {
                    self.failure = Some(error);
                    self.at_end = true;
                }
            }
            return;
        }
    }

    /// Decodes the next whole lines into `text`. `false` when there are none.
    fn refill(&mut self) -> bool {
        self.next = 0;
        let has_line = self.decode_lines();
        self.ends = match memchr::memchr(b'\r', self.text.as_bytes()) {
            Some(_) => LineEnds::Any,
            None => LineEnds::Lf,
        };
        has_line
    }

    fn decode_lines(&mut self) -> bool {
        loop {
            let whole = self.whole_lines();
            if whole > 0 {
                self.decode(whole);
                return true;
            }
            if self.at_end {
                self.text.clear();
                return false;
            }
            if self.unread.len() == self.buffer.len() {
                // The beginning of a line without an end so far.
                self.decode(whole_characters(&self.buffer[..KEPT]).len());
                self.skip_line();
                return true;
            }
            self.fill();
        }
    }

    /// Returns the number of unread bytes in whole lines. The last line of a file needs no end; the
    /// part of a line read before an error is not a line.
    fn whole_lines(&self) -> usize {
        let bytes = &self.buffer[self.unread.clone()];
        if self.at_end && self.failure.is_none() {
            return bytes.len();
        }
        // An LF that has not been read yet may belong to a CR at the end.
        let bytes = bytes.strip_suffix(b"\r").unwrap_or(bytes);
        memchr::memrchr2(b'\n', b'\r', bytes).map_or(0, |at| at + 1)
    }

    /// Decodes the next unread bytes into `text`.
    fn decode(&mut self, length: usize) {
        if self.unread.start == 0 && length > self.buffer.len() / 2 && !self.legacy {
            return self.exchange(length);
        }
        let end = self.unread.start + length;
        let bytes = &self.buffer[self.unread.start..end];
        self.unread.start = end;
        self.text.clear();
        decode_lines(bytes, &mut self.legacy, &mut self.text);
    }

    /// Makes the first bytes of the buffer the text, and the memory of the text the buffer, so that only the bytes
    /// after them are copied.
    fn exchange(&mut self, length: usize) {
        let mut buffer = std::mem::take(&mut self.text).into_bytes();
        buffer.resize(self.buffer.len(), 0);
        let rest = &self.buffer[length..self.unread.end];
        buffer[..rest.len()].copy_from_slice(rest);
        self.unread = 0..rest.len();
        let mut bytes = std::mem::replace(&mut self.buffer, buffer);
        bytes.truncate(length);
        match String::from_utf8(bytes) {
            Ok(text) => self.text = text,
            Err(error) => decode_lines(error.as_bytes(), &mut self.legacy, &mut self.text),
        }
    }

    /// Skips the rest of a line and its end.
    fn skip_line(&mut self) {
        loop {
            let bytes = &self.buffer[self.unread.clone()];
            let at = memchr::memchr2(b'\n', b'\r', bytes).unwrap_or(bytes.len());
            let end = match &bytes[at..] {
                [b'\r', b'\n', ..] => Some(2),
                [b'\r'] | [] => None,
                [_, ..] => Some(1),
            };
            self.unread.start += at;
            if let Some(end) = end {
                self.unread.start += end;
                return;
            }
            if self.at_end {
                self.unread.start = self.unread.end;
                return;
            }
            self.fill();
        }
    }

    /// Shortens a line that may have too many characters to one more than it may have.
    fn shorten(&mut self) {
        let text = &self.text[self.line.clone()];
        self.cut = text.chars().nth(MAX_LINE).is_some();
        if let Some((end, _)) = text.char_indices().nth(MAX_LINE + 1) {
            self.line.end = self.line.start + end;
        }
    }
}

impl<R: Read + Seek> LineReader<R> {
    /// Scans all lines to come, and returns to the current position. What fits into the buffer is read once.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(crate) fn scan(&mut self) -> io::Result<FlowScan> {
        let mut scan = FlowScan::default();
        while self.unread.len() < self.buffer.len() && !self.at_end {
            self.fill();
        }
        scan.feed(&self.buffer[self.unread.clone()]);
        if self.at_end || scan.needs_whole_text() {
            return Ok(scan);
        }
        let here = self.reader.stream_position()?;
        let mut piece = vec![0; BUFFER];
        while !scan.needs_whole_text() {
            match self.reader.read(&mut piece) {
                Ok(0) => break,
                Ok(count) => scan.feed(&piece[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        self.reader.seek(io::SeekFrom::Start(here))?;
        Ok(scan)
    }
}

impl<R: Read> LineSource for LineReader<R> {
    fn advance(&mut self) -> bool {
        if self.next == self.text.len() && !self.refill() {
            return false;
        }
        let rest = &self.text.as_bytes()[self.next..];
        let found = match self.ends {
            LineEnds::Any => memchr::memchr2(b'\n', b'\r', rest),
            LineEnds::Lf => memchr::memchr(b'\n', rest),
        };
        let length = found.unwrap_or(rest.len());
        self.take(length);
        if length > MAX_LINE {
            self.shorten();
        }
        true
    }

    fn ahead(&mut self) -> &str {
        if self.next == self.text.len() {
            self.refill();
        }
        &self.text[self.next..]
    }

    fn take(&mut self, length: usize) -> PhysicalLine<'_> {
        let end = self.text.len().min(self.next + length);
        self.line = self.next..end;
        self.next = end + line_end(&self.text.as_bytes()[end..]);
        self.cut = false;
        Self::line(self)
    }

    fn line(&self) -> PhysicalLine<'_> {
        PhysicalLine {
            text: &self.text[self.line.clone()],
            cut: self.cut,
            offset: 0,
        }
    }

    fn append_rest(&mut self, text: &mut String) {
        while self.advance() {
            text.push_str(self.line().text);
            text.push('\n');
            if text.len() > self.most_kept {
                self.failure = Some(too_big());
                return;
            }
        }
    }
}

/// Returns bytes without a character that was cut at their end.
fn whole_characters(bytes: &[u8]) -> &[u8] {
    match std::str::from_utf8(bytes) {
        Err(error) if error.error_len().is_none() => &bytes[..error.valid_up_to()],
        _ => bytes,
    }
}

/// Number of bytes examined together.
const PIECE: usize = 256 * 1024;

/// Passes on all of a text, in pieces that end with a line. A line that fills a piece is cut.
///
/// # Errors
/// The text cannot be read.
pub(crate) fn whole_lines(mut text: impl Read, mut look: impl FnMut(&[u8])) -> io::Result<()> {
    let mut piece = vec![0; PIECE];
    let mut kept = 0;
    loop {
        let count = match text.read(&mut piece[kept..]) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            count => count?,
        };
        let bytes = &piece[..kept + count];
        let whole = match memchr::memrchr2(b'\n', b'\r', bytes) {
            Some(at) if count > 0 => at + 1,
            // A line that is cut is examined with the next piece, unless it fills this one.
            _ if count > 0 && bytes.len() < PIECE => 0,
            _ => bytes.len(),
        };
        look(&bytes[..whole]);
        if count == 0 {
            return Ok(());
        }
        let rest = whole..kept + count;
        kept = rest.len();
        piece.copy_within(rest, 0);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use frictcomp::text::TextLines;

    /// Returns its bytes in pieces of one size.
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
        while source.advance() {
            let line = source.line();
            found.push((line.text.to_owned(), line.cut));
        }
        found
    }

    /// Returns the lines, each found in the text that is ahead.
    fn lines_ahead(source: &mut dyn LineSource) -> Vec<(String, bool)> {
        let mut found = Vec::new();
        loop {
            let ahead = source.ahead();
            if ahead.is_empty() {
                return found;
            }
            let length = ahead.find(['\n', '\r']).unwrap_or(ahead.len());
            let line = source.take(length);
            found.push((line.text.to_owned(), line.cut));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn the_same_lines_as_from_memory(
            parts in prop::collection::vec("[a-zÜ軸 ]{0,9}(\n|\r|\r\n|)", 0..40),
            piece in 1usize..20,
        ) {
            let text = parts.concat();
            let reader = || LineReader::new(Pieces(text.as_bytes(), piece));
            let expected = lines(&mut TextLines::new(&text));
            prop_assert_eq!(&lines_ahead(&mut TextLines::new(&text)), &expected);
            prop_assert_eq!(&lines(&mut reader()), &expected);
            prop_assert_eq!(&lines_ahead(&mut reader()), &expected);
        }
    }

    #[test]
    fn big_files_pass_through_the_one_buffer() {
        let line = "N10 G01 X1.5 Y2.5 (Ü)";
        let text = format!("{line}\r\n").repeat(40_000);
        let mut reader = LineReader::new(Pieces(text.as_bytes(), 100_003));
        let mut count = 0;
        while reader.advance() {
            assert_eq!(reader.line().text, line);
            count += 1;
        }
        assert_eq!(count, 40_000);
    }

    #[test]
    fn a_look_ahead_loses_no_line() {
        for lines in [1, 5_000, 40_000] {
            let text = "N10 G01 X1.5 Y2.5\n".repeat(lines);
            let tool = "M30 (L 100) ; L 20";
            for (behind, found) in [(tool, false), ("$IF 1", true), ("N9 L a.nc", true)] {
                let text = format!("\u{feff}{text}{behind}");
                let mut reader = LineReader::new(io::Cursor::new(text.as_bytes()));
                assert_eq!(reader.scan().unwrap().needs_whole_text(), found);
                let mut count = 0;
                while reader.advance() {
                    count += 1;
                }
                assert!(found || count == lines + 1, "{lines}");
            }
        }
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
    fn a_file_is_decoded_as_its_lines_are() {
        // R2.1
        let bytes = b"\xef\xbb\xbfN1\n\xef\xbb\xbfN2 (\xc3\x9c)\rN3 (\xdc)\r\nN4 (\xc3\x9c)\n";
        let whole = crate::disk::decode(bytes.to_vec());
        let streamed = lines(&mut LineReader::new(&bytes[..]));
        assert_eq!(lines(&mut TextLines::new(&whole)), streamed);
        assert_eq!(streamed[1].0, "\u{feff}N2 (\u{dc})");

        let parts: [&[u8]; 2] = [b"N1 (\xc3\x9c)\n", b"N2 (\xdc)\r\nN3 (\xc3\x9c)\nN4\n"];
        let bytes = parts.map(|part| part.repeat(40_000)).concat();
        let whole = crate::disk::decode(bytes.clone());
        let streamed = lines(&mut LineReader::new(&bytes[..]));
        assert_eq!(lines(&mut TextLines::new(&whole)), streamed);
    }

    #[test]
    fn what_has_no_end_is_not_kept() {
        let mut reader = LineReader::new(io::repeat(b'\n'));
        reader.most_kept = 1000;
        let mut text = String::new();
        reader.append_rest(&mut text);
        assert_eq!(text.len(), 1001);
        let failure = reader.take_failure().map(|error| error.kind());
        assert_eq!(failure, Some(io::ErrorKind::FileTooLarge));
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
