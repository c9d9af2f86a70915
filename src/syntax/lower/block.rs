//! A block from its pairs, part by part, and what its parts have in common.

use pest::Parser;
use pest::iterators::Pair;

use crate::diagnostic::Code;
use crate::syntax::ast::{Assignment, Block, CallScope, Effect, Item, Target};
use crate::syntax::expression;
use crate::syntax::grammar::{NcParser, Rule, gave_up};
use crate::syntax::keywords::{in_upper_case, not_known};
use crate::syntax::parse::Fault;
use crate::syntax::pieces::{Brackets, brackets, is_blank};
use crate::syntax::skip_levels::SkipLevels;
use crate::text::Span;

/// Parses the code of a block into an empty block.
pub(crate) fn block(code: &str, block: &mut Block) {
    block_as(Rule::block, code, block);
}

/// Parses the code of a block with a rule other than the one for all blocks.
pub(crate) fn block_as(rule: Rule, code: &str, block: &mut Block) {
    let Brackets { read, unclosed } = match brackets(code) {
        Ok(brackets) => brackets,
        Err(fault) => return give_up(fault, block),
    };
    read_as(rule, code, (&read, unclosed), block);
}

/// Parses the code of a block whose brackets are known.
pub(crate) fn read_as(
    rule: Rule,
    code: &str,
    (read, unclosed): (&str, Option<usize>),
    block: &mut Block,
) {
    let mut pairs = match NcParser::parse(rule, read) {
        Ok(pairs) => pairs,
        Err(error) => {
            let span = Span::new(0, code.len());
            return give_up(
                if gave_up(&error) {
                    too_much_to_read(span)
                } else {
                    // `block` matches any text; see the last alternative of `item`.
                    not_understood(span, code)
                },
                block,
            );
        }
    };
    let mut lowering = BlockLowering {
        code,
        read,
        block,
        unclosed,
        unknown: None,
        lower_case: Vec::new(),
    };
    if let Some(pair) = pairs.next() {
        match pair.as_rule() {
            Rule::plain_block => lowering.plain_words(Span::new(0, code.len())),
            _ => pair.into_inner().for_each(|part| lowering.part(part)),
        }
    }
    lowering.finish();
}

/// Gives up a block that is not read: the control may read it, so it may do anything (R2.70).
fn give_up(fault: Fault, block: &mut Block) {
    block
        .items
        .push(Item::Unread(Effect::Everything, fault.span));
    block.faults.push(fault);
}

/// Returns the fault of a parser that took too many steps, or too much of the stack.
fn too_much_to_read(span: Span) -> Fault {
    let message = "the block is not understood: reading it takes more steps than frictcomp allows";
    Fault::new(Code::Fc913, span, message).with_help("split the block into several")
}

impl BlockLowering<'_> {
    /// Reads a skip mark; one with a level that does not exist skips nothing: it is a mistake regardless of the
    /// switches (R2.3).
    fn skip_mark(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let level = pair.into_inner().next();
        let named = level.map_or("1", |level| level.as_str());
        let level = (1..=SkipLevels::HIGHEST).find(|level| level.to_string() == named);
        self.block.skip = level;
        if level.is_none() {
            let highest = SkipLevels::HIGHEST;
            let message = format!("there is no skip level `{named}`");
            let fault = Fault::new(Code::Fc207, span, message)
                .with_help(format!("skip levels are `/1` to `/{highest}`"));
            self.refuse(fault, span);
        }
    }

    fn part(&mut self, pair: Pair<'_, Rule>) {
        if !matches!(pair.as_rule(), Rule::unknown | Rule::bare_word) {
            self.flush_unknown();
        }
        let span = trimmed(span_of(&pair), self.code);
        match pair.as_rule() {
            Rule::skip => self.skip_mark(pair, span),
            Rule::number => self.number(pair, span),
            Rule::flow => self.flow(pair, span),
            Rule::hash => {
                self.words_before(span);
                self.hash(span);
            }
            Rule::hash_word | Rule::hash_switch => self.hash_word(span),
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
}

/// A block that is being lowered.
pub(super) struct BlockLowering<'a> {
    pub(super) code: &'a str,
    /// The code as the parser reads it.
    pub(super) read: &'a str,
    pub(super) block: &'a mut Block,
    /// The first `[` that is never closed.
    pub(super) unclosed: Option<usize>,
    /// Tokens that no rule understood, so far.
    pub(super) unknown: Option<Span>,
    /// The addresses and keywords in lower case.
    pub(super) lower_case: Vec<Span>,
}

