//! Flow: the order in which blocks are executed (R2.40 to R2.43).
//!
//! The structure of control blocks is known from the index, so the position in a program is a
//! block number and nothing else; jumps into branches and loops need no care.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::at::{At, Shown};
use super::cause::{how_to_set, unknown_value};
use super::event::{EndedBy, Observer};
use super::expression::Place as Target;
use super::finder::Finder;
use super::functions::finite;
use super::options::RunOutcome;
use super::program::{EntryIndex, LabelName};
use super::region::Exit;
use super::run::Interpreter;
use super::state::{Departure, Retains, Seeking, Step};
use super::value::Value;
use crate::diagnostic::Code;
use crate::syntax::Fault;
use crate::syntax::ast::{Block, Flow, Item, JumpTarget, Operand};
use crate::text::Span;

impl Interpreter {
    /// Executes blocks until the call stack is empty, the program ends, or the observer stops it.
    pub(super) fn run(
        &mut self,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        loop {
            let Some(frame) = self.state.frames.last() else {
                return RunOutcome::Ended(self.state.ending.take().unwrap_or(EndedBy::EndOfFile));
            };
            let (unit, section, next) = (frame.unit, frame.section, frame.next);
            if !frame.waiting.is_empty() {
                self.call_waiting();
                continue;
            }
            let is_past = next >= self.units[unit].index.sections[section].end;
            if is_past || frame.passage.is_some_and(|passage| next > passage.last) {
                if frame.level == 0 {
                    self.meet_at_end(finder);
                    return RunOutcome::Ended(EndedBy::EndOfFile);
                }
                self.end_of_pass();
                continue;
            }
            let parsed = self.parsed(unit, next);
            if let Some(frame) = self.state.frames.last_mut() {
                frame.next = next + 1;
            }
            if self.is_skipped(&parsed.block) {
                continue;
            }
            let called_from = self
                .state
                .frames
                .last_mut()
                .and_then(|frame| frame.called_from.take());
            let level = self.state.frames.last().map_or(0, |frame| frame.level);
            let shown = Shown::default();
            let at = At {
                file: &parsed.file,
                text: &parsed.text,
                line: parsed.line,
                comments: parsed.comments,
                remark: parsed.remark.as_ref(),
                level,
                called_from: called_from.as_ref(),
                macro_depth: 0,
                used: None,
                shown: &shown,
            };
            if let Some(over) = self.over_budget(&at) {
                let over = self.with_loop(over, unit, next);
                self.work.over = Some(over);
                return RunOutcome::Ended(EndedBy::Budget);
            }
            let depth = self.state.frames.len();
            let flow = self.execute(&parsed.block, &at, finder, observer);
            if let Some(frame) = self.state.frames.get_mut(depth - 1) {
                frame.called_from = called_from;
            }
            let step = match flow {
                ControlFlow::Continue(()) => continue,
                ControlFlow::Break(Departure::Step(step)) => step,
                ControlFlow::Break(Departure::Paused) => return RunOutcome::Paused,
            };
            if let ControlFlow::Break(by) = self.follow(step) {
                if by != EndedBy::Error {
                    self.meet_at_end(finder);
                }
                return RunOutcome::Ended(by);
            }
        }
    }

    /// Does what a block asked for. `Break` when the program ends.
    pub(super) fn follow(&mut self, step: Step) -> ControlFlow<EndedBy> {
        match step {
            // Only a run that has not begun is parked with `Begin`; `go_on` begins it.
            Step::Begin => {}
            Step::Jump(entry) => {
                if let Some(endless) = self.endless_loop() {
                    self.work.over = Some(endless);
                    self.work.endless = true;
                    return ControlFlow::Break(EndedBy::Budget);
                }
                if let Some(frame) = self.state.frames.last_mut() {
                    frame.next = entry;
                }
            }
            Step::Call(mut requests) => {
                let Some(first) = (!requests.is_empty()).then(|| requests.remove(0)) else {
                    return ControlFlow::Continue(());
                };
                if let Some(frame) = self.state.frames.last_mut() {
                    requests.reverse();
                    frame.waiting = requests;
                }
                self.push_call(first);
            }
            Step::Return => match self.state.frames.last() {
                Some(frame) if frame.level > 0 => self.end_of_pass(),
                _ => {
                    // A subprogram run by itself ends as it should.
                    self.state.last = None;
                    return ControlFlow::Break(EndedBy::EndOfFile);
                }
            },
            Step::ReturnTo(destination) => self.go_back(&destination),
            Step::End(by) => return ControlFlow::Break(by),
        }
        ControlFlow::Continue(())
    }

