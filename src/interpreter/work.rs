//! What the execution of one block needs and yields.

use std::cell::{Cell, RefCell};

use super::event::{AxisWord, Note, Outcome};
use super::motion::{self, Motion};
use super::value::Value;
use crate::comp::{AxisIndex, Change, KindSet};
use crate::diagnostic::Diagnostic;
use crate::syntax::{Fault, ast::Block};
use crate::text::{Place, Span};

/// Buffers that are used again for each block.
#[derive(Default)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "facts of one block, of which each is asked by itself"
)]
pub(super) struct Work {
    pub(super) block: Block,
    pub(super) outcomes: Vec<Outcome>,
    pub(super) changes: Vec<Change>,
    /// What may or may not have been switched.
    pub(super) doubted: Vec<(AxisIndex, KindSet)>,
    /// Its axis words.
    pub(super) moved: Vec<AxisWord>,
    /// The axes that have a word, and those that may have another, a bit each.
    pub(super) seen: u64,
    pub(super) again: u64,
    pub(super) diagnostics: Vec<Diagnostic>,
    /// How many messages about the block are not said, and where the first of them belongs.
    pub(super) unsaid: Option<(Span, u64)>,
    pub(super) stack: Vec<Result<Value, Box<Fault>>>,
    /// I, J, K, R and the like, where the block has any.
    pub(super) geometry: Option<motion::Geometry>,
    /// Whether the block is G04 or `#TIME`.
    pub(super) dwells: bool,
    /// What the block moves, where motions are taken.
    pub(super) motion: Option<Motion>,
    pub(super) notes: RefCell<Vec<Note>>,
    /// Whether a text of the block had no meaning that is known here; what depends on it is not said
    /// again (R2.71).
    pub(super) unread: Cell<bool>,
    /// Macros that the block has expanded.
    pub(super) expansions: Cell<u32>,
    /// The block of the main program that says that the program ends.
    pub(super) end: Option<Place>,
    /// The budget that ended the run.
    pub(super) over: Option<Diagnostic>,
    /// Whether that is a loop that never ends.
    pub(super) endless: bool,
    /// Whether an axis occurred for the first time.
    pub(super) new_axes: bool,
    /// Whether a value was written.
    pub(super) wrote: bool,
}

impl Work {
    pub(super) fn clear(&mut self) {
        self.outcomes.clear();
        self.changes.clear();
        self.doubted.clear();
        self.moved.clear();
        self.seen = 0;
        self.again = 0;
        self.diagnostics.clear();
        self.geometry = None;
        self.dwells = false;
        self.motion = None;
        self.notes.get_mut().clear();
        self.unread.set(false);
        self.expansions.set(0);
        self.new_axes = false;
    }
}
