//! Entry to and return from programs. Calls whose effects are known from other ways are not executed once more (R14.4).

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::interpreter::drive::host::Interpreter;
use crate::interpreter::events::EndedBy;
use crate::interpreter::executor::Executor;
use crate::interpreter::programs::index::ProgramId;
use crate::interpreter::stack::{CallFrame, CallStack, ControlStep, Destination, Request, Retains};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::ways::others::{Arrival, CallEffect, CalledAt, OtherPaths, context};
use crate::interpreter::ways::path::Path;
use crate::lists::ChannelSwitch;
use crate::syntax::ast::CallForm;

impl Executor {
    pub(crate) fn push_call(&mut self, request: Request) {
        let ProgramId { unit, section } = request.found;
        let level = self.state.control.frames.level() + 1;
        self.state
            .control
            .memory
            .enter_call(usize::try_from(level).unwrap_or(usize::MAX));
        let restores = match request.form {
            CallForm::Plain => None,
            CallForm::Cycle if self.machine.channel.has(ChannelSwitch::KeepCycleChanges) => None,
            CallForm::Cycle => Some(Box::new(self.state.control.modal.save())),
        };
        let depth = self.state.control.frames.depth();
        self.state.track.change_level(depth);
        self.state.control.frames.push(CallFrame {
            unit,
            section,
            next: request.passage.map_or(
                self.programs.section(ProgramId { unit, section }).start,
                |passage| passage.first,
            ),
            level,
            own: request.own,
            seeking: None,
            called_from: Some(Box::new(request.called_from)),
            restores,
            retains: Retains::Nothing,
            waiting: Vec::new(),
            passage: request.passage,
        });
    }

    pub(crate) fn leave(&mut self) {
        if let Some(frame) = self.state.control.frames.pop() {
            let depth = self.state.control.frames.depth();
            self.state.track.change_level(depth);
            self.state.track.loops.retain(|known| known.depth <= depth);
            self.state
                .control
                .memory
                .leave_call(usize::try_from(frame.level).unwrap_or(usize::MAX));
            if let Some(saved) = &frame.restores {
                let kept =
                    (frame.retains == Retains::Perhaps).then(|| self.state.control.modal.clone());
                self.state.control.modal.restore(saved);
                if let Some(kept) = kept {
                    self.state.control.modal.join(&kept);
                }
            }
        }
    }

    /// Notes a call of a whole file that comes back from its end (R17.2).
    fn note_return(&mut self) {
        let Some(frame) = self.state.control.frames.running() else {
            return;
        };
        let (unit, section) = (frame.unit, frame.section);
        let is_whole = frame.level > 0 && frame.passage.is_none();
        if is_whole && self.programs.index(unit).main == Some(section) {
            self.programs.unit_mut(unit).returned = true;
        }
    }

    pub(crate) fn enter(&mut self, unit: usize, section: usize) {
        let next = self.programs.section(ProgramId { unit, section }).start;
        self.state.control.frames.push(CallFrame {
            unit,
            section,
            next,
            level: 0,
            own: BTreeMap::new(),
            seeking: None,
            called_from: None,
            restores: None,
            retains: Retains::Nothing,
            waiting: Vec::new(),
            passage: None,
        });
    }
}

impl OtherPaths {
    /// Calls the next of several programs that one block calls.
    #[cold]
    pub(crate) fn call_waiting(&mut self, here: &mut Executor) -> ControlFlow<EndedBy> {
        let frame = here.state.control.frames.running_mut();
        match frame.and_then(|frame| frame.waiting.pop()) {
            Some(request) => self.call(here, request),
            None => ControlFlow::Continue(()),
        }
    }

    /// Begins a part of a program once more, or leaves a program.
    pub(crate) fn end_of_pass(&mut self, here: &mut Executor) {
        let executed = here.state.seq;
        let frame = here.state.control.frames.running_mut();
        let again = frame.and_then(|frame| {
            let start = frame.passage.as_mut()?.again(executed)?;
            frame.next = start;
            frame.seeking = None;
            Some(())
        });
        if again.is_none() {
            here.note_return();
            self.come_back_from_call(here);
        } else {
            // Its loops begin anew.
            let depth = here.state.control.frames.depth();
            here.state.track.loops.retain(|known| known.depth < depth);
        }
    }

    /// Leaves programs down to the one that is returned to.
    pub(crate) fn go_back(&mut self, here: &mut Executor, to: &Destination) {
        while here
            .state
            .control
            .frames
            .running()
            .is_some_and(|frame| frame.level > to.level)
        {
            self.leave_for_elsewhere(here);
        }
        if let Some(frame) = here.state.control.frames.running_mut() {
            frame.waiting.clear();
            if let Some(entry) = to.entry {
                frame.next = entry;
                frame.seeking = None;
            }
        }
    }

