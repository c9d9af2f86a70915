//! Parameters, variables and macros of a run. Copies share their values until one of them changes.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::interpreter::values::externals::{ExternalVariables, HeldVariable};
use crate::interpreter::values::handover::FoundVariables;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::names::{
    Array, Declared, Misuse, NamedVariable, Sure, VariableNames, Weight, compare, join_value,
    weight,
};
use crate::interpreter::values::persistent::PersistentMap;
use crate::interpreter::values::value::{Value, ValueType};
use crate::machine::Parameters;
use crate::syntax::ast::Owner;
use crate::syntax::{VariableFamily, VariableName};

/// Memory of everything that a program can write and read back.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Memory {
    pub(crate) parameters: ParameterValues,
    /// Set when an unknown parameter was written: the value that decides which.
    pub(crate) lost: Option<Unknown>,
    /// `V.P.`, `V.S.`, `V.CYC.`, `V.E.` … and arrays of P parameters.
    pub(crate) variables: VariableNames,
    /// Values given by the user for parameters and variables that no program wrote.
    pub(crate) given: PersistentMap<VariableName, Value>,
    /// Set when any of those that programs write may have been written: the text that caused it.
    unknown_names: Option<Unknown>,
    /// The locations that outlive programs, may exist, and were not certainly written since.
    pub(crate) found: BTreeSet<Location>,
    /// Whether a `V.S.` variable that no known program writes may still exist.
    may_find: bool,
    /// `V.E.` variables that the PLC writes, too (R2.99).
    pub(crate) externals: ExternalVariables,
    /// `V.L.` of each call level.
    locals: Vec<VariableNames>,
    /// The code of each macro, or the cause why it is unknown.
    pub(crate) macros: PersistentMap<String, Value>,
    macro_version: MacroVersion,
    /// The weight of macros.
    weight: Weight,
}

/// Rises with every change of the macros. It is no part of their state, which returns to what it was.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
#[serde(transparent)]
struct MacroVersion(u64);

impl MacroVersion {
    fn rise(&mut self) {
        self.0 = self.0.wrapping_add(1);
    }
}

impl PartialEq for MacroVersion {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Memory {
    /// Forgets what a program start clears: P parameters unless they are kept, and `V.P.`, `V.L.`, `V.CYC.` variables
    /// (R2.33, R2.34). `V.S.`, macros (PM/206014219: valid across programs) and what the machine
    /// holds stay.
    pub(crate) fn start_program(&mut self, parameters: Parameters) {
        if parameters == Parameters::Cleared {
            self.parameters = ParameterValues::default();
            self.lost = None;
        }
        self.unknown_names = None;
        self.locals.clear();
        let names = self.variables.names.iter();
        let names = names.filter(|(array, _)| is_kept(array, parameters));
        let names = names.map(|(name, variable)| (name.clone(), variable.clone()));
        self.variables.names = names.collect();
        self.variables.weight = Weight(self.variables.weigh());
    }

    /// Returns the amount held, in values and shares of texts (R2.60).
    pub(crate) fn weight(&self) -> usize {
        let levels = self.locals.iter().chain([&self.variables]);
        let weights = levels.map(|names| names.weight.0);
        weights
            .chain([self.weight.0, self.parameters.weight()])
            .fold(0, usize::saturating_add)
    }

    pub(crate) fn parameter(&self, index: u32) -> Option<Value> {
        match (self.parameters.get(index), &self.lost) {
            (Some(value), _) => Some(value.clone()),
            (None, Some(cause)) => Some(Value::Unknown(cause.clone())),
            (None, None) => None,
        }
    }

    pub(crate) fn set_parameter(&mut self, index: u32, value: Value) {
        self.found
            .remove(&Location::Parameter(Owner::Program, index));
        self.parameters.set(index, value);
    }

