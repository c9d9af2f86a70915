//! `#` commands.

use pest::Parser;
use pest::iterators::Pair;

use super::lowering::{BlockLowering, span_of, trimmed};
use crate::diagnostic::nearest;
use crate::syntax::ast::{Effect, Hash, Item, Operand, Target};
use crate::syntax::grammar::{NcParser, Rule};
use crate::syntax::keywords::{Touches, hash_command, hash_commands};
use crate::syntax::{expression, hash_words::hash_name, unread::not_known};
use crate::text::Span;

impl BlockLowering<'_> {
    pub(super) fn hash(&mut self, span: Span) {
        let code = self.code;
        let (name, length) = hash_name(&code[span.start as usize..]);
        let name_end = span.start as usize + length;
        self.note_case(Span::new(span.start as usize, name_end));
        let Some(touches) = hash_command(&name) else {
            self.unknown_hash(&name, length, span);
            return;
        };
        let rest = Span::new(name_end, span.end as usize);
        let arguments = match name.as_str() {
            "#TIME" | "#DELETE" => self.expressions_in(rest),
            _ => Vec::new(),
        };
        let declarations = if name == "#VAR" {
            self.declarations(rest)
        } else {
            Vec::new()
        };
        let written = match touches {
            Touches::Values => self.places_in(rest),
            _ => Vec::new(),
        };
        self.block.items.push(Item::Hash(Hash {
            name,
            rest,
            arguments,
            declarations,
            written,
            span,
        }));
    }

    /// A `#` command that no table names could do anything (R2.70).
    fn unknown_hash(&mut self, name: &str, length: usize, span: Span) {
        let mut fault = not_known(name, span);
        let start = span.start as usize;
        let near = nearest(name, hash_commands());
        fault = fault.with_near(Span::new(start, start + length), &near);
        fault = fault.with_help(format!(
            "if it affects nothing that frictcomp follows, add `harmless = [\"{name}\"]` to `[machine]` in frictcomp.toml"
        ));
        self.block.faults.push(fault);
        self.block
            .items
            .push(Item::Unread(Effect::Everything, span));
    }

    fn expressions_in(&mut self, rest: Span) -> Vec<Operand> {
        let Ok(pairs) = NcParser::parse(Rule::spaced_expressions, rest.of(self.read)) else {
            return Vec::new();
        };
        let values = pairs.flat_map(Pair::into_inner);
        values
            .map(|value| expression::lower(value, rest.start, self.block))
            .collect()
    }

    /// The parameters and variables that a text names.
    fn places_in(&mut self, rest: Span) -> Vec<Target> {
        let text = rest.of(self.read);
        let mut places = Vec::new();
        let mut from = 0;
        while let Some(start) = next_place(text, from) {
            let found = NcParser::parse(Rule::written_place, &text[start..]).ok();
            let pair = found.and_then(|mut pairs| pairs.next()?.into_inner().next());
            from = start + pair.as_ref().map_or(1, |pair| pair.as_str().len());
            if let Some(pair) = pair {
                let base = rest.start + Span::new(start, start).start;
                let span = trimmed(span_of(&pair).shifted(base), self.code);
                let place = expression::place(pair, base, self.block);
                places.push(Target { place, span });
            }
        }
        places
    }
}

/// Returns the start of the next name that may be one of a parameter or variable.
fn next_place(text: &str, from: usize) -> Option<usize> {
    let bytes = text.as_bytes();
    let begins = |at: &usize| {
        let alone = *at == 0 || !(bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_');
        alone && matches!(bytes[*at], b'P' | b'p' | b'V' | b'v' | b'@')
    };
    (from..bytes.len()).find(begins)
}
