//! What the control has at a moment, as far as the blocks of programs can see or change it.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::channel_axes::ChannelAxes;
use super::coupling::Couplings;
use super::cycles::ModalCycles;
use super::description::Description;
use super::event::EndedBy;
use super::stack::CallStack;
use crate::comp::Compensation;
use crate::interpreter::coordinates::modal::Modal;
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::target::Target;
use crate::interpreter::values::value::Value;

/// The state of the control. A copy is cheap: it shares what does not change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct ControlState {
    pub(in crate::interpreter) compensation: Compensation,
    pub(in crate::interpreter) memory: Memory,
    pub(in crate::interpreter) modal: Modal,
    pub(in crate::interpreter) frames: CallStack,
    pub(in crate::interpreter) couplings: Couplings,
    /// What the names of axes mean, until the program ends.
    pub(in crate::interpreter) channel_axes: ChannelAxes,
    /// The cycle that is repeated after blocks.
    pub(in crate::interpreter) cycles: ModalCycles,
    /// The called files of which it was said what is wrong with them.
    pub(in crate::interpreter) refused: BTreeSet<usize>,
    /// Set while the configured end program runs.
    pub(in crate::interpreter) ending: Option<EndedBy>,
    /// What `#FILE NAME` says that a word calls, until the program ends.
    pub(in crate::interpreter) named: BTreeMap<String, Value>,
    /// G functions and positions before a contour description, inside it.
    pub(in crate::interpreter) described: Option<Box<Description>>,
}

impl ControlState {
    /// The state before the first program.
    pub(in crate::interpreter) fn new(compensation: Compensation, modal: Modal) -> Self {
        Self {
            compensation,
            memory: Memory::default(),
            modal,
            frames: CallStack::default(),
            couplings: Couplings::default(),
            channel_axes: ChannelAxes::default(),
            cycles: ModalCycles::default(),
            refused: BTreeSet::new(),
            ending: None,
            named: BTreeMap::new(),
            described: None,
        }
    }

    /// The values whose numbers differ in another state; `None` where anything else does.
    pub(in crate::interpreter) fn differing_numbers(&self, other: &Self) -> Option<Vec<Target>> {
        let Self {
            compensation,
            memory,
            modal,
            frames,
            couplings,
            channel_axes,
            cycles,
            refused,
            ending,
            named,
            described,
        } = self;
        let same = *frames == other.frames
            && *modal == other.modal
            && *compensation == other.compensation
            && *couplings == other.couplings
            && *cycles == other.cycles
            && *refused == other.refused
            && *ending == other.ending
            && *named == other.named
            && *channel_axes == other.channel_axes
            && *described == other.described;
        same.then(|| memory.differing_numbers(&other.memory))?
    }
}
