//! The values that a program finds in the variables that outlive programs, and its use of them (R2.34).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::cause::Unknown;
use super::externals::ExternalNames;
use super::location::Location;
use super::names::parts;
use super::value::Value;
use crate::machine::Parameters;
use crate::syntax::ast::Owner;

/// Values in the variables that outlive programs, if it is known which programs write them: `V.S.`, and P
/// parameters where a program start keeps them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FoundVariables {
    /// The value that each has if it exists: known if every write is of the same value.
    names: BTreeMap<String, Value>,
    /// Set where any of them may have been written.
    anything: bool,
}

impl FoundVariables {
    /// Adds the values that other programs write.
    pub(crate) fn add(&mut self, other: &Self) {
        self.anything |= other.anything;
        for (name, value) in &other.names {
            self.write(name, value.clone());
        }
    }

    /// Returns the part for some names.
    pub(crate) fn of(&self, names: &BTreeSet<String>) -> Self {
        let asked = self.names.iter().filter(|(name, _)| names.contains(*name));
        Self {
            names: asked
                .map(|(name, value)| (name.clone(), value.clone()))
                .collect(),
            anything: self.anything && !names.is_empty(),
        }
    }

    /// The names that may exist, with their values; none is known where anything may have been written.
    pub(in crate::interpreter) fn names(&self) -> impl Iterator<Item = (&String, Value)> {
        self.names.iter().map(|(name, value)| {
            let known = (!self.anything).then(|| value.clone());
            (
                name,
                known.unwrap_or_else(|| Value::Unknown(Unknown::text(name.as_str()))),
            )
        })
    }

    pub(in crate::interpreter) fn has_anything(&self) -> bool {
        self.anything
    }

    fn write(&mut self, name: &str, value: Value) {
        match self.names.get_mut(name) {
            Some(known) if *known == value => {}
            Some(known) => *known = Value::Unknown(Unknown::text(name)),
            None => {
                self.names.insert(name.to_owned(), named(name, value));
            }
        }
    }
}

/// The value as found by the next program: one that is not known is named as the variable.
fn named(name: &str, value: Value) -> Value {
    match value {
        Value::Unknown(_) => Value::Unknown(Unknown::text(name)),
        known => known,
    }
}

/// The use that a program makes of the variables that outlive programs.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct VariableUse {
    /// The names that it asks for without certainly having written them before.
    pub(crate) wanted: BTreeSet<String>,
    /// The values that it may have written.
    pub(crate) written: FoundVariables,
    parameters: Parameters,
    externals: Arc<ExternalNames>,
}

impl VariableUse {
    pub(in crate::interpreter) fn new(
        parameters: Parameters,
        externals: &Arc<ExternalNames>,
    ) -> Self {
        Self {
            parameters,
            externals: Arc::clone(externals),
            ..Self::default()
        }
    }

    /// Adds another run of the same program.
    pub(crate) fn add(&mut self, other: &Self) {
        self.wanted.extend(other.wanted.iter().cloned());
        self.written.add(&other.written);
    }

    /// Anything may be written: the effect of the program is unknown.
    pub(crate) fn write_anything(&mut self) {
        self.written.anything = true;
    }

    /// Notes a name that is asked for without an earlier write.
    pub(in crate::interpreter) fn want(&mut self, base: &str) {
        if self.outlives(base) && !self.wanted.contains(base) {
            self.wanted.insert(base.to_owned());
        }
    }

    /// A value is written, or may be.
    pub(in crate::interpreter) fn write(&mut self, location: &Location, value: &Value) {
        match location {
            Location::Parameter(Owner::Program, index) => {
                if self.parameters == Parameters::Kept {
                    self.written.write(&format!("P{index}"), value.clone());
                }
            }
            Location::Variable(name) | Location::Elements(name) => self.write_name(name, value),
            Location::Parameters => {
                self.written.anything |= self.parameters == Parameters::Kept;
            }
            Location::Parameter(Owner::Call, _) => {}
        }
    }

    /// A variable, or an element of an array, of which no value is followed from program to program.
    pub(in crate::interpreter) fn write_name(&mut self, name: &str, value: &Value) {
        let (base, subscripts) = parts(name);
        if !self.outlives(base) {
            return;
        }
        let is_whole = subscripts.is_empty();
        let value = is_whole.then(|| value.clone());
        if self.externals.is_own(base) {
            // What no program has written before is 0.
            self.written.write(base, Value::Number(0.0));
        }
        self.written
            .write(base, value.unwrap_or(Value::Unknown(Unknown::text(base))));
    }

    fn outlives(&self, base: &str) -> bool {
        let is_parameter = base.starts_with('P') && self.parameters == Parameters::Kept;
        base.starts_with("V.S.") || is_parameter || self.externals.is_own(base)
    }
}
