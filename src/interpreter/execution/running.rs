//! Executes block after block until the program ends.

use std::ops::ControlFlow;

use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::programs::index::ProgramId;
use crate::interpreter::run::block_context::{BlockContext, ShownBlockLines};
use crate::interpreter::run::event::{EndedBy, Event, Joined, Observer};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::RunOutcome;
use crate::interpreter::run::state::State;
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
            let is_repeated = self.programs.was_read(unit, next);
            let parsed = self.programs.parsed(unit, next);
            if let Some(frame) = self.state.control.frames.running_mut() {
                frame.next = next + 1;
            }
            if self.is_skipped(&parsed.block) {
                self.seek_beyond(unit, next);
                continue;
            }
            if let Some(level) = self.undecided_level(&parsed.block)
                && self.part_by_skip(level, &parsed)
            {
                let flow = if self.offered.is_empty() {
                    ControlFlow::Continue(())
                } else {
                    let shown = ShownBlockLines::default();
                    let level = self.state.control.frames.level();
                    self.offer_skip(&BlockContext::of_parsed(&parsed, level, &shown), observer)
                };
                if let Some(frame) = self.state.control.frames.running_mut() {
                    frame.next = next;
                }
                self.take_sides(None, finder);
                if flow.is_break() {
                    return RunOutcome::Paused;
                }
                continue;
            }
            let called_from = self
                .state
                .control
                .frames
                .running_mut()
                .and_then(|frame| frame.called_from.take());
            let level = self.state.control.frames.level();
            let shown = ShownBlockLines::default();
            let at =
                BlockContext::of_parsed(&parsed, level, &shown).with_caller(called_from.as_ref());
            if let Some(over) = self.over_budget(&at) {
                let over = self.with_loop(over, unit, next);
                self.scratch.over.push(over);
                match self.end_path(EndedBy::Budget) {
                    Some(by) => return RunOutcome::Ended(by),
                    None => continue,
                }
            }
            let depth = self.state.control.frames.depth();
            let spent = self.state.work.spent();
            let is_on_ways = !self.state.waiting.is_empty();
            let flow = self.execute(&at, finder, observer);
            if is_repeated {
                self.state
                    .work
                    .repeat(parsed.weight, self.scratch.said, spent);
            } else {
                self.state.work.grant_ways();
            }
            if is_on_ways {
                self.charge_block(parsed.weight);
            }
            if let Some(frame) = self.state.control.frames.at_depth_mut(depth) {
                frame.called_from = called_from;
            }
            let step = match flow {
                ControlFlow::Continue(()) => None,
                ControlFlow::Break(NextBlock::Step(step)) => Some(step),
                ControlFlow::Break(NextBlock::Paused) => {
                    let step = self.state.parked.take();
                    self.state.parked = self.part_and_step(step, finder);
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
        let Some(frame) = self.state.control.frames.running() else {
            let ending = self.state.control.ending.take();
            return self.go_on_elsewhere(ending.unwrap_or(EndedBy::EndOfFile));
        };
        let (unit, section, next) = (frame.unit, frame.section, frame.next);
        let (passage, level) = (frame.passage, frame.level);
        if !frame.waiting.is_empty() {
            return match self.call_waiting() {
                ControlFlow::Continue(()) => ControlFlow::Continue(None),
                ControlFlow::Break(by) => self.go_on_elsewhere(by),
            };
        }
        let is_past = next >= self.programs.section(ProgramId { unit, section }).end;
        if is_past && frame.seeking.is_some() && self.ends_in_open_if() {
            return self.go_on_elsewhere(EndedBy::Error);
        }
        if is_past || passage.is_some_and(|passage| next > passage.last) {
            if level == 0 {
                return self.go_on_elsewhere(EndedBy::EndOfFile);
            }
            self.end_of_pass();
            return ControlFlow::Continue(None);
        }
        if !self.state.loop_heads.is_empty() && self.enters_covered(next) {
            self.scratch.covered = true;
            return self.go_on_elsewhere(EndedBy::EndOfFile);
        }
        ControlFlow::Continue(Some((unit, next)))
    }

    /// Ends the way. Another one goes on if there is one.
    fn go_on_elsewhere(
        &mut self,
        by: EndedBy,
    ) -> ControlFlow<EndedBy, Option<(usize, EntryIndex)>> {
        match self.end_path(by) {
            Some(by) => ControlFlow::Break(by),
            None => ControlFlow::Continue(None),
        }
    }

    /// Continues on the way whose block comes first in the text; past their budget, all ways are joined.
    #[inline]
    fn choose_way(&mut self, finder: &mut dyn Finder, observer: &mut dyn Observer) {
        if !self.state.waiting.is_empty() && self.choose_path() {
            self.tell_joined(observer);
        }
        if self.state.waiting.len() > MAX_OPEN {
            self.join_waiting();
        }
        if self.is_past_ways() {
            self.widen(finder);
            self.tell_joined(observer);
        }
        let State {
            track,
            control,
            waiting,
            ..
        } = &mut self.state;
        track.follow_again(&control.frames, waiting.is_empty());
    }

    /// Executes a step. Returns the end of the run if it is the last one of the last way.
    pub(crate) fn follow_to_end(&mut self, step: ControlStep) -> Option<EndedBy> {
        let ControlFlow::Break(by) = self.follow(step) else {
            return None;
        };
        self.end_path(by)
    }

    /// Announces that ways meet.
    #[cold]
    fn tell_joined(&mut self, observer: &mut dyn Observer) {
        let Some(frame) = self.state.control.frames.running() else {
            return;
        };
        if self.state.track.is_shadow() {
            return;
        }
        let place = self.programs.index(frame.unit).block_place(frame.next);
        self.show_ways();
        // A run stops at blocks: a request to stop takes effect at the next one.
        let _ = observer.event(Event::Joined(Joined {
            seq: self.state.seq,
            place: &place,
            compensation: &self.state.control.compensation,
            possible: &self.shown.possible,
            occurred: &self.state.occurred,
            version: self.version,
        }));
    }

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

    /// Parts the run after a block that asked. Returns the remaining step, which is that of the way on which no jump is
    /// taken.
    fn part_and_step(
        &mut self,
        step: Option<ControlStep>,
        finder: &mut dyn Finder,
    ) -> Option<ControlStep> {
        if self.sides.is_empty() {
            return step;
        }
        match step {
            None | Some(ControlStep::Call(_)) => {
                self.take_sides(step.as_ref(), finder);
                None
            }
            Some(ControlStep::Covered) => {
                // An error ends the block on all ways.
                self.sides.clear();
                step
            }
            _ if self.is_jump_chosen() => {
                self.take_sides(None, finder);
                None
            }
            step => {
                self.take_jumps(finder);
                step
            }
        }
    }
}
