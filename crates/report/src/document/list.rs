//! Lists in text.

use std::fmt;

use super::Length;
use super::phrase::Phrase;

/// Number of items above which a terminal folds a list.
const ITEMS: usize = 10;

/// Items under a title.
#[derive(Debug, Clone)]
pub(crate) struct DocumentList {
    /// Title, with a colon where it introduces the items.
    pub(crate) title: String,
    pub(crate) items: Vec<Phrase>,
}

impl DocumentList {
    /// Returns the first items, and the line that counts the others.
    pub(crate) fn items(&self, most: usize) -> (&[Phrase], Option<String>) {
        match self.items.split_at_checked(most) {
            Some((shown, more @ [_, ..])) => (shown, Some(format!("… {} more", more.len()))),
            _ => (&self.items, None),
        }
    }

    /// Returns its lines.
    pub(super) fn lines(&self, length: Length) -> impl Iterator<Item = String> {
        let (shown, more) = self.items(length.of(ITEMS));
        let items = shown.iter().map(Phrase::to_string).chain(more);
        let title = format!("  {}", self.title);
        std::iter::once(title).chain(items.map(|item| format!("    {item}")))
    }

    /// Writes it at a length.
    pub(super) fn write(&self, length: Length, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.lines(length)
            .try_for_each(|line| writeln!(f, "{line}"))
    }
}
