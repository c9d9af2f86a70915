//! The options of a run, and its outcome.

use super::event::{EndedBy, Notes};
use super::limits::Limits;
use super::search::SearchedBlock;
use crate::interpreter::coordinates::motion::Motions;
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
    /// As `KeepGoing`; blocks that are never executed are checked for their syntax too.
    CheckAll,
}

/// Treatment of a condition that depends on a value that only the machine knows (R14.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Branches {
    /// Every way is executed, and what they agree on is known.
    #[default]
    Followed,
    /// Events are raised on one way only: the blocks that another answer would pass over are executed without
    /// events, and what the ways agree on is known after them. This also applies where blocks report their motion.
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
    /// Whether plain blocks are parsed by hand.
    pub fast_path: FastPath,
    /// Whether notes are taken.
    pub notes: Notes,
    /// Whether blocks report their motion.
    pub motions: Motions,
    /// Treatment of a condition that depends on a value that only the machine knows.
    pub branches: Branches,
    /// The block of the main program at which it is started by a block search (R2.96).
    pub search: Option<SearchedBlock>,
}

impl Options {
    /// Whether events are raised on one way only, and the others are its shadows (R14.8).
    pub(crate) fn follows_one_way(&self) -> bool {
        self.branches == Branches::OneFollowed || self.takes_motions()
    }

    /// Whether blocks report their motion.
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
    /// As a text in memory.
    #[default]
    Whole,
    /// Line by line; its lines are gone once they are executed.
    LineByLine,
}
