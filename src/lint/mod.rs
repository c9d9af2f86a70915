//! Lints on the use of COMP (chapter 1.4): one file a lint, one memory of what the program did,
//! one of what programs left.
//!
//! FC404 and FC406 are statements about a block's text and come from `syntax`.

mod history;
mod left_away;
mod memory;
mod moved_before;
mod repeated;
mod shared_block;
mod undescribed;

pub use history::Maker;
pub(crate) use history::{History, Told};

use crate::comp::{AxisIndex, Compensation, Kind, State};
use crate::diagnostic::Diagnostic;
use crate::interpreter::{AxisWord, Ended, EndedBy, Executed, Outcome};
use crate::machine::Machine;
use crate::text::{Place, Span};
use memory::Memory;

/// A diagnostic at the end of a program, with the executed block that it is about.
#[derive(Debug, Clone, serde::Serialize)]
pub struct EndNote {
    /// The executed block that it is about.
    pub seq: u64,
    /// What there is to say.
    pub diagnostic: Diagnostic,
}

/// That a program leaves a kind of an axis away from home.
pub(crate) struct LeftAway {
    pub(crate) axis: AxisIndex,
    pub(crate) kind: Kind,
    /// FC401 or FC407.
    pub(crate) note: EndNote,
}

/// A command that the control took.
struct Taken<'a> {
    axis: AxisIndex,
    outcome: &'a Outcome,
    executed: &'a Executed<'a>,
}

/// The lints on a command, before it is remembered; the first that has something to say wins, so
/// that nothing is said twice about it.
const ON_COMMAND: [fn(&Linter<'_>, &Taken<'_>) -> Option<Diagnostic>; 2] =
    [repeated::lint, undescribed::lint];

/// What the lints know while a program runs.
pub(crate) struct Linter<'m> {
    machine: &'m Machine,
    history: &'m mut History,
    /// The name of the program after `%`, or else its file.
    program: String,
    memory: Memory,
    /// The file of the program.
    file: String,
    /// Where its first block begins.
    begin: Option<Place>,
    /// The states of friction compensation that the program found, by axis.
    found: Vec<State>,
}

impl<'m> Linter<'m> {
    /// A program begins.
    pub(crate) fn new(machine: &'m Machine, history: &'m mut History, file: &str) -> Self {
        Self {
            memory: Memory::new(machine.axes.len()),
            machine,
            history,
            program: file.to_owned(),
            file: file.to_owned(),
            begin: None,
            found: Vec::new(),
        }
    }

    /// The program starts with these states.
    pub(crate) fn starts(&mut self, with: &Compensation) {
        let axes = (0..with.len()).map(AxisIndex::new);
        self.found = axes.map(|axis| with.state(axis, Kind::Frict)).collect();
    }

    /// The state of friction compensation that the program found.
    fn found(&self, axis: AxisIndex) -> State {
        let home = || self.history.home(axis, Kind::Frict);
        self.found.get(axis.get()).copied().unwrap_or_else(home)
    }

    /// The program has a name.
    pub(crate) fn named(&mut self, name: &str) {
        name.clone_into(&mut self.program);
    }

    /// Whether every axis that a block moves has moved before, so that this is nothing new.
    #[inline]
    pub(crate) fn knows(&self, moved: &[AxisWord]) -> bool {
        moved.iter().all(|word| self.memory.has_moved(word.axis))
    }

    /// Looks at an executed block and appends what there is to say.
    pub(crate) fn block(&mut self, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
        if executed.seq == 1 && **executed.file == *self.file {
            self.begin = Some(memory::place(executed, Span::default()));
        }
        if !executed.outcomes.is_empty() {
            self.commands(executed, said);
        }
        if !(executed.changes.is_empty() && executed.doubted.is_empty()) {
            self.memory.forgotten(executed);
        }
        // The commands of a block act before its motion (R1.9).
        for word in executed.moved {
            if self.memory.moved(word, executed) {
                said.extend(moved_before::lint(self, word.axis, executed));
            }
        }
    }

    fn commands(&mut self, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
        for outcome in executed.outcomes {
            let Ok(axis) = outcome.result else {
                continue;
            };
            let taken = Taken {
                axis,
                outcome,
                executed,
            };
            said.extend(ON_COMMAND.iter().find_map(|lint| lint(self, &taken)));
            self.memory.command(axis, outcome, executed);
        }
        said.extend(shared_block::lint(executed));
    }

    /// Looks at the state that an ended program leaves, and remembers who made it. A program that
    /// an error or a budget stopped is not blamed for what it did not come to.
    /// One that a loop keeps for ever is ended by a reset, which keeps the state (R1.28).
    pub(crate) fn end(&mut self, ended: &Ended<'_>) -> Vec<LeftAway> {
        let left = ended.compensation;
        self.history
            .program_ended(&self.program, &self.memory, left);
        match ended.by {
            EndedBy::Budget if ended.endless => {
                left_away::lint(self, ended, "the reset that ends it")
            }
            EndedBy::Error | EndedBy::Budget => Vec::new(),
            EndedBy::M30 | EndedBy::M02 | EndedBy::EndOfFile => {
                left_away::lint(self, ended, "program end")
            }
        }
    }

    /// What became of a note that [`end`](Self::end) gave.
    pub(crate) fn settle(&mut self, left: &LeftAway, told: Told) {
        self.history.set_told(left.axis, left.kind, told);
    }

    fn name(&self, axis: AxisIndex) -> &str {
        &self.machine.axis(axis).name
    }
}
