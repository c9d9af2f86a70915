//! The names that a block defines and uses, and the axes that a program names, found without running it.

use std::collections::BTreeMap;

use super::ast::{Address, Block, BlockReference, CallName, CallScope, Flow, Item, Operand, Word};
use super::lines::{BlockReader, FastPath};
use super::parse::parse_block;
use crate::comp::Kind;
use crate::text::{Span, TextLines};

/// Number of macro definitions inside each other that are looked into.
pub(crate) const MAX_MACROS: usize = 16;

/// Use of an axis in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum AxisUse {
    /// Motion or address of the axis.
    Named,
    /// Switch of friction compensation of the axis.
    Switched,
}

/// Returns the axes that the blocks of a program name, executed or not. Names have the form of R2.20.
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

/// Returns whether a name has the form of an axis name (R2.20).
pub(crate) fn is_axis_name(name: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    name.len() <= 16
        && name.starts_with(['A', 'B', 'C', 'U', 'V', 'W', 'X', 'Y', 'Z', 'Q'])
        && name.chars().all(letter)
}

/// Kind of a named thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// A local subprogram.
    Program,
    /// `N100:` or `[NAME]`.
    Label,
    /// A file that is called.
    File,
}

/// Role of a name at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NameRole {
    /// Definition of the name.
    Definition,
    /// Call of the name, or jump to it.
    Use,
}

/// A name in a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NameInBlock {
    /// Kind of the named thing.
    pub named: Named,
    /// Role at this place.
    pub role: NameRole,
    /// A number without leading zeros: `N30`.
    pub name: String,
    /// Span of the name.
    pub span: Span,
}

/// Returns the names of a block, from left to right. The contents of a variable have none.
pub fn names_in(block: &Block, text: &str) -> Vec<NameInBlock> {
    let mut names = NameSearch {
        text,
        found: Vec::new(),
    };
    if let Some(number) = block.number.filter(|number| number.label)
        && let Operand::Number(value) = number.value
    {
        let label = number.span.of(text).trim_end_matches([':', ' ', '\t']);
        let span = Span::new(
            number.span.range().start,
            number.span.range().start + label.len(),
        );
        names.add(Named::Label, NameRole::Definition, (numbered(value), span));
    }
    for item in &block.items {
        match item {
            Item::Label(span) => names.label(*span, NameRole::Definition),
            Item::Flow(Flow::Goto(target), span) => {
                // `$GOTON30` needs no blank.
                let after = Span::new(span.range().start + "$GOTO".len(), span.range().end);
                names.targets([Some(target), None], after);
            }
            Item::Call(call) => names.call(call.name, call.scope),
            Item::Sequence(part) => match part.name {
                Some(name) => names.call(name, CallScope::Global),
                None => names.targets([Some(&part.first), part.last.as_ref()], part.span),
            },
            _ => {}
        }
    }
    names.found
}

struct NameSearch<'a> {
    text: &'a str,
    found: Vec<NameInBlock>,
}

impl NameSearch<'_> {
    fn add(&mut self, named: Named, role: NameRole, (name, span): (String, Span)) {
        self.found.push(NameInBlock {
            named,
            role,
            name,
            span,
        });
    }

    fn label(&mut self, span: Span, role: NameRole) {
        self.add(Named::Label, role, (span.of(self.text).to_owned(), span));
    }

    fn call(&mut self, name: CallName, scope: CallScope) {
        let span = match name {
            CallName::Literal(span) => span,
            CallName::Quoted(span) => Span::new(span.range().start + 1, span.range().end - 1),
            CallName::Variable(_) => return,
        };
        let named = match scope {
            CallScope::Local => Named::Program,
            CallScope::Global => Named::File,
        };
        self.add(named, NameRole::Use, (span.of(self.text).to_owned(), span));
    }

    /// Adds the labels that a statement names, in their order.
    fn targets(&mut self, targets: [Option<&BlockReference>; 2], statement: Span) {
        let mut from = statement.range().start;
        for target in targets.into_iter().flatten() {
            match target {
                BlockReference::Label(span) => {
                    self.label(*span, NameRole::Use);
                    from = span.range().end;
                }
                BlockReference::Number(Operand::Number(value)) => {
                    let Some(span) = number_in(self.text, from..statement.range().end) else {
                        return;
                    };
                    from = span.range().end;
                    self.add(Named::Label, NameRole::Use, (numbered(*value), span));
                }
                BlockReference::Number(_) | BlockReference::Variable(_) => {}
            }
        }
    }
}

fn numbered(value: f64) -> String {
    format!("N{value}")
}

/// Returns the first `N` with its number in a part of a text.
fn number_in(text: &str, part: std::ops::Range<usize>) -> Option<Span> {
    let bytes = &text.as_bytes()[part.clone()];
    let is_number = |at: &usize| {
        let begins = at
            .checked_sub(1)
            .is_none_or(|before| !bytes[before].is_ascii_alphanumeric());
        begins && bytes.get(at + 1).is_some_and(u8::is_ascii_digit)
    };
    let start = memchr::memchr2_iter(b'N', b'n', bytes).find(is_number)?;
    let digits = bytes[start + 1..]
        .iter()
        .take_while(|it| it.is_ascii_digit());
    let length = 1 + digits.count();
    Some(Span::new(part.start + start, part.start + start + length))
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
