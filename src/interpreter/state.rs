//! Everything that a run depends on, as data that is saved and resumed.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::call::Found;
use super::coupling::Couplings;
use super::cycles::ModalCycles;
use super::endless::{LeftLoop, Loop, Reads};
use super::event::EndedBy;
use super::exchange::ChannelAxes;
use super::memory::Memory;
use super::modal::{self, Modal};
use super::program::EntryIndex;
use super::sequence::{Destination, Passage};
use super::value::Value;
use super::ways::Ways;
use crate::comp::Compensation;
use crate::syntax::ast::CallForm;
use crate::text::Place;

/// Everything that a run depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct State {
    pub(super) compensation: Compensation,
    pub(super) memory: Memory,
    pub(super) modal: Modal,
    pub(super) frames: Vec<Frame>,
    /// Executed blocks of the program.
    pub(super) seq: u64,
    /// Executed blocks of the session.
    pub(super) blocks: u64,
    /// Work of the session.
    pub(super) spent: Cell<u64>,
    /// Work beyond what the executed blocks bring with them.
    pub(super) level: Cell<u64>,
    /// Words and commands that were passed over.
    pub(super) opaque: BTreeMap<String, u64>,
    /// The axes that occurred.
    pub(super) occurred: Vec<bool>,
    pub(super) couplings: Couplings,
    /// What the names of axes mean, until the program ends.
    pub(super) channel_axes: ChannelAxes,
    /// The cycle that is repeated after blocks.
    pub(super) cycles: ModalCycles,
    /// The loops that were repeated, the outermost first.
    pub(super) loops: Vec<Loop>,
    /// The loops that were left where a value of the machine may end them.
    pub(super) left_loops: Vec<LeftLoop>,
    /// Whether a loop is compared with an earlier pass, so that what is read matters.
    pub(super) watching: bool,
    pub(super) reads: RefCell<Reads>,
    /// The called files of which it was said what is wrong with them.
    pub(super) refused: BTreeSet<usize>,
    /// Set while the configured end program runs.
    pub(super) ending: Option<EndedBy>,
    /// The last executed block of the main program.
    pub(super) last: Option<Last>,
    /// What a paused run does first when it goes on.
    pub(super) parked: Option<Step>,
    /// What `#FILE NAME` says that a word calls, until the program ends.
    pub(super) named: BTreeMap<String, Value>,
    /// G functions and positions before a contour description, inside it.
    pub(super) described: Option<Box<Description>>,
    /// Where the control may have gone instead (R2.52).
    pub(super) ways: Ways,
}

/// A description of geometry whose blocks do not move (R2.81).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Description {
    /// What opened it, `#CONTOUR BEGIN`.
    pub(super) opener: String,
    pub(super) place: Place,
    /// What was in force before it.
    pub(super) before: Modal,
}

/// One level of the call stack: where a program or subprogram stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Frame {
    /// The file, by its position among the files of the run.
    pub(super) unit: usize,
    pub(super) section: usize,
    /// The next block.
    pub(super) next: EntryIndex,
    /// The call depth; 0 is the main program.
    pub(super) level: u32,
    /// Own parameters of the call.
    pub(super) own: BTreeMap<u32, Value>,
    /// Set between `$IF` or `$SWITCH` and the branch that is looked for.
    pub(super) seeking: Option<Seeking>,
    /// Where it was called.
    pub(super) called_from: Option<Place>,
    /// What the end of a cycle brings back.
    pub(super) restores: Option<Box<modal::Saved>>,
    pub(super) retains: Retains,
    /// Programs that are called before the next block, the first one last.
    pub(super) waiting: Vec<Request>,
    /// The blocks that are executed, where that is not the whole program.
    pub(super) passage: Option<Passage>,
}

impl Frame {
    /// The program that it belongs to.
    pub(super) fn place(&self) -> Found {
        Found {
            unit: self.unit,
            section: self.section,
        }
    }
}

/// Whether a cycle keeps what it did to G functions and feed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Retains {
    /// It does not.
    Nothing,
    /// `#RETAIN CYCLE CHANGES` may have been executed.
    Perhaps,
}

/// What the next branch statement has to decide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) enum Seeking {
    /// A true condition.
    Condition,
    /// A case with this value.
    Case(Value),
}

/// The last executed block, in case that the program ends without M30.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Last {
    pub(super) file: Arc<str>,
    pub(super) line: u32,
    pub(super) text: String,
}

/// What the control does after a block, where that is not the next one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) enum Step {
    /// The program was announced and has not begun.
    Begin,
    /// To a block of the same program.
    Jump(EntryIndex),
    /// Programs, one after the other.
    Call(Vec<Request>),
    /// M17, M29.
    Return,
    /// The same with a place to return to.
    ReturnTo(Destination),
    End(EndedBy),
}

/// Why the next block is not the one that follows.
pub(super) enum Departure {
    /// The observer wants to stop.
    Paused,
    Step(Step),
}

/// A program to call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Request {
    pub(super) found: Found,
    pub(super) passage: Option<Passage>,
    pub(super) own: BTreeMap<u32, Value>,
    pub(super) form: CallForm,
    pub(super) called_from: Place,
}
