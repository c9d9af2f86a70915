//! Text that is safe in markup, whatever bytes a program holds.

use super::visible::push_picture;
use frictcomp::text::is_hidden;

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
