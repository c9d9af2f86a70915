//! The arguments in the brackets of a command.

use pest::Parser;
use pest::iterators::Pair;

use super::lowering::{BlockLowering, span_of, trimmed};
use crate::syntax::ast::{Argument, BracketArguments, Operand, SpindleWord};
use crate::syntax::expression;
use crate::syntax::grammar::{NcParser, Rule};
use crate::text::Span;

impl BlockLowering<'_> {
    /// The arguments in a part of the block.
    pub(super) fn arguments_in(&mut self, part: Span) -> BracketArguments {
        let mut arguments = Vec::new();
        let (mut group, mut item) = (0, 0);
        let read = NcParser::parse(Rule::arguments, part.of(self.read));
        let read = read.into_iter().flatten().flat_map(Pair::into_inner);
        for pair in read {
            match pair.as_rule() {
                Rule::argument_group => (group, item) = (group + 1, item + 1),
                Rule::argument_next => item += 1,
                Rule::argument | Rule::argument_other => {
                    let mut argument = Argument {
                        group,
                        item,
                        key: None,
                        span: trimmed(span_of(&pair).shifted(part.start), self.code),
                        value: None,
                    };
                    for inner in pair.into_inner() {
                        self.take_part(inner, part.start, &mut argument);
                    }
                    arguments.push(argument);
                }
                _ => {}
            }
        }
        BracketArguments(arguments)
    }

    /// Takes the key or the value of an argument.
    fn take_part(&mut self, part: Pair<'_, Rule>, base: u32, argument: &mut Argument) {
        let is_key = part.as_rule() == Rule::argument_key;
        let Some(inner) = part.into_inner().next() else {
            return;
        };
        let span = trimmed(span_of(&inner).shifted(base), self.code);
        if is_key {
            argument.key = Some(span);
            return;
        }
        argument.span = span;
        if inner.as_rule() == Rule::expression {
            argument.value = self.value_of(inner, base);
        }
    }

    /// The value of an argument; none where it cannot be read.
    fn value_of(&mut self, pair: Pair<'_, Rule>, base: u32) -> Option<Operand> {
        let (said, nodes) = (self.block.faults.len(), self.block.nodes.len());
        let value = expression::lower(pair, base, self.block);
        if self.block.faults.len() == said {
            return Some(value);
        }
        self.block.faults.truncate(said);
        self.block.nodes.truncate(nodes);
        self.block.spans.truncate(nodes);
        None
    }

    /// The words in the bracket of a spindle that are followed: `REV1200`, `REV=P1`, `M3`.
    pub(super) fn spindle_words(&mut self, arguments: &BracketArguments) -> Vec<SpindleWord> {
        let mut words = Vec::new();
        for argument in arguments.iter() {
            let word = argument.key.unwrap_or(argument.span);
            let text = word.of(self.code);
            if let Some(speed) = after_letters(text, "REV") {
                let digits = Span::new(word.end as usize - speed.len(), word.end as usize);
                let value = match argument.key {
                    Some(_) => argument.value,
                    None => self.lone_value(digits),
                };
                words.push(SpindleWord::Speed(value));
            } else if let Some(number) = after_letters(text, "M")
                && let Ok(number) = number.parse()
            {
                words.push(SpindleWord::M(number));
            }
        }
        words
    }

    /// The value of a text that is one expression.
    fn lone_value(&mut self, span: Span) -> Option<Operand> {
        let read = NcParser::parse(Rule::lone_expression, span.of(self.read)).ok()?;
        let value = read.flat_map(Pair::into_inner).next()?;
        self.value_of(value, span.start)
    }
}

/// The text after some letters, in either case.
fn after_letters<'a>(word: &'a str, letters: &str) -> Option<&'a str> {
    let (start, rest) = word.split_at_checked(letters.len())?;
    start.eq_ignore_ascii_case(letters).then_some(rest)
}
