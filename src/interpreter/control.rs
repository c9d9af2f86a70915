//! The state of the control on one path, as far as programs can see or change it: axes and their names, modal words,
//! variables, cycles that are called again (R2.13), saved configurations (R2.107), files that a program changed (R2.108)
//! and a description of geometry that is open (R2.81).

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Compensation};
use crate::interpreter::axes::ChannelAxes;
use crate::interpreter::coupling::Couplings;
use crate::interpreter::events::EndedBy;
use crate::interpreter::motion::modal::Modal;
use crate::interpreter::programs::index::ProgramId;
use crate::interpreter::stack::CallStack;
use crate::interpreter::values::location::{Location, MissingProgram, Unknown};
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::history::{History, HistorySide};
use crate::interpreter::ways::path::EarlierStates;
use crate::interpreter::ways::set::WaySet;
use crate::language::{ChannelState, HashCommand, Holds, Simplification};
use crate::syntax::ast::{Call, Repetition};
use crate::text::Place;

/// The state of the control. A copy is cheap: it shares the parts that do not change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ControlState {
    pub(crate) compensation: Compensation,
    /// The commands that switched each kind, on each way that leads here.
    pub(crate) history: History,
    pub(crate) memory: Memory,
    pub(crate) modal: Modal,
    pub(crate) frames: CallStack,
    pub(crate) couplings: Couplings,
    /// Meanings of axis names, until the program ends.
    pub(crate) channel_axes: ChannelAxes,
    /// The cycle that is repeated after blocks.
    pub(crate) cycles: ModalCycles,
    /// The called files whose faults were reported.
    pub(crate) refused: BTreeSet<usize>,
    /// Set while the configured end program runs.
    pub(crate) ending: Option<EndedBy>,
    /// Programs that `#FILE NAME` assigns to words, until the program ends.
    pub(crate) named: BTreeMap<String, Value>,
    /// Configurations that `#SAVE CONFIG` saved.
    pub(crate) saved: SavedConfig,
    /// Files that programs changed.
    pub(crate) files: ChangedFiles,
    /// Optional section around the block, which the control may skip while it moves backward (`#OPTIONAL EXECUTION`).
    pub(crate) optional: OptionalSection,
    /// G functions and positions before a contour description, inside it.
    pub(crate) described: Option<Box<Description>>,
}

/// Section between `#OPTIONAL EXECUTION ON` and `OFF` (R2.109).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum OptionalSection {
    Outside,
    /// Within one that the control may execute.
    Inside,
    /// Within one that it executes where this condition holds.
    Asked(u32),
}

impl OptionalSection {
    fn join(self, other: Self) -> Self {
        if self == other { self } else { Self::Inside }
    }
}

impl ControlState {
    /// Whether a state may be in force in which the control refuses some words.
    pub(crate) fn is_in(&self, state: ChannelState) -> bool {
        match state {
            ChannelState::Coupling => self.couplings.is_any(),
            _ => self.modal.is_in(state),
        }
    }

    /// Returns the states at this block, for where the machine does not execute what follows.
    pub(crate) fn earlier_states(&self) -> EarlierStates {
        EarlierStates {
            compensation: self.compensation.clone(),
            history: self.history.clone(),
        }
    }

    /// Returns the state before the first program.
    pub(crate) fn new(compensation: Compensation, modal: Modal) -> Self {
        Self {
            compensation,
            history: History::default(),
            memory: Memory::default(),
            modal,
            frames: CallStack::default(),
            couplings: Couplings::default(),
            channel_axes: ChannelAxes::default(),
            cycles: ModalCycles::default(),
            refused: BTreeSet::new(),
            ending: None,
            named: BTreeMap::new(),
            saved: SavedConfig::default(),
            files: ChangedFiles::default(),
            optional: OptionalSection::Outside,
            described: None,
        }
    }

