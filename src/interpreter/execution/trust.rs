//! Checks whether a state from outside fits the machine and the files of the run. The items that it names
//! are looked up later without further checks.

use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::programs::store::ProgramStore;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::cycles::{ModalCycles, RepeatedCall};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::path::{Loop, RunTrack};
use crate::interpreter::run::search::EarlierStates;
use crate::interpreter::run::stack::CallFrame;
use crate::interpreter::run::state::RunState;
use crate::interpreter::run::step::{ControlStep, Request};
use crate::interpreter::ways::history::History;
use crate::machine::Machine;
use crate::text::Place;

/// Counters of a run stay below this for centuries, and a damaged one above it would run over.
const MOST_COUNTED: u64 = 1 << 60;

/// The line numbers of a text stay below this.
const MOST_LINES: u32 = 1 << 31;

/// Verdict on a saved state, with the missing item that it names.
type Validity = Result<(), &'static str>;

/// The machine and the files that a state has to fit.
pub(crate) struct Trust<'a> {
    machine: &'a Machine,
    programs: &'a ProgramStore,
    state: &'a RunState,
    others: &'a OtherPaths,
}

impl<'a> Trust<'a> {
    /// The state of a run, before anything is done with it.
    pub(crate) fn of(run: &'a Interpreter) -> Self {
        Self {
            machine: &run.here.machine,
            programs: &run.here.programs,
            state: &run.here.state,
            others: &run.others,
        }
    }

    /// Whether everything that the state names is there.
    pub(crate) fn check(&self) -> Validity {
        let state = self.state;
        holds(
            state.occurred.len() == self.machine.axes.len(),
            "occurrences of other axes",
        )?;
        let mut conditions = state.conditions.iter();
        let asked = conditions.all(|it| it.fits() && is_somewhere(&it.place));
        holds(asked, "a condition with too many answers")?;
        self.check_counters()?;
        self.check_parked()?;
        self.check_path(&state.control, &state.track)?;
        let ended = state.ended.iter().map(|ended| &ended.path);
        let kept = self.others.kept();
        for path in self.others.waiting.iter().chain(kept).chain(ended) {
            self.check_path(&path.control, &path.track)?;
        }
        let begins = !self.programs.units().is_empty()
            || (state.control.frames.is_empty() && state.parked.is_none());
        holds(begins, "a run without a file")
    }

    /// A way through the program, and its loops with the states at their beginnings.
    fn check_path(&self, control: &ControlState, track: &RunTrack) -> Validity {
        let is_machine = control.compensation.fits(self.machine.axis_setups());
        holds(is_machine, "a way on another machine")?;
        self.check_axes(control)?;
        self.check_history(&control.history)?;
        self.check_frames(control)?;
        holds(
            self.has_cycles(&control.cycles),
            "a cycle that is not there",
        )?;
        let named = track.reach.conditions().chain(track.readings.conditions());
        self.check_conditions(named)?;
        let axes = self.machine.axes.len();
        let moved = track.shadow.moved.iter().all(|axis| axis.get() < axes);
        holds(moved, "a motion of another axis")?;
        let readings = track.readings.fit();
        holds(readings, "a condition with too many answers")?;
        track
            .searching
            .as_deref()
            .map_or(Ok(()), |before| self.check_search(before))?;
        track.loops.iter().try_for_each(|it| self.check_loop(it))
    }

    fn check_axes(&self, control: &ControlState) -> Validity {
        let axes = self.machine.axes.len();
        let described = control.described.iter().map(|described| &described.before);
        let mut modals = described.chain([&control.modal]);
        holds(
            modals.all(|modal| modal.fits(axes)),
            "positions of other axes",
        )?;
        holds(control.couplings.fits(axes), "a coupling of other axes")?;
        holds(control.channel_axes.fits(axes), "a name of another axis")
    }

    fn check_history(&self, history: &History) -> Validity {
        let axes = self.machine.axes.len();
        let fits = history.fits(axes, self.state.conditions.len());
        holds(fits, "a condition or an axis that is not there")
    }

    fn check_conditions(&self, mut named: impl Iterator<Item = u32>) -> Validity {
        let conditions = self.state.conditions.len();
        let known = named.all(|condition| (condition as usize) < conditions);
        holds(known, "a condition that is not there")
    }

    fn check_search(&self, before: &EarlierStates) -> Validity {
        let is_machine = before.compensation.fits(self.machine.axis_setups());
        holds(is_machine, "a block search on another machine")?;
        self.check_history(&before.history)
    }

    fn check_loop(&self, it: &Loop) -> Validity {
        let known = it.fits(MOST_COUNTED) && self.has(it.program());
        holds(known, "a loop in a program that is not there")?;
        it.last
            .as_deref()
            .map_or(Ok(()), |last| self.check_path(&last.control, &last.track))
    }

    fn check_counters(&self) -> Validity {
        let state = self.state;
        let counted = [
            state.seq,
            state.blocks,
            state.work.spent(),
            state.work.level(),
            state.work.repeated(),
            state.work.ways(),
        ];
        let mut counted = counted.iter().chain(state.opaque.values());
        let counted = counted.all(|count| *count < MOST_COUNTED);
        holds(counted, "a counter that is too large")?;
        let lines = state.last.iter().all(|last| last.line < MOST_LINES);
        holds(lines, "a line that no text has")
    }

    fn check_frames(&self, control: &ControlState) -> Validity {
        let depth = control.frames.depth();
        let mut frames = control.frames.iter();
        let frames = frames.all(|frame| self.has_frame(frame, depth));
        holds(frames, "a block that is not there")
    }

    fn check_parked(&self) -> Validity {
        let state = self.state;
        let parked = match &state.parked {
            Some(ControlStep::Jump(entry)) => state
                .control
                .frames
                .running()
                .is_some_and(|frame| self.has_block(frame.program(), *entry)),
            Some(ControlStep::Call(requests)) => {
                requests.iter().all(|request| self.has_request(request))
            }
            Some(ControlStep::ReturnTo(back)) => back.entry.is_none_or(|entry| {
                let to = |frame: &&CallFrame| frame.level <= back.level;
                let frame = state.control.frames.iter().rev().find(to);
                frame.is_none_or(|frame| self.has_block(frame.program(), entry))
            }),
            Some(
                ControlStep::Begin
                | ControlStep::Return
                | ControlStep::End(_)
                | ControlStep::Covered,
            )
            | None => true,
        };
        holds(parked, "a step to a block that is not there")
    }

    fn has(&self, found: ProgramId) -> bool {
        let unit = self.programs.units().get(found.unit);
        unit.is_some_and(|unit| found.section < unit.index.sections.len())
    }

    /// Whether a section contains a block, or ends there.
    fn has_block(&self, found: ProgramId, entry: EntryIndex) -> bool {
        let unit = self.programs.units().get(found.unit);
        let section = unit.and_then(|unit| unit.index.sections.get(found.section));
        section.is_some_and(|section| (section.start..=section.end).contains(&entry))
    }

    fn has_frame(&self, frame: &CallFrame, depth: usize) -> bool {
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

fn holds(is: bool, otherwise: &'static str) -> Validity {
    if is { Ok(()) } else { Err(otherwise) }
}

/// Whether a place has a line that a text may have.
fn is_somewhere(place: &Place) -> bool {
    place.first_line < MOST_LINES
}
