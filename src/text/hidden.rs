//! Characters that nobody sees, or that change how their neighbours are read (R9.76).

use std::borrow::Cow;
use std::fmt::Write as _;

/// Whether a character is a control character or one that changes how its neighbours are read, or
/// that nobody sees: C0, DEL, C1, bidirectional controls, separators of lines and paragraphs,
/// characters without width, and what is no character.
pub(crate) fn is_hidden(letter: char) -> bool {
    matches!(
        letter,
        '\0'..='\u{1f}'
            | '\u{7f}'..='\u{9f}'
            | '\u{ad}'
            | '\u{61c}'
            | '\u{180e}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}'
            | '\u{fff0}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e007f}'
    ) || u32::from(letter) & 0xfffe == 0xfffe
}

/// A JSON document of another writer, in which hidden characters stand only within texts, with
/// those escaped.
pub(crate) fn shown_json(document: &str) -> Cow<'_, str> {
    let hidden = |letter: char| letter != '\n' && is_hidden(letter);
    if !document.contains(hidden) {
        return Cow::Borrowed(document);
    }
    let mut out = String::with_capacity(document.len() + 64);
    for letter in document.chars() {
        if !hidden(letter) {
            out.push(letter);
            continue;
        }
        for unit in letter.encode_utf16(&mut [0; 2]) {
            let _ = write!(out, "\\u{unit:04x}");
        }
    }
    Cow::Owned(out)
}
