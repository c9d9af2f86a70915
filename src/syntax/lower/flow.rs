//! `$` statements, calls of subprograms, cycles and parts of programs, and returns to places of programs.

use pest::iterators::Pair;

use super::block::{BlockLowering, not_closed, not_understood, span_of, trimmed};
use crate::diagnostic::{Code, nearest};
use crate::syntax::ast::{
    BlockReference, Call, CallForm, CallName, CallScope, Effect, Expression, Flow, Item, Operand,
    Repetition, Return, ReturnLevels, SequenceCall, Target,
};
use crate::syntax::grammar::Rule;
use crate::syntax::keywords::FLOW_WORDS;
use crate::syntax::parse::Fault;
use crate::syntax::{VariableFamily, VariableName, expression};
use crate::text::Span;

impl BlockLowering<'_> {
    pub(super) fn flow(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let Some(statement) = pair.into_inner().next() else {
            return;
        };
        let word = span.of(self.code);
        let length = word[1..]
            .find(|c: char| !c.is_ascii_alphabetic())
            .map_or(word.len(), |at| at + 1);
        self.note_case(Span::new(span.start as usize, span.start as usize + length));
        let word = &word[..length];
        self.refuse_before_hash(word, span);
        let flow = match statement.as_rule() {
            Rule::flow_unknown => self.unknown_statement(word, span),
            _ => Some(self.flow_statement(statement, word)),
        };
        if let Some(flow) = flow {
            self.block.jumps |= matches!(flow, Flow::Goto(_));
            self.block.items.push(Item::Flow(flow, span));
        }
    }

    /// Refuses anything but a skip mark before `#IF` and its parts (R2.73).
    fn refuse_before_hash(&mut self, word: &str, span: Span) {
        let first = self.block.items.first();
        let label = first.filter(|item| matches!(item, Item::Label(_)));
        let label = label.map(Item::span);
        let before = self.block.number.map(|number| number.span).or(label);
        let Some(before) = before.filter(|_| word.starts_with('#')) else {
            return;
        };
        let what = before.of(self.code).trim();
        let message =
            format!("`{what}` is before `{word}`, where the control accepts only a skip mark");
        let place = Span::new(before.start as usize, span.start as usize + word.len());
        let fault = Fault::new(Code::Fc208, place, message);
        self.block
            .faults
            .push(fault.with_help(format!("remove `{what}`")));
    }

    fn flow_statement(&mut self, pair: Pair<'_, Rule>, word: &str) -> Flow {
        let rule = pair.as_rule();
        let mut targets = Vec::new();
        let mut values = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::target => targets.push(self.target(part)),
                Rule::expression => values.push(expression::lower(part, 0, self.block)),
                Rule::unread_rest => {
                    let value = self.unread_condition(span_of(&part), word);
                    if rule == Rule::flow_goto {
                        return Flow::Goto(BlockReference::Variable(value));
                    }
                    if rule == Rule::flow_for && targets.is_empty() {
                        let span = span_of(&part);
                        targets.push(Target { place: value, span });
                    }
                    values.push(Operand::Expression(value));
                }
                Rule::goto_number => {
                    let value = part.into_inner().next();
                    let value = value.map(|value| expression::lower(value, 0, self.block));
                    return Flow::Goto(BlockReference::Number(
                        value.unwrap_or(Operand::Number(0.0)),
                    ));
                }
                Rule::goto_label => {
                    let name = part.into_inner().next().map(|name| span_of(&name));
                    return Flow::Goto(BlockReference::Label(name.unwrap_or_default()));
                }
                Rule::variable => {
                    let span = span_of(&part);
                    if VariableName::read(span.of(self.code)).family() != VariableFamily::External {
                        let fault = self.no_target(span);
                        self.block.faults.push(fault);
                        let unread = expression::unread(span, self.block);
                        return Flow::Goto(BlockReference::Variable(unread));
                    }
                    let place = expression::place(part, 0, self.block);
                    return Flow::Goto(BlockReference::Variable(place));
                }
                _ => {}
            }
        }
        let first = values.first().copied();
        let condition = first.unwrap_or(Operand::Number(0.0));
        match rule {
            Rule::flow_if => Flow::If(condition),
            Rule::flow_elseif => Flow::ElseIf(condition),
            Rule::flow_else => Flow::Else,
            Rule::flow_endif => Flow::EndIf,
            Rule::flow_switch => Flow::Switch(targets.first().copied(), condition),
            Rule::flow_case => Flow::Case(condition),
            Rule::flow_default => Flow::Default,
            Rule::flow_endswitch => Flow::EndSwitch,
            Rule::flow_for => match targets.first() {
                Some(&counter) => Flow::For {
                    counter,
                    start: condition,
                    end: values.get(1).copied().unwrap_or(condition),
                    step: values.get(2).copied().unwrap_or(Operand::Number(1.0)),
                },
                None => Flow::EndFor,
            },
            Rule::flow_endfor => Flow::EndFor,
            Rule::flow_while => Flow::While(condition),
            Rule::flow_endwhile => Flow::EndWhile,
            Rule::flow_do => Flow::Do(first),
            Rule::flow_enddo => Flow::EndDo(first),
            Rule::flow_repeat => Flow::Repeat,
            Rule::flow_until => Flow::Until(condition),
            Rule::flow_continue => Flow::Continue,
            _ => Flow::Break,
        }
    }

    /// Returns a condition that cannot be read: its control block opens all the same (R2.71).
    fn unread_condition(&mut self, rest: Span, word: &str) -> Expression {
        let rest = trimmed(rest, self.code);
        let shown = rest.of(self.code).trim();
        let fault = match self.unclosed.filter(|at| rest.range().contains(at)) {
            Some(at) => not_closed(at),
            None if shown.is_empty() => {
                let start = rest.start as usize;
                let statement = Span::new(start.saturating_sub(word.len()), start);
                Fault::new(Code::Fc207, statement, format!("`{word}` is incomplete"))
            }
            None if word.eq_ignore_ascii_case("$GOTO") => self.no_target(rest),
            None => not_understood(rest, self.code),
        };
        let is_for = word.eq_ignore_ascii_case("$FOR");
        self.block.faults.push(if is_for {
            fault.with_help("write `$FOR P1 = start, end, step`")
        } else {
            fault
        });
        expression::unread(rest, self.block)
    }

    /// Returns P-ERR-20839: what follows `$GOTO` is no label (R2.103).
    fn no_target(&self, span: Span) -> Fault {
        let shown = span.of(self.code).trim();
        let message = format!("`{shown}` follows `$GOTO`, where only `[`, `N` or `V.E.` may stand");
        *Fault::refused(Code::PErr20839, span, message)
    }

    /// Returns an unknown statement: for the pairing, a misspelt one counts as the one that it means; any other could
    /// be anything (R2.70).
    fn unknown_statement(&mut self, word: &str, span: Span) -> Option<Flow> {
        let near = nearest(word, FLOW_WORDS);
        let Some(first) = near.first().filter(|_| word.len() > 1) else {
            self.unread(Effect::Everything, span);
            return None;
        };
        let start = span.start as usize;
        let start = start + span.of(self.code).find(word).unwrap_or_default();
        let word_span = Span::new(start, start + word.len());
        self.block.faults.push(
            Fault::new(Code::Fc207, span, format!("unknown statement `{word}`"))
                .with_near(word_span, &near),
        );
        let place = expression::unread(span, self.block);
        Some(meant(first, place, span))
    }
}

