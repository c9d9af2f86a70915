//! Variables of the machine that programs write, `V.E.` (R2.99).
//!
//! The PLC and the user interface write them while a program runs. A value that the program sets is held until a block in
//! which the PLC acts by design; after that only the machine knows the variable.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::persistent::PersistentMap;
use crate::interpreter::values::value::Value;
use crate::syntax::{VariableFamily, VariableName};

/// The variables of the machine of which the configuration says who writes them, with all elements and fields.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct ExternalNames {
    /// Variables that keep their values while a program runs (R14.1).
    stable: BTreeSet<VariableName>,
    /// Variables that only programs write (R2.99).
    own: BTreeSet<VariableName>,
}

impl ExternalNames {
    pub(crate) fn new(stable: &[String], own: &[String]) -> Self {
        let names = |given: &[String]| given.iter().map(|name| VariableName::read(name)).collect();
        Self {
            stable: names(stable),
            own: names(own),
        }
    }

    /// Returns whether only programs write a variable.
    pub(crate) fn is_own(&self, name: &VariableName) -> bool {
        is_named(&self.own, name)
    }

    /// Returns whether only programs write a variable or an array.
    pub(crate) fn is_own_array(&self, array: &str) -> bool {
        !self.own.is_empty() && self.is_own(&VariableName::whole(array.to_owned()))
    }

    /// Returns whether a variable keeps its value while a program runs, unless the program writes it.
    pub(crate) fn is_stable(&self, name: &VariableName) -> bool {
        is_named(&self.stable, name) || self.is_own(name)
    }

    /// Returns whether the PLC may write a variable while a program runs.
    pub(crate) fn may_change(&self, name: &VariableName) -> bool {
        name.family() == VariableFamily::External && !self.is_stable(name)
    }

    /// Returns the variables that only programs write.
    pub(crate) fn own(&self) -> impl Iterator<Item = &VariableName> {
        self.own.iter()
    }
}

/// Use of the values that the program set in `V.E.` variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum HeldValues {
    /// The values count.
    #[default]
    Taken,
    /// The values may have changed.
    Doubted,
}

/// Facts about `V.E.` variables beside their values.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ExternalVariables {
    pub(crate) names: Arc<ExternalNames>,
    /// The values of the program that variables may still have.
    pub(crate) held: PersistentMap<VariableName, HeldVariable>,
    /// The block that set every other one to 0.
    pub(crate) initialised: Option<SetAt>,
}

impl ExternalVariables {
    /// Returns whether any variable is held.
    #[inline]
    fn are_held(&self) -> bool {
        !self.held.is_empty() || self.initialised.is_some()
    }

    /// Releases the values that the program set, whose place another value takes, and returns them.
    #[inline]
    pub(crate) fn release(&mut self, name: &VariableName) -> Option<HeldVariable> {
        if self.held.is_empty() {
            return None;
        }
        self.held.remove(name)
    }

    /// Returns whether a variable without a value is 0: only programs write it and none has since the start of the
    /// control, or `#INIT V.E.` has set it.
    pub(crate) fn is_zero(&self, name: &VariableName) -> bool {
        self.names.is_own(name) || self.initialised.is_some() && self.names.may_change(name)
    }

    /// Merges another way: a variable may have the values that the program set on either.
    pub(crate) fn join(&mut self, other: &Self) {
        for name in self.held.differing(&other.held) {
            let both = [&*self, other].map(|it| it.held_or_initial(&name));
            if let Some(joined) = both.into_iter().flatten().reduce(HeldVariable::join) {
                self.held.insert(name, joined);
            }
        }
        if self.initialised != other.initialised {
            self.initialised = None;
        }
    }

    fn held_or_initial(&self, name: &VariableName) -> Option<HeldVariable> {
        let initial = || {
            let at = self.initialised.clone()?;
            Some(HeldVariable::of(Value::Number(0.0), at))
        };
        self.held.get(name).cloned().or_else(initial)
    }
}

/// Most values of a variable that are remembered; with more of them, each counts as set.
const MAX_VALUES: usize = 8;

/// The values that the program set in a variable, one on each way, since the PLC acted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct HeldVariable {
    /// The first block that set it.
    first: SetAt,
    /// Each value, with the first block that set it; none where there are too many.
    values: Vec<(Value, SetAt)>,
}

impl HeldVariable {
    /// Returns a variable that the program has set.
    pub(crate) fn of(value: Value, at: SetAt) -> Self {
        Self {
            first: at.clone(),
            values: vec![(value, at)],
        }
    }

    /// Returns the first block that set it.
    pub(crate) fn first(&self) -> &SetAt {
        &self.first
    }

    /// Returns the part that remains where a condition determines the value; `None` if the value is impossible.
    pub(crate) fn with(&self, value: &Value) -> Option<Self> {
        let mut values = self.values.iter();
        let at = match values.find(|(known, _)| known == value) {
            Some((_, at)) => at,
            None if self.values.is_empty() => &self.first,
            None => return None,
        };
        Some(Self::of(value.clone(), at.clone()))
    }

    fn join(self, other: Self) -> Self {
        let is_any = self.values.is_empty() || other.values.is_empty();
        let mut values = self.values;
        for (value, at) in other.values {
            match values.iter_mut().find(|(known, _)| *known == value) {
                Some((_, known)) if *known > at => *known = at,
                Some(_) => {}
                None => values.push((value, at)),
            }
        }
        if is_any || values.len() > MAX_VALUES {
            values.clear();
        }
        Self {
            first: self.first.min(other.first),
            values,
        }
    }
}

/// Returns whether names hold a variable, or the array or structure that it belongs to.
fn is_named(names: &BTreeSet<VariableName>, name: &VariableName) -> bool {
    !names.is_empty() && name.is_any(|it| names.contains(it))
}

/// The block that set a variable.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct SetAt {
    pub(crate) file: Arc<str>,
    /// Line, from 1.
    pub(crate) line: u32,
}

impl Memory {
    /// Takes over what the configuration says of the writers of `V.E.` variables.
    pub(crate) fn describe_externals(&mut self, names: &Arc<ExternalNames>) {
        self.externals.names = Arc::clone(names);
    }

    /// Returns whether the PLC may write a variable, and no value from the user says what it writes.
    pub(crate) fn may_change(&self, name: &VariableName) -> bool {
        self.externals.names.may_change(name) && self.given.get(name).is_none()
    }

    /// Holds the value of a variable that the program has set, until the PLC acts.
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

    /// Lets the PLC write variables, and returns those of them that were held. Returns those of them that were held.
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

    /// Returns whether any variable is held.
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

    /// Ends `#INIT V.E.`: the PLC may write every variable that it set.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_stands_for_its_elements_and_fields() {
        // R2.99
        let names = ExternalNames::new(&["v.e.MATERIAL".to_owned()], &["V.E.LIST".to_owned()]);
        let name = VariableName::read;
        for own in ["V.E.LIST", "V.E.LIST[2]", "V.E.LIST[2].X", "V.E.LIST.N"].map(name) {
            assert!(names.is_own(&own) && !names.may_change(&own), "{own}");
        }
        let (lists, material) = (name("V.E.LISTS"), name("V.E.MATERIAL"));
        assert!(!names.is_own(&lists) && names.may_change(&lists));
        assert!(names.is_stable(&material) && !names.is_own(&material));
        assert!(!names.may_change(&name("V.P.A")));
    }
}