    /// Returns the value of a variable, the declared default of an array element that was never written.
    pub(crate) fn variable(&self, name: &VariableName) -> Option<Value> {
        if name.family().is_of_level() {
            let mut levels = self.locals.iter().rev();
            let found = levels.find_map(|level| level.value(name));
            if found.is_some() || name.family() == VariableFamily::Local {
                return found;
            }
        }
        let unknown = self.unknown_names.as_ref();
        let unknown = unknown.filter(|_| self.is_written(name));
        let written = self.variables.value(name);
        written.or_else(|| match unknown {
            Some(cause) => Some(Value::Unknown(cause.clone())),
            None if self.may_find(name) => Some(Value::Unknown(Unknown::text(name.array()))),
            None => {
                let is_zero = self.externals.is_zero(name) && self.given.get(name).is_none();
                is_zero.then_some(Value::Number(0.0))
            }
        })
    }

    /// Returns whether only programs write the variable of a name.
    fn is_written(&self, name: &VariableName) -> bool {
        name.family().is_written() || self.externals.names.is_own(name)
    }

    /// Returns whether a name that nothing is known about may exist.
    fn may_find(&self, name: &VariableName) -> bool {
        let is_kept = name.family() == VariableFamily::Shared || self.externals.names.is_own(name);
        self.may_find && is_kept && self.given.get(name).is_none()
    }

    /// Sets what the program finds in variables that outlive programs. Values from the user take precedence.
    pub(crate) fn find(&mut self, found: &FoundVariables) {
        self.may_find = found.has_anything();
        for (location, value) in found.values() {
            if self.given.get(&location.name()).is_some() {
                continue;
            }
            match location {
                Location::Variable(name) => self.find_variable(name, value),
                _ => self.write(location, value),
            }
            self.found.insert(location.clone());
        }
    }

    /// Adds a variable or an array that is found: of an array no element is known but those that the user gave.
    fn find_variable(&mut self, name: &VariableName, value: Value) {
        if let Value::Unknown(cause) = &value {
            self.variables.havoc_elements(name.array(), cause);
        }
        self.variables.set(name, value);
        let given = self.given.from(name);
        let given = given.take_while(|(key, _)| key.array() == name.array());
        for (key, value) in given.filter(|(key, _)| key.is_element()) {
            self.variables.set(key, value.clone());
        }
    }

    /// Returns whether a parameter or a whole variable may exist and the program has not certainly written it.
    pub(crate) fn is_found(&self, location: &Location) -> bool {
        let is_new = |name: &VariableName| {
            self.may_find(name) && self.variables.names.get(name.array()).is_none()
        };
        self.found.contains(location)
            || matches!(location, Location::Variable(name) if is_new(name))
    }

    /// Returns whether a parameter or a whole variable still has the value that the program found, or none.
    pub(crate) fn is_unwritten(&self, location: &Location) -> bool {
        let holds = match location {
            Location::Parameter(_, index) => self.parameters.get(*index).is_some(),
            _ => false,
        };
        let names = &self.variables.names;
        self.is_found(location) || !(holds || names.get(location.name().array()).is_some())
    }

    /// Sets a value given by the user (R2.36). Values that programs write take precedence.
    pub(crate) fn give(&mut self, name: VariableName, value: Value) {
        if !self.is_written(&name) {
            self.set_variable(&name, value.clone());
        }
        self.given.insert(name, value);
    }

    /// Returns the value that the user gave.
    pub(crate) fn given(&self, name: &VariableName) -> Option<&Value> {
        self.given.get(name)
    }

    pub(crate) fn set_variable(&mut self, name: &VariableName, value: Value) {
        if !name.family().is_of_level() {
            self.lose_found(name);
            self.externals.release(name);
            self.variables.set(name, value);
            return;
        }
        let holds = |level: &&mut VariableNames| level.value(name).is_some();
        match self.locals.iter_mut().rev().find(holds) {
            Some(level) => level.set(name, value),
            None => self.level().set(name, value),
        }
    }

