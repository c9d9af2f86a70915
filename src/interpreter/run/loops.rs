//! The loops that a run repeats, and the state at an earlier pass of each (R2.84).

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::control::ControlState;
use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::values::target::Target;

/// A loop that was repeated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct Loop {
    /// How many programs call each other down to the one that holds it.
    pub(in crate::interpreter) depth: usize,
    pub(in crate::interpreter) unit: usize,
    pub(in crate::interpreter) section: usize,
    /// The block that opens it, or to which it goes back, and the last one from which it does.
    pub(in crate::interpreter) head: EntryIndex,
    pub(in crate::interpreter) from: EntryIndex,
    pub(in crate::interpreter) passes: u64,
    /// The executed block at which it came round first.
    pub(in crate::interpreter) since: u64,
    /// The state at the start of an earlier pass.
    pub(in crate::interpreter) mark: Option<Box<Mark>>,
    /// What only counts, once it is known that nothing else changes any more.
    pub(in crate::interpreter) endless: Option<Vec<Target>>,
}

impl Loop {
    /// The section that contains it.
    pub(in crate::interpreter) fn program(&self) -> ProgramId {
        ProgramId {
            unit: self.unit,
            section: self.section,
        }
    }

    /// Whether its counters are below a bound.
    pub(in crate::interpreter) fn fits(&self, bound: u64) -> bool {
        let marked = self.mark.as_ref().map_or(0, |mark| mark.pass);
        self.passes.max(marked) < bound
    }
}

impl Loop {
    /// Whether the loop lies around a jump back, or is the one that jumps.
    pub(in crate::interpreter) fn is_around(
        &self,
        place: ProgramId,
        head: EntryIndex,
        from: EntryIndex,
    ) -> bool {
        let around = self.head < head && from <= self.from;
        self.program() == place && (self.head == head || around)
    }

    /// Whether the state is compared at this pass, or kept to be compared with.
    pub(in crate::interpreter) fn is_due(&self) -> bool {
        self.mark.is_some() || (self.passes >= FIRST_LOOK && self.passes.is_power_of_two())
    }
}

/// A loop that was left where a value of the machine may end it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct LeftLoop {
    pub(in crate::interpreter) unit: usize,
    pub(in crate::interpreter) head: EntryIndex,
    pub(in crate::interpreter) times: u32,
    pub(in crate::interpreter) cause: Arc<str>,
}

/// The state at the start of a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct Mark {
    pub(in crate::interpreter) pass: u64,
    pub(in crate::interpreter) control: ControlState,
    pub(in crate::interpreter) occurred: Vec<bool>,
}

/// The pass after which a loop is looked at for the first time, then at each doubling.
const FIRST_LOOK: u64 = 32;
