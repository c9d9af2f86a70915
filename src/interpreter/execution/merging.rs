//! The ends of the ways through the program.

use crate::comp::AxisIndex;
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::run::block_scratch::OwnEnd;
use crate::interpreter::run::event::{EndedBy, ProgramEnd, StoppedState};
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::path::{EndedPath, Last, Passed};
use crate::interpreter::run::state::RunState;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::ways::possible_state::shown;
use crate::interpreter::ways::set::WaySet;

impl OtherPaths {
    /// Ends a way. Returns the end of the run if no other way continues.
    #[cold]
    pub(crate) fn end_path(&mut self, here: &mut Executor, by: EndedBy) -> Option<EndedBy> {
        let is_covered = std::mem::take(&mut here.scratch.covered);
        let is_alone = self.waiting.is_empty() && here.state.ended.is_empty();
        let waits_for_lines = by == EndedBy::EndOfFile
            && here.state.control.frames.depth() == 1
            && here.programs.index(0).entries.is_empty();
        if is_alone || (waits_for_lines && !is_covered) {
            return Some(by);
        }
        if by == EndedBy::Budget && !here.scratch.endless && !is_covered {
            // The effects of the other ways are not known.
            self.waiting.clear();
            here.state.ended.clear();
            here.havoc_all(&Unknown::Ways);
            return Some(by);
        }
        let never_ends = std::mem::take(&mut here.scratch.endless);
        if never_ends {
            here.reset_after_stop();
            let said = here.scratch.over.last();
            here.scratch.end = said.map(|said| OwnEnd {
                place: said.place.clone(),
                is_passed_into: false,
            });
        }
        if !is_covered {
            if by == EndedBy::EndOfFile && !here.state.control.frames.is_empty() {
                let missing = here.state.missing_end().map(|mut missing| {
                    here.state.limit_to_reach(&mut missing, None);
                    missing
                });
                here.scratch.over.extend(missing);
            }
            let ended = here.ended_path(by);
            here.state.ended.push(ended);
        }
        if self.enter_first(here) {
            here.scratch.havoc_last_motion();
            return None;
        }
        let last = here.state.ended.pop()?;
        here.scratch.end = last.at.map(|(place, passed)| OwnEnd {
            place,
            is_passed_into: passed == Passed::Into,
        });
        here.state.last = last.last;
        here.enter_path(last.path);
        Some(last.by)
    }

    /// The ways through the program meet at its end. Where the run has gone on after errors, one that an error has
    /// ended counts only if no other went on, and the states at the errors are apart (R9.20).
    #[cold]
    pub(crate) fn meet_ended(&mut self, here: &mut Executor, by: EndedBy) -> MetWays {
        if !std::mem::take(&mut here.scratch.covered) {
            let own = here.ended_path(by);
            here.state.ended.push(own);
        }
        let ended = std::mem::take(&mut here.state.ended).into_iter().rev();
        let (failed, own): (Vec<_>, Vec<_>) =
            ended.partition(|end| end.path.track.failed.is_some());
        let is_stop = |end: &EndedPath| matches!(end.by, EndedBy::Error | EndedBy::Budget);
        let (mut stopped, mut all): (Vec<_>, Vec<_>) = own.into_iter().partition(is_stop);
        stopped.sort_by_key(|end| end.by != EndedBy::Error);
        let is_apart = all.is_empty() && !failed.is_empty();
        let apart = if is_apart {
            all = failed;
            stopped
        } else {
            all.append(&mut stopped);
            Vec::new()
        };
        let ends = here.state.ends_of(&all);
        let stopped = here.state.stopped(&apart);
        let mut ways = all.into_iter();
        let Some(EndedPath {
            path, by, at, last, ..
        }) = ways.next()
        else {
            return MetWays { by, ends, stopped };
        };
        let is_stop = matches!(by, EndedBy::Error | EndedBy::Budget);
        here.scratch.endless = by == EndedBy::Budget;
        let at = at.filter(|_| !is_stop);
        here.scratch.end = at.map(|(place, passed)| OwnEnd {
            place,
            is_passed_into: passed == Passed::Into,
        });
        here.state.last = last;
        here.enter_path(path);
        for other in ways {
            self.join_path(here, other.path);
        }
        MetWays { by, ends, stopped }
    }
}

/// The end of a program on whose ways it ended differently.
pub(crate) struct MetWays {
    pub(crate) by: EndedBy,
    /// Each end, that of the dry run first.
    pub(crate) ends: Vec<ProgramEnd>,
    /// The state at the errors after which the run went on.
    pub(crate) stopped: Option<StoppedState>,
}

impl RunState {
    /// The places where ways end, each once.
    fn ends_of(&self, ended: &[EndedPath]) -> Vec<ProgramEnd> {
        let mut ends: Vec<ProgramEnd> = Vec::new();
        for end in ended {
            let place = end.at.as_ref().map(|(place, _)| place.clone());
            let Some(place) = place.or_else(|| end.last.as_ref().map(Last::place)) else {
                continue;
            };
            let mut compensation = end.path.control.compensation.clone();
            let _ = compensation.program_end();
            if let Some(known) = ends.iter_mut().find(|it| it.place == place) {
                for axis in (0..compensation.len()).map(AxisIndex::new) {
                    let kinds = known.compensation.differing(&compensation, axis);
                    known.compensation.havoc(axis, kinds, &mut Vec::new());
                }
                continue;
            }
            let number = end.path.track.reach.conditions().max();
            let cause = number.and_then(|number| self.conditions.get(number as usize));
            ends.push(ProgramEnd {
                place,
                by: end.by,
                is_passed_into: matches!(end.at, Some((_, Passed::Into))),
                cause: cause
                    .filter(|_| !ends.is_empty())
                    .map(|found| found.cause.clone()),
                compensation,
            });
        }
        ends
    }

    /// The state that errors leave, as one.
    fn stopped(&self, ended: &[EndedPath]) -> Option<StoppedState> {
        let mut ways = ended.iter().map(|end| end.path.clone());
        let mut all = ways.next()?;
        for way in ways {
            all.join(way, &Unknown::RemedyClass);
        }
        let mut control = all.control;
        let _ = control.compensation.program_end();
        let state = (&control.compensation, &control.history);
        Some(StoppedState {
            ends: self.ends_of(ended),
            possible: shown(state, &WaySet::always(), &self.conditions),
            history: control.history,
            compensation: control.compensation,
        })
    }
}

impl RunState {
    /// FC310 at the last executed block; a program without any block is reported as such (R18.6).
    pub(crate) fn missing_end(&self) -> Option<Diagnostic> {
        let place = self.last.as_ref()?.place();
        let message = "the program ends here without M30 or M02";
        Some(Diagnostic::new(Code::Fc310, place, message).with_help("end it with `M30`"))
    }
}