    /// Returns the variables of the current level.
    fn level(&mut self) -> &mut VariableNames {
        if self.locals.is_empty() {
            self.locals.push(VariableNames::default());
        }
        let last = self.locals.len() - 1;
        &mut self.locals[last]
    }

    /// Returns the names of the kind that a declaration of the name belongs to.
    fn declared(&mut self, name: &VariableName) -> &mut VariableNames {
        if name.family().is_of_level() {
            self.level()
        } else {
            &mut self.variables
        }
    }

    /// Records that a variable is no longer as an earlier program left it.
    fn lose_found(&mut self, name: &VariableName) {
        if !self.found.is_empty() {
            self.found.remove(&Location::named(name.clone()));
        }
    }

    /// Declares a P parameter; one that an earlier program may have left may keep its value.
    pub(crate) fn declare_parameter(&mut self, index: u32, value: Value) {
        let location = Location::Parameter(Owner::Program, index);
        let mut start = Some(value);
        if self.found.contains(&location) {
            let cause = Unknown::text(location.to_string());
            join_value(&mut start, self.parameter(index).as_ref(), &cause);
        }
        if let Some(value) = start {
            self.set_parameter(index, value);
        }
    }

    /// Declares a scalar on the current level.
    pub(crate) fn declare(&mut self, name: &VariableName, value: Value) {
        self.lose_found(name);
        self.declared(name).set(name, value);
    }

    /// Returns the variable of a declared name, if it outlives programs and exists, or may.
    pub(crate) fn before_declaration(&self, name: &VariableName) -> Option<NamedVariable> {
        let held = self.variables.names.get(name.array());
        let held = held.filter(|_| name.family() == VariableFamily::Shared);
        held.cloned().or_else(|| {
            let cause = Unknown::text(name.array());
            self.may_find(name).then(|| NamedVariable {
                scalar: Some(Value::Unknown(cause.clone())),
                lost: Some(cause),
                ..NamedVariable::default()
            })
        })
    }

    /// Records the declaration of a variable that existed before. Whether the start value replaces its present value is
    /// not documented, so it is unknown where the two differ (R2.34); the user's value decides.
    pub(crate) fn declare_anew(&mut self, name: &VariableName, before: &NamedVariable) {
        let cause = Unknown::text(name.array());
        self.variables.join_name(name.array(), before, &cause);
        if let Some(given) = self.given.get(name)
            && let Some(Value::Unknown(_)) = self.variables.value(name)
        {
            self.variables.set(name, given.clone());
        }
    }

    /// Declares an array on the current level; its elements have a default value.
    pub(crate) fn declare_array(
        &mut self,
        name: &VariableName,
        dimensions: Vec<Option<u32>>,
        default: Value,
    ) {
        let array = Array {
            dimensions,
            default,
        };
        self.lose_found(name);
        self.declared(name).declare_array(name.array(), array);
    }

    /// Records the certain declaration of a variable with a type.
    pub(crate) fn set_declared(&mut self, name: &VariableName, kind: ValueType) {
        let names = self.declared(name);
        names.set_declared(
            name.array(),
            Declared {
                kind,
                certainty: Sure::Certain,
            },
        );
    }

    /// Returns the declaration of a variable or an array, in the level of the program or around it.
    pub(crate) fn declaration(&self, name: &VariableName) -> Option<Declared> {
        let levels = self.locals.iter().rev();
        let mut levels = levels.filter(|_| name.family().is_of_level());
        let local = levels.find_map(|level| level.names.get(name.array()));
        local
            .or_else(|| self.variables.names.get(name.array()))?
            .declared
    }

    /// Returns the form in which the current level declares the name; `None` if it does not.
    pub(crate) fn is_declared_here(&self, name: &VariableName) -> Option<Declared> {
        let level = if name.family().is_of_level() {
            self.locals.last()?
        } else {
            &self.variables
        };
        level.names.get(name.array())?.declared
    }