    /// Executes the step that a block requested. `Break` when the program ends.
    pub(crate) fn follow(
        &mut self,
        here: &mut Executor,
        step: ControlStep,
    ) -> ControlFlow<EndedBy> {
        match step {
            // Only a run that has not begun is parked with `Begin`; `go_on` begins it.
            ControlStep::Begin => {}
            ControlStep::Jump(entry) => {
                if let Some(endless) = here.endless_loop() {
                    here.scratch.ending.over.push(endless);
                    here.scratch.ending.endless = true;
                    return ControlFlow::Break(EndedBy::Budget);
                }
                if let Some(frame) = here.state.control.frames.running_mut() {
                    frame.next = entry;
                }
            }
            ControlStep::Call(mut requests) => {
                let Some(first) = (!requests.is_empty()).then(|| requests.remove(0)) else {
                    return ControlFlow::Continue(());
                };
                if let Some(frame) = here.state.control.frames.running_mut() {
                    requests.reverse();
                    frame.waiting = requests;
                }
                return self.call(here, first);
            }
            ControlStep::Return => match here.state.control.frames.running() {
                Some(frame) if frame.level > 0 => self.end_of_pass(here),
                _ => {
                    // A subprogram run by itself ends as it should; one that holds M30 is a main program. For a program
                    // read line by line, this is decided when the rest of its lines is available.
                    if here.position().holds_end_after() == Some(false) {
                        here.state.last = None;
                    }
                    return ControlFlow::Break(EndedBy::EndOfFile);
                }
            },
            ControlStep::ReturnTo(destination) => self.go_back(here, &destination),
            ControlStep::End(by) => return ControlFlow::Break(by),
            ControlStep::Covered => {
                here.scratch.ending.covered = true;
                return ControlFlow::Break(EndedBy::EndOfFile);
            }
        }
        ControlFlow::Continue(())
    }
}

impl Interpreter {
    /// Returns the called files that were executed to their end.
    pub fn returned_files(&self) -> impl Iterator<Item = &Arc<str>> {
        let units = self.here.programs.units().iter().skip(1);
        let returned = units.filter(|unit| unit.returned);
        returned.map(|unit| unit.index.source.name())
    }
}

/// Share of the budget of ways that is used before calls are no longer followed one by one: a quarter.
const SHARE: u64 = 4;

impl OtherPaths {
    /// Calls a program. Its blocks are executed, unless they were in every state that this one can be; `Break` where
    /// it is known never to come back.
    pub(crate) fn call(&mut self, here: &mut Executor, request: Request) -> ControlFlow<EndedBy> {
        let is_whole = request.passage.is_none();
        here.push_call(request);
        if is_whole && here.state.work.ways() > here.options.limits.ways / SHARE {
            return self.call_on_ways(here);
        }
        ControlFlow::Continue(())
    }

    #[cold]
    fn call_on_ways(&mut self, here: &mut Executor) -> ControlFlow<EndedBy> {
        let track = &here.state.track;
        let Some(called) = here.called().filter(|_| track.searching.is_none()) else {
            return ControlFlow::Continue(());
        };
        let way = here.entry_of_call();
        let context = context(&here.state.control.frames, called.0);
        let waiting = &self.waiting;
        let Some(effect) = self.call_effects.get_mut(called) else {
            let effect = CallEffect::of(way, context);
            self.call_effects.insert(called, effect);
            return ControlFlow::Continue(());
        };
        if waiting
            .iter()
            .any(|it| is_within(&it.control.frames, called, effect))
        {
            return ControlFlow::Continue(());
        }
        match effect.take_in(way, &Unknown::Ways) {
            Arrival::Covered => {
                let after = effect.after(&here.state.track.reach);
                self.go_on_after_call(here, after)
            }
            Arrival::Grown => {
                effect.context = context;
                let entry = effect.entry().clone();
                let callers = here.state.control.frames.without_running();
                here.take_state(entry, callers);
                ControlFlow::Continue(())
            }
        }
    }

    /// Continues the run after a call whose effect is known.
    fn go_on_after_call(
        &mut self,
        here: &mut Executor,
        after: Option<Path>,
    ) -> ControlFlow<EndedBy> {
        let Some(after) = after else {
            return self.follow(here, ControlStep::Covered);
        };
        let callers = here.state.control.frames.without_running();
        let depth = callers.depth();
        here.state.track.reach.clone_from(&after.track.reach);
        here.take_state(after, callers);
        here.state.track.readings.clear();
        here.state.track.change_level(depth);
        ControlFlow::Continue(())
    }

    /// Returns the running program to the one that called it.
    fn come_back_from_call(&mut self, here: &mut Executor) {
        let called = here.called().filter(|_| !self.call_effects.is_empty());
        here.leave();
        let Some(called) = called else {
            return;
        };
        let mut way = here.entry_of_call();
        way.control.frames.clear();
        let context = context(&here.state.control.frames, called.0);
        if let Some(effect) = self.call_effects.get_mut(called)
            && effect.context == context
        {
            effect.come_back(way, &Unknown::Ways);
        }
    }

    /// Leaves the running program for another place than the block after its call.
    fn leave_for_elsewhere(&mut self, here: &mut Executor) {
        if let Some(called) = here.called() {
            self.call_effects.remove(called);
        }
        here.leave();
    }
}

impl Executor {
    /// Continues in a state, whose programs are called by others.
    fn take_state(&mut self, state: Path, mut callers: CallStack) {
        let Path {
            mut control, track, ..
        } = state;
        if let Some(running) = control.frames.pop() {
            callers.push(running);
        }
        control.frames = callers;
        self.state.control = control;
        self.state.track.asked = track.asked;
        self.state.track.assumed = track.assumed;
        self.state.track.failed = track.failed;
        self.version += 1;
    }

    /// Returns the running program, which was called.
    fn called(&self) -> Option<CalledAt> {
        let frames = &self.state.control.frames;
        Some((frames.depth(), frames.program()?))
    }

    /// Returns the state in which the running program is called.
    fn entry_of_call(&self) -> Path {
        self.charge_copies(&self.state.control, &self.state.track.reach);
        let mut entry = self.state.arriving();
        entry.control.frames = entry.control.frames.running_alone();
        entry
    }
}

/// Returns whether a way is in the last executed call of a program.
fn is_within(calls: &CallStack, (depth, program): CalledAt, effect: &CallEffect) -> bool {
    let at_depth = calls.iter().nth(depth.saturating_sub(1));
    at_depth.is_some_and(|frame| frame.program() == program)
        && context(calls, depth) == effect.context
}
