//! A block from its pairs, part by part.

use pest::Parser;
use pest::iterators::Pair;

use super::lowering::{BlockLowering, not_understood, span_of, trimmed};
use crate::diagnostic::Code;
use crate::syntax::ast::{Block, CallScope, Effect, Item};
use crate::syntax::brackets::{Brackets, brackets};
use crate::syntax::expression;
use crate::syntax::fault::Fault;
use crate::syntax::grammar::{NcParser, Rule, gave_up};
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

/// A block that is not read: the control may read it, so it may do anything (R2.70).
fn give_up(fault: Fault, block: &mut Block) {
    block
        .items
        .push(Item::Unread(Effect::Everything, fault.span));
    block.faults.push(fault);
}

/// The parser took too many steps, or too much of the stack.
fn too_much_to_read(span: Span) -> Fault {
    let message = "the block is not understood: reading it takes more steps than frictcomp allows";
    Fault::new(Code::Fc913, span, message).with_help("split the block into several")
}

impl BlockLowering<'_> {
    /// A skip mark with a level that does not exist skips nothing: it is a mistake regardless of the switches (R2.3).
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
