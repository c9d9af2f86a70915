//! A run between two blocks as data.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::fingerprint::Fingerprint;
use super::trust::Trust;
use crate::interpreter::programs::index::{EntryIndex, Index};
use crate::interpreter::programs::store::ProgramStore;
use crate::interpreter::programs::unit::SourceUnit;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::{Options, SourceMode, StopPolicy};
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::state::RunState;
use crate::machine::Machine;
use crate::text::SourceFile;

/// A run between two blocks, to be saved and resumed (R9.30 is about what outlives programs; this
/// is about the middle of one).
///
/// A snapshot is not trusted: [`Interpreter::resume`] refuses one of another version, of changed texts
/// or of a machine with other axes, and one that is not as it was saved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    schema: u32,
    files: Vec<RunFile>,
    /// The blocks of each file that were executed, where the others are checked at the end.
    executed: Vec<Vec<EntryIndex>>,
    state: RunState,
    others: OtherPaths,
    /// The fingerprint of everything else.
    seal: Option<Fingerprint>,
}

/// A file of the run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct RunFile {
    name: String,
    text: Fingerprint,
}

/// Why a snapshot cannot be resumed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ResumeError {
    /// Another version wrote it.
    #[error(
        "the snapshot has schema {found}; this version reads schema {}",
        Snapshot::SCHEMA
    )]
    Schema {
        /// The schema that it has.
        found: u32,
    },
    /// A file of the run is not there.
    #[error("the file `{0}` of the run is missing")]
    MissingFile(String),
    /// A file of the run has another text than when the run was stopped.
    #[error("the file `{0}` has changed since the run was stopped")]
    OtherText(String),
    /// The machine has other axes.
    #[error("the snapshot belongs to a machine with other axes")]
    OtherMachine,
    /// It was changed after it was saved, or names something that does not exist.
    #[error("the snapshot is damaged: {0}")]
    Damaged(&'static str),
}

impl Snapshot {
    /// The number of the format that is written and read.
    pub const SCHEMA: u32 = 16;

    /// The number of the format that the snapshot has.
    pub fn schema(&self) -> u32 {
        self.schema
    }

    /// The names of the files of the run, in the order in which they were first needed.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|file| file.name.as_str())
    }

    /// Returns the snapshot with a seal for its present content, for callers that changed a saved snapshot
    /// on purpose. Its places are checked by [`Interpreter::resume`] all the same.
    pub fn sealed_anew(mut self) -> Self {
        self.seal = self.seal_of_content();
        self
    }

    fn seal_of_content(&self) -> Option<Fingerprint> {
        Fingerprint::of_data(&(
            self.schema,
            &self.files,
            &self.executed,
            &self.state,
            &self.others,
        ))
    }

    fn is_as_saved(&self) -> bool {
        self.seal.is_some() && self.seal == self.seal_of_content()
    }
}

impl SourceUnit {
    fn executed(&self) -> Vec<EntryIndex> {
        (0..)
            .zip(&self.executed)
            .filter_map(|(entry, executed)| executed.then_some(entry))
            .collect()
    }
}

impl Interpreter {
    /// The state of the run between two blocks. `None` where the program is read line by line: its
    /// lines are gone, so nothing could be resumed.
    pub fn snapshot(&self) -> Option<Snapshot> {
        if self.source_mode == SourceMode::LineByLine {
            return None;
        }
        let file = |unit: &SourceUnit| RunFile {
            name: unit.index.source.name().to_string(),
            text: Fingerprint::of_text(unit.index.source.text()),
        };
        let snapshot = Snapshot {
            schema: Snapshot::SCHEMA,
            files: self.here.programs.units().iter().map(file).collect(),
            executed: match self.here.options.stop {
                StopPolicy::CheckAll => self
                    .here
                    .programs
                    .units()
                    .iter()
                    .map(SourceUnit::executed)
                    .collect(),
                StopPolicy::FirstError | StopPolicy::KeepGoing => Vec::new(),
            },
            state: self.here.state.clone(),
            others: self.others.clone(),
            seal: None,
        };
        Some(snapshot.sealed_anew())
    }

    /// An interpreter in the state of a snapshot. `source` returns the text of each file of the run.
    ///
    /// # Errors
    /// A snapshot of another version, a file that `source` does not return or whose text has changed, a
    /// machine with other axes, or content that was changed after it was saved or names something that does
    /// not exist.
    pub fn resume(
        machine: impl Into<Arc<Machine>>,
        options: Options,
        snapshot: Snapshot,
        source: &mut dyn FnMut(&str) -> Option<SourceFile>,
    ) -> Result<Self, ResumeError> {
        if snapshot.schema != Snapshot::SCHEMA {
            return Err(ResumeError::Schema {
                found: snapshot.schema,
            });
        }
        if !snapshot.is_as_saved() {
            return Err(ResumeError::Damaged("its content is not what was saved"));
        }
        let machine = machine.into();
        if !snapshot
            .state
            .control
            .compensation
            .fits(machine.axis_setups())
        {
            return Err(ResumeError::OtherMachine);
        }
        let mut resumed = Self::with_state(machine, options, (snapshot.state, snapshot.others));
        for file in snapshot.files {
            let Some(text) = source(&file.name) else {
                return Err(ResumeError::MissingFile(file.name));
            };
            if Fingerprint::of_text(text.text()) != file.text {
                return Err(ResumeError::OtherText(file.name));
            }
            resumed
                .here
                .programs
                .hold(Index::new(text, options.limits.nesting));
        }
        Trust::of(&resumed).check().map_err(ResumeError::Damaged)?;
        resumed
            .here
            .programs
            .mark_executed(&snapshot.executed)
            .map_err(ResumeError::Damaged)?;
        Ok(resumed)
    }
}

impl ProgramStore {
    fn mark_executed(&mut self, executed: &[Vec<EntryIndex>]) -> Result<(), &'static str> {
        if executed.len() > self.units().len() {
            return Err("executed blocks of a file that is not there");
        }
        for (unit, executed) in executed.iter().enumerate() {
            let unit = self.unit_mut(unit);
            for &entry in executed {
                let place = usize::try_from(entry).unwrap_or(usize::MAX);
                let block = unit.executed.get_mut(place);
                *block.ok_or("an executed block that is not there")? = true;
            }
        }
        Ok(())
    }
}
