//! Decoding of files: UTF-8, the code page 1252 of old systems, or UTF-16.

use encoding_rs::{Encoding, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// Returns the text of a file, decoded like a stream of its lines. A byte order mark at its start is passed
/// over.
pub fn decode(bytes: Vec<u8>) -> String {
    if let Some(text) = decode_wide(&bytes) {
        return text;
    }
    let mut text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let mut text = String::with_capacity(error.as_bytes().len());
            decode_lines(error.as_bytes(), &mut false, &mut text);
            text
        }
    };
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    text
}

/// Decodes bytes in UTF-16.
fn decode_wide(bytes: &[u8]) -> Option<String> {
    let (encoding, mark) = wide(bytes)?;
    let (text, _) = encoding.decode_without_bom_handling(&bytes[mark..]);
    Some(text.into_owned())
}

/// Returns the UTF-16 encoding of a text, as Notepad and PowerShell write it, and the length of its byte order mark.
/// If an editor has left the mark out, the zeros in two letters decide: no other text of letters begins
/// with them.
pub(crate) fn wide(bytes: &[u8]) -> Option<(&'static Encoding, usize)> {
    match bytes {
        [0xff, 0xfe, ..] => Some((UTF_16LE, 2)),
        [0xfe, 0xff, ..] => Some((UTF_16BE, 2)),
        [1..=0xff, 0, 1..=0xff, 0, ..] => Some((UTF_16LE, 0)),
        [0, 1..=0xff, 0, 1..=0xff, ..] => Some((UTF_16BE, 0)),
        _ => None,
    }
}

/// Returns a line in UTF-8; `None` where it is in code page 1252.
pub(crate) fn utf8_line<'a>(line: &'a [u8], legacy: &mut bool) -> Option<&'a str> {
    let utf8 = std::str::from_utf8(line).ok();
    let utf8 = utf8.filter(|line| !*legacy || line.is_ascii());
    *legacy |= utf8.is_none();
    utf8
}

/// Appends whole lines in UTF-8. The first line that is not UTF-8 is taken as code page 1252, and so is
/// every later one that is not ASCII.
pub(crate) fn decode_lines(bytes: &[u8], legacy: &mut bool, text: &mut String) {
    match std::str::from_utf8(bytes) {
        Ok(all) if !*legacy || all.is_ascii() => text.push_str(all),
        _ => {
            for line in bytes.split_inclusive(|byte| matches!(byte, b'\n' | b'\r')) {
                if let Some(line) = utf8_line(line, legacy) {
                    text.push_str(line);
                } else {
                    let (line, _) = WINDOWS_1252.decode_without_bom_handling(line);
                    text.push_str(&line);
                }
            }
        }
    }
}
