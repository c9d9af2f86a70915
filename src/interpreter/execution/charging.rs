//! The work of following several ways, in units (R9.91).

use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::ways::set::WaySet;

/// Units of a block on one of several ways, with the row that shows it.
const BLOCK: u64 = 3000;

/// Units of a copy of the state of the control.
const COPY: u64 = 3000;

/// Units of a copied or compared level of the call stack.
const LEVEL: u64 = 100;

/// Units of a pair of answers: ways that meet are compared with each other until none can be left out.
const PAIR: u64 = 20;

impl Executor {
    /// Counts the work of copying a state, or of comparing it with another one.
    pub(crate) fn charge_copies(&self, control: &ControlState, reach: &WaySet) {
        let levels = LEVEL.saturating_mul(control.frames.depth() as u64);
        let pairs = PAIR.saturating_mul(control.pairs(reach));
        let axes = 20 * self.machine.axes.len() as u64;
        let answers = 10 * reach.conditions().count() as u64;
        let units = COPY.saturating_add(levels).saturating_add(pairs);
        self.state
            .work
            .charge_ways(units.saturating_add(axes + answers));
    }

    /// Counts the work of a block that is executed while other ways wait.
    pub(crate) fn charge_block(&self, weight: u64) {
        let compared = 20 * self.state.control.frames.depth() as u64;
        let units = BLOCK.saturating_add(weight).saturating_add(compared);
        self.state.work.charge_ways(units);
    }
}

impl ControlState {
    /// Pairs of answers that are compared where ways to this state meet others.
    fn pairs(&self, reach: &WaySet) -> u64 {
        let sets = self.history.sets().chain([reach]);
        sets.map(WaySet::pairs).fold(0, u64::saturating_add)
    }
}
