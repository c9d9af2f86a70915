//! Everything that a run depends on, as data that is saved and resumed.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::channel_axes::ChannelAxes;
use super::coupling::Couplings;
use super::cycles::ModalCycles;
use super::description::Description;
use super::event::EndedBy;
use super::loops::{LeftLoop, Loop};
use super::stack::CallStack;
use super::step::Step;
use super::undecided::Told;
use super::ways::Ways;
use crate::comp::Compensation;
use crate::interpreter::coordinates::modal::Modal;
use crate::interpreter::values::effort::Effort;
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::reads::Reads;
use crate::interpreter::values::value::Value;

/// Everything that a run depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct State {
    pub(in crate::interpreter) compensation: Compensation,
    pub(in crate::interpreter) memory: Memory,
    pub(in crate::interpreter) modal: Modal,
    pub(in crate::interpreter) frames: CallStack,
    /// Executed blocks of the program.
    pub(in crate::interpreter) seq: u64,
    /// Executed blocks of the session.
    pub(in crate::interpreter) blocks: u64,
    pub(in crate::interpreter) effort: Effort,
    /// Words and commands that were passed over.
    pub(in crate::interpreter) opaque: BTreeMap<String, u64>,
    /// The words of the program of which something was said that is said once (R2.94).
    pub(in crate::interpreter) once: BTreeSet<String>,
    /// The axes that occurred.
    pub(in crate::interpreter) occurred: Vec<bool>,
    pub(in crate::interpreter) couplings: Couplings,
    /// What the names of axes mean, until the program ends.
    pub(in crate::interpreter) channel_axes: ChannelAxes,
    /// The cycle that is repeated after blocks.
    pub(in crate::interpreter) cycles: ModalCycles,
    /// The loops that were repeated, the outermost first.
    pub(in crate::interpreter) loops: Vec<Loop>,
    /// The loops that were left where a value of the machine may end them.
    pub(in crate::interpreter) left_loops: Vec<LeftLoop>,
    /// Whether a loop is compared with an earlier pass, so that what is read matters.
    pub(in crate::interpreter) watching: bool,
    pub(in crate::interpreter) reads: RefCell<Reads>,
    /// The called files of which it was said what is wrong with them.
    pub(in crate::interpreter) refused: BTreeSet<usize>,
    /// Set while the configured end program runs.
    pub(in crate::interpreter) ending: Option<EndedBy>,
    /// The last executed block of the main program.
    pub(in crate::interpreter) last: Option<Last>,
    /// What a paused run does first when it goes on.
    pub(in crate::interpreter) parked: Option<Step>,
    /// What `#FILE NAME` says that a word calls, until the program ends.
    pub(in crate::interpreter) named: BTreeMap<String, Value>,
    /// G functions and positions before a contour description, inside it.
    pub(in crate::interpreter) described: Option<Box<Description>>,
    /// Where the control may have gone instead (R2.52).
    pub(in crate::interpreter) ways: Ways,
    /// The unknown values that messages were about.
    pub(in crate::interpreter) told: Told,
}

/// The last executed block, in case that the program ends without M30.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::interpreter) struct Last {
    pub(in crate::interpreter) file: Arc<str>,
    pub(in crate::interpreter) line: u32,
    pub(in crate::interpreter) text: String,
}
