//! Texts and numbers as JSON, appended to a buffer that is used again and again.

use super::visible::any_byte;
use frictcomp::text::{is_hidden, shown_json};

/// Escape of a byte in a JSON string: 0 for the byte itself, `u` for a code, else the letter after
/// `\`.
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

/// Appends a text as a JSON string with its quotes. What cannot be seen is escaped, whatever JSON
/// itself asks for (R9.76).
pub(super) fn string(out: &mut Vec<u8>, text: &str) {
    out.push(b'"');
    let is_special = |byte: u8| !(0x20..0x7f).contains(&byte) || byte == b'"' || byte == b'\\';
    if any_byte(text.as_bytes(), is_special) {
        escape(out, text);
    } else {
        out.extend_from_slice(text.as_bytes());
    }
    out.push(b'"');
}

fn escape(out: &mut Vec<u8>, mut rest: &str) {
    let special = |letter: char| matches!(letter, '"' | '\\') || is_hidden(letter);
    while let Some(at) = rest.find(special) {
        let (before, after) = rest.split_at(at);
        out.extend_from_slice(before.as_bytes());
        let letter = after.chars().next().unwrap_or_default();
        let short = u8::try_from(letter).map_or(0, |byte| ESCAPES[usize::from(byte)]);
        if short == 0 || short == b'u' {
            push_units(out, letter);
        } else {
            out.extend_from_slice(&[b'\\', short]);
        }
        rest = &after[letter.len_utf8()..];
    }
    out.extend_from_slice(rest.as_bytes());
}

/// Appends a character by its UTF-16 units, `\u202e`.
fn push_units(out: &mut Vec<u8>, letter: char) {
    for unit in letter.encode_utf16(&mut [0; 2]) {
        let digit = |shift: u32| HEX[usize::from(*unit >> shift & 0xf)];
        out.extend_from_slice(&[b'\\', b'u', digit(12), digit(8), digit(4), digit(0)]);
    }
}

/// A value as a JSON document in which nothing hidden stands.
pub(super) fn to_pretty(value: &impl serde::Serialize) -> String {
    let text = serde_json::to_string_pretty(value).expect("numbers and texts are always JSON");
    shown_json(&text).into_owned()
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

/// A number with a blank between its thousands.
pub(super) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
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
        fn every_control_character_is_escaped(text in "[\\x00-\\x7e]*") {
            let mut out = Vec::new();
            string(&mut out, &text);
            prop_assert!(out.iter().all(|&byte| byte >= 0x20));
            prop_assert_eq!(serde_json::to_vec(&text).unwrap(), out);
        }
    }

    #[test]
    fn thousands_stand_apart() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1204), "1 204");
        assert_eq!(grouped(12_345_678), "12 345 678");
    }
}
