//! The inputs and results of the execution of one block.

use std::cell::{Cell, RefCell};
use std::ops::Range;

use super::event::{Aside, Note, Outcome};
use super::lone_part::LonePart;
use super::path::Path;
use super::search::EarlierStates;
use crate::comp::{AxisIndex, Change, Kind, KindSet};
use crate::diagnostic::Diagnostic;
use crate::interpreter::coordinates::axis_words::AxisWord;
use crate::interpreter::coordinates::geometry::Geometry;
use crate::interpreter::coordinates::motion::Motion;
use crate::interpreter::coordinates::moving::MovedAxis;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::values::cause::{MissingProgram, Unknown};
use crate::interpreter::values::externals::HeldValues;
use crate::interpreter::values::value::Value;
use crate::language::MotionEffect;
use crate::syntax::ast::Block;
use crate::syntax::{Fault, VariableName};
use crate::text::{Place, Span};

/// The block that ends the program.
#[derive(Debug, Clone)]
pub(crate) struct OwnEnd {
    pub(crate) place: Place,
    /// Whether no jump goes to it.
    pub(crate) is_passed_into: bool,
}

/// What comes between an error and the next program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum AfterError {
    /// A reset of the channel.
    #[default]
    Reset,
    /// That, or a restart of the control (R2.100).
    ResetOrRestart,
}

/// A program that only the machine has, and its call: the state that it leaves is not known.
#[derive(Debug, Clone)]
pub(crate) struct LeftOpen {
    pub(crate) program: MissingProgram,
    pub(crate) place: Place,
}

/// Blocks of a file that the block being executed passes over.
#[derive(Debug, Clone)]
pub(crate) struct PassedBlocks {
    pub(crate) unit: usize,
    pub(crate) blocks: Range<EntryIndex>,
    /// The value that decides whether they are executed.
    pub(crate) cause: Unknown,
    /// The message about them, where the run goes on after them.
    pub(crate) said: Option<Diagnostic>,
}

