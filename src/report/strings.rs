//! Texts and numbers as JSON, appended to a buffer that is used again and again.

/// What a byte becomes in a JSON string: 0 itself, `u` a code, else the letter behind `\`.
const ESCAPES: [u8; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 0x20 {
        table[byte] = b'u';
        byte += 1;
    }
    table[0x08] = b'b';
    table[0x09] = b't';
    table[0x0a] = b'n';
    table[0x0c] = b'f';
    table[0x0d] = b'r';
    table[b'"' as usize] = b'"';
    table[b'\\' as usize] = b'\\';
    table
};

const HEX: [u8; 16] = *b"0123456789abcdef";

/// Whether a text holds a special byte; a blank is none. Most texts hold none, so that sixteen bytes
/// are looked at without a branch; the last sixteen may overlap those before.
#[inline]
pub(super) fn any_byte(bytes: &[u8], is_special: impl Fn(u8) -> bool) -> bool {
    let any_of = |chunk: &[u8; 16]| chunk.map(|byte| u8::from(is_special(byte))) != [0; 16];
    if let Some(last) = bytes.last_chunk() {
        return bytes.as_chunks().0.iter().any(any_of) || any_of(last);
    }
    let mut filled = [b' '; 16];
    filled[..bytes.len()].copy_from_slice(bytes);
    any_of(&filled)
}

/// Appends a text as a JSON string with its quotes.
pub(super) fn string(out: &mut Vec<u8>, text: &str) {
    let bytes = text.as_bytes();
    out.push(b'"');
    let is_special = |byte: u8| byte < 0x20 || byte == b'"' || byte == b'\\';
    if any_byte(bytes, is_special) {
        escape(out, bytes);
    } else {
        out.extend_from_slice(bytes);
    }
    out.push(b'"');
}

fn escape(out: &mut Vec<u8>, mut rest: &[u8]) {
    while let Some(at) = rest
        .iter()
        .position(|&byte| ESCAPES[usize::from(byte)] != 0)
    {
        out.extend_from_slice(&rest[..at]);
        let byte = rest[at];
        match ESCAPES[usize::from(byte)] {
            b'u' => {
                let (high, low) = (usize::from(byte >> 4), usize::from(byte & 0xf));
                out.extend_from_slice(&[b'\\', b'u', b'0', b'0', HEX[high], HEX[low]]);
            }
            letter => out.extend_from_slice(&[b'\\', letter]),
        }
        rest = &rest[at + 1..];
    }
    out.extend_from_slice(rest);
}

/// Appends a text as a JSON string, or `null`.
pub(super) fn optional(out: &mut Vec<u8>, text: Option<&str>) {
    match text {
        Some(text) => string(out, text),
        None => out.extend_from_slice(b"null"),
    }
}

/// Appends an integer.
pub(super) fn integer(out: &mut Vec<u8>, number: impl itoa::Integer) {
    out.extend_from_slice(itoa::Buffer::new().format(number).as_bytes());
}

/// Appends items with a comma between them.
pub(super) fn separated<T>(
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = T>,
    mut append: impl FnMut(&mut Vec<u8>, T),
) {
    for (count, item) in items.into_iter().enumerate() {
        if count > 0 {
            out.push(b',');
        }
        append(out, item);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_string_reads_back(text in any::<String>()) {
            let mut out = Vec::new();
            string(&mut out, &text);
            let back: String = serde_json::from_slice(&out).expect("a JSON string");
            prop_assert_eq!(back, text);
        }

        #[test]
        fn every_control_character_is_escaped(text in "[\\x00-\\x7f]*") {
            let mut out = Vec::new();
            string(&mut out, &text);
            prop_assert!(out.iter().all(|&byte| byte >= 0x20));
            prop_assert_eq!(serde_json::to_vec(&text).unwrap(), out);
        }
    }
}
