//! Characters that could deceive: invisible ones, made visible or escaped (R9.76), and those of markup.

use std::borrow::Cow;
use std::fmt::Write as _;

use frictcomp::text::is_hidden;

/// Appends the picture of a hidden character: `␛`, or `⟨U+202E⟩` if it has none.
pub(crate) fn push_picture(out: &mut String, letter: char) {
    match letter {
        '\0'..='\u{1f}' => {
            let picture = char::from_u32(0x2400 + u32::from(letter));
            out.push(picture.unwrap_or('\u{fffd}'));
        }
        '\u{7f}' => out.push('\u{2421}'),
        letter => {
            let _ = write!(out, "\u{27e8}U+{:04X}\u{27e9}", u32::from(letter));
        }
    }
}

/// Returns the last part of a path of any system: titles and pictures have no room for more, and are the same in every
/// folder.
pub(crate) fn last_part(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Returns whether a text holds a special byte; a blank is not one. Most texts hold none, so that sixteen bytes are
/// checked without a branch; the last sixteen may overlap those before.
#[inline]
pub(crate) fn any_byte(bytes: &[u8], is_special: impl Fn(u8) -> bool) -> bool {
    let any_of = |chunk: &[u8; 16]| chunk.map(|byte| u8::from(is_special(byte))) != [0; 16];
    if let Some(last) = bytes.last_chunk() {
        return bytes.as_chunks().0.iter().any(any_of) || any_of(last);
    }
    let mut filled = [b' '; 16];
    filled[..bytes.len()].copy_from_slice(bytes);
    any_of(&filled)
}

fn replaced(text: &str, stays: impl Fn(char) -> bool) -> Cow<'_, str> {
    let hidden = |letter: char| is_hidden(letter) && !stays(letter);
    // Most texts are visible ASCII.
    let special = |byte: u8| !(0x20..0x7f).contains(&byte) && !stays(char::from(byte));
    if !any_byte(text.as_bytes(), special) || !text.contains(hidden) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if hidden(letter) {
            push_picture(&mut out, letter);
        } else {
            out.push(letter);
        }
    }
    Cow::Owned(out)
}

/// Returns a text of several lines with pictures for hidden characters; line ends and tabs stay.
pub fn visible(text: &str) -> Cow<'_, str> {
    replaced(text, |letter| matches!(letter, '\n' | '\t'))
}

/// Returns a text that stays on its line, with pictures for hidden characters.
pub fn visible_line(text: &str) -> Cow<'_, str> {
    replaced(text, |_| false)
}

/// Returns a text at the start of a line. CI runners take a line that begins with `::` or `##` for a command; a name
/// that does so is shown as the path that it is.
pub fn leading(text: &str) -> Cow<'_, str> {
    let shown = visible_line(text);
    if is_command(&shown) {
        return Cow::Owned(format!("./{}", shown.trim_start()));
    }
    shown
}

/// Returns whether a CI runner would take a line that begins with this text for a command.
pub(crate) fn is_command(text: &str) -> bool {
    let text = text.trim_start();
    text.starts_with("::") || text.starts_with("##")
}

/// Appends a text with the characters of markup escaped and invisible characters made visible.
///
/// Control characters become their pictures (`␀`); characters that turn the direction of writing
/// or take no room become `⟨U+202E⟩`, so that the text that is shown is the one that the control reads.
pub(crate) fn push_escaped(out: &mut String, text: &str) {
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' => out.push(letter),
            letter if is_hidden(letter) => push_picture(out, letter),
            letter => out.push(letter),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_ends_with_its_last_part() {
        // R9.16
        assert_eq!(last_part("C:\\plants/mill.toml"), "mill.toml");
        assert_eq!(last_part("stiff"), "stiff");
    }

    #[test]
    fn what_cannot_be_seen_has_a_picture() {
        // R9.76
        assert_eq!(visible_line("a\u{1b}[31m\nb"), "a\u{241b}[31m\u{240a}b");
        assert_eq!(visible("a\tb\n\r"), "a\tb\n\u{240d}");
        assert_eq!(
            visible("\u{9b}\u{202e}\u{2028}\u{7f}"),
            "\u{27e8}U+009B\u{27e9}\u{27e8}U+202E\u{27e9}\u{27e8}U+2028\u{27e9}\u{2421}"
        );
        assert_eq!(visible("Übergröße 漢 ◄"), "Übergröße 漢 ◄");
    }

    fn escaped(text: &str) -> String {
        let mut out = String::new();
        push_escaped(&mut out, text);
        out
    }

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
}