    /// Returns the variable of a name that only a level around the current one has.
    pub(crate) fn of_outer_level(&self, name: &VariableName) -> Option<&NamedVariable> {
        let (current, outer) = self.locals.split_last()?;
        let found = |level: &VariableNames| level.names.get(name.array()).is_some();
        let mut outer = outer.iter().rev().filter(|_| !found(current));
        outer.find_map(|level| level.names.get(name.array()))
    }

    /// Returns whether nothing of the name is known, or may be there.
    pub(crate) fn is_absent(&self, name: &VariableName) -> bool {
        let mut levels = self.locals.iter().chain([&self.variables]);
        self.unknown_names.is_none()
            && !self.may_find(name)
            && levels.all(|level| level.names.get(name.array()).is_none())
    }

    /// Returns the misuse in a name that does not fit its variable.
    pub(crate) fn misuse(&self, name: &VariableName) -> Option<Misuse> {
        let array = self.array(name.array());
        match (name.is_element(), array) {
            (false, Some(_)) => Some(Misuse::NoIndex),
            (true, Some(array)) if array.has(name.subscripts()) => None,
            (true, Some(array)) => {
                let numbers = name.subscripts().numbers()?;
                let count = array.dimensions.len();
                Some(if numbers.len() == count {
                    Misuse::Outside
                } else {
                    Misuse::OtherCount(count)
                })
            }
            (true, None) => self.declaration(name).map(|_| Misuse::NoArray),
            (false, None) => None,
        }
    }

    /// Returns a declared array.
    pub(crate) fn array(&self, name: &str) -> Option<&Array> {
        let mut levels = self.locals.iter().rev();
        let local = levels.find_map(|level| level.array(name));
        local.or_else(|| self.variables.array(name))
    }

    pub(crate) fn delete(&mut self, name: &VariableName) {
        if !name.family().is_of_level() {
            self.lose_found(name);
            self.externals.release(name);
            self.variables.delete(name);
            return;
        }
        let holds = |level: &&mut VariableNames| {
            let variable = level.names.get(name.array());
            variable.is_some_and(|variable| {
                !name.is_element() || variable.element(name.subscripts()).is_some()
            })
        };
        if let Some(level) = self.locals.iter_mut().rev().find(holds) {
            level.delete(name);
        }
    }

    /// Makes all elements of an array unknown, since it is not known which one was written.
    pub(crate) fn havoc_elements(&mut self, name: &VariableName, cause: &Unknown) {
        let array = name.array();
        let levels = self.locals.iter_mut().chain([&mut self.variables]);
        let holding = levels.filter(|names| names.names.get(array).is_some());
        let known = holding.map(|names| names.havoc_elements(array, cause));
        if known.count() == 0 {
            self.declared(name).havoc_elements(array, cause);
        }
    }

    /// Makes all P parameters unknown, since it is not known which one was written.
    fn havoc_parameters(&mut self, cause: &Unknown) {
        self.parameters = ParameterValues::default();
        self.lost = Some(cause.clone());
    }

    /// Discards the values of everything that a program can write. Values that only the machine holds are kept.
    pub(crate) fn havoc_all(&mut self, cause: &Unknown) {
        self.havoc_parameters(cause);
        self.unknown_names = Some(cause.clone());
        let levels = self.locals.iter_mut().chain([&mut self.variables]);
        for names in levels {
            let externals = &self.externals.names;
            let is_written = |array: &&String| {
                VariableFamily::of(array).is_written() || externals.is_own_array(array)
            };
            let written = names.names.keys().filter(is_written);
            for name in written.cloned().collect::<Vec<String>>() {
                names.names.slot(name, NamedVariable::default).havoc(cause);
            }
            names.weight = Weight(names.weigh());
        }
    }

    /// Records that a missing program may have written what the run never wrote.
    pub(crate) fn miss(&mut self, cause: &Unknown) {
        self.lost.get_or_insert_with(|| cause.clone());
        self.unknown_names.get_or_insert_with(|| cause.clone());
    }

