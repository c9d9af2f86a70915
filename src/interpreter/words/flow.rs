//! Statements of flow: which block comes next (R2.40 to R2.43).
//!
//! The structure of control blocks is known from the index, so the position in a program is only a
//! block number; jumps into branches and loops need no special treatment.

use std::ops::Range;

use crate::diagnostic::Code;
use crate::interpreter::block::{BlockContext, ShownBlockLines};
use crate::interpreter::control::ControlState;
use crate::interpreter::executor::Executor;
use crate::interpreter::programs::index::{EntryIndex, JumpAcross, LabelName, Links};
use crate::interpreter::stack::{ControlStep, Seeking};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::plain::{Asking, Truth, Writer};
use crate::interpreter::values::value::{Value, are_nearly_equal, finite, same_case};
use crate::interpreter::ways::question::ConditionKind;
use crate::interpreter::words::questions::{Doubt, Goal, MachineQuestion};
use crate::interpreter::words::refusal::{PossibleRefusal, StopScope};
use crate::readings::{Alternative, Question};
use crate::syntax::Fault;
use crate::syntax::ast::{Block, BlockReference, Flow, Item, Operand};
use crate::text::Span;

/// The counter of a `$FOR`, with its end and step.
struct Count {
    counter: Value,
    end: Operand,
    step: Operand,
}

