//! A run between two blocks as data, with fingerprints of its texts. A state from outside is checked against the machine and
//! the files; the items that it names are looked up later without further checks.

use std::fmt;
use std::hash::Hasher as _;
use std::sync::Arc;

use fnv::FnvHasher;
use postcard::ser_flavors::Flavor;
use serde::{Deserialize, Serialize};

use crate::interpreter::control::{ControlState, ModalCycles, RepeatedCall};
use crate::interpreter::drive::host::Interpreter;
use crate::interpreter::executor::RunState;
use crate::interpreter::options::{Options, SourceMode, StopPolicy};
use crate::interpreter::programs::index::{EntryIndex, Index, ProgramId};
use crate::interpreter::programs::store::{ProgramStore, SourceUnit};
use crate::interpreter::stack::{CallFrame, ControlStep, Request};
use crate::interpreter::ways::history::History;
use crate::interpreter::ways::others::OtherPaths;
use crate::interpreter::ways::path::{EarlierStates, Loop, RunTrack};
use crate::machine::Machine;
use crate::text::{Place, SourceFile};

/// A run between two blocks, to be saved and resumed (R9.30 is about what outlives programs; this
/// is about the middle of one).
///
/// A snapshot is not trusted: [`Interpreter::resume`] refuses one of another version, of changed texts
/// or of a machine with other axes, and one that is not as it was saved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    schema: u32,
    files: Vec<RunFile>,
    /// The blocks of each file that were executed, where the others are checked at the end.
    executed: Vec<Vec<EntryIndex>>,
    state: RunState,
    others: OtherPaths,
    /// The fingerprint of everything else.
    seal: Option<Fingerprint>,
}

/// A file of the run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct RunFile {
    name: String,
    text: Fingerprint,
}

/// Reason why a snapshot cannot be resumed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ResumeError {
    /// Snapshot written by another version.
    #[error(
        "the snapshot has schema {found}; this version reads schema {}",
        Snapshot::SCHEMA
    )]
    Schema {
        /// The schema that it has.
        found: u32,
    },
    /// A file of the run is not there.
    #[error("the file `{0}` of the run is missing")]
    MissingFile(String),
    /// A file of the run has another text than when the run was stopped.
    #[error("the file `{0}` has changed since the run was stopped")]
    OtherText(String),
    /// The machine has other axes.
    #[error("the snapshot belongs to a machine with other axes")]
    OtherMachine,
    /// A snapshot that was changed after it was saved, or names something that does not exist.
    #[error("the snapshot is damaged: {0}")]
    Damaged(&'static str),
}

impl Snapshot {
    /// The number of the format that is written and read.
    pub const SCHEMA: u32 = 17;

    /// Returns the number of the format that the snapshot has.
    pub fn schema(&self) -> u32 {
        self.schema
    }

    /// Returns the names of the files of the run, in the order in which they were first needed.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|file| file.name.as_str())
    }

    /// Returns the snapshot with a seal for its present content, for callers that changed a saved snapshot
    /// on purpose. Its places are checked by [`Interpreter::resume`] all the same.
    pub fn sealed_anew(mut self) -> Self {
        self.seal = self.seal_of_content();
        self
    }

    fn seal_of_content(&self) -> Option<Fingerprint> {
        Fingerprint::of_data(&(
            self.schema,
            &self.files,
            &self.executed,
            &self.state,
            &self.others,
        ))
    }

    fn is_as_saved(&self) -> bool {
        self.seal.is_some() && self.seal == self.seal_of_content()
    }
}

impl SourceUnit {
    fn executed(&self) -> Vec<EntryIndex> {
        (0..)
            .zip(&self.executed)
            .filter_map(|(entry, executed)| executed.then_some(entry))
            .collect()
    }
}

impl Interpreter {
    /// Returns the state of the run between two blocks. `None` where the program is read line by line: its lines are
    /// gone, so nothing could be resumed.
    pub fn snapshot(&self) -> Option<Snapshot> {
        if self.source_mode == SourceMode::LineByLine {
            return None;
        }
        let file = |unit: &SourceUnit| RunFile {
            name: unit.index.source.name().to_string(),
            text: Fingerprint::of_text(unit.index.source.text()),
        };
        let snapshot = Snapshot {
            schema: Snapshot::SCHEMA,
            files: self.here.programs.units().iter().map(file).collect(),
            executed: match self.here.options.stop {
                StopPolicy::CheckAll => self
                    .here
                    .programs
                    .units()
                    .iter()
                    .map(SourceUnit::executed)
                    .collect(),
                StopPolicy::FirstError | StopPolicy::KeepGoing => Vec::new(),
            },
            state: self.here.state.clone(),
            others: self.others.clone(),
            seal: None,
        };
        Some(snapshot.sealed_anew())
    }

    /// Returns an interpreter in the state of a snapshot. `source` returns the text of each file of the run.
    ///
    /// # Errors
    /// A snapshot of another version, a file that `source` does not return or whose text has changed, a
    /// machine with other axes, or content that was changed after it was saved or names something that does
    /// not exist.
    pub fn resume(
        machine: impl Into<Arc<Machine>>,
        options: Options,
        snapshot: Snapshot,
        source: &mut dyn FnMut(&str) -> Option<SourceFile>,
    ) -> Result<Self, ResumeError> {
        if snapshot.schema != Snapshot::SCHEMA {
            return Err(ResumeError::Schema {
                found: snapshot.schema,
            });
        }
        if !snapshot.is_as_saved() {
            return Err(ResumeError::Damaged("its content is not what was saved"));
        }
        let machine = machine.into();
        if !snapshot
            .state
            .control
            .compensation
            .fits(machine.axis_setups())
        {
            return Err(ResumeError::OtherMachine);
        }
        let mut resumed = Self::with_state(machine, options, (snapshot.state, snapshot.others));
        for file in snapshot.files {
            let Some(text) = source(&file.name) else {
                return Err(ResumeError::MissingFile(file.name));
            };
            if Fingerprint::of_text(text.text()) != file.text {
                return Err(ResumeError::OtherText(file.name));
            }
            resumed
                .here
                .programs
                .hold(Index::new(text, options.limits.nesting));
        }
        Trust::of(&resumed).check().map_err(ResumeError::Damaged)?;
        resumed
            .here
            .programs
            .mark_executed(&snapshot.executed)
            .map_err(ResumeError::Damaged)?;
        Ok(resumed)
    }
}

