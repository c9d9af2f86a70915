//! Blocks one after another, until the program ends.

use std::ops::ControlFlow;

use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::ProgramId;
use crate::interpreter::run::at::{At, Shown};
use crate::interpreter::run::event::{EndedBy, Observer};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::RunOutcome;
use crate::interpreter::run::step::{Departure, Step};

impl Interpreter {
    /// Executes blocks until the call stack is empty, the program ends, or the observer stops it.
    pub(in crate::interpreter) fn run(
        &mut self,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        loop {
            let Some(frame) = self.state.control.frames.running() else {
                return RunOutcome::Ended(
                    self.state
                        .control
                        .ending
                        .take()
                        .unwrap_or(EndedBy::EndOfFile),
                );
            };
            let (unit, section, next) = (frame.unit, frame.section, frame.next);
            if !frame.waiting.is_empty() {
                self.call_waiting();
                continue;
            }
            let is_past = next >= self.programs.section(ProgramId { unit, section }).end;
            if is_past || frame.passage.is_some_and(|passage| next > passage.last) {
                if frame.level == 0 {
                    self.meet_at_end(finder);
                    return RunOutcome::Ended(EndedBy::EndOfFile);
                }
                self.end_of_pass();
                continue;
            }
            let is_repeated = self.programs.was_read(unit, next);
            let parsed = self.programs.parsed(unit, next);
            if let Some(frame) = self.state.control.frames.running_mut() {
                frame.next = next + 1;
            }
            if self.is_skipped(&parsed.block) {
                continue;
            }
            let called_from = self
                .state
                .control
                .frames
                .running_mut()
                .and_then(|frame| frame.called_from.take());
            let level = self.state.control.frames.level();
            let shown = Shown::default();
            let at = At::of_parsed(&parsed, level, &shown).with_caller(called_from.as_ref());
            if let Some(over) = self.over_budget(&at) {
                let over = self.with_loop(over, unit, next);
                self.work.over = Some(over);
                return RunOutcome::Ended(EndedBy::Budget);
            }
            let depth = self.state.control.frames.depth();
            let spent = self.state.effort.spent();
            let flow = self.execute(&at, finder, observer);
            if is_repeated {
                self.state
                    .effort
                    .repeat(parsed.weight, self.work.said, spent);
            }
            if let Some(frame) = self.state.control.frames.at_depth_mut(depth) {
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
    pub(in crate::interpreter) fn follow(&mut self, step: Step) -> ControlFlow<EndedBy> {
        match step {
            // Only a run that has not begun is parked with `Begin`; `go_on` begins it.
            Step::Begin => {}
            Step::Jump(entry) => {
                if let Some(endless) = self.endless_loop() {
                    self.work.over = Some(endless);
                    self.work.endless = true;
                    return ControlFlow::Break(EndedBy::Budget);
                }
                if let Some(frame) = self.state.control.frames.running_mut() {
                    frame.next = entry;
                }
            }
            Step::Call(mut requests) => {
                let Some(first) = (!requests.is_empty()).then(|| requests.remove(0)) else {
                    return ControlFlow::Continue(());
                };
                if let Some(frame) = self.state.control.frames.running_mut() {
                    requests.reverse();
                    frame.waiting = requests;
                }
                self.push_call(first);
            }
            Step::Return => match self.state.control.frames.running() {
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
}