    /// Releases a variable that is held. Returns what the program had set.
    pub(crate) fn release(&mut self, name: &VariableName) -> Option<HeldVariable> {
        self.externals.release(name)
    }

    pub(crate) fn delete_parameter(&mut self, index: u32) {
        self.found
            .remove(&Location::Parameter(Owner::Program, index));
        self.parameters.remove(index);
    }

    /// Returns the names whose numbers differ in another memory; `None` where anything else does, or more than a few.
    pub(crate) fn differing_numbers(&self, other: &Self) -> Option<Vec<Location>> {
        let same = self.lost == other.lost
            && self.externals == other.externals
            && self.unknown_names == other.unknown_names
            && self.locals.len() == other.locals.len()
            && self.has_macros_of(other);
        if !same {
            return None;
        }
        let mut differing = Vec::new();
        let parameter = |index| Location::Parameter(Owner::Program, index);
        for index in self.parameters.differing(&other.parameters) {
            let mine = self.parameters.get(index)?;
            compare(
                mine,
                other.parameters.get(index)?,
                || parameter(index),
                &mut differing,
            )?;
        }
        let levels = self.locals.iter().zip(&other.locals);
        for (mine, theirs) in levels.chain([(&self.variables, &other.variables)]) {
            mine.differing(theirs, &mut differing)?;
        }
        Some(differing)
    }

    /// Makes unknown what differs in another memory where two ways join (R14.1). Returns the number
    /// of differences.
    pub(crate) fn join(&mut self, other: &Self, cause: &Unknown) -> usize {
        let Self {
            parameters,
            lost,
            variables,
            // Values from the user are the same on all ways.
            given: _,
            unknown_names,
            found,
            may_find,
            externals,
            locals,
            macros,
            macro_version,
            weight: _,
        } = other;
        let indices = self.parameters.differing(parameters);
        let mut differing = indices.len();
        for index in indices {
            let mut mine = self.parameter(index);
            join_value(&mut mine, other.parameter(index).as_ref(), cause);
            if let Some(value) = mine {
                self.set_parameter(index, value);
            }
        }
        if self.lost.is_none() {
            self.lost.clone_from(lost);
        }
        if self.unknown_names.is_none() {
            self.unknown_names.clone_from(unknown_names);
        }
        self.found.extend(found.iter().cloned());
        self.may_find |= may_find;
        differing += self.variables.join(variables, cause);
        self.externals.join(externals);
        while self.locals.len() < locals.len() {
            self.locals.push(VariableNames::default());
        }
        let none = VariableNames::default();
        for (place, mine) in self.locals.iter_mut().enumerate() {
            differing += mine.join(locals.get(place).unwrap_or(&none), cause);
        }
        let names = self.macros.differing(macros);
        for name in &names {
            self.havoc_macro(name, cause);
        }
        if !names.is_empty() {
            self.macro_version.0 = self.macro_version.0.max(macro_version.0);
            self.macro_version.rise();
        }
        differing + names.len()
    }

    /// Returns the variables that are read not only by the program and that differ in another memory, beyond what the
    /// PLC may have changed.
    pub(crate) fn differing_variables(&self, other: &Self) -> BTreeSet<String> {
        let names = self.variables.names.differing(&other.variables.names);
        let is_lost = |memory: &Self, name: &VariableName| {
            let value = memory.variables.value(name);
            matches!(value, Some(Value::Unknown(_))) && memory.externals.names.may_change(name)
        };
        let names = names.into_iter().map(VariableName::whole);
        names
            .filter(|name| name.family().is_read_by_others())
            .filter(|name| !is_lost(self, name) && !is_lost(other, name))
            .map(|name| name.to_string())
            .collect()
    }