    /// Calls the next of several programs that one block calls.
    #[cold]
    fn call_waiting(&mut self) {
        let frame = self.state.frames.last_mut();
        if let Some(request) = frame.and_then(|frame| frame.waiting.pop()) {
            self.push_call(request);
        }
    }

    /// A part of a program begins once more, or a program is left.
    fn end_of_pass(&mut self) {
        let executed = self.state.seq;
        let frame = self.state.frames.last_mut();
        let again = frame.and_then(|frame| {
            let start = frame.passage.as_mut()?.again(executed)?;
            frame.next = start;
            frame.seeking = None;
            Some(())
        });
        if again.is_none() {
            self.leave();
        }
    }

    pub(super) fn leave(&mut self) {
        if let Some(frame) = self.state.frames.pop() {
            self.journal.begin_anew();
            self.state
                .memory
                .leave_call(usize::try_from(frame.level).unwrap_or(usize::MAX));
            if let Some(saved) = &frame.restores {
                let kept = (frame.retains == Retains::Perhaps).then(|| self.state.modal.clone());
                self.state.modal.restore(saved);
                if let Some(kept) = kept {
                    self.state.modal.doubt(&kept);
                }
            }
            if self.state.ways.has_targets() {
                self.leave_ways(&frame);
            }
        }
    }

