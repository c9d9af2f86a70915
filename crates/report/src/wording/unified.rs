//! The changes of a text, in the form of `diff -u`.

use similar::TextDiff;

/// A text before and after a change, each with its name.
#[derive(Debug, Clone, Copy)]
pub struct TextChange<'a> {
    /// The name and the text before it.
    pub before: (&'a str, &'a str),
    /// The name and the text after it.
    pub after: (&'a str, &'a str),
}

/// Returns the lines that a change removes and adds, with three lines of context.
pub fn render_unified(change: TextChange<'_>) -> String {
    let ((old_name, old), (new_name, new)) = (change.before, change.after);
    let diff = TextDiff::from_lines(old, new);
    diff.unified_diff().header(old_name, new_name).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_shown_with_its_lines() {
        let change = TextChange {
            before: ("a (agreed)", "one\ntwo\n"),
            after: ("a (now)", "one\n2\n"),
        };
        assert_eq!(
            render_unified(change),
            "--- a (agreed)\n+++ a (now)\n@@ -1,2 +1,2 @@\n one\n-two\n+2\n"
        );
    }
}