    /// Writes a value; one that may be in several locations is not known.
    pub(crate) fn write(&mut self, location: &Location, value: Value) {
        match (location, value) {
            (Location::Parameter(_, index), value) => self.set_parameter(*index, value),
            (Location::Variable(name), value) => self.set_variable(name, value),
            (Location::Elements(name), Value::Unknown(cause)) => self.havoc_elements(name, &cause),
            (Location::Parameters, Value::Unknown(cause)) => self.havoc_parameters(&cause),
            (Location::Elements(_) | Location::Parameters, _) => {}
        }
    }

    /// Returns whether the macros of another memory are the same.
    fn has_macros_of(&self, other: &Self) -> bool {
        self.macros == other.macros
    }

    pub(crate) fn enter_call(&mut self, depth: usize) {
        while self.locals.len() < depth {
            self.locals.push(VariableNames::default());
        }
        self.locals.push(VariableNames::default());
    }

    pub(crate) fn leave_call(&mut self, depth: usize) {
        self.locals.truncate(depth);
    }

    pub(crate) fn define_macro(&mut self, name: &str, code: &str) {
        self.hold_macro(name.trim(), Value::Text(unescaped(code).into()));
    }

    pub(crate) fn hold_macro(&mut self, name: &str, code: Value) {
        self.macro_version.rise();
        self.weight.add(weight(name.len(), &code));
        if let Some(before) = self.macros.insert(name.to_owned(), code) {
            self.weight.take(weight(name.len(), &before));
        }
    }

    /// Records that a macro may have been defined, or redefined (R2.51).
    pub(crate) fn havoc_macro(&mut self, name: &str, cause: &Unknown) {
        if !matches!(self.macros.get(name.trim()), Some(Value::Unknown(_))) {
            self.hold_macro(name.trim(), Value::Unknown(cause.clone()));
        }
    }

    /// Records that any of the macros may have been taken away, or redefined, except for those that `stays` names with
    /// their code.
    pub(crate) fn havoc_macros(&mut self, cause: &Unknown, stays: impl Fn(&str, &str) -> bool) {
        let goes = |(name, code): &(&String, &Value)| match code {
            Value::Text(code) => !stays(name, code),
            Value::Number(_) | Value::Unknown(_) => false,
        };
        let names = self
            .macros
            .iter()
            .filter(goes)
            .map(|(name, _)| name.clone());
        for name in names.collect::<Vec<String>>() {
            self.havoc_macro(&name, cause);
        }
    }

    /// Clears the macros: `#INIT MACRO TAB`.
    pub(crate) fn clear_macros(&mut self) {
        self.macro_version.rise();
        let weights = self
            .macros
            .iter()
            .map(|(name, code)| weight(name.len(), code));
        self.weight.take(weights.sum::<usize>());
        self.macros.clear();
    }

    /// Returns the code of a macro, which may be unknown.
    pub(crate) fn macro_code(&self, name: &str) -> Option<&Value> {
        self.macros.get(name.trim())
    }

    /// Returns the meaning of a quoted name: the code of its macro, or the text itself.
    pub(crate) fn macro_or_text(&self, name: &str) -> Value {
        let code = self.macro_code(name).cloned();
        code.unwrap_or_else(|| Value::Text(name.into()))
    }

    /// Returns the `V.S.` variables, which outlive programs.
    pub(crate) fn shared(&self) -> BTreeMap<String, Value> {
        let held = self.variables.held().into_iter();
        let shared = held.filter(|(name, _)| {
            name.family() == VariableFamily::Shared || self.externals.names.is_own(name)
        });
        shared
            .map(|(name, value)| (name.to_string(), value))
            .collect()
    }