impl Executor {
    /// Returns the condition of `$IF c $GOTO …`; `None` for any other statement.
    pub(crate) fn one_line_condition(
        &mut self,
        flow: &Flow,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<bool>, Box<Fault>> {
        let Flow::If(condition) = flow else {
            return Ok(None);
        };
        if !at.block.jumps {
            return Ok(None);
        }
        let (value, doubt) = if self.jumps_back(span, at) {
            let value = self.loop_value(*condition, at)?;
            let doubt = Doubt::of(&value);
            (value, doubt)
        } else {
            self.asked_value(*condition, at)?
        };
        if let Some(doubt) = doubt
            && self.part_at_jump(*condition, &doubt, span, at)
        {
            return Ok(Some(false));
        }
        let truth = value.truth();
        truth.map(Some).ok_or_else(|| no_condition(span))
    }

    /// Executes a `$` statement.
    pub(crate) fn flow(
        &mut self,
        flow: &Flow,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let Some(frame) = self.state.control.frames.running_mut() else {
            return Ok(None);
        };
        if at.macro_depth > 0 && !matches!(flow, Flow::Goto(_)) {
            let message = "a control statement in the code of a macro belongs to no control block";
            let fault = Fault::new(Code::Fc208, span, message);
            return Err(Box::new(fault.with_help("write it in the program")));
        }
        let entry = frame.next - 1;
        let seeking = frame.seeking.take();
        let index = self.programs.index(frame.unit);
        if !index.is_linked(entry) && !matches!(flow, Flow::Goto(_)) {
            // It belongs to no control block, which was reported before the program began.
            return Ok(None);
        }
        let links = index.links(entry);
        let after = ControlStep::Jump(links.end + 1);
        if let Some(level) = self.split_level() {
            self.pass_over_part(Unknown::SkipLevel(level), span, at);
            return Ok(None);
        }
        Ok(match flow {
            Flow::If(condition) => self.branch(*condition, links.next, span, at)?,
            Flow::ElseIf(condition) => match seeking {
                Some(Seeking::Condition) => self.branch(*condition, links.next, span, at)?,
                _ => Some(self.skip_other_branches(links, after)),
            },
            Flow::Else => match seeking {
                Some(Seeking::Condition) => None,
                _ => Some(self.skip_other_branches(links, after)),
            },
            Flow::Switch(..) => self.switch(flow, links.next, span, at)?,
            Flow::Case(operand) => match seeking {
                Some(Seeking::Case(wanted)) => {
                    let value = self.value(*operand, at)?;
                    if let Value::Unknown(cause) = value {
                        self.state.control.seek(Seeking::Case(wanted));
                        self.part_at_unknown_case(flow, (cause, span), at);
                        None
                    } else if same_case(&wanted, &value) {
                        None
                    } else {
                        self.state.control.seek(Seeking::Case(wanted));
                        Some(ControlStep::Jump(links.next))
                    }
                }
                // The previous case ends without `$BREAK`: the control continues with this one.
                _ => None,
            },
            Flow::For {
                counter,
                start,
                end,
                step,
            } => {
                let start = self.value(*start, at)?;
                let place = self.target_place(counter.place, at)?;
                self.warn_own(place.as_ref(), counter.span, at);
                let start = self.as_declared(place.as_ref(), start, counter.span, at)?;
                self.set_by(place, start.clone(), at);
                let count = Count {
                    counter: start,
                    end: *end,
                    step: *step,
                };
                self.pass(&count, (entry, at), span, at)?
            }
            Flow::EndFor => return self.next_pass(links.opener, span, at),
            Flow::While(condition) | Flow::Do(Some(condition)) => {
                self.loop_while(*condition, entry..links.end, span, at)?
            }
            Flow::EndWhile | Flow::EndDo(None) => Some(ControlStep::Jump(links.opener)),
            Flow::EndDo(Some(condition)) => {
                self.repeat_where((*condition, Truth::Holds), links.opener..entry, at)?
            }
            Flow::Until(condition) => {
                self.repeat_where((*condition, Truth::Fails), links.opener..entry, at)?
            }
            Flow::Break => Some(after),
            Flow::Continue if index.switches.contains_key(&links.opener) => {
                self.continue_in_switch(entry..links.end, span, at)
            }
            Flow::Continue => Some(ControlStep::Jump(links.end)),
            Flow::Goto(target) => self.jump(target, span, at)?,
            Flow::Default | Flow::EndIf | Flow::EndSwitch | Flow::Do(None) | Flow::Repeat => None,
        })
    }

    /// Executes `$CONTINUE` in a `$SWITCH` outside a loop: it is allowed (P-ERR-20244), and no page says what it does.
    fn continue_in_switch(
        &mut self,
        rest: Range<EntryIndex>,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Option<ControlStep> {
        self.state.rests_on.insert(Question::ContinueInSwitch);
        let leaves = Some(ControlStep::Jump(rest.end));
        match self.machine.readings.of(Question::ContinueInSwitch) {
            Some(Alternative::First) => return leaves,
            Some(Alternative::Second) => return None,
            None => {}
        }
        let cause = Unknown::ContinueInSwitch;
        let question = MachineQuestion {
            kind: ConditionKind::Branch,
            span,
            texts: vec!["$CONTINUE == $BREAK".into()],
            reads: Some(Asking::of_unknown(Writer::Nothing, cause.clone())),
            cause,
            kept: None,
        };
        let goals = [rest.end, rest.start + 1].map(Goal::block);
        self.part(question, goals.into(), at);
        None
    }

    fn switch(
        &mut self,
        flow: &Flow,
        first: EntryIndex,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let Flow::Switch(target, operand) = flow else {
            return Ok(None);
        };
        let (value, doubt) = self.asked_value(*operand, at)?;
        if let Some(target) = target {
            let place = self.target_place(target.place, at)?;
            self.warn_own(place.as_ref(), target.span, at);
            let set = self.as_declared(place.as_ref(), value.clone(), target.span, at)?;
            self.set_by(place, set, at);
        }
        if let Some(doubt) = &doubt
            && self.part_at_cases(*operand, doubt, span, at)
        {
            return Ok(None);
        }
        if let Value::Unknown(cause) = value {
            self.part_at_unknown_case(flow, (cause, span), at);
            Ok(None)
        } else {
            self.state.control.seek(Seeking::Case(value));
            Ok(Some(ControlStep::Jump(first)))
        }
    }

    fn branch(
        &mut self,
        condition: Operand,
        next: EntryIndex,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let (value, doubt) = self.asked_value(condition, at)?;
        let whole = self.position().current_block();
        let is_open = self.position().is_unclosed(whole.start);
        if is_open && value.truth() != Some(false) {
            self.warn_unclosed(span, at);
        }
        if let Some(doubt) = &doubt {
            let mut goals = [whole.start + 1, next].map(Goal::block);
            goals[1].seeking = (is_open || next != whole.end).then_some(Seeking::Condition);
            if self.part_at(condition, doubt, (ConditionKind::Branch, span), goals, at) {
                return Ok(None);
            }
        }
        Ok(match value.truth() {
            Some(true) => None,
            Some(false) => {
                self.state.control.seek(Seeking::Condition);
                Some(ControlStep::Jump(next))
            }
            None => return Err(no_condition(span)),
        })
    }

    /// Returns the branches after the one that was executed are passed over. Without `$ENDIF` there is nothing to be
    /// found after them.
    fn skip_other_branches(&mut self, links: Links, after: ControlStep) -> ControlStep {
        if self.position().is_unclosed(links.opener) {
            self.state.control.seek(Seeking::Condition);
        }
        after
    }

    /// Reports P-ERR-20375: an `$IF` has no `$ENDIF`.
    fn warn_unclosed(&mut self, span: Span, at: &BlockContext<'_>) {
        let message = "this `$IF` has no `$ENDIF`: where its condition is true the control goes on with a warning, where it is \
                       false it skips the rest of the text and stops at its end";
        let fault = Fault::new(Code::PErr20375, span, message);
        self.say_before_parting(
            at.diagnostic(fault.with_help("write the end in a separate block")),
        );
    }

    fn loop_while(
        &mut self,
        condition: Operand,
        region: Range<EntryIndex>,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let value = self.loop_value(condition, at)?;
        if let Value::Unknown(cause) = value {
            let goals = [region.start + 1, region.end + 1].map(Goal::block);
            let doubt = Doubt::Unknown(cause);
            self.part_at(condition, &doubt, (ConditionKind::Loop, span), goals, at);
            return Ok(None);
        }
        Ok(match value.truth() {
            Some(true) => None,
            Some(false) => Some(ControlStep::Jump(region.end + 1)),
            None => return Err(no_condition(span)),
        })
    }

    /// Goes back to the opener of a loop if the condition at its end requires it.
    fn repeat_where(
        &mut self,
        (condition, repeats): (Operand, Truth),
        region: Range<EntryIndex>,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let value = self.loop_value(condition, at)?;
        if let Value::Unknown(cause) = value {
            let span = flow_span(at.block);
            let doubt = Doubt::Unknown(cause);
            let mut goals = [region.start, region.end + 1].map(Goal::block);
            if repeats == Truth::Fails {
                goals.reverse();
            }
            self.part_at(condition, &doubt, (ConditionKind::Loop, span), goals, at);
            return Ok(None);
        }
        let is_repeated = value.truth() == Some(repeats == Truth::Holds);
        Ok(is_repeated.then_some(ControlStep::Jump(region.start)))
    }

    /// Goes through the loop once more, or leaves it when the counter passed the end. `head` is the `$FOR`, `span` the
    /// statement of the block that asks.
    fn pass(
        &mut self,
        count: &Count,
        (opener, head): (EntryIndex, &BlockContext<'_>),
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let statement = || flow_span(head.block).of(head.text).trim();
        let counter = &count.counter;
        let end = self.loop_value(count.end, head)?;
        let step = self.loop_value(count.step, head)?;
        let region_end = self.state.control.frames.running().map_or(opener, |frame| {
            self.programs.index(frame.unit).links(opener).end
        });
        for value in [counter, &end, &step] {
            if let Value::Unknown(cause) = value {
                let goals = [opener + 1, region_end + 1].map(Goal::block);
                self.part_at_count((cause, statement()), span, goals, at);
                return Ok(None);
            }
        }
        let (Some(counter), Some(end), Some(step)) =
            (counter.number(), end.number(), step.number())
        else {
            return Err(no_condition(span));
        };
        if is_last_pass_open(counter, end, step) {
            let goals = [opener + 1, region_end + 1].map(Goal::block);
            self.part_at_count((&Unknown::Rounding, statement()), span, goals, at);
            return Ok(None);
        }
        let passed = if step > 0.0 {
            counter > end
        } else {
            step < 0.0 && counter < end
        };
        Ok(Some(ControlStep::Jump(if passed {
            region_end + 1
        } else {
            opener + 1
        })))
    }

    /// Executes `$ENDFOR`: counts, and looks at the end again.
    fn next_pass(
        &mut self,
        opener: EntryIndex,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let Some(unit) = self.state.control.frames.running().map(|frame| frame.unit) else {
            return Ok(None);
        };
        let parsed = self.programs.parsed(unit, opener);
        let shown = ShownBlockLines::default();
        let head = at.other(&parsed, &shown);
        let statement = head.block.items.iter().find_map(|item| match item {
            Item::Flow(
                Flow::For {
                    counter, end, step, ..
                },
                _,
            ) => Some((*counter, *end, *step)),
            _ => None,
        });
        let Some((counter, end, step)) = statement else {
            return Ok(None);
        };
        let shown = |mut fault: Box<Fault>| {
            fault.span = span;
            fault
        };
        let operand = Operand::Expression(counter.place);
        let value = self.loop_value(operand, &head).map_err(shown)?;
        let width = self.loop_value(step, &head).map_err(shown)?;
        let sum = match (value.number(), width.number()) {
            (Some(value), Some(width)) => finite(value + width, span)?,
            _ => match (value, width) {
                (unknown @ Value::Unknown(_), _) | (_, unknown) => unknown,
            },
        };
        let place = self.target_place(counter.place, &head).map_err(shown)?;
        let sum = self
            .as_declared(place.as_ref(), sum, counter.span, &head)
            .map_err(shown)?;
        self.set_by(place, sum.clone(), &head);
        let count = Count {
            counter: sum,
            end,
            step,
        };
        let mut step = self
            .pass(&count, (opener, &head), span, at)
            .map_err(shown)?;
        if let Some(ControlStep::Jump(entry)) = &mut step {
            // After a jump into the loop its opener was not executed; the index has it all the same.
            *entry = (*entry).max(opener + 1);
        }
        Ok(step)
    }

    fn jump(
        &mut self,
        target: &BlockReference,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<ControlStep>, Box<Fault>> {
        let value = match target {
            BlockReference::Number(operand) => self.value(*operand, at)?,
            BlockReference::Label(name) => Value::Text(name.of(at.text).into()),
            BlockReference::Variable(place) => self.value(Operand::Expression(*place), at)?,
        };
        let label = match &value {
            Value::Number(number) => LabelName::numbered(*number),
            Value::Text(name) => LabelName::Text(name.trim_matches(['[', ']']).to_owned()),
            Value::Unknown(cause) => {
                self.perhaps_stop((Unknown::MissingLabel, StopScope::Block), span, at);
                self.part_at_target(target, cause, span, at);
                return Ok(None);
            }
        };
        let Some(frame) = self.state.control.frames.running() else {
            return Ok(None);
        };
        let found = self
            .programs
            .index(frame.unit)
            .label(frame.section, label.clone());
        match found {
            Some(entry) => {
                self.check_jump(entry, span, at)?;
                Ok(Some(ControlStep::Jump(entry)))
            }
            None if is_reported(*target, at) => Ok(None),
            None => Err(Box::new(missing_label(&label, span))),
        }
    }

    /// Reports P-ERR-21480 or FC328: the control refuses a jump within a loop (R2.103).
    pub(crate) fn check_jump(
        &mut self,
        to: EntryIndex,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let what = match self.position().jump_across(to) {
            JumpAcross::Nothing => return Ok(()),
            JumpAcross::WithinLoop => {
                let what = "this jump stays within its loop, which the control refuses";
                return Err(Fault::refused(Code::PErr21480, span, what));
            }
            JumpAcross::OneOfSeveralLoops => {
                let what = "this jump leaves a loop and stays within the one around it";
                self.may_refuse(21480, what, span, at);
                return Ok(());
            }
            JumpAcross::IntoLoop => "this jump enters a loop from outside",
            JumpAcross::IntoSwitch => "this jump enters a `$SWITCH` from outside",
        };
        let refusal = PossibleRefusal::asked(21480, Question::JumpInto);
        self.may_refuse(refusal, what, span, at);
        Ok(())
    }
}

impl ControlState {
    fn seek(&mut self, seeking: Seeking) {
        if let Some(frame) = self.frames.running_mut() {
            frame.seeking = Some(seeking);
        }
    }
}

/// Returns whether rounding decides whether a counter has passed its end: its step is not exact in binary, or it comes
/// near without reaching it (R2.112; PM/206929163).
fn is_last_pass_open(counter: f64, end: f64, step: f64) -> bool {
    /// A step of so many parts of one is exact.
    const EXACT: f64 = 1_048_576.0;
    let is_exact = (step * EXACT).fract() == 0.0;
    let is_near = are_nearly_equal(counter, end) || (counter - end).abs() <= 1e-9 * step.abs();
    !is_exact && is_near
}

fn no_condition(span: Span) -> Box<Fault> {
    Box::new(Fault::new(Code::Fc312, span, "a string is not a condition"))
}

fn flow_span(block: &Block) -> Span {
    block
        .items
        .iter()
        .find_map(|item| match item {
            Item::Flow(_, span) => Some(*span),
            _ => None,
        })
        .unwrap_or_default()
}

/// Returns FC209.
pub(crate) fn missing_label(label: &LabelName, span: Span) -> Fault {
    let message = format!("jump label `{label}` does not exist in this program");
    Fault::new(Code::Fc209, span, message)
}

/// Returns whether a label that does not exist is reported before the program begins: it is written in a block.
pub(crate) fn is_reported(target: BlockReference, at: &BlockContext<'_>) -> bool {
    at.macro_depth == 0
        && matches!(
            target,
            BlockReference::Number(Operand::Number(_)) | BlockReference::Label(_)
        )
}