impl ProgramStore {
    fn mark_executed(&mut self, executed: &[Vec<EntryIndex>]) -> Result<(), &'static str> {
        if executed.len() > self.units().len() {
            return Err("executed blocks of a file that is not there");
        }
        for (unit, executed) in executed.iter().enumerate() {
            let unit = self.unit_mut(unit);
            for &entry in executed {
                let place = usize::try_from(entry).unwrap_or(usize::MAX);
                let block = unit.executed.get_mut(place);
                *block.ok_or("an executed block that is not there")? = true;
            }
        }
        Ok(())
    }
}

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
    /// Returns the state of a run, before anything is done with it.
    pub(crate) fn of(run: &'a Interpreter) -> Self {
        Self {
            machine: &run.here.machine,
            programs: &run.here.programs,
            state: &run.here.state,
            others: &run.others,
        }
    }

    /// Checks that everything that the state names is there.
    pub(crate) fn check(&self) -> Validity {
        let state = self.state;
        holds(
            state.occurred.len() == self.machine.axes.len(),
            "occurrences of other axes",
        )?;
        let mut conditions = state.conditions.iter();
        let asked = conditions.all(|it| it.fits() && is_somewhere(&it.place));
        holds(asked, "a condition with too many answers")?;
        self.check_conditions(state.asked.iter().map(|asked| asked.condition))?;
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

    /// Returns a way through the program, and its loops with the states at their beginnings.
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
        let asked = track.asked.iter().map(|asked| asked.condition);
        self.check_conditions(named.chain(asked))?;
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

    /// Returns whether a section contains a block, or ends there.
    fn has_block(&self, found: ProgramId, entry: EntryIndex) -> bool {
        let unit = self.programs.units().get(found.unit);
        let section = unit.and_then(|unit| unit.index.sections.get(found.section));
        section.is_some_and(|section| (section.start..=section.end).contains(&entry))
    }

    fn has_frame(&self, frame: &CallFrame, depth: usize) -> bool {
        let program = frame.program();
        let is_deep = usize::try_from(frame.level).is_ok_and(|level| level > depth);
        let called = frame.called_from.as_deref();
        !is_deep
            && self.has_block(program, frame.next)
            && called.is_none_or(is_somewhere)
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

/// Returns whether a place has a line that a text may have.
fn is_somewhere(place: &Place) -> bool {
    place.first_line < MOST_LINES
}

/// The fingerprint of a text or of saved data: the same for the same bytes, on every machine and in
/// every version. It shows what changed by mistake; it does not protect against forgery.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub(crate) struct Fingerprint(u64);

/// A text that is not a fingerprint.
#[derive(Debug, thiserror::Error)]
#[error("a fingerprint has 16 hexadecimal digits")]
pub(crate) struct NoFingerprint;

impl Fingerprint {
    /// Returns the fingerprint of a text.
    fn of_text(text: &str) -> Self {
        let mut hasher = FnvHasher::default();
        hasher.write(text.as_bytes());
        Self(hasher.finish())
    }

    /// Returns the fingerprint of data, computed over its serialised bytes. `None` for data that cannot be serialised.
    pub(crate) fn of_data(data: &impl Serialize) -> Option<Self> {
        let bytes = Bytes(FnvHasher::default());
        postcard::serialize_with_flavor(data, bytes).ok()
    }
}

/// Takes the bytes of data one after another without keeping them.
struct Bytes(FnvHasher);

impl Flavor for Bytes {
    type Output = Fingerprint;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.0.write_u8(byte);
        Ok(())
    }

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        self.0.write(bytes);
        Ok(())
    }

    fn finalize(self) -> postcard::Result<Fingerprint> {
        Ok(Fingerprint(self.0.finish()))
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl From<Fingerprint> for String {
    fn from(fingerprint: Fingerprint) -> Self {
        fingerprint.to_string()
    }
}

impl TryFrom<String> for Fingerprint {
    type Error = NoFingerprint;

    fn try_from(text: String) -> Result<Self, NoFingerprint> {
        let is_written_so = |number: &u64| format!("{number:016x}") == text;
        let number = u64::from_str_radix(&text, 16).ok();
        number.filter(is_written_so).map(Self).ok_or(NoFingerprint)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fingerprint_is_the_same_everywhere() {
        let text = Fingerprint::of_text("N10 M30\n");
        assert_eq!(text.to_string(), "cb1b80c8f84f73ea");
        assert_ne!(text, Fingerprint::of_text("N10 M30"));
        let data = Fingerprint::of_data(&(1_u32, "X", [Some(1.5), None]));
        assert_eq!(data.map(String::from).as_deref(), Some("39a203fb83b150d3"));
    }

    #[test]
    fn only_its_own_digits_are_one() {
        let read = |text: &str| Fingerprint::try_from(text.to_owned()).is_ok();
        assert!(read("00000000000000ff"));
        assert!(!read("ff") && !read("00000000000000FF") && !read("+0000000000000ff"));
    }
}