impl BlockLowering<'_> {
    /// Reads a label, which comes before everything else; a bracket after words is not a label (R2.70).
    pub(super) fn label(&mut self, name: Span, span: Span) {
        if self.block.words.is_empty() && self.block.items.is_empty() {
            self.block.items.push(Item::Label(name));
        } else {
            self.unread(Effect::Everything, span);
        }
    }

    /// Records text with the form of the language, but no known meaning (R2.70).
    pub(super) fn unread(&mut self, effect: Effect, span: Span) {
        self.block.faults.push(not_known(span.of(self.code), span));
        self.block.items.push(Item::Unread(effect, span));
    }

    pub(super) fn finish(&mut self) {
        self.flush_unknown();
        self.refuse_after_call();
        let words = &self.lower_case;
        if let (Some(span), Some(fix)) = (words.first(), in_upper_case(self.code, words)) {
            let word = span.of(self.code);
            self.block.faults.push(
                Fault::new(Code::Fc404, *span, format!("`{word}` is not in upper case"))
                    .with_help(format!("write `{}`", word.to_ascii_uppercase()))
                    .with_fix(fix),
            );
        }
    }

    /// Refuses whatever follows a call in its block (TF5200 Diagnosis, error 21542).
    fn refuse_after_call(&mut self) {
        let mut items = self.block.items.iter();
        let Some(Item::Call(call)) = items.find(|item| matches!(item, Item::Call(_))) else {
            return;
        };
        let is_after = |item: &&Item| item.span().start > call.span.start;
        let follows = items.find(is_after);
        let Some(item) = follows.filter(|item| !matches!(item, Item::BadCommand(_))) else {
            return;
        };
        let (shown, call) = (item.span().of(self.code), call.span.of(self.code));
        let message = format!(
            "`{}` follows the call `{}` in its block, where the control accepts nothing",
            shown.trim(),
            call.trim()
        );
        let fault = Fault::new(Code::Fc207, item.span(), message)
            .with_help("write it before the call, or in the next block");
        self.block.faults.push(fault);
    }

    pub(super) fn flush_unknown(&mut self) {
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

    pub(super) fn note_case(&mut self, span: Span) {
        let lower = span
            .of(self.code)
            .bytes()
            .any(|byte| byte.is_ascii_lowercase());
        if lower {
            self.lower_case.push(span);
        }
    }

    pub(super) fn assignment(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner();
        if let (Some(place), Some(sign), Some(value)) = (inner.next(), inner.next(), inner.next()) {
            let target = self.target(place.clone());
            let operator = expression::operator(sign.as_str().trim_end_matches('='));
            let value = match operator {
                Some(operator) => expression::compound(place, operator, value, self.block),
                None => expression::lower(value, 0, self.block),
            };
            self.block.items.push(Item::Assign(Assignment {
                target,
                value,
                span,
            }));
        }
    }

    pub(super) fn target(&mut self, pair: Pair<'_, Rule>) -> Target {
        let span = trimmed(span_of(&pair), self.code);
        let place = expression::place(pair, 0, self.block);
        Target { place, span }
    }

    pub(super) fn refuse(&mut self, fault: Fault, span: Span) {
        self.block.faults.push(fault);
        self.block.items.push(Item::BadCommand(span));
    }
}

pub(super) fn span_of(pair: &Pair<'_, Rule>) -> Span {
    let span = pair.as_span();
    Span::new(span.start(), span.end())
}

/// Returns the span without the blanks that pest leaves at its end.
pub(super) fn trimmed(span: Span, code: &str) -> Span {
    let text = span.of(code);
    let length = text.trim_end_matches(is_blank).len();
    Span::new(span.start as usize, span.start as usize + length)
}

pub(super) fn not_understood(span: Span, code: &str) -> Fault {
    let found = span.of(code).trim();
    let shown: String = found.chars().take(40).collect();
    let fault = Fault::new(
        Code::Fc207,
        span,
        format!("`{shown}` is not understood here"),
    );
    let before = code.get(..span.start as usize).unwrap_or_default();
    if found == "O" && before.ends_with(|letter: char| letter.is_ascii_digit()) {
        return fault.with_help("write the digit `0` in place of the letter `O`");
    }
    fault
}

pub(super) fn not_closed(at: usize) -> Fault {
    Fault::new(
        Code::Fc205,
        Span::new(at, at + 1),
        "this bracket is not closed",
    )
    .with_help("close it with `]`, or continue the command on the next line with `\\`")
}
