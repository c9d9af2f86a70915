//! What the parser does not see of a line: comments, continuation signs, block numbers of continued
//! lines and foreign characters are blanked out byte for byte.

use super::texts::Texts;
use crate::text::Span;

/// What masking found in a line.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Masked {
    /// A `\` stands at the end of the code.
    pub(super) continues: bool,
    /// The first character outside ASCII, or control character, that stands in code.
    pub(super) foreign: Option<Span>,
}

/// Appends a line to `code` with comments, a continuation sign and foreign characters blanked out.
pub(super) fn mask(line: &str, code: &mut String) -> Masked {
    let from = code.len();
    let bytes = line.as_bytes();
    let trailing = line.trim_end_matches(is_blank).len();
    let texts = Texts::new(line.as_bytes());
    let mut masked = Masked::default();
    let mut at = 0;
    while at < bytes.len() {
        match bytes[at] {
            b'"' => {
                let end = texts.end(at).unwrap_or(at + 1);
                code.push_str(&line[at..end]);
                at = end;
            }
            b';' => {
                blank(code, bytes.len() - at);
                at = bytes.len();
            }
            b'(' => {
                let end = comment_end(bytes, at);
                blank(code, end - at);
                at = end;
            }
            byte if byte.is_ascii() && (at >= trailing || !is_control(byte)) => {
                let end = at + 1 + code_length(&bytes[at + 1..]);
                code.push_str(&line[at..end]);
                at = end;
            }
            _ => {
                let length = line[at..].chars().next().map_or(1, char::len_utf8);
                masked.foreign = masked.foreign.or(Some(Span::new(at, at + length)));
                blank(code, length);
                at += length;
            }
        }
    }
    let end = from + code[from..].trim_end_matches(is_blank).len();
    if code[from..end].ends_with('\\') {
        code.replace_range(end - 1..end, " ");
        masked.continues = true;
    }
    masked
}

/// Blanks out the block number of a continued line (R1.5).
pub(super) fn mask_number(code: &mut String, from: usize) {
    let line = &code[from..];
    let start = from + line.len() - line.trim_start_matches(is_blank).len();
    let Some(number) = code[start..].strip_prefix(['N', 'n']) else {
        return;
    };
    let digits = number.trim_start_matches(|c: char| c.is_ascii_digit());
    let length = number.len() - digits.len();
    if length > 0 {
        let end = start + 1 + length;
        code.replace_range(start..end, &" ".repeat(end - start));
    }
}

/// Blank, tab, and the NUL and ETX that some editors leave (R2.1).
pub(super) fn is_blank(c: char) -> bool {
    c.is_ascii_whitespace() || matches!(c, '\u{0}' | '\u{3}' | '\u{1a}')
}

/// A control character that editors leave at the end of a file; within a block it is none of the
/// language (R2.1, R9.94).
fn is_control(byte: u8) -> bool {
    matches!(byte, 0 | 3 | 0x1a)
}

/// How many bytes stand in front of a text, a comment, a foreign or a control character.
fn code_length(bytes: &[u8]) -> usize {
    let ends = |byte: &u8| is_control(*byte) || matches!(byte, b'"' | b';' | b'(' | 0x80..);
    bytes.iter().position(ends).unwrap_or(bytes.len())
}

fn blank(code: &mut String, length: usize) {
    code.extend(std::iter::repeat_n(' ', length));
}

/// One past the `)` that closes the comment at `start`; comments nest (R2.6).
pub(super) fn comment_end(bytes: &[u8], start: usize) -> usize {
    let mut depth = 0_usize;
    for (at, byte) in bytes.iter().enumerate().skip(start) {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            return at + 1;
        }
    }
    bytes.len()
}
