//! Characters that are invisible, or that change how their neighbours are read (R9.76).

use std::borrow::Cow;
use std::fmt::Write as _;

use super::place::Span;

/// Returns whether a character is a control character, changes how its neighbours are read, or is invisible: C0, DEL,
/// C1, bidirectional controls, separators of lines and paragraphs, characters without width, and code points that are
/// not characters.
pub fn is_hidden(letter: char) -> bool {
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

/// The characters that change the direction of a text, with their names in Unicode.
const BIDIRECTIONAL: [(char, &str); 12] = [
    ('\u{61c}', "ARABIC LETTER MARK"),
    ('\u{200e}', "LEFT-TO-RIGHT MARK"),
    ('\u{200f}', "RIGHT-TO-LEFT MARK"),
    ('\u{202a}', "LEFT-TO-RIGHT EMBEDDING"),
    ('\u{202b}', "RIGHT-TO-LEFT EMBEDDING"),
    ('\u{202c}', "POP DIRECTIONAL FORMATTING"),
    ('\u{202d}', "LEFT-TO-RIGHT OVERRIDE"),
    ('\u{202e}', "RIGHT-TO-LEFT OVERRIDE"),
    ('\u{2066}', "LEFT-TO-RIGHT ISOLATE"),
    ('\u{2067}', "RIGHT-TO-LEFT ISOLATE"),
    ('\u{2068}', "FIRST STRONG ISOLATE"),
    ('\u{2069}', "POP DIRECTIONAL ISOLATE"),
];

/// Finds characters that change the direction of a text, with a sentence that names them (R9.94).
pub fn changed_direction(text: &str) -> Option<(Span, String)> {
    if text.is_ascii() {
        return None;
    }
    let is_meant = |letter: char| BIDIRECTIONAL.iter().any(|(it, _)| *it == letter);
    let first = text.find(is_meant)?;
    let last = text.rfind(is_meant)?;
    let end = last + text[last..].chars().next().map_or(0, char::len_utf8);
    let found = BIDIRECTIONAL.iter().filter(|(it, _)| text.contains(*it));
    let names: Vec<String> = found
        .map(|(letter, name)| format!("`U+{:04X} {name}`", u32::from(*letter)))
        .collect();
    let sentence = format!(
        "the line contains {}; on the screen its characters may appear in another order than the control reads",
        names.join(", ")
    );
    Some((Span::new(first, end), sentence))
}

/// Returns a JSON document of another writer, whose hidden characters are only within texts, with
/// those escaped.
pub fn shown_json(document: &str) -> Cow<'_, str> {
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
