//! The kind of each byte of a line: code, string, quoted number, comment, or a foreign character. Every question about the text of
//! a program is answered here. What the parser skips is blanked out byte for byte; open brackets of a block have a depth.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::ops::Range;

use super::parse::Fault;
use crate::diagnostic::Code;
use crate::text::Span;

/// Kind of a piece of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PieceKind {
    /// Text that the control reads.
    Code,
    /// `"…"`, with its quotes.
    Text,
    /// `'16#FA1B'`, with its quotes.
    Quoted,
    /// `(…)` or `; …`.
    Comment,
    /// A character outside ASCII, or a control character.
    Foreign,
}

/// A piece of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Piece {
    pub(crate) kind: PieceKind,
    pub(crate) range: Range<usize>,
}

/// Returns the pieces of a line, one after another without gaps.
pub(crate) fn pieces(line: &str) -> impl Iterator<Item = Piece> + '_ {
    let bytes = line.as_bytes();
    let trailing = line.trim_end_matches(is_blank).len();
    let texts = Texts::new(bytes);
    let mut at = 0;
    // Looked for once in each stretch of code, however many quotation marks are in it (R9.90).
    let mut end_of_code = 0;
    let mut code_end = move |start: usize| {
        if start >= end_of_code {
            end_of_code = start + 1 + code_length(&bytes[start + 1..]);
        }
        end_of_code
    };
    std::iter::from_fn(move || {
        let start = at;
        let byte = *bytes.get(start)?;
        let is_code = byte.is_ascii() && (start >= trailing || !is_control(byte));
        let (kind, end) = match byte {
            b'"' => match texts.end(start) {
                Some(end) => (PieceKind::Text, end),
                None => (PieceKind::Code, start + 1),
            },
            b';' => (PieceKind::Comment, bytes.len()),
            b'(' => {
                let end = closing(bytes, start).unwrap_or(bytes.len());
                (PieceKind::Comment, end)
            }
            b'\'' => {
                let code = &bytes[start + 1..code_end(start)];
                match memchr::memchr(b'\'', code) {
                    Some(length) => (PieceKind::Quoted, start + length + 2),
                    None => (PieceKind::Code, start + 1 + code.len()),
                }
            }
            _ if is_code => {
                let code = &bytes[start + 1..code_end(start)];
                let length = memchr::memchr(b'\'', code).unwrap_or(code.len());
                (PieceKind::Code, start + 1 + length)
            }
            _ => {
                let length = line[start..].chars().next().map_or(1, char::len_utf8);
                (PieceKind::Foreign, start + length)
            }
        };
        at = end;
        Some(Piece {
            kind,
            range: start..end,
        })
    })
}

/// Returns the kind of a letter that would be typed at a place of a line.
pub fn kind_at(line: &str, at: usize) -> PieceKind {
    let (before, after) = line.split_at(at);
    let typed = format!("{before}A{after}");
    let found = pieces(&typed).find(|piece| piece.range.contains(&at));
    found.map_or(PieceKind::Code, |piece| piece.kind)
}

/// Returns the stretches of a line that are code, and the code of a macro that it defines; nothing of a line that names
/// a program.
pub(crate) fn code_stretches(line: &str) -> impl Iterator<Item = &str> {
    let is_name = line.trim_start_matches(is_blank).starts_with('%');
    let line = if is_name { "" } else { line };
    let mut before: Option<usize> = None;
    pieces(line).filter_map(move |piece| match piece.kind {
        PieceKind::Code => Some(&line[piece.range]),
        PieceKind::Text => {
            let last = before.replace(piece.range.end);
            let is_macro = last.is_some_and(|last| line[last..piece.range.start].trim() == "=");
            is_macro.then(|| &line[piece.range.start + 1..piece.range.end - 1])
        }
        PieceKind::Quoted | PieceKind::Comment | PieceKind::Foreign => None,
    })
}

/// Returns the words of a line that may name variables and parameters.
pub fn code_words(line: &str) -> impl Iterator<Item = &str> {
    let is_part = |it: char| it.is_ascii_alphanumeric() || "_.@".contains(it);
    code_stretches(line).flat_map(move |code| code.split(move |it| !is_part(it)))
}

/// Returns whether a character is a blank, a tab, or the NUL and ETX that some editors leave (R2.1).
pub(super) fn is_blank(c: char) -> bool {
    c.is_ascii_whitespace() || matches!(c, '\u{0}' | '\u{3}' | '\u{1a}')
}

/// Returns whether a byte is a control character that editors leave at the end of a file; within a block it is not part
/// of the language (R2.1, R9.94).
fn is_control(byte: u8) -> bool {
    matches!(byte, 0 | 3 | 0x1a)
}

