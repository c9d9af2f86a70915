//! What outlives programs beside the states of the axes, as data (R2.34, R9.32): variables, arrays,
//! macros, kept parameters, coupling groups.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::run::Interpreter;
use super::value::Value;
use crate::comp::AxisIndex;

/// A declared array without its elements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArrayShape {
    /// How many elements each dimension has.
    pub dimensions: Vec<u32>,
    /// The value of elements that were never written.
    pub default: Value,
}

/// What programs leave to the next one beside the states of the axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Carried {
    /// Variables and elements of arrays, by their full names.
    pub variables: BTreeMap<String, Value>,
    /// Arrays of which some element was written, but it is not known which, with the value that made it
    /// so.
    pub lost: BTreeMap<String, Arc<str>>,
    /// Declared arrays.
    pub arrays: BTreeMap<String, ArrayShape>,
    /// P parameters, where the machine keeps them.
    pub parameters: BTreeMap<u32, Value>,
    /// Set when some kept parameter was written, but it is not known which.
    pub lost_parameters: Option<Arc<str>>,
    /// Macros with their code.
    pub macros: BTreeMap<String, String>,
    /// Macros that may have been redefined, with the value that made it so.
    pub lost_macros: BTreeMap<String, Arc<str>>,
    /// The coupling groups that `#SET AX LINK` defined, with the names of their axes.
    pub couplings: BTreeMap<String, Vec<String>>,
    /// The axes that coupling groups may name which nobody knows any more.
    pub lost_couplings: Vec<String>,
}

impl Interpreter {
    /// What the next program finds.
    pub fn carried(&self) -> Carried {
        let name = |axis: &AxisIndex| self.machine.axis(*axis).name.clone();
        let couplings = self.state.couplings.groups();
        Carried {
            couplings: couplings
                .map(|(group, axes)| (group.to_owned(), axes.iter().map(name).collect()))
                .collect(),
            lost_couplings: self
                .state
                .couplings
                .lost()
                .map(|axis| name(&axis))
                .collect(),
            ..self.state.memory.carried(self.machine.parameters)
        }
    }

    /// Takes over what an earlier session left. Axes that the machine does not have are passed over.
    pub fn take_over(&mut self, carried: Carried) {
        for (group, names) in &carried.couplings {
            let found = names.iter().filter_map(|name| self.machine.find(name));
            let axes = found.collect();
            self.state.couplings.define(group, axes);
        }
        if !carried.lost_couplings.is_empty() {
            let names = carried.lost_couplings.iter();
            let axes = names.filter_map(|name| self.machine.find(name));
            self.state.couplings.lose(axes);
        }
        self.state.memory.take_over(carried);
        self.journal.begin_anew();
    }

    /// Takes over the position of an axis, and that a program named it.
    pub fn place_axis(&mut self, axis: AxisIndex, position: Option<f64>) {
        self.state.occurred[axis.get()] = true;
        self.state.modal.place(axis, position);
        self.version += 1;
    }
}
