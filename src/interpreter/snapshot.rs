//! A run between two blocks as data.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::options::{Options, StopPolicy};
use super::program::{EntryIndex, Index};
use super::run::Interpreter;
use super::state::State;
use super::unit::Unit;
use crate::machine::Machine;
use crate::source::SourceFile;

/// A run between two blocks, to be saved and resumed (R9.30 is about what outlives programs; this
/// is about the middle of one).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// 1.
    pub schema: u32,
    /// The files of the run, in the order in which they were first needed.
    pub files: Vec<String>,
    /// The blocks of each file that were executed, where the others are checked at the end.
    executed: Vec<Vec<EntryIndex>>,
    state: State,
}

/// Why a snapshot cannot be resumed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ResumeError {
    /// A file of the run is not there.
    #[error("the file `{0}` of the run is missing")]
    MissingFile(String),
    /// The machine has other axes.
    #[error("the snapshot belongs to a machine with other axes")]
    OtherMachine,
}

impl Interpreter {
    /// The state of the run between two blocks. Programs that are streamed have none.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            schema: 1,
            files: self
                .units
                .iter()
                .map(|unit| unit.index.source.name().to_string())
                .collect(),
            executed: match self.options.stop {
                StopPolicy::CheckAll => self.units.iter().map(Unit::executed).collect(),
                StopPolicy::FirstError | StopPolicy::KeepGoing => Vec::new(),
            },
            state: self.state.clone(),
        }
    }

    /// An interpreter in the state of a snapshot. `source` gives the text of each file of the run.
    ///
    /// # Errors
    /// The name of a file that `source` does not give, or of a machine with other axes.
    pub fn resume(
        machine: impl Into<Arc<Machine>>,
        options: Options,
        snapshot: Snapshot,
        source: &mut dyn FnMut(&str) -> Option<SourceFile>,
    ) -> Result<Self, ResumeError> {
        let machine = machine.into();
        if snapshot.state.compensation.len() != machine.axes.len() {
            return Err(ResumeError::OtherMachine);
        }
        let mut resumed = Self::with_state(machine, options, snapshot.state);
        for file in snapshot.files {
            let Some(text) = source(&file) else {
                return Err(ResumeError::MissingFile(file));
            };
            resumed.hold(Index::new(text, options.limits.nesting));
        }
        for (unit, executed) in resumed.units.iter_mut().zip(snapshot.executed) {
            unit.mark_executed(&executed);
        }
        Ok(resumed)
    }
}

impl Unit {
    fn executed(&self) -> Vec<EntryIndex> {
        (0..)
            .zip(&self.executed)
            .filter_map(|(entry, executed)| executed.then_some(entry))
            .collect()
    }

    fn mark_executed(&mut self, entries: &[EntryIndex]) {
        for &entry in entries {
            let place = usize::try_from(entry).unwrap_or(usize::MAX);
            if let Some(executed) = self.executed.get_mut(place) {
                *executed = true;
            }
        }
    }
}
