//! Modal cycles: programs that are called again after blocks or motions (R2.13).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::interpreter::programs::index::ProgramId;
use crate::interpreter::values::cause::MissingProgram;
use crate::interpreter::values::value::Value;
use crate::syntax::ast::{Call, Repetition};

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
    /// A cycle that is in force.
    pub(crate) fn of(cycle: Repeated) -> Self {
        Self {
            cycles: vec![cycle],
        }
    }

    /// Whether no cycle is in force.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.cycles.is_empty()
    }

    /// The cycles that may be in force.
    pub(crate) fn known(&self) -> &[Repeated] {
        &self.cycles
    }

    /// It may have been switched off.
    pub(crate) fn havoc(&mut self) {
        for cycle in &mut self.cycles {
            if let RepeatedCall::Program(found) = cycle.call {
                cycle.call = RepeatedCall::Perhaps(found);
            }
        }
    }

    /// Another cycle may be in force instead.
    pub(crate) fn add(&mut self, cycle: Repeated) {
        self.cycles.push(cycle);
        self.havoc();
        if let Some((last, before)) = self.cycles.split_last()
            && before.contains(last)
        {
            self.cycles.pop();
        }
    }

    /// Those of another way may be in force instead.
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
