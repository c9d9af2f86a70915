//! Masking of the text that the parser skips: comments, continuation signs, block numbers of continued
//! lines and foreign characters are blanked out byte for byte.

use std::borrow::Cow;

use super::pieces::{PieceKind, is_blank, pieces};
use crate::text::Span;

/// Findings of the masking of a line.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Masked {
    /// The code ends in a `\`.
    pub(super) continues: bool,
    /// The first character outside ASCII, or control character, in the code.
    pub(super) foreign: Option<Span>,
}

/// Appends a line to `code` with comments, a continuation sign and foreign characters blanked out.
pub(super) fn mask(line: &str, code: &mut String) -> Masked {
    let from = code.len();
    let mut masked = Masked::default();
    for piece in pieces(line) {
        if piece.kind == PieceKind::Foreign {
            let found = Span::new(piece.range.start, piece.range.end);
            masked.foreign = masked.foreign.or(Some(found));
        }
        match piece.kind {
            PieceKind::Comment | PieceKind::Foreign => blank(code, piece.range.len()),
            _ => code.push_str(&line[piece.range]),
        }
    }
    let end = from + code[from..].trim_end_matches(is_blank).len();
    if code[from..end].ends_with('\\') {
        code.replace_range(end - 1..end, " ");
        masked.continues = true;
    }
    masked
}

/// A line as the parser sees it, byte for byte.
pub fn code_of(line: &str) -> String {
    let mut code = String::new();
    mask(line, &mut code);
    code
}

/// Part of a block as the parser sees it, byte for byte: its lines without comments, continuation signs and the
/// block numbers of continued lines.
pub(crate) fn code_of_part(text: &str) -> Cow<'_, str> {
    if !text.contains(['(', ';', '\\', '\n']) {
        return Cow::Borrowed(text);
    }
    let mut code = String::with_capacity(text.len());
    for (at, line) in text.split('\n').enumerate() {
        if at > 0 {
            code.push('\n');
        }
        let from = code.len();
        mask(line, &mut code);
        if at > 0 {
            mask_number(&mut code, from);
        }
    }
    Cow::Owned(code)
}

/// Whether a line marks its block as continued on the next one.
pub(crate) fn goes_on(line: &str) -> bool {
    line.contains('\\') && mask(line, &mut String::new()).continues
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

fn blank(code: &mut String, length: usize) {
    code.extend(std::iter::repeat_n(' ', length));
}
