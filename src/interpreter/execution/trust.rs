//! Whether a state that comes from outside fits the machine and the files of the run. What it names is
//! looked up later without further checks.

use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::cycles::{ModalCycles, RepeatedCall};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::path::Track;
use crate::interpreter::run::stack::Frame;
use crate::interpreter::run::step::{Request, Step};
use crate::interpreter::run::ways::Ways;
use crate::text::Place;

/// Counters of a run stay below this for centuries, and a damaged one above it would run over.
const MOST_COUNTED: u64 = 1 << 60;

/// The line numbers of a text stay below this.
const MOST_LINES: u32 = 1 << 31;

/// Verdict on a saved state, with the missing item that it names.
type Doubt = Result<(), &'static str>;

impl Interpreter {
    /// Whether everything that the state names is there.
    pub(in crate::interpreter) fn check_state(&self) -> Doubt {
        self.check_axes()?;
        self.check_counters()?;
        self.check_frames(&self.state.control)?;
        self.check_calls()?;
        self.check_ways(&self.state.track.ways)?;
        self.check_paths()?;
        let state = &self.state;
        let begins = !self.programs.units().is_empty()
            || (state.control.frames.is_empty() && state.parked.is_none());
        holds(begins, "a run without a file")
    }

    fn check_axes(&self) -> Doubt {
        let axes = self.machine.axes.len();
        let occurred = &self.state.occurred;
        holds(occurred.len() == axes, "occurrences of other axes")?;
        self.check_axes_of(&self.state.control)
    }

    fn check_axes_of(&self, control: &ControlState) -> Doubt {
        let axes = self.machine.axes.len();
        let described = control.described.iter().map(|described| &described.before);
        let mut modals = described.chain([&control.modal]);
        holds(
            modals.all(|modal| modal.fits(axes)),
            "positions of other axes",
        )?;
        holds(control.couplings.fits(axes), "a coupling of other axes")?;
        holds(control.channel_axes.fits(axes), "a name of another axis")?;
        let conditions = self.state.conditions.len();
        let possible =
            control.possible.fits(axes, conditions) && control.untouched.fits(axes, conditions);
        holds(possible, "a condition that is not there")
    }

    /// The other ways through the program, and those that have ended.
    fn check_paths(&self) -> Doubt {
        let ended = self.state.ended.iter().map(|ended| &ended.path);
        for path in self.state.pending.iter().chain(ended) {
            let is_machine = path.control.compensation.fits(self.machine.axis_setups());
            holds(is_machine, "a way on another machine")?;
            self.check_axes_of(&path.control)?;
            self.check_frames(&path.control)?;
            let cycles = self.has_cycles(&path.control.cycles);
            holds(cycles, "a cycle that is not there")?;
            self.check_ways(&path.track.ways)?;
            self.check_track(&path.track)?;
        }
        self.check_track(&self.state.track)
    }

    fn check_track(&self, track: &Track) -> Doubt {
        let conditions = self.state.conditions.len();
        let mut named = track.reach.conditions();
        let is_known = named.all(|condition| (condition as usize) < conditions);
        holds(is_known, "a condition that is not there")?;
        let mut loops = track.loops.iter();
        let loops = loops.all(|known| {
            let before = known.covered.as_ref();
            known.fits(MOST_COUNTED)
                && self.has(known.program())
                && before.is_none_or(|before| {
                    self.check_axes_of(&before.control).is_ok()
                        && self.check_frames(&before.control).is_ok()
                        && self.has_cycles(&before.control.cycles)
                        && before
                            .track
                            .reach
                            .conditions()
                            .all(|it| (it as usize) < conditions)
                })
        });
        holds(loops, "a loop in a program that is not there")
    }

    fn check_counters(&self) -> Doubt {
        let state = &self.state;
        let counted = [
            state.seq,
            state.blocks,
            state.effort.spent(),
            state.effort.level(),
            state.effort.repeated(),
        ];
        let counted = counted.iter().all(|count| *count < MOST_COUNTED);
        holds(counted, "a counter that is too large")?;
        let lines = state.last.iter().all(|last| last.line < MOST_LINES);
        holds(lines, "a line that no text has")
    }

    fn check_frames(&self, control: &ControlState) -> Doubt {
        let depth = control.frames.depth();
        let mut frames = control.frames.iter();
        let frames = frames.all(|frame| self.has_frame(frame, depth));
        holds(frames, "a block that is not there")
    }

    fn check_calls(&self) -> Doubt {
        let state = &self.state;
        holds(
            self.has_cycles(&state.control.cycles),
            "a cycle that is not there",
        )?;
        let parked = match &state.parked {
            Some(Step::Jump(entry)) => state
                .control
                .frames
                .running()
                .is_some_and(|frame| self.has_block(frame.program(), *entry)),
            Some(Step::Call(requests)) => requests.iter().all(|request| self.has_request(request)),
            Some(Step::ReturnTo(back)) => back.entry.is_none_or(|entry| {
                let to = |frame: &&Frame| frame.level <= back.level;
                let frame = state.control.frames.iter().rev().find(to);
                frame.is_none_or(|frame| self.has_block(frame.program(), entry))
            }),
            Some(Step::Begin | Step::Return | Step::End(_) | Step::Covered) | None => true,
        };
        holds(parked, "a step to a block that is not there")
    }

    fn check_ways(&self, ways: &Ways) -> Doubt {
        let axes = self.machine.axes.len();
        holds(ways.fit(axes), "a way of other axes")?;
        let tails = ways.tails().all(|(place, _)| self.has(place));
        holds(tails, "a way through a program that is not there")?;
        let cycles = ways.cycles().all(|cycles| self.has_cycles(cycles));
        holds(cycles, "a cycle on a way that is not there")
    }

    pub(in crate::interpreter) fn has(&self, found: ProgramId) -> bool {
        let unit = self.programs.units().get(found.unit);
        unit.is_some_and(|unit| found.section < unit.index.sections.len())
    }

    /// Whether a section contains a block, or ends there.
    fn has_block(&self, found: ProgramId, entry: EntryIndex) -> bool {
        let unit = self.programs.units().get(found.unit);
        let section = unit.and_then(|unit| unit.index.sections.get(found.section));
        section.is_some_and(|section| (section.start..=section.end).contains(&entry))
    }

    fn has_frame(&self, frame: &Frame, depth: usize) -> bool {
        let program = frame.program();
        let is_deep = usize::try_from(frame.level).is_ok_and(|level| level > depth);
        let called = frame.called_from.iter();
        !is_deep
            && self.has_block(program, frame.next)
            && called.into_iter().all(is_somewhere)
            && frame
                .waiting
                .iter()
                .all(|request| self.has_request(request))
            && frame
                .passage
                .is_none_or(|passage| self.has_block(program, passage.first))
    }

    fn has_request(&self, request: &Request) -> bool {
        let first = request.passage.map(|passage| passage.first);
        self.has(request.found)
            && is_somewhere(&request.called_from)
            && first.is_none_or(|first| self.has_block(request.found, first))
    }

    fn has_cycles(&self, cycles: &ModalCycles) -> bool {
        cycles.known().iter().all(|cycle| match &cycle.call {
            RepeatedCall::Program(found) | RepeatedCall::Perhaps(found) => self.has(*found),
            RepeatedCall::External(_) => true,
        })
    }
}

fn holds(is: bool, otherwise: &'static str) -> Doubt {
    if is { Ok(()) } else { Err(otherwise) }
}

/// Whether a place has a line that a text may have.
fn is_somewhere(place: &Place) -> bool {
    place.first_line < MOST_LINES
}
