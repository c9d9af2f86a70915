//! The events between two programs: a reset of the channel, a restart of the control.

use crate::comp::{AxisIndex, Kind, KindSet};
use crate::interpreter::run::interpreter::Interpreter;
use crate::readings::Question;

impl Interpreter {
    /// A reset of the channel (R1.28): the compensation stays as it is, or returns to its start-up
    /// state, depending on the reading; kinds with manual activation are switched off in any case.
    pub fn reset(&mut self) {
        let _ = self.state.control.compensation.reset();
        self.reset_friction();
        self.scratch.changes.clear();
        self.version += 1;
    }

    /// Resets friction compensation, where the machine is read so (R1.28).
    pub(in crate::interpreter) fn reset_friction(&mut self) {
        if self.machine.readings.takes_second(Question::Reset) {
            for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
                self.return_to_start(axis);
            }
        }
    }

    /// If the state before the start of the control is not known, friction compensation is unknown where
    /// the machine is read as keeping it (R1.29).
    pub(crate) fn havoc_start(&mut self) {
        if self.machine.readings.takes_second(Question::Restart) {
            self.havoc_any_axis(KindSet::of(Kind::Frict));
            self.scratch.clear();
            self.version += 1;
        }
    }

    /// A restart of the control (R1.29): every kind returns to its start-up state, unless the machine
    /// is read as keeping what was switched.
    pub fn restart(&mut self) {
        self.state.control.memory.restart();
        self.journal.begin_anew();
        if !self.machine.readings.takes_second(Question::Restart) {
            self.set_compensation(self.machine.compensation());
        }
    }
}
