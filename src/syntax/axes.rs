//! Which axes a program names, without running it.

use std::collections::BTreeMap;

use super::ast::{Address, Block, Item, Word};
use super::lines::{BlockReader, FastPath};
use crate::comp::Kind;
use crate::text::TextLines;

/// What a program does with an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum AxisUse {
    /// It moves the axis, or speaks to it.
    Named,
    /// It switches friction compensation of the axis.
    Switched,
}

/// The axes that the blocks of a program name, executed or not. Names have the form of R2.20.
pub fn axis_uses(text: &str) -> BTreeMap<String, AxisUse> {
    let mut uses = BTreeMap::new();
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let mut block = Block::default();
    while let Some(raw) = reader.next(&mut block) {
        let words = block.words.iter();
        let name = |word: &Word| match word.address {
            Address::Letter(letter) => Some(char::from(letter).to_string()),
            Address::Name(span) => Some(span.of(raw.text).to_owned()),
            Address::Lower(_) | Address::Main(_) => None,
        };
        let mut found: Vec<(String, AxisUse)> = Vec::new();
        found.extend(words.filter_map(name).map(|name| (name, AxisUse::Named)));
        found.extend(block.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some((name(word)?, AxisUse::Named)),
            Item::Comp(command) => {
                let switched = command.selection.kinds().contains(Kind::Frict);
                let how = if switched {
                    AxisUse::Switched
                } else {
                    AxisUse::Named
                };
                Some((command.axis.clone(), how))
            }
            Item::Bracket { axis, .. } => Some((axis.of(raw.text).to_owned(), AxisUse::Named)),
            _ => None,
        }));
        // A single Q is no axis without a configuration.
        let found = found.into_iter();
        for (name, how) in found.filter(|(name, _)| is_axis_name(name) && name != "Q") {
            let known = uses.entry(name).or_insert(how);
            *known = how.max(*known);
        }
    }
    uses
}

/// Whether a name has the form of an axis name (R2.20).
pub(crate) fn is_axis_name(name: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    name.len() <= 16
        && name.starts_with(['A', 'B', 'C', 'U', 'V', 'W', 'X', 'Y', 'Z', 'Q'])
        && name.chars().all(letter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_found_in_words_and_brackets() {
        // R2.20
        let text = "%A\nN10 G1 X1 Y=2 Z1=3 F100 M3 S1000\nX[COMP OFF FRICT] B[COMP ON LEAD]\n\
                    $IF V.E.P\nC2[COMP ON FRICT]\n$ENDIF\n(A5 in a comment)\nM30\n";
        let found: Vec<_> = axis_uses(text).into_iter().collect();
        let expected = [
            ("B", AxisUse::Named),
            ("C2", AxisUse::Switched),
            ("X", AxisUse::Switched),
            ("Y", AxisUse::Named),
            ("Z1", AxisUse::Named),
        ];
        assert_eq!(found, expected.map(|(name, how)| (name.to_owned(), how)));
    }
}
