//! A text with the bytes from which it was decoded, so that a change leaves all others as they are.

use std::ops::Range;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

use super::decode::{decode, utf8_line, wide};

/// A text with the bytes of its file.
#[derive(Debug, Clone)]
pub struct EncodedText {
    bytes: Vec<u8>,
    text: String,
    /// Lines of one code page, in their order; there is at least one entry.
    stretches: Vec<EncodedLines>,
}

/// A replacement that cannot be written in the code page of the file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the code page of the file has no way to write `{0}`")]
pub struct NotEncodable(pub String);

/// Lines of one code page.
#[derive(Debug, Clone, Copy)]
struct EncodedLines {
    page: &'static Encoding,
    /// Offset in the text.
    text: usize,
    /// Offset in the bytes.
    bytes: usize,
}

impl EncodedText {
    /// Creates the text of a file.
    pub fn new(bytes: Vec<u8>) -> Self {
        Self {
            text: decode(bytes.clone()),
            stretches: stretches(&bytes),
            bytes,
        }
    }

    /// Returns the text, without a byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the bytes of the file after replacements, which name ranges of the text from its start to its
    /// end and do not overlap. All other bytes stay as they are.
    ///
    /// # Errors
    /// A replacement cannot be written in the code page of the file.
    pub fn replaced<'a>(
        &self,
        replacements: impl IntoIterator<Item = (Range<usize>, &'a str)>,
    ) -> Result<Vec<u8>, NotEncodable> {
        let mut result = Vec::with_capacity(self.bytes.len());
        let mut copied = 0;
        for (range, text) in replacements {
            let (start, page) = self.offset(range.start);
            let (end, _) = self.offset(range.end);
            result.extend_from_slice(&self.bytes[copied..start]);
            append(text, page, &mut result)?;
            copied = end;
        }
        result.extend_from_slice(&self.bytes[copied..]);
        Ok(result)
    }

    /// Returns the offset in the bytes that corresponds to one in the text, and the code page there.
    fn offset(&self, at: usize) -> (usize, &'static Encoding) {
        let after = self.stretches.partition_point(|it| it.text <= at);
        let stretch = self.stretches[after.saturating_sub(1)];
        let before = &self.text[stretch.text..at];
        let length = if stretch.page == UTF_8 {
            before.len()
        } else if stretch.page == WINDOWS_1252 {
            before.chars().count()
        } else {
            2 * before.encode_utf16().count()
        };
        (stretch.bytes + length, stretch.page)
    }
}

/// Returns the code pages of the lines of a file, as [`decode`] takes them.
fn stretches(bytes: &[u8]) -> Vec<EncodedLines> {
    let stretch = |page, text, bytes| EncodedLines { page, text, bytes };
    if let Some((page, mark)) = wide(bytes) {
        return vec![stretch(page, 0, mark)];
    }
    let mark = Encoding::for_bom(bytes).map_or(0, |(_, mark)| mark);
    if std::str::from_utf8(bytes).is_ok() {
        return vec![stretch(UTF_8, 0, mark)];
    }
    let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
    // A byte order mark before a line of an old system does not count.
    let first = bytes.split(is_end).next().unwrap_or_default();
    let mark = std::str::from_utf8(first).map_or(0, |_| mark);
    let mut found = vec![stretch(UTF_8, 0, mark)];
    let (mut text, mut offset, mut legacy) = (0, mark, false);
    for line in bytes[mark..].split_inclusive(is_end) {
        let (page, length) = match utf8_line(line, &mut legacy) {
            Some(line) => (UTF_8, line.len()),
            None => (
                WINDOWS_1252,
                WINDOWS_1252.decode_without_bom_handling(line).0.len(),
            ),
        };
        // A line in ASCII fits either code page; a replacement in it takes that of the lines above.
        let page = if legacy { WINDOWS_1252 } else { page };
        if found.last().is_none_or(|last| last.page != page) {
            found.push(stretch(page, text, offset));
        }
        text += length;
        offset += line.len();
    }
    found
}

/// Appends a text in a code page.
fn append(text: &str, page: &'static Encoding, out: &mut Vec<u8>) -> Result<(), NotEncodable> {
    if page == UTF_16LE {
        out.extend(text.encode_utf16().flat_map(u16::to_le_bytes));
    } else if page == UTF_16BE {
        out.extend(text.encode_utf16().flat_map(u16::to_be_bytes));
    } else {
        let (bytes, _, is_lossy) = page.encode(text);
        if is_lossy {
            return Err(NotEncodable(text.to_owned()));
        }
        out.extend_from_slice(&bytes);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(bytes: &[u8], found: &str, text: &str) -> Result<Vec<u8>, NotEncodable> {
        let encoded = EncodedText::new(bytes.to_vec());
        let start = encoded.text().find(found).expect("it is there");
        let range = start..start + found.len();
        let mut expected = encoded.text().to_owned();
        expected.replace_range(range.clone(), text);
        let changed = encoded.replaced([(range, text)])?;
        assert_eq!(decode(changed.clone()), expected);
        Ok(changed)
    }

    #[test]
    fn nothing_but_the_replacement_changes() {
        // R9.82
        let cases: [(&[u8], &[u8]); 9] = [
            (b"(\xc3\x9c) on\r\n\xc3\x9c", b"(\xc3\x9c) ON\r\n\xc3\x9c"),
            (
                b"\xef\xbb\xbf(\xc3\x9c) on\r",
                b"\xef\xbb\xbf(\xc3\x9c) ON\r",
            ),
            // The first line is UTF-8, the others come from an old system.
            (
                b"(\xc3\x9c)\n(\xdc) X\r\n(\xc3\x9c) on \x81\xa0",
                b"(\xc3\x9c)\n(\xdc) X\r\n(\xc3\x9c) ON \x81\xa0",
            ),
            (b"\xef\xbb\xbfon\n\xdc\n", b"\xef\xbb\xbfON\n\xdc\n"),
            (b"\xef\xbb\xbf\xdc on\n", b"\xef\xbb\xbf\xdc ON\n"),
            (
                b"\xff\xfe(\0\xdc\0)\0o\0n\0\r\0\n\0",
                b"\xff\xfe(\0\xdc\0)\0O\0N\0\r\0\n\0",
            ),
            (
                b"\xfe\xff\xd8\x3d\xde\0\0o\0n",
                b"\xfe\xff\xd8\x3d\xde\0\0O\0N",
            ),
            // Without a byte order mark.
            (b"N\0 \0o\0n\0\xdc\0", b"N\0 \0O\0N\0\xdc\0"),
            (b"\0N\0 \0o\0n\0\xdc", b"\0N\0 \0O\0N\0\xdc"),
        ];
        for (before, after) in cases {
            let found = changed(before, "on", "ON");
            assert_eq!(found.as_deref(), Ok(after), "{before:?}");
        }
    }

    #[test]
    fn a_replacement_is_written_as_its_file_is() {
        // R9.82
        assert_eq!(
            changed(b"\xdc\non", "on", "\u{dc}"),
            Ok(b"\xdc\n\xdc".to_vec())
        );
        assert_eq!(
            changed(b"on\n\xdc", "on", "\u{dc}"),
            Ok(b"\xc3\x9c\n\xdc".to_vec())
        );
        assert_eq!(
            changed(b"\xdc on", "on", "\u{6f22}"),
            Err(NotEncodable("\u{6f22}".into()))
        );
    }
}
