//! Which brackets of a block stay open, and how deep they nest.

use super::fault::Fault;
use super::mask::text_end;
use crate::diagnostic::Code;
use crate::text::Span;

/// How deep brackets may nest (R2.60).
pub const MAX_BRACKETS: usize = 64;

/// Finds the first `[` that is never closed; refuses what nests too deeply for recursion.
pub(super) fn brackets(code: &str) -> Result<Option<usize>, Fault> {
    let bytes = code.as_bytes();
    if memchr::memchr2(b'[', b'*', bytes).is_none() {
        return Ok(None);
    }
    let mut open = Vec::new();
    let mut powers = 0_usize;
    let mut inside_text = 0;
    for (at, byte) in bytes.iter().enumerate() {
        match byte {
            _ if at < inside_text => {}
            b'"' => inside_text = text_end(bytes, at).unwrap_or_default(),
            b'[' => open.push(at),
            b']' => {
                open.pop();
            }
            b'*' if bytes.get(at + 1) == Some(&b'*') => powers += 1,
            _ => {}
        }
        if open.len() > MAX_BRACKETS || powers > MAX_BRACKETS {
            return Err(Fault::new(
                Code::Fc913,
                Span::new(at, at + 1),
                format!("expressions are nested more than {MAX_BRACKETS} levels deep"),
            )
            .with_help("compute parts of the expression in blocks of their own"));
        }
    }
    Ok(open.first().copied())
}
