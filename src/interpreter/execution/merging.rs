//! The ends of the ways through the program.

use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::run::block_scratch::OwnEnd;
use crate::interpreter::run::event::{EndedBy, ProgramEnd};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::path::Last;
use crate::interpreter::run::path::{EndedPath, Passed};
use crate::interpreter::run::state::State;

impl Interpreter {
    /// Ends a way. Returns the end of the run if no other way continues.
    #[cold]
    pub(in crate::interpreter) fn end_path(&mut self, by: EndedBy) -> Option<EndedBy> {
        let is_covered = std::mem::take(&mut self.scratch.covered);
        let is_alone = self.state.pending.is_empty() && self.state.ended.is_empty();
        let waits_for_lines = by == EndedBy::EndOfFile
            && self.state.control.frames.depth() == 1
            && self.programs.index(0).entries.is_empty();
        if is_alone || (waits_for_lines && !is_covered) {
            return Some(by);
        }
        if by == EndedBy::Budget && !self.scratch.endless && !is_covered {
            // The effects of the other ways are not known.
            self.state.pending.clear();
            self.state.ended.clear();
            self.havoc_all(&"a way that was not followed".into());
            return Some(by);
        }
        let never_ends = std::mem::take(&mut self.scratch.endless);
        if !is_covered && !never_ends {
            if by == EndedBy::EndOfFile && !self.state.control.frames.is_empty() {
                let missing = self.state.missing_end().map(|mut missing| {
                    self.state.limit_to_reach(&mut missing, None);
                    missing
                });
                self.scratch.over.extend(missing);
            }
            let ended = self.ended_path(by);
            self.state.ended.push(ended);
        }
        if self.enter_first() {
            self.scratch.havoc_last_motion();
            return None;
        }
        let last = self.state.ended.pop()?;
        self.scratch.end = last.at.map(|(place, passed)| OwnEnd {
            place,
            is_passed_into: passed == Passed::Into,
        });
        self.state.last = last.last;
        self.enter_path(last.path);
        Some(last.by)
    }

    fn ended_path(&mut self, by: EndedBy) -> EndedPath {
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

    /// The ways through the program meet at its end. Returns what ended it, and each end.
    #[cold]
    pub(in crate::interpreter) fn meet_ended(&mut self, by: EndedBy) -> (EndedBy, Vec<ProgramEnd>) {
        let own = self.ended_path(by);
        let mut ended = std::mem::take(&mut self.state.ended);
        ended.push(own);
        let mut ends: Vec<ProgramEnd> = Vec::new();
        for end in ended.iter().rev() {
            let place = end.at.as_ref().map(|(place, _)| place.clone());
            let place = place.or_else(|| end.last.as_ref().map(Last::place));
            let Some(place) = place.filter(|_| end.by != EndedBy::Error) else {
                continue;
            };
            let mut compensation = end.path.control.compensation.clone();
            let _ = compensation.program_end();
            let number = end.path.track.reach.conditions().max();
            let cause = number.and_then(|number| self.state.conditions.get(number as usize));
            ends.push(ProgramEnd {
                place,
                is_passed_into: matches!(end.at, Some((_, Passed::Into))),
                cause: cause
                    .filter(|_| !ends.is_empty())
                    .map(|found| found.cause.clone()),
                compensation,
            });
        }
        // The next program does not find the state that an error leaves.
        let is_error = |end: &EndedPath| end.by == EndedBy::Error;
        if !ended.iter().all(is_error) {
            ended.retain(|end| !is_error(end));
        }
        let mut ways = ended.into_iter().rev();
        let Some(EndedPath {
            path, by, at, last, ..
        }) = ways.next()
        else {
            return (by, ends);
        };
        self.scratch.end = at.map(|(place, passed)| OwnEnd {
            place,
            is_passed_into: passed == Passed::Into,
        });
        self.state.last = last;
        self.enter_path(path);
        for other in ways {
            self.join_path(other.path);
        }
        (by, ends)
    }
}

impl State {
    /// FC310 at the last executed block; a program without any block is reported as such (R18.6).
    pub(in crate::interpreter) fn missing_end(&self) -> Option<Diagnostic> {
        let place = self.last.as_ref()?.place();
        let message = "the program ends here without M30 or M02";
        Some(Diagnostic::new(Code::Fc310, place, message).with_help("end it with `M30`"))
    }
}
