//! The part of the control's state at a moment that blocks of programs can see or change.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::changed_files::ChangedFiles;
use super::channel_axes::ChannelAxes;
use super::coupling::Couplings;
use super::cycles::ModalCycles;
use super::description::Description;
use super::event::EndedBy;
use super::saved_config::SavedConfig;
use super::search::EarlierStates;
use super::stack::CallStack;
use crate::comp::Compensation;
use crate::interpreter::coordinates::modal::Modal;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::history::{History, HistorySide};
use crate::interpreter::ways::set::WaySet;
use crate::language::{Holds, Simplification};

/// The state of the control. A copy is cheap: it shares the parts that do not change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ControlState {
    pub(crate) compensation: Compensation,
    /// What switched each kind, on each way that leads here.
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
    /// Whether the control may skip blocks while it moves backward (`#OPTIONAL EXECUTION`).
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
    /// The states at this block, for where the machine does not execute what follows.
    pub(crate) fn earlier_states(&self) -> EarlierStates {
        EarlierStates {
            compensation: self.compensation.clone(),
            history: self.history.clone(),
        }
    }

    /// The state before the first program.
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

    /// A description of geometry that is open on one way only may be open or not (R2.70).
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

    /// The values whose numbers differ in another state; `None` where anything else does.
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
