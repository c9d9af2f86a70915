//! Texts and values as JSON, integers and counts.

use std::borrow::{Borrow, Cow};
use std::fmt::Display;

use frictcomp::text::shown_json;
use serde::Serialize;

use super::visible::any_byte;

/// Appends a value as JSON on one line without hidden characters, even where JSON itself allows them
/// (R9.76).
pub(crate) fn append_json(out: &mut Vec<u8>, value: &(impl Serialize + ?Sized)) {
    let start = out.len();
    let written = serde_json::to_writer(&mut *out, value);
    written.expect("memory takes every byte, and numbers and texts are always JSON");
    let is_special = |byte: u8| !(0x20..0x7f).contains(&byte);
    // Most values are visible ASCII.
    if any_byte(&out[start..], is_special) {
        let text = String::from_utf8_lossy(&out[start..]);
        if let Cow::Owned(shown) = shown_json(&text) {
            out.truncate(start);
            out.extend_from_slice(shown.as_bytes());
        }
    }
}

/// Appends a text as [`append_json`] does. Most texts are visible ASCII with nothing to escape.
pub(crate) fn append_json_text(out: &mut Vec<u8>, text: &str) {
    let is_special = |byte: u8| !(0x20..0x7f).contains(&byte) || matches!(byte, b'"' | b'\\');
    if any_byte(text.as_bytes(), is_special) {
        return append_json(out, text);
    }
    out.push(b'"');
    out.extend_from_slice(text.as_bytes());
    out.push(b'"');
}

/// A text that is made again only where it is about something else than the last one.
#[derive(Debug, Default)]
pub(crate) struct KeptText<K> {
    subject: Option<K>,
    text: Vec<u8>,
}

impl<K> KeptText<K> {
    /// Returns the text about a subject.
    pub(crate) fn of<Q>(&mut self, subject: &Q, make: impl FnOnce(&mut Vec<u8>)) -> &[u8]
    where
        K: Borrow<Q>,
        Q: PartialEq + ToOwned<Owned = K> + ?Sized,
    {
        let kept = self.subject.as_ref();
        if kept.is_none_or(|kept| kept.borrow() != subject) {
            self.subject = Some(subject.to_owned());
            self.text.clear();
            make(&mut self.text);
        }
        &self.text
    }
}

/// Appends an integer.
pub(crate) fn integer(out: &mut Vec<u8>, number: impl itoa::Integer) {
    out.extend_from_slice(itoa::Buffer::new().format(number).as_bytes());
}

/// Returns a count with its noun in English: `1 block`, `2 blocks`.
pub fn counted(count: impl Copy + Display + PartialEq + From<u8>, noun: &str) -> String {
    let plural = if count == 1.into() { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// Returns a number with a blank between its thousands.
pub(crate) fn grouped(number: u64) -> String {
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
            append_json(&mut out, &text);
            let mut again = Vec::new();
            append_json_text(&mut again, &text);
            prop_assert_eq!(&again, &out);
            let back: String = serde_json::from_slice(&out).expect("a JSON string");
            prop_assert_eq!(back, text);
        }

        #[test]
        fn every_control_character_is_escaped(text in "[\\x00-\\x7e]*") {
            let mut out = Vec::new();
            append_json(&mut out, &text);
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
