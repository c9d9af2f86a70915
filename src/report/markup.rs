//! Text that is safe in HTML and XML, whatever bytes a program holds.

use std::fmt::Write as _;

/// Appends a text with the characters of markup escaped and what cannot be seen made visible.
///
/// Control characters become their pictures (`␀`); characters that turn the direction of writing
/// or take no room become `⟨U+202E⟩`, so that nobody reads another text than the control does.
pub(super) fn push_escaped(out: &mut String, text: &str) {
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' => out.push(letter),
            '\u{0}'..='\u{1f}' => out.push(control_picture(letter)),
            '\u{7f}' => out.push('\u{2421}'),
            letter if is_hidden(letter) => {
                let _ = write!(out, "\u{27e8}U+{:04X}\u{27e9}", u32::from(letter));
            }
            letter => out.push(letter),
        }
    }
}

/// The escaped text.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + text.len() / 8);
    push_escaped(&mut out, text);
    out
}

/// How many characters of a source line are shown.
pub(super) const LINE_ROOM: usize = 400;

/// Appends one source line, cut where it is unreasonably long.
pub(super) fn push_source_line(out: &mut String, text: &str) {
    match text.char_indices().nth(LINE_ROOM) {
        None => push_escaped(out, text),
        Some((end, _)) => {
            push_escaped(out, &text[..end]);
            let left = text[end..].chars().count();
            let _ = write!(out, " \u{2026} and {left} more characters");
        }
    }
}

fn control_picture(letter: char) -> char {
    char::from_u32(0x2400 + u32::from(letter)).unwrap_or('\u{fffd}')
}

/// Characters that change how their neighbours are read, or that nobody sees.
fn is_hidden(letter: char) -> bool {
    matches!(
        letter,
        '\u{80}'..='\u{9f}'
            | '\u{ad}'
            | '\u{61c}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}'
            | '\u{fff0}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e007f}'
    ) || u32::from(letter) & 0xfffe == 0xfffe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_inert() {
        assert_eq!(
            escaped("<script>alert('\"&')</script>]]>"),
            "&lt;script&gt;alert(&#39;&quot;&amp;&#39;)&lt;/script&gt;]]&gt;"
        );
    }

    #[test]
    fn what_cannot_be_seen_is_shown() {
        assert_eq!(
            escaped("a\0b\u{202e}c\u{7f}\u{ffff}"),
            "a\u{2400}b\u{27e8}U+202E\u{27e9}c\u{2421}\u{27e8}U+FFFF\u{27e9}"
        );
        assert_eq!(escaped("Übergröße 漢\t"), "Übergröße 漢\t");
    }

    #[test]
    fn long_lines_are_cut() {
        let mut out = String::new();
        push_source_line(&mut out, &"ü".repeat(LINE_ROOM + 7));
        assert!(out.ends_with("ü … and 7 more characters"), "{out}");
    }
}
