//! What the execution of one block needs and yields.

use std::cell::{Cell, RefCell};

use super::event::{Note, Outcome};
use crate::comp::{AxisIndex, Change, KindSet};
use crate::diagnostic::Diagnostic;
use crate::interpreter::coordinates::axis_words::AxisWord;
use crate::interpreter::coordinates::geometry::Geometry;
use crate::interpreter::coordinates::motion::Motion;
use crate::interpreter::values::value::Value;
use crate::syntax::Fault;
use crate::syntax::ast::Block;
use crate::text::{Place, Span};

/// Buffers that are used again for each block.
#[derive(Default)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "facts of one block, of which each is asked by itself"
)]
#[derive(Clone)]
pub(in crate::interpreter) struct Work {
    pub(in crate::interpreter) block: Block,
    pub(in crate::interpreter) outcomes: Vec<Outcome>,
    pub(in crate::interpreter) changes: Vec<Change>,
    /// What may or may not have been switched.
    pub(in crate::interpreter) doubted: Vec<(AxisIndex, KindSet)>,
    /// The axes that it may or may not move.
    pub(in crate::interpreter) perhaps_moved: Vec<AxisIndex>,
    /// Its axis words.
    pub(in crate::interpreter) moved: Vec<AxisWord>,
    /// The axes that have a word, and those that may have another, a bit each.
    pub(in crate::interpreter) seen: u64,
    pub(in crate::interpreter) again: u64,
    pub(in crate::interpreter) diagnostics: Vec<Diagnostic>,
    /// How many messages about the block are not said, and where the first of them belongs.
    pub(in crate::interpreter) unsaid: Option<(Span, u64)>,
    pub(in crate::interpreter) stack: Vec<Result<Value, Box<Fault>>>,
    /// I, J, K, R and the like, where the block has any.
    pub(in crate::interpreter) geometry: Option<Geometry>,
    /// Whether the block is G04 or `#TIME`.
    pub(in crate::interpreter) dwells: bool,
    /// What the block moves, where motions are taken.
    pub(in crate::interpreter) motion: Option<Motion>,
    pub(in crate::interpreter) notes: RefCell<Vec<Note>>,
    /// Whether a text of the block had no meaning that is known here; what depends on it is not said
    /// again (R2.71).
    pub(in crate::interpreter) unread: Cell<bool>,
    /// Macros that the block has expanded.
    pub(in crate::interpreter) expansions: Cell<u32>,
    /// The block of the main program that says that the program ends.
    pub(in crate::interpreter) end: Option<Place>,
    /// The budget that ended the run.
    pub(in crate::interpreter) over: Option<Diagnostic>,
    /// Whether that is a loop that never ends.
    pub(in crate::interpreter) endless: bool,
    /// Whether calls are nested too deeply for the run to go on (R9.91).
    pub(in crate::interpreter) too_deep: bool,
    /// Whether an axis occurred for the first time.
    pub(in crate::interpreter) new_axes: bool,
    /// Whether a value was written.
    pub(in crate::interpreter) wrote: bool,
}

impl Work {
    pub(in crate::interpreter) fn clear(&mut self) {
        self.outcomes.clear();
        self.changes.clear();
        self.doubted.clear();
        self.perhaps_moved.clear();
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
        self.too_deep = false;
        self.new_axes = false;
    }
}
