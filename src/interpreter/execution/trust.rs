//! Whether a state that comes from outside fits the machine and the files of the run. What it names is
//! looked up later without further checks.

use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::run::cycles::{ModalCycles, RepeatedCall};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::stack::Frame;
use crate::interpreter::run::step::{Request, Step};
use crate::text::Place;

/// Counters of a run stay below this for centuries, and a damaged one above it would run over.
const MOST_COUNTED: u64 = 1 << 60;

/// The line numbers of a text stay below this.
const MOST_LINES: u32 = 1 << 31;

/// What a state names that is not there.
type Doubt = Result<(), &'static str>;

impl Interpreter {
    /// Whether everything that the state names is there.
    pub(in crate::interpreter) fn check_state(&self) -> Doubt {
        self.check_axes()?;
        self.check_counters()?;
        self.check_frames()?;
        self.check_calls()?;
        self.check_ways()?;
        let state = &self.state;
        let begins = !self.programs.units().is_empty()
            || (state.control.frames.is_empty() && state.parked.is_none());
        holds(begins, "a run without a file")
    }

    fn check_axes(&self) -> Doubt {
        let (state, axes) = (&self.state, self.machine.axes.len());
        holds(state.occurred.len() == axes, "occurrences of other axes")?;
        let described = state
            .control
            .described
            .iter()
            .map(|described| &described.before);
        let mut modals = described.chain([&state.control.modal]);
        holds(
            modals.all(|modal| modal.fits(axes)),
            "positions of other axes",
        )?;
        holds(
            state.control.couplings.fits(axes),
            "a coupling of other axes",
        )?;
        holds(
            state.control.channel_axes.fits(axes),
            "a name of another axis",
        )
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
        let mut loops = state.track.loops.iter();
        let loops = loops.all(|known| known.fits(MOST_COUNTED) && self.has(known.program()));
        holds(loops, "a loop in a program that is not there")?;
        let lines = state.last.iter().all(|last| last.line < MOST_LINES);
        holds(lines, "a line that no text has")
    }

    fn check_frames(&self) -> Doubt {
        let frames = self
            .state
            .control
            .frames
            .iter()
            .all(|frame| self.has_frame(frame));
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
            Some(Step::Begin | Step::Return | Step::End(_)) | None => true,
        };
        holds(parked, "a step to a block that is not there")
    }

    fn check_ways(&self) -> Doubt {
        let ways = &self.state.track.ways;
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

    fn has_frame(&self, frame: &Frame) -> bool {
        let program = frame.program();
        let is_deep = usize::try_from(frame.level)
            .is_ok_and(|level| level > self.state.control.frames.depth());
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
