//! Calls whose effects are known from other ways: they are not executed once more (R14.4).

use std::ops::ControlFlow;

use crate::interpreter::run::call_effects::{CallEffect, CalledAt, context};
use crate::interpreter::run::event::EndedBy;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::loop_heads::Arrival;
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::path::Path;
use crate::interpreter::run::stack::CallStack;
use crate::interpreter::run::step::{ControlStep, Request};
use crate::interpreter::values::cause::Unknown;

/// Share of the budget of ways that is used before calls are no longer followed one by one: a quarter.
const SHARE: u64 = 4;

impl OtherPaths {
    /// Calls a program. Its blocks are executed, unless they were in every state that this one can be; `Break` where
    /// it is known never to come back.
    pub(super) fn call(&mut self, here: &mut Executor, request: Request) -> ControlFlow<EndedBy> {
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

    /// The effect of a call is known: the run continues after it.
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

    /// The running program comes back to the one that called it.
    pub(super) fn come_back_from_call(&mut self, here: &mut Executor) {
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

    /// The running program is left for another place than the block after its call.
    pub(super) fn leave_for_elsewhere(&mut self, here: &mut Executor) {
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

    /// The running program, which was called.
    fn called(&self) -> Option<CalledAt> {
        let frames = &self.state.control.frames;
        Some((frames.depth(), frames.program()?))
    }

    /// The state in which the running program is called.
    fn entry_of_call(&self) -> Path {
        self.charge_copies(&self.state.control, &self.state.track.reach);
        let mut entry = self.state.arriving();
        entry.control.frames = entry.control.frames.running_alone();
        entry
    }
}

/// Whether a way is in the last executed call of a program.
fn is_within(calls: &CallStack, (depth, program): CalledAt, effect: &CallEffect) -> bool {
    let at_depth = calls.iter().nth(depth.saturating_sub(1));
    at_depth.is_some_and(|frame| frame.program() == program)
        && context(calls, depth) == effect.context
}
