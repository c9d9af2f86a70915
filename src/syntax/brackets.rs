//! The open brackets of a block and their depth.

use std::borrow::Cow;

use super::fault::Fault;
use super::pieces::Texts;
use crate::diagnostic::Code;
use crate::text::Span;

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

/// The code with marks in place of some of its brackets.
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

/// The `[` that are never closed where `'…'` holds none, as in expressions.
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
