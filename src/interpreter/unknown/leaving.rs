//! The state left by a program that only the machine has: either state of each kind, as a separate
//! way (R14.1).

use std::sync::Arc;

use super::branching::{MAX_CONDITIONS, answers};
use crate::comp::{AxisIndex, Kind};
use crate::interpreter::run::block_scratch::LeftOpen;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::Branches;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::history::Split;
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;

impl Interpreter {
    /// Each configured kind of each axis is selected after the call, or is not.
    #[cold]
    pub(crate) fn leave_open(&mut self, left: &LeftOpen) {
        if self.options.branches == Branches::Passed {
            return;
        }
        for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
            let unknown = self.state.control.compensation.unknown(axis);
            let configured = self.machine.axis(axis).configured;
            for kind in unknown.intersection(configured).iter() {
                self.leave_kind_open((axis, kind), left);
            }
        }
    }

    fn leave_kind_open(&mut self, (axis, kind): (AxisIndex, Kind), left: &LeftOpen) {
        if self.state.conditions.len() + 1 >= MAX_CONDITIONS {
            return;
        }
        self.state.work.charge(ITEM * 8);
        let name: Arc<str> = self.machine.axis(axis).name.as_str().into();
        let condition = self.state.ask_anew(Condition::new(
            ConditionKind::Call(kind),
            left.place.clone(),
            vec![left.program.to_string().into(), name],
            Unknown::Program(left.program.clone()),
        ));
        let reach = &self.state.track.reach;
        let mut sides = answers(condition, 2).map(|answer| reach.and(&WaySet::of(answer)));
        if let (Some(on), Some(off)) = (sides.next(), sides.next()) {
            let history = &mut self.state.control.history;
            history.open(axis, kind, Split { on, off });
        }
    }
}
