//! One controller session: programs that run one after the other on one machine.
//!
//! The state that one program leaves is the state that the next one starts with.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::diagnostic::{Diagnostic, Levels};
use crate::machine::{Machine, Setting};
use crate::source::{LineSource, SourceFile};
use crate::timeline::{EndedBy, Sink};

/// What happens at an error of the control (R9.20).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StopPolicy {
    /// The first error stops the program and the session, as on the control.
    #[default]
    FirstError,
    /// The failing command is treated as if it were not there.
    KeepGoing,
}

/// Bounds on what a dry run may do (R2.60).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Executed blocks of a session, `--max-blocks`.
    pub blocks: u64,
    /// Depth of subprogram calls, `--max-calls`.
    pub calls: u32,
    /// Depth of nested `$` blocks, `--max-nesting`.
    pub nesting: u32,
    /// Depth of macro expansion, `--max-macros`.
    pub macros: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            blocks: 100_000_000,
            calls: 50,
            nesting: 50,
            macros: 16,
        }
    }
}

/// How a session runs.
#[derive(Debug, Clone, Default)]
pub struct SessionOptions {
    /// What happens at an error.
    pub stop: StopPolicy,
    /// The levels of blocks that are skipped, bit 1 for `/` and `/1`, up to bit 10 (R2.3).
    pub skip: u16,
    /// Budgets.
    pub limits: Limits,
    /// The user's severities.
    pub levels: Levels,
    /// Values of variables that only the machine knows.
    pub settings: Vec<(String, Setting)>,
}

/// The text of a program.
pub enum Program<'a> {
    /// Lines that come one after another. Such a program has no flow: no `$` statement, no local
    /// subprogram; see [`crate::source::FlowScan`].
    Lines(&'a mut dyn LineSource),
    /// The whole text, for programs with flow.
    Whole(SourceFile),
}

/// Finds called programs for the library, which opens no file itself.
pub trait Finder {
    /// The text of the program called `name`, asked for by the file `caller`. `None` when there
    /// is none (FC320).
    fn find(&mut self, name: &str, caller: &str) -> Option<SourceFile>;
}

/// A finder that finds nothing.
pub struct NoFiles;

impl Finder for NoFiles {
    fn find(&mut self, _name: &str, _caller: &str) -> Option<SourceFile> {
        None
    }
}

/// Why a saved state cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum StateError {
    /// It has another schema.
    #[error("the state has schema {found}, this version reads schema 1")]
    Schema {
        /// The schema that it has.
        found: u32,
    },
    /// It belongs to another machine.
    #[error("the state belongs to another machine: {difference}")]
    OtherMachine {
        /// What differs.
        difference: String,
    },
}

/// What outlives the programs of a session (R9.30).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedState {
    /// 1.
    pub schema: u32,
}

/// One controller session.
pub struct Session {}

impl Session {
    /// A session right after the start of the control.
    pub fn new(_machine: Machine, _options: SessionOptions) -> Self {
        unimplemented!()
    }

    /// A session that goes on where another one ended. Returns also what the control says about
    /// lists that changed since (P-ERR-110641).
    ///
    /// # Errors
    /// A state of another schema or machine.
    pub fn resume(
        _machine: Machine,
        _options: SessionOptions,
        _saved: SavedState,
    ) -> Result<(Self, Vec<Diagnostic>), StateError> {
        unimplemented!()
    }

    /// Says what the session starts with.
    pub fn begin(&mut self, _sink: &mut dyn Sink) -> ControlFlow<()> {
        unimplemented!()
    }

    /// Runs one program. `Break` when the sink wants no more.
    pub fn program(
        &mut self,
        _file: &str,
        _program: Program<'_>,
        _finder: &mut dyn Finder,
        _sink: &mut dyn Sink,
    ) -> ControlFlow<(), EndedBy> {
        unimplemented!()
    }

    /// Whether an error stopped the session, so that no further program may run (R9.20).
    pub fn is_stopped(&self) -> bool {
        unimplemented!()
    }

    /// Says the summary.
    pub fn finish(&mut self, _sink: &mut dyn Sink) -> ControlFlow<()> {
        unimplemented!()
    }

    /// What the next session starts with.
    pub fn save(&self) -> SavedState {
        unimplemented!()
    }
}
