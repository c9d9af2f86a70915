//! Calls of subprograms, cycles and parts of programs, and returns to places of programs.

use pest::iterators::Pair;

use super::block::{BlockLowering, not_closed, not_understood, span_of, trimmed};
use crate::syntax::ast::{
    BlockReference, Call, CallForm, CallName, CallScope, Effect, Item, Operand, Repetition, Return,
    ReturnLevels, SequenceCall,
};
use crate::syntax::{expression, grammar::Rule};
use crate::text::Span;

impl BlockLowering<'_> {
    pub(super) fn plain_call(&mut self, pair: Pair<'_, Rule>, scope: CallScope, span: Span) {
        let mut name = None;
        for part in pair.into_inner() {
            name = match part.as_rule() {
                Rule::called | Rule::glued_name => {
                    part.into_inner().next().map(|inner| self.call_name(inner))
                }
                _ => Some(self.call_name(part)),
            };
        }
        if let Some(name) = name {
            self.block.items.push(Item::Call(Call {
                scope,
                name,
                form: CallForm::Plain,
                arguments: Vec::new(),
                words: Vec::new(),
                repetition: Repetition::Once,
                span,
            }));
        }
    }

    pub(super) fn call_name(&mut self, pair: Pair<'_, Rule>) -> CallName {
        let span = trimmed(span_of(&pair), self.code);
        match pair.as_rule() {
            Rule::text => CallName::Quoted(span),
            Rule::variable => CallName::Variable(expression::place(pair, 0, self.block)),
            _ => CallName::Literal(span),
        }
    }

    pub(super) fn cycle_call(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut scope = CallScope::Global;
        let mut name = None;
        let mut arguments = Vec::new();
        let mut words = Vec::new();
        let mut known = true;
        let mut repetition = Repetition::Once;
        for part in pair.into_inner() {
            if part.as_rule() == Rule::call_word {
                if part.as_str().len() == 2 {
                    scope = CallScope::Local;
                }
                continue;
            }
            match part.as_rule() {
                Rule::cycle_keyword => continue,
                Rule::unread_rest => known = false,
                _ => {}
            }
            let Some(argument) = part.into_inner().next() else {
                continue;
            };
            match argument.as_rule() {
                Rule::cycle_name => {
                    name = argument
                        .into_inner()
                        .next()
                        .map(|inner| self.call_name(inner));
                }
                Rule::cycle_value => {
                    let mut inner = argument.into_inner();
                    if let (Some(index), Some(value)) = (inner.next(), inner.next()) {
                        let index = index.as_str().parse().unwrap_or(u32::MAX);
                        let value = expression::lower(value, 0, self.block);
                        arguments.push((index, value));
                    }
                }
                Rule::cycle_word => {
                    let mut inner = argument.into_inner();
                    if let (Some(word), Some(value)) = (inner.next(), inner.next()) {
                        let letter = word.as_str().as_bytes().get(1).copied().unwrap_or_default();
                        let value = expression::lower(value, 0, self.block);
                        words.push((letter.to_ascii_uppercase(), value));
                    }
                }
                // `MODAL` is the older word for `MODAL_MOVE`.
                _ => match argument.as_str().to_ascii_uppercase().as_str() {
                    "MODAL" | "MODAL_MOVE" => repetition = Repetition::AfterMotion,
                    "MODAL_BLOCK" => repetition = Repetition::AfterBlock,
                    _ => known = false,
                },
            }
        }
        if !known {
            match self.unclosed.take() {
                Some(at) => self.refuse(not_closed(at), span),
                None => self.unread(Effect::Everything, span),
            }
            return;
        }
        match name {
            Some(name) => self.block.items.push(Item::Call(Call {
                scope,
                name,
                form: CallForm::Cycle,
                arguments,
                words,
                repetition,
                span,
            })),
            None => self.refuse(
                not_understood(span, self.code)
                    .with_help("name the cycle: `L CYCLE [NAME=cycle.nc @P1=10]`"),
                span,
            ),
        }
    }
}

/// Form of the call of a part of a program.
const HOW: &str = "name the first and the last block: `L SEQUENCE [N10 N20]`";

impl BlockLowering<'_> {
    pub(super) fn sequence_call(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut name = None;
        let mut targets = Vec::new();
        let mut end_tag = false;
        let mut passes = None;
        for part in pair.into_inner() {
            if part.as_rule() == Rule::sequence_rest {
                match self.unclosed.take() {
                    Some(at) => self.refuse(not_closed(at), span),
                    None => self.unread(Effect::Everything, span),
                }
                return;
            }
            let Some(argument) = part.into_inner().next() else {
                continue;
            };
            match argument.as_rule() {
                Rule::cycle_name => {
                    let inner = argument.into_inner().next();
                    name = inner.map(|inner| self.call_name(inner));
                }
                Rule::passes => {
                    let value = argument.into_inner().next();
                    passes = value.map(|value| expression::lower(value, 0, self.block));
                }
                Rule::end_tag => end_tag = true,
                _ => targets.push(self.jump_target(argument)),
            }
        }
        let mut targets = targets.into_iter();
        match (targets.next(), targets.next(), targets.next()) {
            (Some(first), last, None) => self.block.items.push(Item::Sequence(SequenceCall {
                name,
                first,
                last,
                end_tag,
                passes,
                span,
            })),
            _ => self.refuse(not_understood(span, self.code).with_help(HOW), span),
        }
    }

    pub(super) fn return_call(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut levels = ReturnLevels::One;
        let mut target = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::return_word => {}
                Rule::to_main => levels = ReturnLevels::Main,
                Rule::jumps => {
                    if let Some(value) = part.into_inner().next() {
                        levels = ReturnLevels::Number(expression::lower(value, 0, self.block));
                    }
                }
                _ => target = Some(self.jump_target(part)),
            }
        }
        self.block.items.push(Item::Return(Return {
            levels,
            target,
            span,
        }));
    }

    /// `N10`, `[LABEL]`.
    fn jump_target(&mut self, pair: Pair<'_, Rule>) -> BlockReference {
        let is_label = pair.as_rule() == Rule::target_label;
        let inner = pair.into_inner().next();
        match inner {
            Some(inner) if is_label => BlockReference::Label(span_of(&inner)),
            Some(inner) => BlockReference::Number(expression::lower(inner, 0, self.block)),
            None => BlockReference::Number(Operand::Number(0.0)),
        }
    }
}
