//! Parameters, variables and macros of a run.

use std::collections::{BTreeMap, HashMap};

use serde::{Deserialize, Serialize};

use super::value::Value;

/// Parameters up to this number have a place in a vector of their own.
const DIRECT: u32 = 1024;

/// Everything a program can write and read back.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Memory {
    direct: Vec<Option<Value>>,
    parameters: BTreeMap<u32, Value>,
    /// `V.P.`, `V.S.`, `V.CYC.`, `V.E.` … and array elements, by their full text.
    variables: HashMap<String, Value>,
    /// Dimensions of declared arrays.
    arrays: HashMap<String, Vec<u32>>,
    /// `V.L.` of each call level.
    locals: Vec<HashMap<String, Value>>,
    macros: HashMap<String, String>,
}

impl Memory {
    /// Forgets what a program start clears: P parameters and `V.P.`, `V.L.`, `V.CYC.` variables
    /// (R2.33, R2.34). `V.S.` and what the machine holds stay.
    pub(super) fn start_program(&mut self) {
        self.direct.clear();
        self.parameters.clear();
        self.locals.clear();
        self.macros.clear();
        self.variables.retain(|name, _| !is_of_run(name));
        self.arrays.retain(|name, _| !is_of_run(name));
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
            return self
                .locals
                .iter()
                .rev()
                .find_map(|level| level.get(name))
                .cloned();
        }
        self.variables
            .get(name)
            .cloned()
            .or_else(|| self.is_element(name).then_some(Value::Number(0.0)))
    }

    /// Whether a name with subscripts is an element of a declared array.
    fn is_element(&self, name: &str) -> bool {
        let Some(open) = name.find('[') else {
            return false;
        };
        let (array, subscripts) = name.split_at(open);
        let Some(dimensions) = self.arrays.get(array) else {
            return false;
        };
        let found: Vec<Option<u32>> = subscripts
            .split(['[', ']'])
            .filter(|part| !part.is_empty())
            .map(|part| part.parse().ok())
            .collect();
        found.len() == dimensions.len()
            && found
                .iter()
                .zip(dimensions)
                .all(|(at, size)| at.is_some_and(|at| at < *size))
    }

    pub(super) fn set_variable(&mut self, name: &str, value: Value) {
        if name.starts_with("V.L.") {
            let known = self
                .locals
                .iter_mut()
                .rev()
                .find(|level| level.contains_key(name));
            if let Some(level) = known {
                level.insert(name.to_owned(), value);
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

    fn declare_local(&mut self, name: &str, value: Value) {
        if self.locals.is_empty() {
            self.locals.push(HashMap::new());
        }
        if let Some(level) = self.locals.last_mut() {
            level.insert(name.to_owned(), value);
        }
    }

    /// Declares a scalar on the current level.
    pub(super) fn declare(&mut self, name: &str, value: Value) {
        if name.starts_with("V.L.") {
            self.declare_local(name, value);
        } else {
            self.variables.insert(name.to_owned(), value);
        }
    }

    pub(super) fn declare_array(&mut self, name: &str, dimensions: Vec<u32>) {
        self.arrays.insert(name.to_owned(), dimensions);
    }

    pub(super) fn dimensions(&self, name: &str) -> Option<&[u32]> {
        self.arrays.get(name).map(Vec::as_slice)
    }

    pub(super) fn delete(&mut self, name: &str) {
        if name.starts_with("V.L.") {
            for level in &mut self.locals {
                level.remove(name);
            }
        }
        self.variables.remove(name);
        self.arrays.remove(name);
        let elements = format!("{name}[");
        self.variables.retain(|key, _| !key.starts_with(&elements));
    }

    pub(super) fn delete_parameter(&mut self, index: u32) {
        self.parameters.remove(&index);
        if let Some(place) = self.direct.get_mut(index as usize) {
            *place = None;
        }
    }

    pub(super) fn enter_call(&mut self, depth: usize) {
        while self.locals.len() < depth {
            self.locals.push(HashMap::new());
        }
        self.locals.push(HashMap::new());
    }

    pub(super) fn leave_call(&mut self, depth: usize) {
        self.locals.truncate(depth);
    }

    pub(super) fn define_macro(&mut self, name: &str, code: &str) {
        self.macros.insert(name.to_owned(), code.to_owned());
    }

    pub(super) fn macro_code(&self, name: &str) -> Option<&str> {
        self.macros.get(name).map(String::as_str)
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

fn is_of_run(name: &str) -> bool {
    name.starts_with("V.P.") || name.starts_with("V.CYC.") || name.starts_with('P')
}
