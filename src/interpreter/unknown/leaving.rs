//! States of which only the machine knows which a kind has, as separate ways (R14.1): those that a program leaves that
//! only the machine has, and those that a program finds (R10.1).

use std::sync::Arc;

use super::branching::answers;
use crate::comp::{AxisIndex, Kind, KindSet, Membership};
use crate::interpreter::run::block_scratch::LeftOpen;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::history::Split;
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;
use crate::text::Place;

impl Executor {
    /// Each configured kind of each axis is selected after the call, or is not.
    #[cold]
    pub(crate) fn leave_open(&mut self, left: &LeftOpen) {
        for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
            let unknown = self.state.control.compensation.unknown(axis);
            let configured = self.machine.axis(axis).configured;
            for kind in unknown.intersection(configured).iter() {
                if self.state.control.history.states(axis, kind).is_some() {
                    // The program keeps it.
                    continue;
                }
                self.state.work.charge(ITEM * 8);
                let name: Arc<str> = self.machine.axis(axis).name.as_str().into();
                let condition = Condition::new(
                    ConditionKind::Call(kind),
                    left.place.clone(),
                    vec![left.program.to_string().into(), name],
                    Unknown::Program(left.program.clone()),
                );
                self.open((axis, kind), condition);
            }
        }
    }

    /// The next program finds a kind of an axis selected or not. Returns the number of the condition, of which the first
    /// answer is that it is; `None` where too many are asked.
    pub(crate) fn find_open(&mut self, axis: AxisIndex, kind: Kind) -> Option<u32> {
        let name: Arc<str> = self.machine.axis(axis).name.as_str().into();
        let compensation = &mut self.state.control.compensation;
        compensation.decide(axis, kind, Membership::In);
        let selected = compensation.state(axis, kind);
        compensation.havoc(axis, KindSet::of(kind), &mut Vec::new());
        self.version += 1;
        let condition = Condition::new(
            ConditionKind::Found(kind, selected),
            Place::head_of(&Arc::default()),
            vec![Arc::clone(&name)],
            Unknown::text(&*name),
        );
        self.open((axis, kind), condition)
    }

    /// Opens a kind of an axis on the ways that lead here, by a condition on whether it is selected.
    fn open(&mut self, (axis, kind): (AxisIndex, Kind), condition: Condition) -> Option<u32> {
        if !self.state.can_ask() {
            return None;
        }
        let condition = self.state.ask_anew(condition);
        let reach = &self.state.track.reach;
        let mut sides = answers(condition, 2).map(|answer| reach.and(&WaySet::of(answer)));
        if let (Some(on), Some(off)) = (sides.next(), sides.next()) {
            let history = &mut self.state.control.history;
            history.open(axis, kind, Split { on, off });
        }
        Some(condition)
    }
}
