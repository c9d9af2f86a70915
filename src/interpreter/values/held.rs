//! Values that the program sets in variables of the machine, until the PLC acts (R2.99).

use std::sync::Arc;

use super::cause::Unknown;
use super::externals::{ExternalNames, HeldVariable, SetAt};
use super::memory::Memory;
use super::value::Value;
use crate::syntax::{VariableFamily, VariableName};

impl Memory {
    /// Takes over what the configuration says of the writers of `V.E.` variables.
    pub(crate) fn describe_externals(&mut self, names: &Arc<ExternalNames>) {
        self.externals.names = Arc::clone(names);
    }

    /// Whether the PLC may write a variable, and no value from the user says what it writes.
    pub(crate) fn may_change(&self, name: &VariableName) -> bool {
        self.externals.names.may_change(name) && self.given.get(name).is_none()
    }

    /// The program has set a variable, which keeps its value until the PLC acts.
    pub(crate) fn hold(&mut self, name: &VariableName, at: SetAt) {
        if let Some(known) = self.known(name)
            && self.externals.names.may_change(name)
        {
            let held = HeldVariable::of(known, at);
            self.externals.held.insert(name.clone(), held);
        }
    }

    /// Returns the block that set a variable, while it has that value.
    pub(crate) fn set_at(&self, name: &VariableName) -> Option<&SetAt> {
        let externals = &self.externals;
        let is_initial = || self.variables.value(name).is_none();
        let initialised = externals.initialised.as_ref();
        let initialised = initialised.filter(|_| externals.names.may_change(name) && is_initial());
        let held = externals.held.get(name).map(HeldVariable::first);
        held.or(initialised)
    }

    /// The PLC may write variables. Returns those of them that were held.
    pub(crate) fn let_change(
        &mut self,
        is_it: impl Fn(&VariableName) -> bool,
    ) -> Vec<VariableName> {
        let held = self.externals.held.iter().filter(|(name, _)| is_it(name));
        let held: Vec<(VariableName, HeldVariable)> = held
            .map(|(name, held)| (name.clone(), held.clone()))
            .collect();
        for (name, held) in &held {
            self.externals.held.remove(name);
            if let Some(known) = self.known(name) {
                let given = self.given.get(name).cloned();
                let unknown = || {
                    Value::Unknown(Unknown::changed(
                        &name.to_string(),
                        known.as_written(),
                        held.first(),
                    ))
                };
                self.variables.set(name, given.unwrap_or_else(unknown));
            }
        }
        held.into_iter().map(|(name, _)| name).collect()
    }

    /// Whether any variable is held.
    #[inline]
    pub(crate) fn holds_any(&self) -> bool {
        self.externals.are_held()
    }

    /// Values that the program set are held again.
    pub(crate) fn hold_again(&mut self, name: &VariableName, held: Option<HeldVariable>) {
        if let Some(held) = held {
            self.externals.held.insert(name.clone(), held);
        }
    }

    /// Variables that `#INIT V.E.` set are held one by one.
    pub(crate) fn hold_initial(&mut self, names: &[VariableName]) {
        for name in names {
            if let Some(at) = self.externals.initialised.clone()
                && self.variables.value(name).is_none()
            {
                self.variables.set(name, Value::Number(0.0));
                self.hold(name, at);
            }
        }
    }

    /// The PLC may write every variable that `#INIT V.E.` set.
    pub(crate) fn end_initialisation(&mut self) {
        self.externals.initialised = None;
    }

    /// Sets a variable, with its elements and fields, to 0.
    pub(crate) fn zero(&mut self, whole: &VariableName, at: &SetAt) {
        let names = self.variables.held().into_keys();
        let parts = names.filter(|name| name.is_in(whole) && name != whole);
        for name in parts.chain([whole.clone()]).collect::<Vec<_>>() {
            self.set_variable(&name, Value::Number(0.0));
            self.hold(&name, at.clone());
        }
    }

    /// Sets every `V.E.` variable to 0 (PM/207988747).
    pub(crate) fn initialise(&mut self, at: SetAt) {
        let arrays = self.variables.names.keys().cloned();
        let names = arrays.map(VariableName::whole);
        let names = names.filter(|it| it.family() == VariableFamily::External);
        for name in names.collect::<Vec<_>>() {
            self.delete(&name);
        }
        let own: Vec<VariableName> = self.externals.names.own().cloned().collect();
        for name in own {
            self.set_variable(&name, Value::Number(0.0));
        }
        self.externals.initialised = Some(at);
    }

    fn known(&self, name: &VariableName) -> Option<Value> {
        let value = self.variables.value(name);
        value.filter(|it| !matches!(it, Value::Unknown(_)))
    }
}
