//! The step after a block, where it does not lead to the next one.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::event::EndedBy;
use crate::diagnostic::Diagnostic;
use crate::interpreter::programs::index::{EntryIndex, LabelName, ProgramId};
use crate::interpreter::values::value::Value;
use crate::syntax::ast::CallForm;
use crate::text::Place;

/// Step of the control after a block, where it does not lead to the next one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) enum ControlStep {
    /// The program was announced and has not begun.
    Begin,
    /// To a block of the same program.
    Jump(EntryIndex),
    /// Programs, one after the other.
    Call(Vec<Request>),
    /// M17, M29.
    Return,
    /// M17, M29 with a place to return to.
    ReturnTo(Destination),
    End(EndedBy),
    /// Nowhere: another way does what this one would do (R14.3).
    Covered,
}

/// Reason why the block that follows is not executed next.
pub(in crate::interpreter) enum NextBlock {
    /// The observer stops the run.
    Paused,
    Step(ControlStep),
}

/// A program to call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct Request {
    pub(in crate::interpreter) found: ProgramId,
    pub(in crate::interpreter) passage: Option<Passage>,
    pub(in crate::interpreter) own: BTreeMap<u32, Value>,
    pub(in crate::interpreter) form: CallForm,
    pub(in crate::interpreter) called_from: Place,
}

/// The blocks of a program that a frame executes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::interpreter) struct Passage {
    pub(in crate::interpreter) first: EntryIndex,
    pub(in crate::interpreter) last: EntryIndex,
    /// Number of passes left.
    pub(in crate::interpreter) left: u64,
    /// Number of blocks executed before this pass began.
    pub(in crate::interpreter) begun: u64,
}

impl Passage {
    /// The start of the next pass, when there is one. A pass of blocks that are all skipped is the
    /// last one.
    pub(in crate::interpreter) fn again(&mut self, executed: u64) -> Option<EntryIndex> {
        if self.left == 0 || executed == self.begun {
            return None;
        }
        self.left -= 1;
        self.begun = executed;
        Some(self.first)
    }
}

/// Target of an M17.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct Destination {
    pub(in crate::interpreter) level: u32,
    /// The block, where it is not the one that follows the call.
    pub(in crate::interpreter) entry: Option<EntryIndex>,
}

/// A block of a main program that is read line by line, and the message if it is never reached.
#[derive(Clone, Debug)]
pub(in crate::interpreter) struct AwaitedBlock {
    pub(in crate::interpreter) label: LabelName,
    pub(in crate::interpreter) missing: Diagnostic,
}