    /// Returns the parameters, and the variables that the running program sees.
    pub(crate) fn all(&self) -> Vec<(String, Value)> {
        let parameters = self.parameters.iter();
        let parameters = parameters.map(|(index, value)| (format!("P{index}"), value.clone()));
        let mut variables = self.variables.held();
        for level in &self.locals {
            variables.append(&mut level.held());
        }
        let variables = variables.into_iter();
        let variables = variables.map(|(name, value)| (name.to_string(), value));
        parameters.chain(variables).collect()
    }
}

/// Returns the code of a macro as it is used.
fn unescaped(code: &str) -> String {
    code.replace("\\\"", "\"")
}

/// Returns whether a program start leaves a variable or array.
pub(crate) fn is_kept(array: &str, parameters: Parameters) -> bool {
    let family = VariableFamily::of(array);
    !family.is_of_run() || (parameters == Parameters::Kept && family == VariableFamily::Parameter)
}

/// Number below which parameters are found without a search.
const DIRECT: u32 = 1024;

/// Parameters that are copied together.
const PAGE: usize = 16;

type Page = [Option<Value>; PAGE];

/// The values of P parameters. Copies share the pages in which nothing was written since.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ParameterValues {
    pages: Vec<Shared<Page>>,
    further: PersistentMap<u32, Value>,
    /// Weight of the texts among the further ones.
    texts: Weight,
}

impl ParameterValues {
    pub(crate) fn get(&self, index: u32) -> Option<&Value> {
        if index >= DIRECT {
            return self.further.get(&index);
        }
        let (page, place) = page_of(index);
        self.pages.get(page)?[place].as_ref()
    }

    pub(crate) fn set(&mut self, index: u32, value: Value) {
        if index >= DIRECT {
            self.texts.add(weight(0, &value) - 1);
            if let Some(before) = self.further.insert(index, value) {
                self.texts.take(weight(0, &before) - 1);
            }
            return;
        }
        let (page, place) = page_of(index);
        if self.pages.len() <= page {
            self.pages.resize(page + 1, Shared::default());
        }
        self.pages[page][place] = Some(value);
    }

    pub(crate) fn remove(&mut self, index: u32) {
        if let Some(before) = self.further.remove(&index) {
            self.texts.take(weight(0, &before) - 1);
        }
        let (page, place) = page_of(index);
        if let Some(page) = self.pages.get_mut(page) {
            page[place] = None;
        }
    }

    /// Returns the parameters that have a value, in the order of their numbers.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, &Value)> {
        let direct = (0..).zip(self.pages.iter().flat_map(|page| page.iter()));
        let direct = direct.filter_map(|(index, value)| Some((index, value.as_ref()?)));
        let further = self.further.iter().map(|(index, value)| (*index, value));
        direct.chain(further)
    }

    /// Returns the numbers whose values differ in another set, or that only one of the two has.
    pub(crate) fn differing(&self, other: &Self) -> Vec<u32> {
        let none = Shared::default();
        let mut found = Vec::new();
        for number in 0..self.pages.len().max(other.pages.len()) {
            let [mine, theirs] = [self, other].map(|it| it.pages.get(number).unwrap_or(&none));
            if mine.is_copy_of(theirs) {
                continue;
            }
            let indices = (0..DIRECT).skip(number * PAGE);
            let pairs = indices.zip(mine.iter().zip(theirs.iter()));
            let differing = pairs.filter(|(_, (mine, theirs))| mine != theirs);
            found.extend(differing.map(|(index, _)| index));
        }
        found.extend(self.further.differing(&other.further));
        found
    }

    pub(crate) fn weight(&self) -> usize {
        let count = self.pages.len() * PAGE + self.further.len();
        count.saturating_add(self.texts.0)
    }
}

fn page_of(index: u32) -> (usize, usize) {
    let index = index as usize;
    (index / PAGE, index % PAGE)
}

/// A value that copies share until one of them changes.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Shared<T>(Arc<T>);

impl<T> Shared<T> {
    /// Returns whether two are copies of each other, neither of which has changed since.
    fn is_copy_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T: PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        self.is_copy_of(other) || self.0 == other.0
    }
}

impl<T> Deref for Shared<T> {
    type Target = T;

    #[inline]
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: Clone> DerefMut for Shared<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut T {
        Arc::make_mut(&mut self.0)
    }
}
