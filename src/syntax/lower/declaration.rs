//! The declarations of `#VAR`.

use pest::Parser;
use pest::iterators::Pair;

use super::lowering::{BlockLowering, not_understood, span_of, trimmed};
use crate::syntax::ast::{Declaration, Operand, Target};
use crate::syntax::grammar::{NcParser, Rule};
use crate::syntax::{expression, hash_words::opening_command, pieces::is_blank};
use crate::text::Span;

impl BlockLowering<'_> {
    pub(super) fn declarations(&mut self, rest: Span) -> Vec<Declaration> {
        let mut declarations = Vec::new();
        let mut start = rest.start as usize;
        let mut left = rest.of(self.code);
        let read = self.read;
        let last_bracket = start + left.rfind(']').unwrap_or_default();
        while !left.is_empty() {
            let line = &left[..declaration_end(left, last_bracket.saturating_sub(start))];
            left = left.get(line.len() + 1..).unwrap_or_default();
            let span = Span::new(start, start + line.len());
            start += line.len() + 1;
            let code = line.trim_matches(is_blank);
            if code.is_empty() {
                continue;
            }
            if opening_command(line).is_some() {
                continue;
            }
            if let Ok(pairs) = NcParser::parse(Rule::declaration_line, span.of(read)) {
                let parts = pairs
                    .flat_map(Pair::into_inner)
                    .filter_map(|part| (part.as_rule() == Rule::declaration).then_some(part));
                for part in parts {
                    declarations.extend(self.declaration(part, span.start));
                }
            } else {
                let fault = not_understood(trimmed(span, self.code), self.code)
                    .with_help("declare as in `V.P.COUNT : UNS32 = 3`");
                self.block.faults.push(fault);
            }
        }
        declarations
    }

    fn declaration(&mut self, pair: Pair<'_, Rule>, base: u32) -> Option<Declaration> {
        let mut target = None;
        let (mut kind, mut length) = (None, None);
        let mut initial = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::variable_or_array => {
                    let span = trimmed(span_of(&part).shifted(base), self.code);
                    let place = expression::place(part, base, self.block);
                    target = Some(Target { place, span });
                }
                Rule::type_name => {
                    let mut parts = part.into_inner();
                    kind = parts.next().map(|word| word.as_str().to_ascii_uppercase());
                    let number = parts.next();
                    length = number.map(|number| expression::lower(number, base, self.block));
                }
                Rule::initial => self.initial(part, base, &mut initial),
                _ => {}
            }
        }
        Some(Declaration {
            target: target?,
            kind,
            length,
            initial,
        })
    }

    /// Initial values in row order; nested brackets only group them.
    fn initial(&mut self, pair: Pair<'_, Rule>, base: u32, values: &mut Vec<Operand>) {
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::expression => values.push(expression::lower(part, base, self.block)),
                _ => self.initial(part, base, values),
            }
        }
    }
}

/// Returns the length of the first declaration of a region: one line, or more where a bracket stays open, as
/// the values of an array may. A bracket after the last `]` is never closed and ends with its line.
fn declaration_end(text: &str, last_bracket: usize) -> usize {
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'[' => depth += 1,
            b']' => depth = depth.saturating_sub(1),
            b'\n' if depth == 0 || at > last_bracket => return at,
            _ => {}
        }
    }
    text.len()
}
