//! Names in Markdown (R12.16): the name of a file or an axis is shown as it is, without markup.

use frictcomp_report::visible_line;

/// Returns a name as plain text.
pub(super) fn plain(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for letter in visible_line(name).chars() {
        if letter.is_ascii_punctuation() {
            text.push('\\');
        }
        text.push(letter);
    }
    text
}

/// Returns a name as code: its fence is longer than any run of backquotes in it.
pub(super) fn code(name: &str) -> String {
    let shown = visible_line(name);
    let runs = shown.split(|letter| letter != '`').map(str::len);
    let longest = runs.max().unwrap_or_default();
    let fence = "`".repeat(longest + 1);
    // A blank keeps the fence apart from a backquote; the reader removes it.
    let pad = if longest > 0 { " " } else { "" };
    format!("{fence}{pad}{shown}{pad}{fence}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_no_markdown() {
        // R12.16
        assert_eq!(code("a.nc"), "`a.nc`");
        assert_eq!(code("`[x](http://y)`"), "`` `[x](http://y)` ``");
        assert_eq!(plain("X1"), "X1");
        assert_eq!(plain("X|_[a](b)"), r"X\|\_\[a\]\(b\)");
        assert!(!code("a\nb").contains('\n'));
    }
}