/// Buffers that are used again for each block.
#[derive(Default)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "facts of one block, of which each is asked by itself"
)]
#[derive(Clone)]
pub(crate) struct BlockScratch {
    pub(crate) block: Block,
    pub(crate) outcomes: Vec<Outcome>,
    pub(crate) changes: Vec<Change>,
    pub(crate) left_open: Option<LeftOpen>,
    /// Kinds that may or may not have been switched.
    pub(crate) doubted: Vec<(AxisIndex, KindSet)>,
    /// The axes that it moves, or may, without their own word.
    pub(crate) also_moved: Vec<MovedAxis>,
    /// Motion of its axis words, where the G functions in force do not decide it.
    pub(crate) word_row: Option<MotionEffect>,
    /// Its axis words.
    pub(crate) moved: Vec<AxisWord>,
    /// Words of axes that the machine does not have.
    pub(crate) lacking: Vec<(String, Span)>,
    pub(crate) aside: Aside,
    /// Whether the axes come to rest in the block, or may.
    pub(crate) rests: Cell<bool>,
    /// The axes that have a word, and those that may have another, a bit each.
    pub(crate) seen: u64,
    pub(crate) again: u64,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Errors that end some of the ways that lead to the block, and not the others.
    pub(crate) of_some_ways: Vec<Diagnostic>,
    /// The blocks that it passes over, which only the machine may execute.
    pub(crate) passed: Vec<PassedBlocks>,
    /// The paths on which the run may go on elsewhere than after them.
    pub(crate) left: Vec<Path>,
    /// Number of messages on the last block.
    pub(crate) said: u64,
    /// Number of messages on the block that are left out, and the place of the first of them.
    pub(crate) unsaid: Option<(Span, u64)>,
    pub(crate) stack: Vec<Result<Value, Box<Fault>>>,
    /// I, J, K, R and the like, where the block has any.
    pub(crate) geometry: Option<Geometry>,
    /// Whether the block is G04 or `#TIME`.
    pub(crate) dwells: bool,
    /// Motion of the block, where motions are taken.
    pub(crate) motion: Option<Motion>,
    pub(crate) notes: RefCell<Vec<Note>>,
    /// The variables that its expressions read and that the PLC may write, where their value is known (R2.99).
    pub(crate) relied: RefCell<Vec<VariableName>>,
    pub(crate) held: HeldValues,
    /// Whether the PLC acts by design in the block.
    pub(crate) plc_acts: bool,
    /// The states of compensation that its expressions read.
    pub(crate) asked: RefCell<Vec<(AxisIndex, Kind)>>,
    /// Whether a text of the block had no known meaning; what depends on it is not reported again
    /// (R2.71).
    pub(crate) unread: Cell<bool>,
    /// The states before the block, where the control may skip its commands (R2.109).
    pub(crate) earlier: Option<Box<EarlierStates>>,
    /// A variable that was read and whose reading flushes the channel, where that matters (R1.42).
    pub(crate) flushing: RefCell<Option<VariableName>>,
    /// A `V.I.` variable that was read and that no program of the run declares (R2.102).
    pub(crate) undeclared: RefCell<Option<String>>,
    /// Why a program may be called that is not known, if one may.
    pub(crate) unknown_call: Option<Unknown>,
    /// A part of the macro expanded last that limits what may be in the block.
    pub(crate) lone: Option<LonePart>,
    /// Macros that the block has expanded.
    pub(crate) expansions: Cell<u32>,
    /// The block that ends the program.
    pub(crate) end: Option<OwnEnd>,
    /// What follows the error by which the block ends the program.
    pub(crate) after_error: AfterError,
    /// Messages on the end of the run or of a way through it: a budget, or the end of a file
    /// without M30.
    pub(crate) over: Vec<Diagnostic>,
    /// Whether another way does what this one would do from here on.
    pub(crate) covered: bool,
    /// Whether that is a loop that never ends.
    pub(crate) endless: bool,
    /// Whether calls are nested too deeply for the run to continue (R9.91).
    pub(crate) too_deep: bool,
    /// Whether an axis occurred for the first time.
    pub(crate) new_axes: bool,
    /// Whether a value was written.
    pub(crate) wrote: bool,
}

impl BlockScratch {
    /// Clears the messages on the block; those left at program end belong to no block.
    pub(crate) fn clear_said(&mut self) {
        self.said = u64::try_from(self.diagnostics.len()).unwrap_or(u64::MAX);
        self.diagnostics.clear();
        self.of_some_ways.clear();
        self.changes.clear();
    }

    /// Hands the states that the block read to the details reported of it.
    #[inline]
    pub(crate) fn gather_asked(&mut self) {
        let asked = self.asked.get_mut();
        if !asked.is_empty() {
            self.aside.asked.append(asked);
        }
    }

    pub(crate) fn clear(&mut self) {
        self.outcomes.clear();
        self.changes.clear();
        self.left_open = None;
        self.earlier = None;
        self.doubted.clear();
        self.also_moved.clear();
        self.word_row = None;
        if !self.moved.is_empty() {
            std::mem::swap(&mut self.moved, &mut self.aside.last_moved);
            self.moved.clear();
            if self.aside.arc.is_some() || self.aside.last_arc.is_some() {
                std::mem::swap(&mut self.aside.arc, &mut self.aside.last_arc);
            }
        }
        if self.rests.replace(false) || self.dwells {
            self.aside.last_moved.clear();
            self.aside.last_arc = None;
        }
        self.aside.arc = None;
        self.lacking.clear();
        self.seen = 0;
        self.again = 0;
        self.diagnostics.clear();
        self.aside.withheld.clear();
        self.unknown_call = None;
        self.lone = None;
        self.geometry = None;
        self.dwells = false;
        self.plc_acts = false;
        self.motion = None;
        self.notes.get_mut().clear();
        self.aside.asked.clear();
        self.unread.set(false);
        self.expansions.set(0);
        self.too_deep = false;
        self.new_axes = false;
    }
}