    /// Joins the states of two ways that meet at a block: differences become unknown (R14.1). `reach` holds
    /// the ways to this one and to the other. Returns how many values differ.
    pub(crate) fn join(&mut self, other: &Self, reach: [&WaySet; 2], cause: &Unknown) -> usize {
        let Self {
            compensation,
            history,
            memory,
            modal,
            frames,
            couplings,
            channel_axes,
            cycles,
            refused,
            // The call stack tells where a program end is executed.
            ending: _,
            named,
            saved,
            files,
            optional,
            described,
        } = other;
        let theirs = HistorySide {
            compensation,
            history,
            reach: reach[1],
        };
        self.history.join(&mut self.compensation, reach[0], &theirs);
        let differing = self.memory.join(memory, cause);
        self.modal.join(modal);
        self.frames.join(frames, cause);
        let coupled = self.couplings.join(couplings);
        if !coupled.is_empty() {
            self.modal.simplify(Simplification::Coupling, Holds::On);
        }
        for axis in coupled {
            self.modal.havoc_position(axis);
            self.compensation.set_coupled(axis, self.couplings.of(axis));
        }
        self.channel_axes.join(channel_axes);
        self.cycles.join(cycles);
        self.refused.extend(refused);
        join_names(&mut self.named, named, cause);
        self.saved.join(saved);
        self.files.join(files);
        self.optional = self.optional.join(*optional);
        self.join_description(described.as_deref());
        differing
    }

    /// Merges a description of geometry: one that is open on one way only may be open or not (R2.70).
    fn join_description(&mut self, other: Option<&Description>) {
        match (self.described.take(), other) {
            (Some(mut mine), Some(theirs)) if mine.opener == theirs.opener => {
                mine.before.join(&theirs.before);
                self.described = Some(mine);
            }
            (None, None) => {}
            (mine, theirs) => {
                let openers = mine.as_deref().into_iter().chain(theirs);
                for description in openers {
                    self.modal.havoc_words();
                    self.modal.note_transformed(description.opener.words);
                    self.modal.join(&description.before);
                }
            }
        }
    }

    /// Returns the values whose numbers differ in another state; `None` where anything else does.
    pub(crate) fn differing_numbers(&self, other: &Self) -> Option<Vec<Location>> {
        let Self {
            compensation,
            history,
            memory,
            modal,
            frames,
            couplings,
            channel_axes,
            cycles,
            refused,
            ending,
            named,
            saved,
            files,
            optional,
            described,
        } = self;
        let same = *frames == other.frames
            && *modal == other.modal
            && *compensation == other.compensation
            && *history == other.history
            && *couplings == other.couplings
            && *cycles == other.cycles
            && *refused == other.refused
            && *ending == other.ending
            && *named == other.named
            && *saved == other.saved
            && *files == other.files
            && *optional == other.optional
            && *channel_axes == other.channel_axes
            && *described == other.described;
        same.then(|| memory.differing_numbers(&other.memory))?
    }
}

/// Makes unknown the words that may call another program on one way.
fn join_names(
    names: &mut BTreeMap<String, Value>,
    other: &BTreeMap<String, Value>,
    cause: &Unknown,
) {
    if names == other {
        return;
    }
    let words: Vec<String> = names.keys().chain(other.keys()).cloned().collect();
    for word in words {
        if names.get(&word) != other.get(&word) {
            names.insert(word, Value::Unknown(cause.clone()));
        }
    }
}

/// The modal cycle in force, or the cycles of which one may be.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ModalCycles {
    cycles: Vec<Repeated>,
}

/// A modal cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Repeated {
    pub(crate) call: RepeatedCall,
    pub(crate) own: BTreeMap<u32, Value>,
    pub(crate) after_motion_only: bool,
}

/// Program that a modal cycle calls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum RepeatedCall {
    /// A program that was found.
    Program(ProgramId),
    /// A program that was found, or nothing: it is not known whether the cycle is in force.
    Perhaps(ProgramId),
    /// A program that only the machine has.
    External(MissingProgram),
}

impl ModalCycles {
    /// Returns a cycle that is in force.
    pub(crate) fn of(cycle: Repeated) -> Self {
        Self {
            cycles: vec![cycle],
        }
    }

    /// Returns whether no cycle is in force.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.cycles.is_empty()
    }

    /// Returns the cycles that may be in force.
    pub(crate) fn known(&self) -> &[Repeated] {
        &self.cycles
    }

    /// Marks the cycles as possibly switched off.
    pub(crate) fn havoc(&mut self) {
        for cycle in &mut self.cycles {
            if let RepeatedCall::Program(found) = cycle.call {
                cycle.call = RepeatedCall::Perhaps(found);
            }
        }
    }

    /// Adds a cycle that may be in force instead.
    pub(crate) fn add(&mut self, cycle: Repeated) {
        self.cycles.push(cycle);
        self.havoc();
        if let Some((last, before)) = self.cycles.split_last()
            && before.contains(last)
        {
            self.cycles.pop();
        }
    }

    /// Merges the cycles of another way, which may be in force instead.
    pub(crate) fn join(&mut self, other: &Self) {
        if self == other {
            return;
        }
        self.havoc();
        for cycle in &other.cycles {
            self.add(cycle.clone());
        }
    }
}

