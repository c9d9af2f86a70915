//! Words: block numbers, addresses with a value, axes with longer names, `G800[…]`, words of a spindle, and commands in the brackets
//! of an axis or spindle.

use pest::Parser;
use pest::iterators::Pair;

use super::block::{BlockLowering, not_closed, span_of, trimmed};
use crate::diagnostic::{Code, Fix, did_you_mean, nearest};
use crate::language::AxisCommand;
use crate::syntax::ast::{
    Address, Argument, BlockNumber, BracketArguments, Effect, GCall, Item, Operand, SpindleWord,
    Word,
};
use crate::syntax::comp::{CompWords, end_of_command};
use crate::syntax::expression;
use crate::syntax::grammar::{NcParser, Rule};
use crate::syntax::keywords::{is_spindle_command, is_spindle_word};
use crate::syntax::parse::{Fault, repeated_word};
use crate::syntax::pieces::is_blank;
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

    /// Reports FC212: `X1E2` is X1 and a feed of 2 at the end of the block (R2.113; PM/206811147).
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

    /// Reads `N10` before plain words.
    fn plain_number(&mut self, span: Span) {
        let value = self.plain_value(span);
        self.block.number = Some(BlockNumber {
            value,
            label: false,
            span,
        });
    }

    /// Reads a letter with a number after it.
    pub(super) fn plain_word(&mut self, span: Span) {
        let letter = span.of(self.code).bytes().next().unwrap_or_default();
        let value = self.plain_value(span);
        self.block.push_word(Word {
            address: address(letter),
            value: Some(value),
            span,
        });
    }

    /// Returns the number after the letter of a plain word.
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

impl BlockLowering<'_> {
    pub(super) fn axis_bracket(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut axis = span;
        let mut body = None;
        let mut closed = false;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::axis_name => axis = trimmed(span_of(&part), self.code),
                Rule::bracket_body => body = Some(span_of(&part)),
                Rule::bracket_end => closed = true,
                _ => {}
            }
        }
        let body = body.unwrap_or(span);
        if !closed {
            let open = self.code[axis.end as usize..].find('[').unwrap_or_default();
            self.unclosed = None;
            let open = axis.end as usize + open;
            let mut fault = not_closed(open);
            if let Some(end) = end_of_command(self.code, open + 1) {
                fault = fault.with_fix(Fix::guess(Span::new(end, end), "]"));
            }
            self.refuse(fault, span);
            return;
        }
        let words = words(self.code, body);
        if words.iter().any(|word| word.of(self.code).contains('"')) {
            // The code of a macro may be any part of the command.
            self.unread(Effect::Everything, span);
            return;
        }
        let keyword = words.first().copied();
        let first = keyword.map_or("", |word| word.of(self.code));
        if first.eq_ignore_ascii_case("COMP") {
            let command = CompWords {
                text: self.code,
                axis,
                whole: span,
                words: &words,
            }
            .lower(&mut self.block.faults);
            self.block.items.push(match command {
                Some(command) => Item::Comp(command),
                None => Item::BadCommand(span),
            });
        } else if let Some(keyword) = keyword {
            let spindle = axis.of(self.code).starts_with(['S', 's']) && !near_comp(first);
            let known = if spindle {
                is_spindle_command(first)
            } else {
                AxisCommand::is_known(first)
            };
            if known {
                let words: Vec<&str> = words.iter().map(|word| word.of(self.code)).collect();
                let command = AxisCommand::of(first, &words);
                let arguments = self.arguments_in(body);
                let spindle = if spindle {
                    self.spindle_words(&arguments)
                } else {
                    Vec::new()
                };
                self.block.items.push(Item::Bracket {
                    axis,
                    keyword,
                    command,
                    arguments,
                    spindle,
                    span,
                });
            } else if spindle {
                self.unread(Effect::Spindle, span);
            } else {
                self.refuse(invalid_keyword(keyword, first), span);
            }
        } else {
            self.refuse(
                Fault::new(
                    Code::PErr21301,
                    span,
                    "the bracket of the axis contains no keyword",
                )
                .with_help("write `X[COMP ON FRICT]`, or an expression for a position"),
                span,
            );
        }
    }

    /// Reads `S.POS180`.
    pub(super) fn spindle_word(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut name = span;
        let mut value = None;
        let mut bracketed = false;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::spindle_name => name = trimmed(span_of(&part), self.code),
                Rule::expression => value = Some(expression::lower(part, 0, self.block)),
                _ => bracketed = true,
            }
        }
        let word = name.of(self.code).split('.').nth(1).unwrap_or_default();
        if bracketed || !is_spindle_word(word) {
            self.unread(Effect::Spindle, span);
            return;
        }
        self.block.push_word(Word {
            address: Address::Name(name),
            value,
            span,
        });
    }
}

/// Returns the words of a bracket, separated by blanks.
fn words(code: &str, body: Span) -> Vec<Span> {
    let text = body.of(code);
    let mut words = Vec::new();
    let mut start = None;
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (is_blank(c), start) {
            (false, None) => start = Some(at),
            (true, Some(from)) => {
                words.push(Span::new(from, at).shifted(body.start));
                start = None;
            }
            _ => {}
        }
    }
    words
}

fn near_comp(word: &str) -> bool {
    did_you_mean(word, ["COMP"]).is_some()
}

fn invalid_keyword(span: Span, word: &str) -> Fault {
    let known = AxisCommand::keywords().chain(["COMP"]);
    let fault = Fault::new(
        Code::PErr21301,
        span,
        format!("invalid first keyword `{word}` in an axis bracket"),
    );
    let near = nearest(word, known);
    if near.is_empty() {
        return fault.with_help("friction compensation is switched with `COMP ON FRICT`");
    }
    fault.with_near(span, &near)
}

impl BlockLowering<'_> {
    /// Returns the arguments in a part of the block.
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

    /// Returns the value of an argument; none where it cannot be read.
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

    /// Returns the words in the bracket of a spindle that are followed: `REV1200`, `REV=P1`, `M3`.
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

    /// Returns the value of a text that is one expression.
    fn lone_value(&mut self, span: Span) -> Option<Operand> {
        let read = NcParser::parse(Rule::lone_expression, span.of(self.read)).ok()?;
        let value = read.flat_map(Pair::into_inner).next()?;
        self.value_of(value, span.start)
    }
}

/// Returns the text after some letters, in either case.
fn after_letters<'a>(word: &'a str, letters: &str) -> Option<&'a str> {
    let (start, rest) = word.split_at_checked(letters.len())?;
    start.eq_ignore_ascii_case(letters).then_some(rest)
}
