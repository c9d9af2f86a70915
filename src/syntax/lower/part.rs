//! Calls of parts of programs, and returns to places of programs.

use pest::iterators::Pair;

use super::lowering::{BlockLowering, not_closed, not_understood, span_of};
use crate::syntax::ast::{
    BlockReference, Effect, Item, Operand, Return, ReturnLevels, SequenceCall,
};
use crate::syntax::{expression, grammar::Rule};
use crate::text::Span;

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
