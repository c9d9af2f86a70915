//! The options of a run, its limits (R2.60), and its outcome.

use std::fmt;
use std::str::FromStr;

use crate::interpreter::block::BlockContext;
use crate::interpreter::events::{EndedBy, Notes};
use crate::interpreter::motion::form::Motions;
use crate::syntax::ast::Operand;
use crate::syntax::{FastPath, SkipLevels};

/// Reaction to an error of the control (R9.20).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum StopPolicy {
    /// The first error stops the program and the session, as on the control.
    #[default]
    FirstError,
    /// The failing command is treated as if it were not there.
    KeepGoing,
    /// Like `KeepGoing`; blocks that are never executed are checked for their syntax too.
    CheckAll,
}

/// Treatment of a condition that depends on a value that only the machine knows (R14.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Branches {
    /// All ways: each one is executed, and what they agree on is known.
    #[default]
    Followed,
    /// One way with events: the blocks that another answer would pass over are executed without events, and what the
    /// ways agree on is known after them. This also applies where blocks report their motion.
    OneFollowed,
}

/// Options of a run.
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct Options {
    /// Reaction to an error.
    pub stop: StopPolicy,
    /// The skip levels that are on; without them those of the machine count. If neither is given, it is
    /// unknown whether a block with a skip mark is executed (R2.90).
    pub skip: Option<SkipLevels>,
    /// Budgets.
    pub limits: Limits,
    /// Use of the fast path for plain blocks: they are parsed by hand, and executed step by step only where necessary.
    pub fast_path: FastPath,
    /// Recording of notes.
    pub notes: Notes,
    /// Reports of motion by blocks.
    pub motions: Motions,
    /// Treatment of a condition that depends on a value that only the machine knows.
    pub branches: Branches,
    /// The block of the main program at which it is started by a block search (R2.96).
    pub search: Option<SearchedBlock>,
}

impl Options {
    /// Returns whether events are raised on one way only, and the others are its shadows (R14.8).
    pub(crate) fn follows_one_way(&self) -> bool {
        self.branches == Branches::OneFollowed || self.takes_motions()
    }

    /// Returns whether blocks report their motion.
    pub(crate) fn takes_motions(&self) -> bool {
        self.motions == Motions::Taken
    }

    /// Sets [`stop`](Self::stop).
    pub fn with_stop(mut self, stop: StopPolicy) -> Self {
        self.stop = stop;
        self
    }

    /// Sets [`skip`](Self::skip).
    pub fn with_skip(mut self, skip: impl Into<Option<SkipLevels>>) -> Self {
        self.skip = skip.into();
        self
    }

    /// Sets [`limits`](Self::limits).
    pub fn with_limits(mut self, limits: Limits) -> Self {
        self.limits = limits;
        self
    }

    /// Sets [`fast_path`](Self::fast_path).
    pub fn with_fast_path(mut self, fast_path: FastPath) -> Self {
        self.fast_path = fast_path;
        self
    }

    /// Sets [`notes`](Self::notes).
    pub fn with_notes(mut self, notes: Notes) -> Self {
        self.notes = notes;
        self
    }

    /// Sets [`branches`](Self::branches).
    pub fn with_branches(mut self, branches: Branches) -> Self {
        self.branches = branches;
        self
    }

    /// Sets [`search`](Self::search).
    pub fn with_search(mut self, search: impl Into<Option<SearchedBlock>>) -> Self {
        self.search = search.into();
        self
    }

    /// Sets [`motions`](Self::motions).
    pub fn with_motions(mut self, motions: Motions) -> Self {
        self.motions = motions;
        self
    }
}

/// Outcome of a call that runs a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RunOutcome {
    /// The program ended.
    Ended(EndedBy),
    /// The observer stopped it; it can continue, or be saved and resumed.
    Paused,
    /// The observer stopped a program that is read line by line: it cannot continue.
    Stopped,
}

/// Mode in which the running program is handed over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum SourceMode {
    /// Text in memory.
    #[default]
    Whole,
    /// Line by line; its lines are gone once they are executed.
    LineByLine,
}