/// Returns the number of bytes before a text, a comment, a foreign or a control character.
fn code_length(bytes: &[u8]) -> usize {
    let ends = |byte: &u8| is_control(*byte) || matches!(byte, b'"' | b';' | b'(' | 0x80..);
    bytes.iter().position(ends).unwrap_or(bytes.len())
}

/// Returns whether a comment begins with a `(` that nothing closes (R2.6).
pub(super) fn is_open_comment(comment: &str) -> bool {
    comment.starts_with('(') && closing(comment.as_bytes(), 0).is_none()
}

/// Returns one past the `)` that closes the comment at `start`; comments nest (R2.6).
fn closing(bytes: &[u8], start: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (at, byte) in bytes.iter().enumerate().skip(start) {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            return Some(at + 1);
        }
    }
    None
}

/// Finds where texts end, in one pass over all of them.
#[derive(Debug, Clone)]
pub(super) struct Texts<'a> {
    bytes: &'a [u8],
    /// The last quote without a `\` before it; texts that begin at or after it hold no `\"`.
    last: OnceCell<Option<usize>>,
}

impl<'a> Texts<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            last: OnceCell::new(),
        }
    }

    /// Returns one past the quote that closes the text at `start`. A `\"` stands for a quote inside; where that leaves
    /// the text open, it was the text's own last character.
    pub(super) fn end(&self, start: usize) -> Option<usize> {
        if !self.is_closed(start) {
            let rest = &self.bytes[start + 1..];
            return memchr::memchr(b'"', rest).map(|length| start + length + 2);
        }
        let mut at = start + 1;
        while let Some(length) = memchr::memchr(b'"', &self.bytes[at..]) {
            at += length + 1;
            if !self.is_escaped(at - 1) {
                return Some(at);
            }
        }
        None
    }

    /// Returns whether a quote after a place has no `\` before it.
    pub(super) fn is_closed(&self, start: usize) -> bool {
        let last = self.last.get_or_init(|| {
            let mut quotes = memchr::memrchr_iter(b'"', self.bytes);
            quotes.find(|at| !self.is_escaped(*at))
        });
        last.is_some_and(|last| last > start)
    }

    fn is_escaped(&self, quote: usize) -> bool {
        quote > 0 && self.bytes[quote - 1] == b'\\'
    }
}

/// Findings of the masking of a line.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Masked {
    /// Whether the code ends in a `\`.
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

/// Returns a line as the parser sees it, byte for byte.
pub fn code_of(line: &str) -> String {
    let mut code = String::new();
    mask(line, &mut code);
    code
}

/// Returns the part of a block as the parser sees it, byte for byte: its lines without comments, continuation signs and
/// the block numbers of continued lines.
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

/// Returns whether a line marks its block as continued on the next one.
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

/// Greatest depth of nested brackets (R2.60).
pub const MAX_BRACKETS: usize = 64;

/// Texts of one block that may end in a `\`: looking for the end of each goes to the end of the block.
const MAX_OPEN_TEXTS: usize = 64;

/// Stands for a `[` that is never closed, `never_closed` in the grammar; one that a program holds itself
/// is read as [`OTHER`].
const NEVER_CLOSED: char = '\u{1}';

/// A control character that no rule of the grammar accepts.
const OTHER: char = '\u{2}';

/// A block as the parser reads it.
#[derive(Debug)]
pub(super) struct Brackets<'a> {
    /// The code, in which each `[` that is surely never closed is marked: no rule looks for its end (R9.90).
    pub(super) read: Cow<'a, str>,
    /// The first `[` that is never closed.
    pub(super) unclosed: Option<usize>,
}

/// Finds the `[` that are never closed; refuses what nests too deeply for recursion.
pub(super) fn brackets(code: &str) -> Result<Brackets<'_>, Fault> {
    let mut read = Cow::Borrowed(code);
    if code.contains(NEVER_CLOSED) {
        read = Cow::Owned(code.replace(NEVER_CLOSED, OTHER.encode_utf8(&mut [0; 4])));
    }
    let mut unclosed = unclosed(code)?;
    let first = unclosed.first().copied();
    if first.is_some() {
        // Brackets within `'…'` of an expression open and close nothing; in other brackets they do.
        if code.contains('\'') {
            let in_expressions = unclosed_outside_quotes(code);
            unclosed.retain(|at| in_expressions.binary_search(at).is_ok());
        }
        read = Cow::Owned(marked(&read, &unclosed));
    }
    Ok(Brackets {
        read,
        unclosed: first,
    })
}

/// Returns the code with marks in place of some of its brackets.
fn marked(code: &str, brackets: &[usize]) -> String {
    let mut marked = String::with_capacity(code.len());
    let mut from = 0;
    for &at in brackets {
        marked.push_str(&code[from..at]);
        marked.push(NEVER_CLOSED);
        from = at + 1;
    }
    marked.push_str(&code[from..]);
    marked
}

