//! Parameters, variables and macros of a run.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::value::Value;
use crate::machine::Parameters;

/// Parameters up to this number have a place in a vector of their own.
const DIRECT: u32 = 1024;

/// Everything a program can write and read back.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Memory {
    direct: Vec<Option<Value>>,
    parameters: BTreeMap<u32, Value>,
    /// `V.P.`, `V.S.`, `V.CYC.`, `V.E.` … and array elements, by their full text.
    variables: HashMap<String, Value>,
    arrays: HashMap<String, Array>,
    /// `V.L.` of each call level.
    locals: Vec<Level>,
    macros: HashMap<String, String>,
}

/// A declared array.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Array {
    dimensions: Vec<u32>,
    /// The value of elements that were never written.
    default: Value,
}

/// What `#VAR` declared on one call level.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Level {
    values: HashMap<String, Value>,
    arrays: HashMap<String, Array>,
}

impl Level {
    fn value(&self, name: &str) -> Option<Value> {
        self.values
            .get(name)
            .cloned()
            .or_else(|| default_of(&self.arrays, name))
    }

    fn holds(&self, name: &str) -> bool {
        self.values.contains_key(name) || default_of(&self.arrays, name).is_some()
    }
}

/// The default of an array's element, where the name has the subscripts of one.
fn default_of(arrays: &HashMap<String, Array>, name: &str) -> Option<Value> {
    let (array, subscripts) = name.split_at(name.find('[')?);
    let array = arrays.get(array)?;
    let mut sizes = array.dimensions.iter();
    for part in subscripts.split(['[', ']']).filter(|part| !part.is_empty()) {
        let at: u32 = part.parse().ok()?;
        if at >= *sizes.next()? {
            return None;
        }
    }
    sizes.next().is_none().then(|| array.default.clone())
}

impl Memory {
    /// Forgets what a program start clears: P parameters unless they are kept, and `V.P.`, `V.L.`, `V.CYC.` variables
    /// (R2.33, R2.34). `V.S.`, macros (PM/206014219: valid across programs) and what the machine
    /// holds stay.
    pub(super) fn start_program(&mut self, parameters: Parameters) {
        let kept = |name: &str| {
            !is_of_run(name) || (parameters == Parameters::Kept && name.starts_with('P'))
        };
        if parameters == Parameters::Cleared {
            self.direct.clear();
            self.parameters.clear();
        }
        self.locals.clear();
        self.variables.retain(|name, _| kept(name));
        self.arrays.retain(|name, _| kept(name));
    }

    pub(super) fn parameter(&self, index: u32) -> Option<&Value> {
        if index < DIRECT {
            self.direct.get(index as usize)?.as_ref()
        } else {
            self.parameters.get(&index)
        }
    }

    pub(super) fn set_parameter(&mut self, index: u32, value: Value) {
        if index < DIRECT {
            let place = index as usize;
            if self.direct.len() <= place {
                self.direct.resize(place + 1, None);
            }
            self.direct[place] = Some(value);
        } else {
            self.parameters.insert(index, value);
        }
    }

    /// The value of a variable, the declared default of an array element that was never written.
    pub(super) fn variable(&self, name: &str) -> Option<Value> {
        if name.starts_with("V.L.") {
            return self.locals.iter().rev().find_map(|level| level.value(name));
        }
        self.variables
            .get(name)
            .cloned()
            .or_else(|| default_of(&self.arrays, name))
    }

    pub(super) fn set_variable(&mut self, name: &str, value: Value) {
        if name.starts_with("V.L.") {
            let known = self.locals.iter_mut().rev().find(|level| level.holds(name));
            if let Some(level) = known {
                level.values.insert(name.to_owned(), value);
            } else {
                self.declare_local(name, value);
            }
            return;
        }
        match self.variables.get_mut(name) {
            Some(place) => *place = value,
            None => {
                self.variables.insert(name.to_owned(), value);
            }
        }
    }

    /// The `V.L.` variables of the current level.
    fn level(&mut self) -> &mut Level {
        if self.locals.is_empty() {
            self.locals.push(Level::default());
        }
        let last = self.locals.len() - 1;
        &mut self.locals[last]
    }

    fn declare_local(&mut self, name: &str, value: Value) {
        self.level().values.insert(name.to_owned(), value);
    }

