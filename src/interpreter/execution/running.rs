//! Executes block after block until the program ends.

use std::ops::ControlFlow;

use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::programs::index::ProgramId;
use crate::interpreter::run::block_context::{BlockContext, ShownBlockLines};
use crate::interpreter::run::event::{EndedBy, Event, Joined, Observer};
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::RunOutcome;
use crate::interpreter::run::state::RunState;
use crate::interpreter::run::step::{ControlStep, NextBlock};
use crate::interpreter::unknown::branching::MAX_OPEN;

impl Interpreter {
    /// Executes blocks until the call stack is empty, the program ends, or the observer stops it.
    pub(crate) fn run(
        &mut self,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        loop {
            self.choose_way(finder, observer);
            let (unit, next) = match self.due_block() {
                ControlFlow::Continue(Some(due)) => due,
                ControlFlow::Continue(None) => continue,
                ControlFlow::Break(by) => return RunOutcome::Ended(by),
            };
            let is_repeated = self.here.programs.was_read(unit, next);
            let parsed = self.here.programs.parsed(unit, next);
            if let Some(frame) = self.here.state.control.frames.running_mut() {
                frame.next = next + 1;
            }
            if self.here.is_skipped(&parsed.block) {
                self.here.seek_beyond(unit, next);
                continue;
            }
            if let Some(level) = self.here.undecided_level(&parsed.block)
                && self.here.part_by_skip(level, &parsed)
            {
                let flow = if self.here.offered.is_empty() {
                    ControlFlow::Continue(())
                } else {
                    let shown = ShownBlockLines::default();
                    let level = self.here.state.control.frames.level();
                    self.here
                        .offer_skip(&BlockContext::of_parsed(&parsed, level, &shown), observer)
                };
                if let Some(frame) = self.here.state.control.frames.running_mut() {
                    frame.next = next;
                }
                self.others.take_sides(&mut self.here, None, finder);
                if flow.is_break() {
                    return RunOutcome::Paused;
                }
                continue;
            }
            let called_from = self
                .here
                .state
                .control
                .frames
                .running_mut()
                .and_then(|frame| frame.called_from.take());
            let level = self.here.state.control.frames.level();
            let shown = ShownBlockLines::default();
            let at =
                BlockContext::of_parsed(&parsed, level, &shown).with_caller(called_from.as_ref());
            if let Some(over) = self.here.over_budget(&at) {
                let over = self.here.with_loop(over, unit, next);
                self.here.scratch.over.push(over);
                match self.others.end_path(&mut self.here, EndedBy::Budget) {
                    Some(by) => return RunOutcome::Ended(by),
                    None => continue,
                }
            }
            let depth = self.here.state.control.frames.depth();
            let spent = self.here.state.work.spent();
            let is_on_ways = !self.others.waiting.is_empty();
            let flow = self.execute(&at, finder, observer);
            if is_repeated {
                self.here
                    .state
                    .work
                    .repeat(parsed.weight, self.here.scratch.said, spent);
            } else {
                self.here.state.work.grant_ways();
            }
            if is_on_ways {
                self.here.charge_block(parsed.weight);
            }
            if let Some(frame) = self.here.state.control.frames.at_depth_mut(depth) {
                frame.called_from = called_from;
            }
            let step = match flow {
                ControlFlow::Continue(()) => None,
                ControlFlow::Break(NextBlock::Step(step)) => Some(step),
                ControlFlow::Break(NextBlock::Paused) => {
                    let step = self.here.state.parked.take();
                    self.here.state.parked = self.part_and_step(step, finder);
                    return RunOutcome::Paused;
                }
            };
            let Some(step) = self.part_and_step(step, finder) else {
                continue;
            };
            if let Some(by) = self.follow_to_end(step) {
                return RunOutcome::Ended(by);
            }
        }
    }

