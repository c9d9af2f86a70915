//! pest pairs to blocks.

mod bracket;
mod call;
mod flow;
mod hash;
mod part;

pub(crate) use flow::is_statement;

use pest::Parser;
use pest::iterators::Pair;

use super::ast::{
    Address, Assignment, Block, CallScope, Declaration, Effect, GCall, Item, Number, Operand,
    Target, Word,
};
use super::grammar::{NcParser, Rule};
use super::unread::not_known;
use super::{Fault, MAX_BRACKETS, expression};
use crate::diagnostic::Code;
use crate::text::Span;

/// Parses the code of a block into an empty block.
pub(super) fn block(code: &str, block: &mut Block) {
    block_as(Rule::block, code, block);
}

/// The same from another rule than the one that all blocks are parsed with.
pub(super) fn block_as(rule: Rule, code: &str, block: &mut Block) {
    let unclosed = match brackets(code) {
        Ok(unclosed) => unclosed,
        Err(fault) => {
            block.faults.push(fault);
            return;
        }
    };
    let Ok(mut pairs) = NcParser::parse(rule, code) else {
        // `block` matches any text; see the last alternative of `item`.
        block
            .faults
            .push(not_understood(Span::new(0, code.len()), code));
        return;
    };
    let mut lowering = Lowering {
        code,
        block,
        unclosed,
        unknown: None,
        lower_case: None,
    };
    if let Some(pair) = pairs.next() {
        match pair.as_rule() {
            Rule::plain_block => lowering.plain_words(Span::new(0, code.len())),
            _ => pair.into_inner().for_each(|part| lowering.part(part)),
        }
    }
    lowering.finish();
}

/// Finds the first `[` that is never closed; refuses what nests too deeply for recursion.
pub(super) fn brackets(code: &str) -> Result<Option<usize>, Fault> {
    let bytes = code.as_bytes();
    if memchr::memchr2(b'[', b'*', bytes).is_none() {
        return Ok(None);
    }
    let mut open = Vec::new();
    let mut powers = 0_usize;
    let mut text_end = 0;
    for (at, byte) in bytes.iter().enumerate() {
        match byte {
            _ if at < text_end => {}
            b'"' => text_end = super::lines::text_end(bytes, at).unwrap_or_default(),
            b'[' => open.push(at),
            b']' => {
                open.pop();
            }
            b'*' if bytes.get(at + 1) == Some(&b'*') => powers += 1,
            _ => {}
        }
        if open.len() > MAX_BRACKETS || powers > MAX_BRACKETS {
            return Err(Fault::new(
                Code::Fc913,
                Span::new(at, at + 1),
                format!("expressions nest more than {MAX_BRACKETS} deep"),
            )
            .with_help("compute parts of it in blocks of their own"));
        }
    }
    Ok(open.first().copied())
}

fn span_of(pair: &Pair<'_, Rule>) -> Span {
    let span = pair.as_span();
    Span::new(span.start(), span.end())
}

/// The span without the blanks that pest leaves at its end.
fn trimmed(span: Span, code: &str) -> Span {
    let text = span.of(code);
    let length = text.trim_end_matches(super::lines::is_blank).len();
    Span::new(span.start as usize, span.start as usize + length)
}

fn not_understood(span: Span, code: &str) -> Fault {
    let found = span.of(code).trim();
    let shown: String = found.chars().take(40).collect();
    Fault::new(
        Code::Fc207,
        span,
        format!("`{shown}` is not understood here"),
    )
}

struct Lowering<'a> {
    code: &'a str,
    block: &'a mut Block,
    /// The first `[` that is never closed.
    unclosed: Option<usize>,
    /// Tokens that no rule understood, so far.
    unknown: Option<Span>,
    /// The first address or keyword in lower case.
    lower_case: Option<Span>,
}

