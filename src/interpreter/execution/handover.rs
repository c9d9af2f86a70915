//! The state handed from one program to the next (R2.34, R9.32).

use crate::comp::AxisIndex;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::values::carried::Carried;
use crate::interpreter::ways::carried::CarriedWays;

impl Interpreter {
    /// Returns the state that the next program finds.
    pub fn carried(&self) -> Carried {
        let name = |axis: &AxisIndex| self.here.machine.axis(*axis).name.clone();
        let couplings = self.here.state.control.couplings.groups();
        Carried {
            couplings: couplings
                .map(|(group, axes)| (group.to_owned(), axes.iter().map(name).collect()))
                .collect(),
            lost_couplings: self
                .here
                .state
                .control
                .couplings
                .lost()
                .map(|axis| name(&axis))
                .collect(),
            ways: CarriedWays::of(
                &self.here.state.control.history,
                &self.here.state.conditions,
                &self.here.machine,
            ),
            ..self
                .here
                .state
                .control
                .memory
                .carried(self.here.machine.parameters)
        }
    }

    /// Takes over what an earlier session left. Axes that the machine does not have are passed over.
    pub fn take_over(&mut self, mut carried: Carried) {
        let ways = std::mem::take(&mut carried.ways);
        let compensation = &self.here.state.control.compensation;
        (self.here.state.conditions, self.here.state.control.history) =
            ways.into_parts(&self.here.machine, compensation);
        self.here.version += 1;
        self.here.show_ways();
        for (group, names) in &carried.couplings {
            let found = names.iter().filter_map(|name| self.here.machine.find(name));
            let axes = found.collect();
            self.here.state.control.couplings.define(group, axes);
        }
        if !carried.lost_couplings.is_empty() {
            let names = carried.lost_couplings.iter();
            let axes = names.filter_map(|name| self.here.machine.find(name));
            self.here.state.control.couplings.lose(axes);
        }
        self.here.state.control.memory.take_over(carried);
    }

    /// Takes over the position of an axis, and that a program named it.
    pub fn place_axis(&mut self, axis: AxisIndex, position: Option<f64>) {
        self.here.state.occurred[axis.get()] = true;
        self.here.state.control.modal.place(axis, position);
        self.here.version += 1;
    }
}