fn unclosed(code: &str) -> Result<Vec<usize>, Fault> {
    let bytes = code.as_bytes();
    let mut open = Vec::new();
    // A short block nests only by brackets and powers.
    let is_power = |at| bytes.get(at + 1) == Some(&b'*');
    if bytes.len() <= MAX_BRACKETS
        && memchr::memchr(b'[', bytes).is_none()
        && !memchr::memchr_iter(b'*', bytes).any(is_power)
    {
        return Ok(open);
    }
    let texts = Texts::new(code.as_bytes());
    let [mut powers, mut addresses, mut open_texts] = [0_usize; 3];
    let mut inside_text = 0;
    for (at, byte) in bytes.iter().enumerate() {
        if at < inside_text {
            continue;
        }
        // `PPP1` is a parameter whose number is in a parameter, and so on.
        match byte {
            b'P' | b'p' => addresses += 1,
            b' ' | b'\t' | b'\n' => {}
            _ => addresses = 0,
        }
        match byte {
            b'"' => {
                inside_text = texts.end(at).unwrap_or_default();
                open_texts += usize::from(!texts.is_closed(at));
            }
            b'[' => open.push(at),
            b']' => {
                open.pop();
            }
            b'*' if is_power(at) => powers += 1,
            _ => {}
        }
        if open.len().max(powers).max(addresses) > MAX_BRACKETS {
            return Err(too_deep(Span::new(at, at + 1)));
        }
        if open_texts > MAX_OPEN_TEXTS {
            return Err(too_many_open_texts(Span::new(at, at + 1)));
        }
    }
    Ok(open)
}

/// Returns the `[` that are never closed where `'…'` holds none, as in expressions.
fn unclosed_outside_quotes(code: &str) -> Vec<usize> {
    let bytes = code.as_bytes();
    let texts = Texts::new(bytes);
    let mut open = Vec::new();
    let mut inside = 0;
    let last_quote = memchr::memrchr(b'\'', bytes).unwrap_or_default();
    for (at, byte) in bytes.iter().enumerate() {
        if at < inside {
            continue;
        }
        match byte {
            b'"' => inside = texts.end(at).unwrap_or_default(),
            b'\'' if at < last_quote => {
                let rest = &bytes[at + 1..];
                inside = memchr::memchr(b'\'', rest).map_or(0, |length| at + length + 2);
            }
            b'[' => open.push(at),
            b']' => {
                open.pop();
            }
            _ => {}
        }
    }
    open
}

fn too_deep(span: Span) -> Fault {
    Fault::new(
        Code::Fc913,
        span,
        format!("expressions are nested more than {MAX_BRACKETS} levels deep"),
    )
    .with_help("compute parts of the expression in blocks of their own")
}

fn too_many_open_texts(span: Span) -> Fault {
    Fault::new(
        Code::Fc913,
        span,
        format!("more than {MAX_OPEN_TEXTS} strings of this block end in `\\\"`"),
    )
    .with_help("close each string with a `\"` that has no `\\` in front")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn code_is_what_the_parser_sees() {
        // R9.74
        let code = |line: &str| {
            let code: Vec<&str> = code_stretches(line).map(str::trim).collect();
            code.join("|")
        };
        assert_eq!(code("N10 X1 (Y2 (Z3) A4) B5 ; C6"), "N10 X1|B5");
        assert_eq!(code("V.P.A=\"(\" X1 ; \"Y"), "V.P.A=|X1");
        assert_eq!(code("#MSG [\"X1 ; (\"] Y2"), "#MSG [|] Y2");
        assert_eq!(code("\"M\" = \"X1\""), "=|X1");
        assert_eq!(code("P1 = 'H1B5' X2"), "P1 =|X2");
        assert_eq!(code("P1 = 'H1(B5' X2"), "P1 =|'H1");
        assert_eq!(code("X1 'Y2"), "X1|'Y2");
        assert_eq!(code("X1 \" Y2"), "X1|\"|Y2");
        assert_eq!(code("%X1"), "");
    }

    #[test]
    fn a_place_is_code_unless_it_lies_inside_something_else() {
        use PieceKind::{Code, Comment, Text};

        let text = "X1 (Y) \"Z\" ;";
        let kinds = [1, 4, 6, 8, 10, 12].map(|at| kind_at(text, at));
        assert_eq!(kinds, [Code, Comment, Code, Text, Code, Comment]);
        assert_eq!(kind_at("X1 (Y", 5), Comment);
    }

    proptest! {
        #[test]
        fn pieces_tile_a_line(line in r#"([ -~]|[;("')\\]|\u{0}|ü|\t){0,40}"#) {
            // R2.6
            let mut end = 0;
            for piece in pieces(&line) {
                prop_assert_eq!(piece.range.start, end);
                prop_assert!(piece.range.end > end);
                end = piece.range.end;
            }
            prop_assert_eq!(end, line.len());
        }
    }
}
