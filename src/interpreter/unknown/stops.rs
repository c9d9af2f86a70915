//! Errors that end the ways that lead to a block, each with the state that it leaves (R14.5, R18.10).

use std::sync::Arc;

use super::branching::answers;
use crate::comp::{AxisIndex, Kind};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::block_scratch::{AfterError, OwnEnd};
use crate::interpreter::run::event::EndedBy;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::options::StopPolicy;
use crate::interpreter::run::path::{EndedPath, Passed};
use crate::interpreter::run::stopping::{FailedAt, stops};
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;
use crate::readings::Question;
use crate::text::Span;

impl Executor {
    /// An error ends some of the ways that lead to the block: they end the program here. With
    /// [`StopPolicy::KeepGoing`] nothing does, as if the failing command were not there (R9.20).
    #[cold]
    pub(crate) fn stop_on(&mut self, ways: &WaySet, after: AfterError, at: &BlockContext<'_>) {
        if self.options.stop == StopPolicy::KeepGoing {
            return;
        }
        let is_passed_into = !self.may_be_jumped_to(at);
        let sides = self.sides_after(ways, after, at);
        // The states after a reset and after a restart differ, which is reported.
        let is_one_end = sides.len() == 1;
        let here = (self.state.control.clone(), self.state.track.clone());
        for (ways, next) in sides {
            (self.state.control, self.state.track) = here.clone();
            self.state.go_on_with(ways);
            match next {
                NextStart::Reset => self.reset_after_stop(),
                NextStart::Restart => {
                    self.restart();
                    self.state.control.history.forget_sites();
                }
            }
            let end = self.scratch.end.replace(OwnEnd {
                place: at.place(Span::new(0, at.text.len())),
                is_passed_into,
            });
            let mut ended = self.ended_path(EndedBy::Error);
            if self.options.stop == StopPolicy::CheckAll {
                // It does not leave the loops in which the run goes on.
                ended.path.parted = 0;
            }
            if is_one_end {
                self.state.end_way(ended);
            } else {
                self.state.ended.push(ended);
            }
            self.scratch.end = end;
        }
        (self.state.control, self.state.track) = here;
        self.version += 1;
    }

    /// Where the run goes on after errors, one ends the program on all ways that lead to the block; what follows is
    /// then executed as if the failing command were not there (R9.20).
    #[cold]
    pub(crate) fn fail(&mut self, after: AfterError, at: &BlockContext<'_>) {
        if self.options.stop == StopPolicy::CheckAll && self.state.track.failed.is_none() {
            let ways = self.state.track.reach.clone();
            self.stop_on(&ways, after, at);
            let failed = FailedAt::new(self.state.seq, at, &self.scratch.diagnostics);
            self.state.track.failed = Some(Box::new(failed));
        }
    }

    /// The same where a message on the block is about an error of the control.
    #[cold]
    pub(crate) fn fail_if_refused(&mut self, at: &BlockContext<'_>) {
        let mut said = self.scratch.diagnostics.iter();
        if said.any(|said| stops(said) && !said.code.is_budget()) {
            self.fail(AfterError::Reset, at);
        }
    }

    /// The way that leads here ends the program.
    pub(crate) fn ended_path(&mut self, by: EndedBy) -> EndedPath {
        let mut path = self.state.leave_path();
        path.track.assumed.undo(&mut path.control.memory);
        path.control.frames.clear();
        let at = self.scratch.end.take().map(|end| {
            let passed = if end.is_passed_into {
                Passed::Into
            } else {
                Passed::Perhaps
            };
            (end.place, passed)
        });
        EndedPath {
            path,
            by,
            at,
            last: self.state.last.clone(),
        }
    }

    /// Only after a reset does the next program run (R1.28).
    pub(crate) fn reset_after_stop(&mut self) {
        let start_up = self.machine.compensation();
        let compensation = &self.state.control.compensation;
        let is_away = |axis: AxisIndex| {
            compensation.state(axis, Kind::Frict) != start_up.state(axis, Kind::Frict)
        };
        if (0..self.machine.axes.len())
            .map(AxisIndex::new)
            .any(is_away)
        {
            self.state.rests_on.insert(Question::Reset);
        }
        let changes = self.scratch.changes.len();
        self.reset_friction();
        self.scratch.changes.truncate(changes);
    }

    /// The ways on which the channel is reset after the error, and those on which the control is restarted, where that
    /// leaves another state (R1.28, R1.29).
    fn sides_after(
        &mut self,
        ways: &WaySet,
        after: AfterError,
        at: &BlockContext<'_>,
    ) -> Vec<(WaySet, NextStart)> {
        let is_open = after == AfterError::ResetOrRestart
            && self.state.control.compensation != self.machine.compensation()
            && self.state.can_ask();
        if !is_open {
            return vec![(ways.clone(), NextStart::Reset)];
        }
        self.state.rests_on.insert(Question::Restart);
        let condition = self.state.ask_anew(Condition::new(
            ConditionKind::Restart,
            at.place(Span::new(0, at.text.trim_end().len())),
            vec![Arc::from("restarted")],
            Unknown::RemedyClass,
        ));
        let starts = [NextStart::Restart, NextStart::Reset];
        let answers = answers(condition, 2).map(|answer| ways.and(&WaySet::of(answer)));
        answers.zip(starts).collect()
    }
}

/// What comes between an error and the next program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NextStart {
    Reset,
    Restart,
}
