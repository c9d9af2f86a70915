//! What a run may use up (R2.60).
//!
//! Executed blocks are counted one by one. What a block makes the run do beyond its own length is
//! *work*: macros that expand, texts that grow, regions that are looked through because their
//! condition is not known, names that are compared. Work is a level that rises with each unit and
//! falls with each executed block, so that a program that loops on purpose never comes near the
//! bound, and one whose blocks do far more than is written in them soon does.

use super::at::At;
use super::program::EntryIndex;
use super::run::Interpreter;
use super::state::State;
use crate::diagnostic::{Advice, Budget, Code, Diagnostic};
use crate::syntax::Fault;
use crate::text::Span;

/// Bounds on what a dry run may do (R2.60).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Executed blocks of a session, `--max-blocks`.
    pub blocks: u64,
    /// Work beyond what the executed blocks bring with them, `--max-work`.
    pub work: u64,
    /// Values that are held at a time, `--max-values`; a text counts as one more for every 32
    /// bytes.
    pub values: u32,
    /// Depth of subprogram calls, `--max-calls`.
    pub calls: u32,
    /// Depth of nested `$` blocks, `--max-nesting`.
    pub nesting: u32,
    /// Depth of macro expansion, `--max-macros`.
    pub macros: u32,
}

impl Limits {
    /// The same with another value of [`blocks`](Self::blocks).
    pub fn with_blocks(mut self, blocks: u64) -> Self {
        self.blocks = blocks;
        self
    }

    /// The same with another value of [`work`](Self::work).
    pub fn with_work(mut self, work: u64) -> Self {
        self.work = work;
        self
    }

    /// The same with another value of [`values`](Self::values).
    pub fn with_values(mut self, values: u32) -> Self {
        self.values = values;
        self
    }

    /// The same with another value of [`calls`](Self::calls).
    pub fn with_calls(mut self, calls: u32) -> Self {
        self.calls = calls;
        self
    }

    /// The same with another value of [`nesting`](Self::nesting).
    pub fn with_nesting(mut self, nesting: u32) -> Self {
        self.nesting = nesting;
        self
    }

    /// The same with another value of [`macros`](Self::macros).
    pub fn with_macros(mut self, macros: u32) -> Self {
        self.macros = macros;
        self
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            blocks: 100_000_000,
            work: 10_000_000,
            values: 1_000_000,
            calls: 50,
            nesting: 50,
            macros: 16,
        }
    }
}

/// Units of work that an executed block brings with it.
const PER_BLOCK: u64 = 500;

/// Units of work that a byte of an executed block brings with it.
const PER_BYTE: u64 = 4;

/// Units of work that a byte of a program in memory brings with it: its regions may have to be
/// looked through once.
const PER_BYTE_HELD: u64 = 16;

/// The cost of looking at one block or one name, whatever its length.
pub(super) const ITEM: usize = 32;

impl State {
    /// Counts work.
    pub(super) fn charge(&self, units: usize) {
        let units = u64::try_from(units).unwrap_or(u64::MAX);
        self.spent.set(self.spent.get().saturating_add(units));
        self.level.set(self.level.get().saturating_add(units));
    }

    /// An executed block brings work with it.
    #[inline]
    pub(super) fn grant(&self, text: &str) {
        let level = self.level.get();
        if level > 0 {
            let bytes = u64::try_from(text.len()).unwrap_or(u64::MAX);
            let granted = PER_BYTE.saturating_mul(bytes).saturating_add(PER_BLOCK);
            self.level.set(level.saturating_sub(granted));
        }
    }
}

impl Interpreter {
    /// The work of the session so far, in units: characters of macros, texts and regions that were
    /// gone through, operands that were computed, names that were compared (R2.60).
    pub fn work(&self) -> u64 {
        self.state.spent.get()
    }

    /// How high the level of work may rise.
    pub(super) fn work_bound(&self) -> u64 {
        let held = PER_BYTE_HELD.saturating_mul(self.held_text);
        self.options.limits.work.saturating_add(held)
    }

    /// Whether the budget of work is used up.
    pub(super) fn is_worn_out(&self) -> bool {
        self.state.level.get() > self.work_bound()
    }

    /// FC910 when the next block may not be executed any more.
    #[inline]
    pub(super) fn over_budget(&self, at: &At<'_>) -> Option<Diagnostic> {
        let budget = self.options.limits.blocks;
        (self.state.blocks >= budget).then(|| too_many_blocks(budget, at))
    }

    /// FC919 or FC918 when the block used up what it must not. What it could have changed besides is
    /// unknown then: the run did not get to the end of it.
    pub(super) fn used_up(&mut self, at: &At<'_>) -> Option<Diagnostic> {
        let wrote = std::mem::take(&mut self.work.wrote);
        if self.state.level.get() > self.options.limits.work && self.is_worn_out() {
            self.forget_all(&"the budget of work".into());
            return Some(self.too_much_work(at));
        }
        let limit = usize::try_from(self.options.limits.values).unwrap_or(usize::MAX);
        let held = || {
            self.state
                .memory
                .weight()
                .saturating_add(self.state.couplings.len())
        };
        if wrote && held() > limit {
            return Some(too_many_values(limit, at));
        }
        None
    }

    #[cold]
    fn too_much_work(&self, at: &At<'_>) -> Diagnostic {
        let budget = self.options.limits.work;
        let fault = Fault::new(
            Code::Fc919,
            Span::new(0, at.text.len()),
            format!("this block made more than {budget} units of work beyond its own text"),
        )
        .with_help(Advice::RaiseBudget(Budget::Work));
        let diagnostic = at.diagnostic(fault);
        match self.state.frames.last() {
            Some(frame) => self.with_loop(diagnostic, frame.unit, frame.next.saturating_sub(1)),
            None => diagnostic,
        }
    }

    /// The budget's message with the loop that used it up.
    pub(super) fn with_loop(
        &self,
        diagnostic: Diagnostic,
        unit: usize,
        entry: EntryIndex,
    ) -> Diagnostic {
        let index = &self.units[unit].index;
        match index.innermost_loop(entry) {
            Some(opener) => {
                let place = index.block_place(opener);
                let passes = match self.passes(unit, opener) {
                    Some(passes) => format!("in this loop, after {passes} passes"),
                    None => "in this loop".to_owned(),
                };
                diagnostic.with_label(place, passes)
            }
            None => diagnostic,
        }
    }
}

/// FC910.
#[cold]
fn too_many_blocks(budget: u64, at: &At<'_>) -> Diagnostic {
    at.diagnostic(
        Fault::new(
            Code::Fc910,
            Span::new(0, at.text.len()),
            format!("more than {budget} blocks were executed; the dry run ends here"),
        )
        .with_help(Advice::RaiseBudget(Budget::Blocks)),
    )
}

/// FC918.
#[cold]
fn too_many_values(limit: usize, at: &At<'_>) -> Diagnostic {
    at.diagnostic(
        Fault::new(
            Code::Fc918,
            Span::new(0, at.text.len()),
            format!("the program holds more than {limit} values; a string counts once more for every 32 bytes"),
        )
        .with_help(Advice::RaiseBudget(Budget::Values)),
    )
}
