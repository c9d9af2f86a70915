//! The axes that a program names, found without running it.

use std::collections::BTreeMap;

use super::ast::{Address, Block, Item, Word};
use super::lines::{BlockReader, FastPath};
use super::parse::parse_block;
use crate::comp::Kind;
use crate::text::TextLines;

/// Number of macro definitions inside each other that are looked into.
pub(crate) const MAX_MACROS: usize = 16;

/// Use of an axis in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum AxisUse {
    /// It moves the axis, or addresses it.
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
        for (name, how) in uses_of(&block, raw.text) {
            let known = uses.entry(name).or_insert(how);
            *known = how.max(*known);
        }
    }
    uses
}

/// Returns the axes that a block names. The code of a macro counts where it is defined.
pub(super) fn uses_of(block: &Block, text: &str) -> Vec<(String, AxisUse)> {
    let mut found = Vec::new();
    with_macros(block, text, MAX_MACROS, &mut |block, text| {
        found.extend(own_uses(block, text));
    });
    // A single Q is not an axis without a configuration.
    found.retain(|(name, _)| is_axis_name(name) && name != "Q");
    found
}

/// Hands over a block, and the code of the macros that it defines.
pub(crate) fn with_macros(
    block: &Block,
    text: &str,
    depth: usize,
    take: &mut impl FnMut(&Block, &str),
) {
    take(block, text);
    for item in &block.items {
        if let Item::MacroDefinition(_, code) = item
            && depth > 0
        {
            let code = code.of(text).trim_matches('"').replace("\\\"", "\"");
            with_macros(&parse_block(&code), &code, depth - 1, take);
        }
    }
}

/// Finds the axis names in a block, without those of its macros.
pub(super) fn own_uses<'a>(
    block: &'a Block,
    text: &'a str,
) -> impl Iterator<Item = (String, AxisUse)> + 'a {
    let name = |word: &Word| match word.address {
        Address::Letter(letter) => Some(char::from(letter).to_string()),
        Address::Name(span) => Some(span.of(text).to_owned()),
        Address::Lower(_) | Address::Main(_) => None,
    };
    let words = block.words.iter().filter_map(name);
    let words = words.map(|name| (name, AxisUse::Named));
    let items = block.items.iter().filter_map(move |item| match item {
        Item::Word(word) => name(word).map(|name| (name, AxisUse::Named)),
        Item::Comp(command) => {
            let how = if command.selection.kinds().contains(Kind::Frict) {
                AxisUse::Switched
            } else {
                AxisUse::Named
            };
            Some((command.axis.clone(), how))
        }
        Item::Bracket { axis, .. } => Some((axis.of(text).to_owned(), AxisUse::Named)),
        _ => None,
    });
    words.chain(items)
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
                    $IF V.E.P\nC2[COMP ON FRICT]\n$ENDIF\n(A5 in a comment)\n\
                    \"CUT\" = \"A1[COMP OFF FRICT] U2\"\n#MSG [\"W[COMP ON FRICT]\"]\nM30\n";
        let found: Vec<_> = axis_uses(text).into_iter().collect();
        let expected = [
            ("A1", AxisUse::Switched),
            ("B", AxisUse::Named),
            ("C2", AxisUse::Switched),
            ("U", AxisUse::Named),
            ("X", AxisUse::Switched),
            ("Y", AxisUse::Named),
            ("Z1", AxisUse::Named),
        ];
        assert_eq!(found, expected.map(|(name, how)| (name.to_owned(), how)));
    }
}