impl Lowering<'_> {
    fn part(&mut self, pair: Pair<'_, Rule>) {
        if !matches!(pair.as_rule(), Rule::unknown | Rule::bare_word) {
            self.flush_unknown();
        }
        let span = trimmed(span_of(&pair), self.code);
        match pair.as_rule() {
            Rule::skip => {
                let level = pair.into_inner().next();
                self.block.skip =
                    Some(level.map_or(1, |level| level.as_str().parse().unwrap_or(1)));
            }
            Rule::number => self.number(pair, span),
            Rule::flow => self.flow(pair, span),
            Rule::hash => self.hash(span),
            Rule::macro_definition => {
                let mut texts = pair.into_inner().map(|text| span_of(&text));
                if let (Some(name), Some(code)) = (texts.next(), texts.next()) {
                    self.block.items.push(Item::MacroDefinition(name, code));
                }
            }
            Rule::macro_use => self.block.items.push(Item::MacroUse(span)),
            Rule::label => {
                let name = pair.into_inner().next().map_or(span, |name| span_of(&name));
                self.label(name, span);
            }
            Rule::spindle_word => self.spindle_word(pair, span),
            Rule::unread_bracket => {
                let assigns = pair
                    .into_inner()
                    .any(|part| part.as_rule() == Rule::expression);
                let effect = if assigns {
                    Effect::Parameters
                } else {
                    Effect::Everything
                };
                self.unread(effect, span);
            }
            Rule::cycle_call => self.cycle_call(pair, span),
            Rule::sequence_call => self.sequence_call(pair, span),
            Rule::return_call => self.return_call(pair, span),
            Rule::local_call => self.plain_call(pair, CallScope::Local, span),
            Rule::global_call => self.plain_call(pair, CallScope::Global, span),
            Rule::assignment => self.assignment(pair, span),
            Rule::axis_bracket => self.axis_bracket(pair, span),
            Rule::named_word => self.named_word(pair, span),
            Rule::g_call => self.g_call(pair, span),
            Rule::plain_words => self.plain_words(span),
            Rule::plain_word => self.plain_word(span),
            Rule::word => self.word(pair, span),
            Rule::bare_number => {
                if let Some(value) = pair.into_inner().next() {
                    let value = expression::lower(value, 0, self.block);
                    self.block.items.push(Item::BareNumber(value, span));
                }
            }
            Rule::bare_word => self.bare_word(span),
            Rule::unknown => {
                self.unknown = Some(self.unknown.map_or(span, |so_far| so_far.to(span)));
            }
            _ => {}
        }
    }

    /// A label stands in front of everything else; a bracket behind words is none (R2.70).
    fn label(&mut self, name: Span, span: Span) {
        if self.block.words.is_empty() && self.block.items.is_empty() {
            self.block.items.push(Item::Label(name));
        } else {
            self.unread(Effect::Everything, span);
        }
    }

    /// Text with the form of the language that is not known here (R2.70).
    fn unread(&mut self, effect: Effect, span: Span) {
        self.block.faults.push(not_known(span.of(self.code), span));
        self.block.items.push(Item::Unread(effect, span));
    }

    fn finish(&mut self) {
        self.flush_unknown();
        if let Some(span) = self.lower_case {
            let word = span.of(self.code);
            self.block.faults.push(
                Fault::new(Code::Fc404, span, format!("`{word}` is not in upper case"))
                    .with_help(format!("write `{}`", word.to_ascii_uppercase())),
            );
        }
    }

    fn flush_unknown(&mut self) {
        let Some(span) = self.unknown.take() else {
            return;
        };
        let fault = match self.unclosed.take() {
            Some(at) => not_closed(at),
            None => not_understood(span, self.code),
        };
        self.block.items.push(Item::BadCommand(span));
        self.block.faults.push(fault);
    }

    fn note_case(&mut self, span: Span) {
        let lower = span
            .of(self.code)
            .bytes()
            .any(|byte| byte.is_ascii_lowercase());
        if lower && self.lower_case.is_none() {
            self.lower_case = Some(span);
        }
    }

    fn number(&mut self, pair: Pair<'_, Rule>, span: Span) {
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
        self.block.number = Some(Number { value, label, span });
    }

    fn bare_word(&mut self, span: Span) {
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

    /// Letters with a number behind each, and blanks between them.
    fn plain_words(&mut self, words: Span) {
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

    /// `N10` in front of plain words.
    fn plain_number(&mut self, span: Span) {
        let value = self.plain_value(span);
        self.block.number = Some(Number {
            value,
            label: false,
            span,
        });
    }

    /// A letter with a number after it.
    fn plain_word(&mut self, span: Span) {
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

    fn word(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner().peekable();
        let main = inner
            .next_if(|part| part.as_rule() == Rule::main_axis)
            .is_some();
        let (Some(letter), Some(value)) = (inner.next(), inner.next()) else {
            return;
        };
        let byte = letter.as_str().bytes().next().unwrap_or_default();
        if main || !is_axis_letter(byte) {
            self.note_case(span_of(&letter));
        }
        let letter = byte.to_ascii_uppercase();
        // `M200=1200`, `G159=3` (PM/205952267)
        let carries = matches!(letter, b'M' | b'H' | b'T' | b'G') && !main;
        if inner.next().is_some() && !carries {
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

    fn named_word(&mut self, pair: Pair<'_, Rule>, span: Span) {
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

    fn g_call(&mut self, pair: Pair<'_, Rule>, span: Span) {
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

    fn assignment(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner();
        if let (Some(place), Some(sign), Some(value)) = (inner.next(), inner.next(), inner.next()) {
            let target = self.target(place.clone());
            let operator = expression::operator(sign.as_str().trim_end_matches('='));
            let value = match operator {
                Some(operator) => expression::compound((place, value), operator, self.block),
                None => expression::lower(value, 0, self.block),
            };
            self.block.items.push(Item::Assign(Assignment {
                target,
                value,
                span,
            }));
        }
    }

    fn target(&mut self, pair: Pair<'_, Rule>) -> Target {
        let span = trimmed(span_of(&pair), self.code);
        let place = expression::place(pair, 0, self.block);
        Target { place, span }
    }

    fn refuse(&mut self, fault: Fault, span: Span) {
        self.block.faults.push(fault);
        self.block.items.push(Item::BadCommand(span));
    }

    fn declarations(&mut self, rest: Span) -> Vec<Declaration> {
        let mut declarations = Vec::new();
        let mut start = rest.start as usize;
        let mut left = rest.of(self.code);
        let last_bracket = start + left.rfind(']').unwrap_or_default();
        while !left.is_empty() {
            let line = &left[..declaration_end(left, last_bracket.saturating_sub(start))];
            left = left.get(line.len() + 1..).unwrap_or_default();
            let span = Span::new(start, start + line.len());
            start += line.len() + 1;
            let code = line.trim_matches(super::lines::is_blank);
            if code.is_empty() || super::lines::hash_word(line).is_some() {
                continue;
            }
            if let Ok(pairs) = NcParser::parse(Rule::declaration_line, line) {
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
        let mut kind = None;
        let mut initial = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::variable_or_array => {
                    let span = trimmed(span_of(&part).shifted(base), self.code);
                    let place = expression::place(part, base, self.block);
                    target = Some(Target { place, span });
                }
                Rule::type_name => {
                    kind = part
                        .into_inner()
                        .next()
                        .map(|word| word.as_str().to_ascii_uppercase());
                }
                Rule::initial => self.initial(part, base, &mut initial),
                _ => {}
            }
        }
        Some(Declaration {
            target: target?,
            kind,
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

/// How long the first declaration of a region is: one line, or more where a bracket stays open, as the
/// values of an array may. A bracket behind the last `]` is never closed and ends with its line.
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

fn not_closed(at: usize) -> Fault {
    Fault::new(
        Code::Fc205,
        Span::new(at, at + 1),
        "this bracket is not closed",
    )
    .with_help("close it with `]`, or continue the command on the next line with `\\`")
}
