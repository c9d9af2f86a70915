//! A reset between two programs, and the state before the first.

use super::ending::ProgramStop;
use crate::comp::{Kind, KindSet};
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::interpreter::Interpreter;
use crate::readings::Question;

impl Interpreter {
    /// A reset of the channel (R1.28): the compensation stays as it is, or returns to its start-up
    /// state, depending on the reading; kinds with manual activation are switched off in any case. Couplings and
    /// exchanged axes end with it, unless the channel list says otherwise.
    pub fn reset(&mut self) {
        self.here.end_exchange(ProgramStop::Reset);
        let _ = self.here.state.control.compensation.reset();
        self.here.reset_friction();
        self.here.scratch.changes.clear();
        self.here.version += 1;
    }
}

impl Executor {
    /// If the state before the start of the control is not known, friction compensation is unknown where
    /// the machine is read as keeping it (R1.29).
    pub(crate) fn havoc_start(&mut self) {
        if self.machine.readings.takes_second(Question::Restart) {
            self.havoc_any_axis(KindSet::of(Kind::Frict));
            self.scratch.clear();
            self.version += 1;
        }
    }
}
