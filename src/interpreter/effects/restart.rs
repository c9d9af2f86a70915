//! What comes between two programs: a reset of the channel, a restart of the control.

use crate::comp::AxisIndex;
use crate::interpreter::run::executor::Executor;
use crate::readings::Question;

impl Executor {
    /// Resets friction compensation, where the machine is read so (R1.28).
    pub(crate) fn reset_friction(&mut self) {
        if self.machine.readings.takes_second(Question::Reset) {
            for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
                self.return_to_start(axis);
            }
        }
    }

    /// A restart of the control (R1.29): every kind returns to its start-up state, unless the machine
    /// is read as keeping what was switched.
    pub(crate) fn restart(&mut self) {
        self.state.control.memory.restart();
        if !self.machine.readings.takes_second(Question::Restart) {
            self.state.control.history.close_all();
            self.state.control.compensation = self.machine.compensation();
            self.version += 1;
        }
    }
}
