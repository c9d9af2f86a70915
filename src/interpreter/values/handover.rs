//! Values that one program hands to the next (R2.34, R9.32).

use super::carried::Carried;
use super::memory::{Memory, is_kept};
use super::value::Value;
use crate::machine::Parameters;
use crate::syntax::{VariableFamily, VariableName};

impl Memory {
    /// Forgets what a restart of the control clears: `V.S.` and `V.E.` variables (R2.34, P-EXTV-00013).
    pub(crate) fn restart(&mut self) {
        let arrays = self.variables.names.keys().cloned();
        let names = arrays.map(VariableName::whole);
        let goes = |name: &VariableName| {
            let family = name.family();
            matches!(family, VariableFamily::Shared | VariableFamily::External)
        };
        for name in names.filter(goes).collect::<Vec<_>>() {
            self.delete(&name);
        }
        let given = self
            .given
            .iter()
            .map(|(name, value)| (name.clone(), value.clone()));
        let given = given.filter(|(name, _)| self.externals.names.may_change(name));
        for (name, value) in given.collect::<Vec<_>>() {
            self.set_variable(&name, value);
        }
    }

    /// Returns the values that a program start leaves (R9.32).
    pub(crate) fn carried(&self, parameters: Parameters) -> Carried {
        let mut carried = Carried::default();
        for (name, code) in self.macros.iter() {
            match code {
                Value::Text(code) => {
                    carried.macros.insert(name.clone(), code.to_string());
                }
                Value::Unknown(cause) => {
                    carried.lost_macros.insert(name.clone(), cause.clone());
                }
                Value::Number(_) => {}
            }
        }
        if parameters == Parameters::Kept {
            let parameters = self.parameters.iter();
            carried.parameters = parameters.map(|(at, value)| (at, value.clone())).collect();
            carried.lost_parameters.clone_from(&self.lost);
        }
        let names = self.variables.names.iter();
        for (name, variable) in names.filter(|(name, _)| is_kept(name, parameters)) {
            variable.carry(name, &mut carried);
        }
        carried
    }

    /// Takes over what an earlier session left.
    pub(crate) fn take_over(&mut self, carried: Carried) {
        for (name, shape) in carried.arrays {
            self.declare_array(&VariableName::read(&name), shape.dimensions, shape.default);
        }
        for (name, cause) in &carried.lost {
            self.variables.havoc_elements(name, cause);
        }
        for (name, value) in carried.variables {
            self.set_variable(&VariableName::read(&name), value);
        }
        self.lost = carried.lost_parameters;
        for (index, value) in carried.parameters {
            self.set_parameter(index, value);
        }
        for (name, code) in carried.macros {
            self.hold_macro(&name, Value::Text(code.into()));
        }
        for (name, cause) in carried.lost_macros {
            self.hold_macro(&name, Value::Unknown(cause));
        }
    }
}
