//! Which brackets of a block stay open, and how deep they nest.

use super::fault::Fault;
use super::texts::Texts;
use crate::diagnostic::Code;
use crate::text::Span;

/// How deep brackets may nest (R2.60).
pub const MAX_BRACKETS: usize = 64;

/// Texts of one block that may end in a `\`: looking for the end of each goes to the end of the block.
const MAX_OPEN_TEXTS: usize = 64;

/// Finds the first `[` that is never closed; refuses what nests too deeply for recursion.
pub(super) fn brackets(code: &str) -> Result<Option<usize>, Fault> {
    let bytes = code.as_bytes();
    // A short block nests only by brackets and powers.
    if bytes.len() <= MAX_BRACKETS && memchr::memchr2(b'[', b'*', bytes).is_none() {
        return Ok(None);
    }
    let texts = Texts::new(code.as_bytes());
    let mut open = Vec::new();
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
            b'*' if bytes.get(at + 1) == Some(&b'*') => powers += 1,
            _ => {}
        }
        if open.len().max(powers).max(addresses) > MAX_BRACKETS {
            return Err(too_deep(Span::new(at, at + 1)));
        }
        if open_texts > MAX_OPEN_TEXTS {
            return Err(too_many_open_texts(Span::new(at, at + 1)));
        }
    }
    Ok(open.first().copied())
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
