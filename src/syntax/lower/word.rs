//! Words: block numbers, addresses with a value, axes with longer names, `G800[…]`.

use pest::iterators::Pair;

use super::block::{BlockLowering, span_of};
use crate::diagnostic::Code;
use crate::syntax::ast::{Address, BlockNumber, Effect, GCall, Item, Operand, Word};
use crate::syntax::fault::{Fault, repeated_word};
use crate::syntax::{expression, grammar::Rule};
use crate::text::Span;

impl BlockLowering<'_> {
    pub(super) fn number(&mut self, pair: Pair<'_, Rule>, span: Span) {
        self.note_case(Span::new(span.start as usize, span.start as usize + 1));
        let mut value = Operand::Number(0.0);
        let mut label = false;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::number_value => {
                    if let Some(inner) = part.into_inner().next() {
                        value = expression::lower_primary(inner, 0, self.block);
                    }
                }
                _ => label = true,
            }
        }
        if self.block.number.is_some() {
            self.block
                .faults
                .push(repeated_word(span.of(self.code), span));
            return;
        }
        self.block.number = Some(BlockNumber { value, label, span });
    }

    /// FC212: `X1E2` is X1 and a feed of 2 at the end of the block (R2.113; PM/206811147).
    fn note_exponent(&mut self, span: Span) {
        let start = span.start as usize;
        let bytes = self.code.as_bytes();
        let is_number = |byte: u8| byte.is_ascii_digit() || byte == b'.';
        let before = start.checked_sub(1).and_then(|at| bytes.get(at));
        let after = bytes.get(start + 1);
        let joins = before.is_some_and(|byte| is_number(*byte))
            && after.is_some_and(|byte| is_number(*byte) || matches!(byte, b'+' | b'-'));
        if joins {
            let shown = span.of(self.code).trim();
            let message = format!(
                "`{shown}` looks like an exponent and is a word of its own: the feed at the end of the block"
            );
            self.block.faults.push(
                Fault::new(Code::Fc212, span, message)
                    .with_help("write the number without an exponent, or a blank before `E`"),
            );
        }
    }

    pub(super) fn bare_word(&mut self, span: Span) {
        let text = span.of(self.code).as_bytes();
        match text {
            [letter] if is_axis_letter(*letter) => {
                self.flush_unknown();
                self.block.push_word(Word {
                    address: address(*letter),
                    value: None,
                    span,
                });
            }
            _ => self.unknown = Some(self.unknown.map_or(span, |so_far| so_far.to(span))),
        }
    }

    /// Letters with a number after each, and blanks between them.
    pub(super) fn plain_words(&mut self, words: Span) {
        let mut start = words.start as usize;
        for word in words.of(self.code).as_bytes().split(|byte| *byte == b' ') {
            let span = Span::new(start, start + word.len());
            start += word.len() + 1;
            match word {
                [] => {}
                [b'N', b'0'..=b'9' | b'.', ..]
                    if self.block.number.is_none() && self.block.words.is_empty() =>
                {
                    self.plain_number(span);
                }
                _ => self.plain_word(span),
            }
        }
    }

    /// `N10` before plain words.
    fn plain_number(&mut self, span: Span) {
        let value = self.plain_value(span);
        self.block.number = Some(BlockNumber {
            value,
            label: false,
            span,
        });
    }

    /// A letter with a number after it.
    pub(super) fn plain_word(&mut self, span: Span) {
        let letter = span.of(self.code).bytes().next().unwrap_or_default();
        let value = self.plain_value(span);
        self.block.push_word(Word {
            address: address(letter),
            value: Some(value),
            span,
        });
    }

    /// The number after the letter of a plain word.
    fn plain_value(&mut self, word: Span) -> Operand {
        let number = Span::new(word.start as usize + 1, word.end as usize);
        expression::lower_number(number.of(self.code), number, self.block)
    }

    pub(super) fn word(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner().peekable();
        let main = inner
            .next_if(|part| part.as_rule() == Rule::main_axis)
            .is_some();
        let (Some(letter), Some(value)) = (inner.next(), inner.next()) else {
            return;
        };
        let byte = letter.as_str().bytes().next().unwrap_or_default();
        if byte.eq_ignore_ascii_case(&b'E') && !main {
            self.note_exponent(span);
        }
        if main || !is_axis_letter(byte) {
            self.note_case(span_of(&letter));
        }
        let letter = byte.to_ascii_uppercase();
        // `M200=1200`, `G159=3` (PM/205952267)
        let carries = matches!(letter, b'M' | b'H' | b'T' | b'G') && !main;
        let second = inner.next();
        if second.is_some() && !carries {
            // `L10=5` may call something, `R1=5` assigns to something.
            let effect = if letter == b'L' {
                Effect::Everything
            } else {
                Effect::Parameters
            };
            self.unread(effect, span);
            return;
        }
        let value = expression::lower(value, 0, self.block);
        if let Some(second) = second.and_then(|second| second.into_inner().next()) {
            let second = expression::lower(second, 0, self.block);
            self.block.second_values.push((span, second));
        }
        let address = if main {
            Address::Main(byte.to_ascii_uppercase())
        } else {
            address(byte)
        };
        self.block.push_word(Word {
            address,
            value: Some(value),
            span,
        });
    }

    pub(super) fn named_word(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner();
        if let (Some(name), Some(value)) = (inner.next(), inner.next()) {
            let name = span_of(&name);
            let value = expression::lower(value, 0, self.block);
            self.block.push_word(Word {
                address: Address::Name(name),
                value: Some(value),
                span,
            });
        }
    }

    pub(super) fn g_call(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner();
        let number = inner.next().and_then(|index| index.as_str().parse().ok());
        let arguments = inner
            .flat_map(Pair::into_inner)
            .map(|argument| {
                let value = argument.into_inner().next()?;
                Some(expression::lower(value, 0, self.block))
            })
            .collect();
        self.block.items.push(Item::GCall(GCall {
            number: number.unwrap_or(u32::MAX),
            arguments,
            span,
        }));
    }
}

fn is_axis_letter(byte: u8) -> bool {
    matches!(byte.to_ascii_uppercase(), b'A'..=b'C' | b'U'..=b'Z' | b'Q')
}

fn address(byte: u8) -> Address {
    if byte.is_ascii_lowercase() && is_axis_letter(byte) {
        Address::Lower(byte)
    } else {
        Address::Letter(byte.to_ascii_uppercase())
    }
}