    /// Declares a scalar on the current level.
    pub(super) fn declare(&mut self, name: &str, value: Value) {
        if name.starts_with("V.L.") {
            self.declare_local(name, value);
        } else {
            self.variables.insert(name.to_owned(), value);
        }
    }

    /// Declares an array on the current level; its elements have a default value.
    pub(super) fn declare_array(&mut self, name: &str, dimensions: Vec<u32>, default: Value) {
        let array = Array {
            dimensions,
            default,
        };
        let (arrays, values) = if name.starts_with("V.L.") {
            let level = self.level();
            (&mut level.arrays, &mut level.values)
        } else {
            (&mut self.arrays, &mut self.variables)
        };
        values.retain(|key, _| !is_element_of(key, name));
        arrays.insert(name.to_owned(), array);
    }

    pub(super) fn dimensions(&self, name: &str) -> Option<&[u32]> {
        let local = self
            .locals
            .iter()
            .rev()
            .find_map(|level| level.arrays.get(name));
        local
            .or_else(|| self.arrays.get(name))
            .map(|array| array.dimensions.as_slice())
    }

    pub(super) fn delete(&mut self, name: &str) {
        let gone = |key: &str| key == name || is_element_of(key, name);
        if name.starts_with("V.L.") {
            let level = self
                .locals
                .iter_mut()
                .rev()
                .find(|level| level.holds(name) || level.arrays.contains_key(name));
            if let Some(level) = level {
                level.values.retain(|key, _| !gone(key));
                level.arrays.remove(name);
            }
            return;
        }
        self.variables.retain(|key, _| !gone(key));
        self.arrays.remove(name);
    }

    /// Some element of an array was written and nobody knows which: none is known any more.
    pub(super) fn forget_elements(&mut self, name: &str, cause: &Arc<str>) {
        let unknown = Value::Unknown(cause.clone());
        let levels = self.locals.iter_mut();
        let maps = levels
            .map(|level| (&mut level.values, &mut level.arrays))
            .chain([(&mut self.variables, &mut self.arrays)]);
        for (values, arrays) in maps {
            for (key, value) in values.iter_mut() {
                if is_element_of(key, name) {
                    *value = unknown.clone();
                }
            }
            if let Some(array) = arrays.get_mut(name) {
                array.default = unknown.clone();
            }
        }
    }

    /// Some P parameter was written and nobody knows which: none is known any more.
    pub(super) fn forget_parameters(&mut self, cause: &Arc<str>) {
        let written = self.direct.iter_mut().flatten();
        for value in written.chain(self.parameters.values_mut()) {
            *value = Value::Unknown(cause.clone());
        }
    }

    pub(super) fn delete_parameter(&mut self, index: u32) {
        self.parameters.remove(&index);
        if let Some(place) = self.direct.get_mut(index as usize) {
            *place = None;
        }
    }

    pub(super) fn enter_call(&mut self, depth: usize) {
        while self.locals.len() < depth {
            self.locals.push(Level::default());
        }
        self.locals.push(Level::default());
    }

    pub(super) fn leave_call(&mut self, depth: usize) {
        self.locals.truncate(depth);
    }

    pub(super) fn define_macro(&mut self, name: &str, code: &str) {
        let code = code.replace("\\\"", "\"");
        self.macros.insert(name.trim().to_owned(), code);
    }

    /// `#INIT MACRO TAB`
    pub(super) fn clear_macros(&mut self) {
        self.macros.clear();
    }

    pub(super) fn macro_code(&self, name: &str) -> Option<&str> {
        self.macros.get(name.trim()).map(String::as_str)
    }

    /// The `V.S.` variables, which outlive programs.
    pub(super) fn shared(&self) -> BTreeMap<String, Value> {
        self.variables
            .iter()
            .filter(|(name, _)| name.starts_with("V.S."))
            .map(|(name, value)| (name.clone(), value.clone()))
            .collect()
    }
}

fn is_element_of(key: &str, array: &str) -> bool {
    key.strip_prefix(array)
        .is_some_and(|rest| rest.starts_with('['))
}

fn is_of_run(name: &str) -> bool {
    name.starts_with("V.P.") || name.starts_with("V.CYC.") || name.starts_with('P')
}
