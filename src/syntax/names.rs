//! The names that a block defines and uses: programs, jump labels, files.

use super::ast::{Block, BlockReference, CallName, CallScope, Flow, Item, Operand};
use crate::text::Span;

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
    /// The named thing is defined here.
    Definition,
    /// It is called, or jumped to.
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

/// The names of a block, from left to right. The contents of a variable have none.
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

    /// The labels that a statement names, in their order.
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

/// The first `N` with its number in a part of a text.
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