    /// The next block of the running program. `None` where the run first goes on elsewhere, `Break` where the last way
    /// ends.
    #[inline]
    fn due_block(&mut self) -> ControlFlow<EndedBy, Option<(usize, EntryIndex)>> {
        let Some(frame) = self.here.state.control.frames.running() else {
            let ending = self.here.state.control.ending.take();
            return self.go_on_elsewhere(ending.unwrap_or(EndedBy::EndOfFile));
        };
        let (unit, section, next) = (frame.unit, frame.section, frame.next);
        let (passage, level) = (frame.passage, frame.level);
        if !frame.waiting.is_empty() {
            return match self.others.call_waiting(&mut self.here) {
                ControlFlow::Continue(()) => ControlFlow::Continue(None),
                ControlFlow::Break(by) => self.go_on_elsewhere(by),
            };
        }
        let is_past = next >= self.here.programs.section(ProgramId { unit, section }).end;
        if is_past && frame.seeking.is_some() && self.here.ends_in_open_if() {
            return self.go_on_elsewhere(EndedBy::Error);
        }
        if is_past || passage.is_some_and(|passage| next > passage.last) {
            if level == 0 {
                return self.go_on_elsewhere(EndedBy::EndOfFile);
            }
            self.others.end_of_pass(&mut self.here);
            return ControlFlow::Continue(None);
        }
        if !self.others.loop_heads.is_empty() && self.others.enters_covered(&mut self.here, next) {
            self.here.scratch.covered = true;
            return self.go_on_elsewhere(EndedBy::EndOfFile);
        }
        ControlFlow::Continue(Some((unit, next)))
    }

    /// Ends the way. Another one goes on if there is one.
    fn go_on_elsewhere(
        &mut self,
        by: EndedBy,
    ) -> ControlFlow<EndedBy, Option<(usize, EntryIndex)>> {
        match self.others.end_path(&mut self.here, by) {
            Some(by) => ControlFlow::Break(by),
            None => ControlFlow::Continue(None),
        }
    }

    /// Continues on the way whose block comes first in the text; past their budget, all ways are joined.
    #[inline]
    fn choose_way(&mut self, finder: &mut dyn Finder, observer: &mut dyn Observer) {
        if !self.others.waiting.is_empty() && self.others.choose_path(&mut self.here) {
            self.tell_joined(observer);
        }
        if self.others.waiting.len() > MAX_OPEN {
            self.others.join_waiting(&mut self.here);
        }
        if self.others.is_past_ways(&mut self.here) {
            self.others.widen(&mut self.here, finder);
            self.tell_joined(observer);
        }
        let is_alone = self.others.waiting.is_empty();
        self.here.is_alone = is_alone;
        let RunState { track, control, .. } = &mut self.here.state;
        track.follow_again(&control.frames, is_alone);
    }

    /// Executes a step. Returns the end of the run if it is the last one of the last way.
    pub(crate) fn follow_to_end(&mut self, step: ControlStep) -> Option<EndedBy> {
        let ControlFlow::Break(by) = self.others.follow(&mut self.here, step) else {
            return None;
        };
        self.others.end_path(&mut self.here, by)
    }

    /// Announces that ways meet.
    #[cold]
    fn tell_joined(&mut self, observer: &mut dyn Observer) {
        let Some(frame) = self.here.state.control.frames.running() else {
            return;
        };
        if self.here.state.track.is_shadow() {
            return;
        }
        let place = self.here.programs.index(frame.unit).block_place(frame.next);
        self.here.show_ways();
        // A run stops at blocks: a request to stop takes effect at the next one.
        let _ = observer.event(Event::Joined(Joined {
            seq: self.here.state.seq,
            place: &place,
            compensation: &self.here.state.control.compensation,
            possible: &self.here.shown.possible,
            occurred: &self.here.state.occurred,
            version: self.here.version,
        }));
    }

    /// Parts the run after a block that asked. Returns the remaining step, which is that of the way on which no jump is
    /// taken.
    fn part_and_step(
        &mut self,
        step: Option<ControlStep>,
        finder: &mut dyn Finder,
    ) -> Option<ControlStep> {
        if self.here.sides.is_empty() {
            return step;
        }
        match step {
            None | Some(ControlStep::Call(_)) => {
                self.others
                    .take_sides(&mut self.here, step.as_ref(), finder);
                None
            }
            Some(ControlStep::Covered) => {
                // An error ends the block on all ways.
                self.here.sides.clear();
                step
            }
            _ if self.here.is_jump_chosen() => {
                self.others.take_sides(&mut self.here, None, finder);
                None
            }
            step => {
                self.others.take_jumps(&mut self.here, finder);
                step
            }
        }
    }
}

impl Executor {
    /// Looks for a branch beyond the part of a control block at an entry, which is skipped.
    fn seek_beyond(&mut self, unit: usize, entry: EntryIndex) {
        let links = self.programs.index(unit).links(entry);
        if let Some(frame) = self.state.control.frames.running_mut()
            && frame.seeking.is_some()
        {
            if links.next == entry {
                frame.seeking = None;
            } else {
                frame.next = links.next;
            }
        }
    }
}
