//! The lines of a text by their numbers.

use std::sync::Arc;

use frictcomp::text::{LineSource, TextLines};

/// The maximum number of characters that are shown of a line.
const MOST_SHOWN: usize = 400;

/// A text and where its lines begin.
#[derive(Debug)]
pub(crate) struct IndexedText {
    text: Arc<String>,
    starts: Vec<usize>,
}

impl IndexedText {
    pub(crate) fn new(text: &Arc<String>) -> Self {
        let mut lines = TextLines::new(text);
        let mut starts = Vec::new();
        while lines.advance() {
            starts.push(lines.line().offset);
        }
        Self {
            text: Arc::clone(text),
            starts,
        }
    }

    /// Returns a number of lines from one on, counted from 1, joined by a blank.
    pub(crate) fn shown(&self, line: u32, count: u8) -> String {
        let first = usize::try_from(line.max(1)).unwrap_or(usize::MAX) - 1;
        let last = first.saturating_add(usize::from(count.max(1)));
        let starts = self.starts.get(first..last.min(self.starts.len()));
        let pieces = starts.into_iter().flatten().map(|&start| {
            let rest = &self.text[start..];
            let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
            rest[..end].trim_end()
        });
        let joined = pieces.collect::<Vec<_>>().join(" ");
        match joined.char_indices().nth(MOST_SHOWN) {
            Some((cut, _)) => format!("{}\u{2026}", &joined[..cut]),
            None => joined,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_found_by_their_numbers() {
        let lines = IndexedText::new(&Arc::new("a\r\nb \\\n  c\n\u{e4}".to_owned()));
        assert_eq!(lines.shown(1, 1), "a");
        assert_eq!(lines.shown(2, 2), "b \\   c");
        assert_eq!(lines.shown(4, 1), "\u{e4}");
        assert_eq!(lines.shown(5, 1), "");
        let long = IndexedText::new(&Arc::new("x".repeat(1000)));
        assert_eq!(long.shown(1, 1).chars().count(), MOST_SHOWN + 1);
    }
}