/// Bounds on what a dry run may do (R2.60).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Limits {
    /// Executed blocks of a session.
    pub blocks: u64,
    /// Work beyond the text of the executed blocks: macros, strings that grow, regions under an
    /// unknown condition.
    pub work: u64,
    /// Units of work of blocks that are executed again, in loops and by calls: about a nanosecond each.
    /// Blocks that are executed once need none, however many there are.
    pub repeats: u64,
    /// Units of work on ways that only the machine decides, and on regions that may or may not be executed: about a
    /// nanosecond each, for each program. Past it no further way is followed, and whatever the rest could change is
    /// unknown.
    pub ways: u64,
    /// Values that are held at a time; a text counts as one more for every 32 bytes.
    pub values: u32,
    /// Depth of subprogram calls.
    pub calls: u32,
    /// Depth of nested `$` blocks.
    pub nesting: u32,
    /// Depth of macro expansion.
    pub macros: u32,
}

/// Repeated work that takes about two seconds of processor time.
const BRIEF_REPEATS: u64 = 1_500_000_000;

/// Units of ways for each unit of work: 700 million, by default.
const WAYS_PER_WORK: u64 = 70;

/// Default of the work beyond the text of the blocks.
const WORK: u64 = 10_000_000;

impl Limits {
    /// Returns the default limits, and repeated work for about two seconds of a processor (R9.91).
    pub fn brief() -> Self {
        Self::default().with_repeats(BRIEF_REPEATS)
    }

    /// Sets [`blocks`](Self::blocks).
    pub fn with_blocks(mut self, blocks: u64) -> Self {
        self.blocks = blocks;
        self
    }

    /// Sets [`work`](Self::work), and [`ways`](Self::ways) in proportion.
    pub fn with_work(mut self, work: u64) -> Self {
        self.work = work;
        self.ways = work.saturating_mul(WAYS_PER_WORK);
        self
    }

    /// Sets [`ways`](Self::ways).
    pub fn with_ways(mut self, ways: u64) -> Self {
        self.ways = ways;
        self
    }

    /// Sets [`repeats`](Self::repeats).
    pub fn with_repeats(mut self, repeats: u64) -> Self {
        self.repeats = repeats;
        self
    }

    /// Sets [`values`](Self::values).
    pub fn with_values(mut self, values: u32) -> Self {
        self.values = values;
        self
    }

    /// Sets [`calls`](Self::calls).
    pub fn with_calls(mut self, calls: u32) -> Self {
        self.calls = calls;
        self
    }

    /// Sets [`nesting`](Self::nesting).
    pub fn with_nesting(mut self, nesting: u32) -> Self {
        self.nesting = nesting;
        self
    }

    /// Sets [`macros`](Self::macros).
    pub fn with_macros(mut self, macros: u32) -> Self {
        self.macros = macros;
        self
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            blocks: 100_000_000,
            work: WORK,
            ways: WORK * WAYS_PER_WORK,
            repeats: u64::MAX,
            values: 1_000_000,
            calls: 50,
            nesting: 50,
            macros: 16,
        }
    }
}

/// The block of the main program at which a block search ends (R2.96).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SearchedBlock {
    /// The first executed block with this block number.
    Number(u64),
    /// The first executed block that begins in this line, from 1.
    Line(u32),
}

/// A text that names no block.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is neither a block number such as `N100` nor a line such as `12`")]
pub struct NoSearchedBlock(pub String);

impl FromStr for SearchedBlock {
    type Err = NoSearchedBlock;

    /// Reads `N100` or `12`.
    fn from_str(text: &str) -> Result<Self, NoSearchedBlock> {
        let block = match text.strip_prefix(['N', 'n']) {
            Some(number) => number.parse().ok().map(Self::Number),
            None => text.parse().ok().filter(|line| *line > 0).map(Self::Line),
        };
        block.ok_or_else(|| NoSearchedBlock(text.to_owned()))
    }
}

impl fmt::Display for SearchedBlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "N{number}"),
            Self::Line(line) => write!(f, "line {line}"),
        }
    }
}

impl SearchedBlock {
    #[expect(
        clippy::cast_precision_loss,
        reason = "block numbers are far below 2^53"
    )]
    /// Returns whether a block is the searched one.
    pub(crate) fn is(self, at: &BlockContext<'_>) -> bool {
        if at.level > 0 {
            return false;
        }
        match self {
            Self::Line(line) => at.line == line,
            Self::Number(wanted) => at.block.number.as_ref().is_some_and(
                |number| matches!(number.value, Operand::Number(it) if it.total_cmp(&(wanted as f64)).is_eq()),
            ),
        }
    }
}
