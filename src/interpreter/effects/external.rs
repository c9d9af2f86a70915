//! Programs that only the machine has (R2.83).

use crate::interpreter::programs::wanted::WantedCall;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::cause::{MissingProgram, Unknown};
use crate::syntax::ast::CallScope;

impl Executor {
    /// Whether only the machine has the program.
    pub(crate) fn is_external(&self, wanted: &WantedCall) -> bool {
        wanted.word.is_some()
            || wanted.scope == CallScope::Global && self.machine.programs.is_external(&wanted.name)
    }

    /// Makes unknown what a program that only the machine has does not keep.
    pub(crate) fn leave_to_machine(&mut self, program: &MissingProgram) {
        let name = program.to_string();
        let keeps = self.machine.programs.keeps(&name);
        self.scratch.plc_acts = true;
        if !keeps.compensation {
            self.havoc_couplings();
            self.havoc_compensation();
        }
        if !keeps.parameters {
            // It writes the P parameters and variables of its caller (R2.33, R2.52).
            self.havoc_memory(&Unknown::Program(program.clone()));
        }
        self.state.control.modal.functions.perhaps_give_feeds();
        if !keeps.positions {
            self.state.control.modal.havoc_positions();
            self.perhaps_move_all();
            self.state.control.modal.note_transformed(&name);
        }
    }
}
