//! The state handed from one program to the next (R2.34, R9.32).

use crate::comp::AxisIndex;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::values::carried::Carried;
use crate::interpreter::ways::carried::CarriedWays;

impl Interpreter {
    /// Returns the state that the next program finds.
    pub fn carried(&self) -> Carried {
        let name = |axis: &AxisIndex| self.machine.axis(*axis).name.clone();
        let couplings = self.state.control.couplings.groups();
        Carried {
            couplings: couplings
                .map(|(group, axes)| (group.to_owned(), axes.iter().map(name).collect()))
                .collect(),
            lost_couplings: self
                .state
                .control
                .couplings
                .lost()
                .map(|axis| name(&axis))
                .collect(),
            ways: CarriedWays::of(
                &self.state.control.history,
                &self.state.conditions,
                &self.machine,
            ),
            ..self.state.control.memory.carried(self.machine.parameters)
        }
    }

    /// Takes over what an earlier session left. Axes that the machine does not have are passed over.
    pub fn take_over(&mut self, mut carried: Carried) {
        let ways = std::mem::take(&mut carried.ways);
        let compensation = &self.state.control.compensation;
        (self.state.conditions, self.state.control.history) =
            ways.into_parts(&self.machine, compensation);
        self.version += 1;
        self.show_ways();
        for (group, names) in &carried.couplings {
            let found = names.iter().filter_map(|name| self.machine.find(name));
            let axes = found.collect();
            self.state.control.couplings.define(group, axes);
        }
        if !carried.lost_couplings.is_empty() {
            let names = carried.lost_couplings.iter();
            let axes = names.filter_map(|name| self.machine.find(name));
            self.state.control.couplings.lose(axes);
        }
        self.state.control.memory.take_over(carried);
    }

    /// Takes over the position of an axis, and that a program named it.
    pub fn place_axis(&mut self, axis: AxisIndex, position: Option<f64>) {
        self.state.occurred[axis.get()] = true;
        self.state.control.modal.place(axis, position);
        self.version += 1;
    }
}
