//! Blocks inserted into a text, which stays as it is everywhere else.

use std::ops::Range;

/// A block that is inserted into a program.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Insertion {
    /// The line before which it is inserted, from 1; one past the last line means the end.
    pub line: u32,
    /// The block to insert, without its line end.
    pub text: String,
}

/// Returns the places in a text at which blocks are inserted, and the text inserted there: each block on its own line,
/// with the text's line ends (R10.3). In text order.
pub fn insertions(text: &str, blocks: &[Insertion]) -> Vec<(Range<usize>, String)> {
    let lines = lines(text);
    let usual = lines.first().map_or("", |line| line_end(line.1));
    let usual = if usual.is_empty() { "\n" } else { usual };
    let is_open = lines.last().is_some_and(|last| line_end(last.1).is_empty());
    let mut sorted: Vec<&Insertion> = blocks.iter().collect();
    sorted.sort_by_key(|block| block.line);
    let insertion = |block: &Insertion| {
        let before = usize::try_from(block.line.saturating_sub(1)).unwrap_or(usize::MAX);
        let end = match lines.get(before).map(|line| line_end(line.1)) {
            Some(end) if !end.is_empty() => end,
            _ => usual,
        };
        match lines.get(before) {
            Some((from, _)) => (*from..*from, format!("{}{end}", block.text)),
            // The last line of the text gets a line end; the block has none.
            None if is_open => (text.len()..text.len(), format!("{end}{}", block.text)),
            None => (text.len()..text.len(), format!("{}{end}", block.text)),
        }
    };
    sorted.into_iter().map(insertion).collect()
}

/// Returns the text with the blocks inserted.
pub(super) fn with_blocks(text: &str, blocks: &[Insertion]) -> String {
    let mut result = String::with_capacity(text.len() + 40 * blocks.len());
    let mut copied = 0;
    for (range, inserted) in insertions(text, blocks) {
        result.push_str(&text[copied..range.start]);
        result.push_str(&inserted);
        copied = range.end;
    }
    result.push_str(&text[copied..]);
    result
}

/// Returns the offset of each line, and the line with its end.
fn lines(text: &str) -> Vec<(usize, &str)> {
    let mut lines = Vec::new();
    let mut from = 0;
    while from < text.len() {
        let rest = &text[from..];
        let end = rest.find(['\r', '\n']).unwrap_or(rest.len());
        let ends = if rest[end..].starts_with("\r\n") {
            2
        } else {
            1
        };
        let length = rest.len().min(end + ends);
        lines.push((from, &rest[..length]));
        from += length;
    }
    lines
}

fn line_end(line: &str) -> &str {
    &line[line.trim_end_matches(['\r', '\n']).len()..]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(line: u32, text: &str) -> Insertion {
        Insertion {
            line,
            text: text.to_owned(),
        }
    }

    #[test]
    fn nothing_but_the_blocks_is_added() {
        // R10.3
        for (before, blocks, after) in [
            ("a\nb\n", &[block(2, "X")][..], "a\nX\nb\n"),
            ("a\r\nb", &[block(2, "X")], "a\r\nX\r\nb"),
            ("a\rb\r", &[block(1, "X"), block(3, "Y")], "X\ra\rb\rY\r"),
            (
                "a\r\nb",
                &[block(3, "X"), block(3, "Y")],
                "a\r\nb\r\nX\r\nY",
            ),
            (
                "a\nb\n\n",
                &[block(3, "X"), block(2, "Y")],
                "a\nY\nb\nX\n\n",
            ),
            ("", &[block(1, "X")], "X\n"),
        ] {
            assert_eq!(with_blocks(before, blocks), after, "{before:?}");
        }
    }
}