    /// The condition of `$IF c $GOTO …`; `None` for any other statement.
    pub(super) fn one_line_condition(
        &mut self,
        flow: &Flow,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Option<bool>, Box<Fault>> {
        let Flow::If(condition) = flow else {
            return Ok(None);
        };
        if !block.jumps() {
            return Ok(None);
        }
        let value = self.value(*condition, block, at)?;
        if let Value::Unknown(cause) = &value {
            self.assume_no_jump("whether this jump is taken", (cause, flow_span(block)), at);
            self.pass_jump(block, cause, at);
            return Ok(Some(false));
        }
        let truth = value.truth();
        truth
            .map(Some)
            .ok_or_else(|| no_condition(flow_span(block)))
    }

    /// Executes a `$` statement.
    pub(super) fn flow(
        &mut self,
        flow: &Flow,
        span: Span,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Option<Step>, Box<Fault>> {
        let Some(frame) = self.state.frames.last_mut() else {
            return Ok(None);
        };
        let entry = frame.next - 1;
        let seeking = frame.seeking.take();
        let index = &self.units[frame.unit].index;
        if !index.is_linked(entry) && !matches!(flow, Flow::Goto(_)) {
            // It belongs to no control block, which was said before the program began.
            return Ok(None);
        }
        let links = index.links(entry);
        let behind = Step::Jump(links.end + 1);
        Ok(match flow {
            Flow::If(condition) => self.branch(*condition, (block, at, span), links.next)?,
            Flow::ElseIf(condition) => match seeking {
                Some(Seeking::Condition) => {
                    self.branch(*condition, (block, at, span), links.next)?
                }
                _ => Some(behind),
            },
            Flow::Else => match seeking {
                Some(Seeking::Condition) => None,
                _ => Some(behind),
            },
            Flow::Switch(target, operand) => {
                let value = self.value(*operand, block, at)?;
                if let Some(target) = target {
                    let place = self.target_place(target.place, block, at)?;
                    self.write(place, value.clone());
                }
                if let Value::Unknown(cause) = &value {
                    self.skip_unknown((entry, links.end), cause, span, at)
                } else {
                    self.seek(Seeking::Case(value));
                    Some(Step::Jump(links.next))
                }
            }
            Flow::Case(operand) => match seeking {
                Some(Seeking::Case(wanted)) => {
                    let value = self.value(*operand, block, at)?;
                    if let Value::Unknown(cause) = &value {
                        self.skip_unknown((entry, links.end), cause, span, at)
                    } else if same_case(&wanted, &value) {
                        None
                    } else {
                        self.seek(Seeking::Case(wanted));
                        Some(Step::Jump(links.next))
                    }
                }
                // The case before ends without `$BREAK`: the control goes on with this one.
                _ => None,
            },
            Flow::For {
                counter,
                start,
                end,
                step,
            } => {
                let start = self.value(*start, block, at)?;
                let place = self.target_place(counter.place, block, at)?;
                self.write(place, start.clone());
                self.pass((&start, *end, *step), entry, (block, at, span))?
            }
            Flow::EndFor => return self.next_pass(links.opener, span, at),
            Flow::While(condition) | Flow::Do(Some(condition)) => {
                self.loop_while(*condition, (block, at, span), (entry, links.end))?
            }
            Flow::EndWhile | Flow::EndDo(None) => Some(Step::Jump(links.opener)),
            Flow::EndDo(Some(condition)) => {
                let value = self.value(*condition, block, at)?;
                match (&value, value.truth()) {
                    (Value::Unknown(cause), _) => {
                        self.skip_unknown((links.opener, entry), cause, span, at)
                    }
                    (_, Some(true)) => Some(Step::Jump(links.opener)),
                    _ => None,
                }
            }
            Flow::Until(condition) => {
                let value = self.value(*condition, block, at)?;
                match (&value, value.truth()) {
                    (Value::Unknown(cause), _) => {
                        self.skip_unknown((links.opener, entry), cause, span, at)
                    }
                    (_, Some(false)) => Some(Step::Jump(links.opener)),
                    _ => None,
                }
            }
            Flow::Break => Some(behind),
            Flow::Continue => Some(Step::Jump(links.end)),
            Flow::Goto(target) => self.jump(target, span, block, at)?,
            Flow::Default | Flow::EndIf | Flow::EndSwitch | Flow::Do(None) | Flow::Repeat => None,
        })
    }

    fn seek(&mut self, seeking: Seeking) {
        if let Some(frame) = self.state.frames.last_mut() {
            frame.seeking = Some(seeking);
        }
    }

    fn branch(
        &mut self,
        condition: Operand,
        (block, at, span): (&Block, &At<'_>, Span),
        next: EntryIndex,
    ) -> Result<Option<Step>, Box<Fault>> {
        let value = self.value(condition, block, at)?;
        Ok(match (&value, value.truth()) {
            (Value::Unknown(cause), _) => {
                let (entry, end) = self.current_block();
                self.skip_unknown((entry, end), cause, span, at)
            }
            (_, Some(true)) => None,
            (_, Some(false)) => {
                self.seek(Seeking::Condition);
                Some(Step::Jump(next))
            }
            (_, None) => return Err(no_condition(span)),
        })
    }

    /// The statement that is executed and the end of its control block.
    pub(super) fn current_block(&self) -> (EntryIndex, EntryIndex) {
        self.state.frames.last().map_or((0, 0), |frame| {
            let entry = frame.next - 1;
            (entry, self.units[frame.unit].index.links(entry).end)
        })
    }

    fn loop_while(
        &mut self,
        condition: Operand,
        (block, at, span): (&Block, &At<'_>, Span),
        region: (EntryIndex, EntryIndex),
    ) -> Result<Option<Step>, Box<Fault>> {
        let value = self.value(condition, block, at)?;
        Ok(match (&value, value.truth()) {
            (Value::Unknown(cause), _) => self.skip_unknown(region, cause, span, at),
            (_, Some(true)) => None,
            (_, Some(false)) => Some(Step::Jump(region.1 + 1)),
            (_, None) => return Err(no_condition(span)),
        })
    }

    /// Goes through the loop once more, or leaves it when the counter passed the end.
    fn pass(
        &mut self,
        (counter, end, step): (&Value, Operand, Operand),
        opener: EntryIndex,
        (block, at, span): (&Block, &At<'_>, Span),
    ) -> Result<Option<Step>, Box<Fault>> {
        let end = self.value(end, block, at)?;
        let step = self.value(step, block, at)?;
        let region_end = self.state.frames.last().map_or(opener, |frame| {
            self.units[frame.unit].index.links(opener).end
        });
        for value in [counter, &end, &step] {
            if let Value::Unknown(cause) = value {
                return Ok(self.skip_unknown((opener, region_end), cause, span, at));
            }
        }
        let (Some(counter), Some(end), Some(step)) =
            (counter.number(), end.number(), step.number())
        else {
            return Err(no_condition(span));
        };
        let passed = if step > 0.0 {
            counter > end
        } else {
            step < 0.0 && counter < end
        };
        Ok(Some(Step::Jump(if passed {
            region_end + 1
        } else {
            opener + 1
        })))
    }

    /// `$ENDFOR`: counts, and looks at the end again.
    fn next_pass(
        &mut self,
        opener: EntryIndex,
        span: Span,
        at: &At<'_>,
    ) -> Result<Option<Step>, Box<Fault>> {
        let Some(unit) = self.state.frames.last().map(|frame| frame.unit) else {
            return Ok(None);
        };
        let parsed = self.parsed(unit, opener);
        let shown = Shown::default();
        let head = At {
            shown: &shown,
            text: &parsed.text,
            line: parsed.line,
            ..*at
        };
        let block = &parsed.block;
        let statement = block.items.iter().find_map(|item| match item {
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
        let value = self.value(operand, block, &head).map_err(shown)?;
        let width = self.value(step, block, &head).map_err(shown)?;
        let sum = match (value.number(), width.number()) {
            (Some(value), Some(width)) => finite(value + width, span)?,
            _ => match (value, width) {
                (unknown @ Value::Unknown(_), _) | (_, unknown) => unknown,
            },
        };
        let place: Target = self
            .target_place(counter.place, block, &head)
            .map_err(shown)?;
        self.write(place, sum.clone());
        let mut step = self
            .pass((&sum, end, step), opener, (block, &head, span))
            .map_err(shown)?;
        if let Some(Step::Jump(entry)) = &mut step {
            // A jump into the loop found no opener before it; the index knows it all the same.
            *entry = (*entry).max(opener + 1);
        }
        Ok(step)
    }

    fn jump(
        &mut self,
        target: &JumpTarget,
        span: Span,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Option<Step>, Box<Fault>> {
        let value = match target {
            JumpTarget::Number(operand) => self.value(*operand, block, at)?,
            JumpTarget::Label(name) => Value::Text(name.of(at.text).into()),
            JumpTarget::Variable(place) => self.value(Operand::Expression(*place), block, at)?,
        };
        let label = match &value {
            Value::Number(number) => LabelName::numbered(*number),
            Value::Text(name) => LabelName::Text(name.trim_matches(['[', ']']).to_owned()),
            Value::Unknown(cause) => {
                self.assume_no_jump("where this jump goes", (cause, span), at);
                self.note_jump(&Exit::AnyLabel, cause);
                return Ok(None);
            }
        };
        let Some(frame) = self.state.frames.last() else {
            return Ok(None);
        };
        let found = self.units[frame.unit]
            .index
            .label(frame.section, label.clone());
        match found {
            Some(entry) => Ok(Some(Step::Jump(entry))),
            None if at.macro_depth == 0
                && matches!(
                    target,
                    JumpTarget::Number(Operand::Number(_)) | JumpTarget::Label(_)
                ) =>
            {
                // Said before the program began.
                Ok(None)
            }
            None => Err(Box::new(Fault::new(
                Code::Fc209,
                span,
                format!("jump label `{label}` does not exist in this program"),
            ))),
        }
    }

    /// Passes over the jump of a block, which may be taken.
    pub(super) fn pass_jump(&mut self, block: &Block, cause: &Arc<str>, at: &At<'_>) {
        for item in &block.items {
            if let Item::Flow(Flow::Goto(target), _) = item {
                let exit = self.exit(target, block, at).unwrap_or(Exit::AnyLabel);
                self.note_jump(&exit, cause);
            }
        }
    }

    /// Passes over what a statement decides whose operands cannot be computed.
    pub(super) fn undecided(
        &mut self,
        flow: &Flow,
        cause: &Arc<str>,
        span: Span,
        at: &At<'_>,
    ) -> Option<Step> {
        let (entry, end) = self.current_block();
        let region = match flow {
            Flow::Goto(_) => {
                self.note_jump(&Exit::AnyLabel, cause);
                return None;
            }
            Flow::EndFor | Flow::EndDo(_) | Flow::Until(_) => {
                let frame = self.state.frames.last()?;
                (self.units[frame.unit].index.links(entry).opener, entry)
            }
            _ => (entry, end),
        };
        self.skip_unknown(region, cause, span, at)
    }

    /// Where a jump goes that is not taken.
    fn exit(
        &mut self,
        target: &JumpTarget,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Exit, Box<Fault>> {
        let value = match target {
            JumpTarget::Label(name) => return Ok(Exit::label(name.of(at.text))),
            JumpTarget::Number(operand) => self.value(*operand, block, at)?,
            JumpTarget::Variable(place) => self.value(Operand::Expression(*place), block, at)?,
        };
        Ok(match value {
            Value::Number(number) => Exit::Label(LabelName::numbered(number)),
            Value::Text(name) => Exit::label(&name),
            Value::Unknown(_) => Exit::AnyLabel,
        })
    }

    /// FC902: a jump that is not known offline is not taken (R2.52).
    fn assume_no_jump(&mut self, what: &str, (cause, span): (&str, Span), at: &At<'_>) {
        if self.work.unread.get() {
            return;
        }
        let value = unknown_value(cause);
        let message =
            format!("{what} depends on {value}; the rest of the run assumes that it is not");
        let fault = Fault::new(Code::Fc902, span, message).with_help(how_to_set(cause));
        self.work.diagnostics.push(at.diagnostic(fault));
    }
}

/// R2.40: both values count as equal when they differ by less than 0.001 (PM/206908427).
fn same_case(wanted: &Value, value: &Value) -> bool {
    match (wanted, value) {
        (Value::Number(wanted), Value::Number(value)) => (wanted - value).abs() < 0.001,
        (wanted, value) => wanted == value,
    }
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