/// Returns whether a call repeats after motion only.
pub(crate) fn after_motion_only(call: &Call) -> Option<bool> {
    match call.repetition {
        Repetition::Once => None,
        Repetition::AfterMotion => Some(true),
        Repetition::AfterBlock => Some(false),
    }
}

/// A configuration that `#LOAD CONFIG` restores.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) enum SavedItem<T> {
    /// Configuration that an earlier program may have saved.
    #[default]
    Perhaps,
    /// No saved configuration.
    Nothing,
    /// Known configuration.
    Known(T),
}

/// The saved configurations of the channel.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct SavedConfig {
    /// The axes of the channel.
    pub(crate) axes: SavedItem<ChannelAxes>,
    /// The pairs of coupled axes.
    pub(crate) links: SavedItem<Vec<AxisIndex>>,
}

impl<T: PartialEq> SavedItem<T> {
    fn join(&mut self, other: &Self) {
        if self != other {
            *self = Self::Perhaps;
        }
    }
}

impl SavedConfig {
    /// Merges the configurations of another way, which may have been saved instead.
    pub(crate) fn join(&mut self, other: &Self) {
        self.axes.join(&other.axes);
        self.links.join(&other.links);
    }
}

/// The files that are not those of the archive any more.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ChangedFiles {
    /// Names of the files without folders, in lower case.
    names: BTreeSet<String>,
    /// Whether any file may have changed: the program computes a name.
    any: bool,
    /// The files to which `#MSG SAVE` may write, where the program named one.
    messages: BTreeSet<String>,
    /// The file that `#FILE EXIST` looked for last and did not find in the archive.
    #[serde(default)]
    missing: MissingFile,
}

/// A file that is looked for and not here.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
enum MissingFile {
    #[default]
    Nothing,
    /// The one of this name, without its folder, in lower case.
    Named(String),
    /// Any one: the program computes its name.
    Any,
}

impl ChangedFiles {
    /// Records a change of a file; `None` for one whose name is not known.
    pub(crate) fn change(&mut self, name: Option<&str>) {
        match name {
            Some(name) => _ = self.names.insert(base_name(name)),
            None => self.any = true,
        }
    }

    /// Returns whether a program is not that of the archive.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.any || !self.names.is_empty() && self.names.contains(&base_name(name))
    }

    /// Messages are written to a file from here on.
    pub(crate) fn write_messages_to(&mut self, name: &str) {
        self.messages = BTreeSet::from([base_name(name)]);
    }

    /// Records the write of a message to its files.
    pub(crate) fn write_message(&mut self) {
        self.names.extend(self.messages.iter().cloned());
    }

    /// Records that `#FILE EXIST` looked for a file that is not here; `None` for one whose name is not known.
    pub(crate) fn miss(&mut self, name: Option<&str>) {
        self.missing = name.map_or(MissingFile::Any, |name| MissingFile::Named(base_name(name)));
    }

    /// Records that `#FILE EXIST` found its file.
    pub(crate) fn find(&mut self) {
        self.missing = MissingFile::Nothing;
    }

    /// Returns whether the program asked whether a file that is not here exists.
    pub(crate) fn is_guarded(&self, name: &str) -> bool {
        match &self.missing {
            MissingFile::Nothing => false,
            MissingFile::Named(missing) => *missing == base_name(name),
            MissingFile::Any => true,
        }
    }

    /// Merges the changed files of another way.
    pub(crate) fn join(&mut self, other: &Self) {
        self.names.extend(other.names.iter().cloned());
        self.any |= other.any;
        self.messages.extend(other.messages.iter().cloned());
        if self.missing != other.missing {
            self.missing = MissingFile::Nothing;
        }
    }
}

fn base_name(path: &str) -> String {
    let name = path.trim().rsplit(['/', '\\']).next().unwrap_or_default();
    name.to_ascii_lowercase()
}

/// A description of geometry whose blocks do not move (R2.81).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Description {
    /// Command that opened it, `#CONTOUR BEGIN`.
    pub(crate) opener: &'static HashCommand,
    pub(crate) place: Place,
    /// State in force before it.
    pub(crate) before: Modal,
}
