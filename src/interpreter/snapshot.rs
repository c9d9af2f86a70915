//! A run between two blocks as data.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::call::Found;
use super::options::{Options, StopPolicy};
use super::program::{EntryIndex, Index};
use super::run::Interpreter;
use super::state::{Frame, RepeatedCall, Request, State, Step};
use super::unit::Unit;
use crate::machine::Machine;
use crate::text::SourceFile;

/// A run between two blocks, to be saved and resumed (R9.30 is about what outlives programs; this
/// is about the middle of one).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// 1.
    pub schema: u32,
    /// The files of the run, in the order in which they were first needed.
    pub files: Vec<String>,
    /// The blocks of each file that were executed, where the others are checked at the end.
    executed: Vec<Vec<EntryIndex>>,
    state: State,
}

/// Why a snapshot cannot be resumed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ResumeError {
    /// A file of the run is not there.
    #[error("the file `{0}` of the run is missing")]
    MissingFile(String),
    /// The machine has other axes.
    #[error("the snapshot belongs to a machine with other axes")]
    OtherMachine,
    /// It names what is not there.
    #[error("the snapshot is damaged, or its files have changed: {0}")]
    Damaged(&'static str),
}

/// Counters of a run stay below this for centuries, and a damaged one above it would run over.
const MOST_COUNTED: u64 = 1 << 60;

impl Interpreter {
    /// The state of the run between two blocks. Programs that are streamed have none.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            schema: 1,
            files: self
                .units
                .iter()
                .map(|unit| unit.index.source.name().to_string())
                .collect(),
            executed: match self.options.stop {
                StopPolicy::CheckAll => self.units.iter().map(Unit::executed).collect(),
                StopPolicy::FirstError | StopPolicy::KeepGoing => Vec::new(),
            },
            state: self.state.clone(),
        }
    }

    /// An interpreter in the state of a snapshot. `source` gives the text of each file of the run.
    ///
    /// # Errors
    /// The name of a file that `source` does not give, a machine with other axes, or places that the
    /// files do not have.
    pub fn resume(
        machine: impl Into<Arc<Machine>>,
        options: Options,
        snapshot: Snapshot,
        source: &mut dyn FnMut(&str) -> Option<SourceFile>,
    ) -> Result<Self, ResumeError> {
        let machine = machine.into();
        if snapshot.state.compensation.len() != machine.axes.len() {
            return Err(ResumeError::OtherMachine);
        }
        let mut resumed = Self::with_state(machine, options, snapshot.state);
        for file in snapshot.files {
            let Some(text) = source(&file) else {
                return Err(ResumeError::MissingFile(file));
            };
            resumed.hold(Index::new(text, options.limits.nesting));
        }
        resumed.check_places()?;
        for (unit, executed) in resumed.units.iter_mut().zip(snapshot.executed) {
            unit.mark_executed(&executed);
        }
        Ok(resumed)
    }
}

impl Interpreter {
    /// Whether everything that the state names is there: a snapshot comes from outside, and what it
    /// says is looked up without a further question afterwards.
    fn check_places(&self) -> Result<(), ResumeError> {
        let holds = |is: bool, what| {
            if is {
                Ok(())
            } else {
                Err(ResumeError::Damaged(what))
            }
        };
        let (state, axes) = (&self.state, self.machine.axes.len());
        let sets = [
            state.occurred.len() == axes,
            state.compensation.fits(self.machine.axis_setups()),
        ];
        holds(sets == [true; 2], "it has other axes")?;
        let described = state.described.iter().map(|described| &described.before);
        let mut modals = described.chain([&state.modal]);
        holds(
            modals.all(|modal| modal.fits(axes)),
            "positions of other axes",
        )?;
        holds(state.couplings.fits(axes), "a coupling of other axes")?;
        let counted = [
            state.seq,
            state.blocks,
            state.spent.get(),
            state.level.get(),
        ];
        let counted = counted.iter().all(|count| *count < MOST_COUNTED);
        holds(counted, "a counter that is too large")?;
        let mut loops = state.loops.iter();
        let loops = loops.all(|known| known.fits(MOST_COUNTED) && self.has(known.place()));
        holds(loops, "a loop in a program that is not there")?;
        let frames = state.frames.iter().all(|frame| self.has_frame(frame));
        holds(frames, "a block that is not there")?;
        let repeated = match &state.repeated {
            Some(repeated) => match &repeated.call {
                RepeatedCall::Program(found) | RepeatedCall::Perhaps(found) => self.has(*found),
                RepeatedCall::External(_) => true,
            },
            None => true,
        };
        holds(repeated, "a cycle that is not there")?;
        let parked = match &state.parked {
            Some(Step::Jump(entry)) => state.frames.last().is_some_and(|frame| {
                let found = Found {
                    unit: frame.unit,
                    section: frame.section,
                };
                self.has_block(found, *entry)
            }),
            Some(Step::Call(requests)) => requests.iter().all(|request| self.has_request(request)),
            Some(Step::ReturnTo(back)) => back.entry().is_none_or(|entry| {
                let has = |unit: &Unit| unit.index.has_block(entry);
                self.units.iter().any(has)
            }),
            Some(Step::Begin | Step::Return | Step::End(_)) | None => true,
        };
        holds(parked, "a step to a block that is not there")?;
        let begins = !self.units.is_empty() || (state.frames.is_empty() && state.parked.is_none());
        holds(begins, "a run without a file")
    }

    fn has(&self, found: Found) -> bool {
        let unit = self.units.get(found.unit);
        unit.is_some_and(|unit| found.section < unit.index.sections.len())
    }

    /// Whether a block stands in a section, or the section ends there.
    fn has_block(&self, found: Found, entry: EntryIndex) -> bool {
        let unit = self.units.get(found.unit);
        let section = unit.and_then(|unit| unit.index.sections.get(found.section));
        section.is_some_and(|section| (section.start..=section.end).contains(&entry))
    }

    fn has_frame(&self, frame: &Frame) -> bool {
        let found = Found {
            unit: frame.unit,
            section: frame.section,
        };
        let calls =
            usize::try_from(frame.level).is_ok_and(|level| level <= self.state.frames.len());
        calls
            && self.has_block(found, frame.next)
            && frame
                .waiting
                .iter()
                .all(|request| self.has_request(request))
            && frame
                .passage
                .is_none_or(|passage| self.has_block(found, passage.first))
    }

    fn has_request(&self, request: &Request) -> bool {
        let first = request.passage.map(|passage| passage.first);
        self.has(request.found) && first.is_none_or(|first| self.has_block(request.found, first))
    }
}

impl Unit {
    fn executed(&self) -> Vec<EntryIndex> {
        (0..)
            .zip(&self.executed)
            .filter_map(|(entry, executed)| executed.then_some(entry))
            .collect()
    }

    fn mark_executed(&mut self, entries: &[EntryIndex]) {
        for &entry in entries {
            let place = usize::try_from(entry).unwrap_or(usize::MAX);
            if let Some(executed) = self.executed.get_mut(place) {
                *executed = true;
            }
        }
    }
}