/// Returns the statement that a word opens, closes or parts, with a condition that could not be read.
fn meant(word: &str, place: Expression, span: Span) -> Flow {
    let value = Operand::Expression(place);
    match word {
        "$IF" => Flow::If(value),
        "$ELSEIF" => Flow::ElseIf(value),
        "$ELSE" => Flow::Else,
        "$ENDIF" => Flow::EndIf,
        "$SWITCH" => Flow::Switch(None, value),
        "$CASE" => Flow::Case(value),
        "$DEFAULT" => Flow::Default,
        "$ENDSWITCH" => Flow::EndSwitch,
        "$FOR" => Flow::For {
            counter: Target { place, span },
            start: value,
            end: value,
            step: value,
        },
        "$ENDFOR" => Flow::EndFor,
        "$WHILE" => Flow::While(value),
        "$ENDWHILE" => Flow::EndWhile,
        "$DO" => Flow::Do(Some(value)),
        "$ENDDO" => Flow::EndDo(None),
        "$REPEAT" => Flow::Repeat,
        "$UNTIL" => Flow::Until(value),
        "$BREAK" => Flow::Break,
        "$CONTINUE" => Flow::Continue,
        _ => Flow::Goto(BlockReference::Variable(place)),
    }
}

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

    /// Returns `N10`, `[LABEL]`.
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
