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
pub(crate) enum ControlStep {
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
pub(crate) enum NextBlock {
    /// The observer stops the run.
    Paused,
    Step(ControlStep),
}

/// A program to call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Request {
    pub(crate) found: ProgramId,
    pub(crate) passage: Option<Passage>,
    pub(crate) own: BTreeMap<u32, Value>,
    pub(crate) form: CallForm,
    pub(crate) called_from: Place,
}

/// The blocks of a program that a frame executes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Passage {
    pub(crate) first: EntryIndex,
    pub(crate) last: EntryIndex,
    /// Number of passes left.
    pub(crate) left: u64,
    /// Number of blocks executed before this pass began.
    pub(crate) begun: u64,
}

impl Passage {
    /// The start of the next pass, when there is one. A pass of blocks that are all skipped is the
    /// last one.
    pub(crate) fn again(&mut self, executed: u64) -> Option<EntryIndex> {
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
pub(crate) struct Destination {
    pub(crate) level: u32,
    /// The block, where it is not the one that follows the call.
    pub(crate) entry: Option<EntryIndex>,
}

/// A block of a main program that is read line by line, and the message if it is never reached.
#[derive(Clone, Debug)]
pub(crate) struct AwaitedBlock {
    pub(crate) label: LabelName,
    pub(crate) missing: Diagnostic,
}
