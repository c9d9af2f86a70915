//! The values that a program finds in the variables that outlive programs, and its use of them (R2.34).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::cause::Unknown;
use super::externals::ExternalNames;
use super::location::Location;
use super::value::Value;
use crate::machine::Parameters;
use crate::syntax::ast::Owner;
use crate::syntax::{Subscripts, VariableFamily, VariableName};

/// Values in the variables that outlive programs, if it is known which programs write them: `V.S.`, and P
/// parameters where a program start keeps them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FoundVariables {
    /// The value that each has if it exists: known if every write is of the same value.
    values: BTreeMap<Location, Value>,
    /// Set where any of them may have been written.
    anything: bool,
}

impl FoundVariables {
    /// Adds the values that other programs write.
    pub(crate) fn add(&mut self, other: &Self) {
        self.anything |= other.anything;
        for (location, value) in &other.values {
            self.write(location, value.clone());
        }
    }

    /// Returns the part that a program asks for.
    pub(crate) fn wanted_by(&self, used: &VariableUse) -> Self {
        let mut part = self.clone();
        part.values
            .retain(|location, _| used.wanted.contains(location));
        part.anything &= !used.wanted.is_empty();
        part
    }

    /// The locations that may exist, with their values; none is known where anything may have been written.
    pub(crate) fn values(&self) -> impl Iterator<Item = (&Location, Value)> {
        self.values.iter().map(|(location, value)| {
            let value = if self.anything {
                unknown(location)
            } else {
                value.clone()
            };
            (location, value)
        })
    }

    pub(crate) fn has_anything(&self) -> bool {
        self.anything
    }

    fn write(&mut self, location: &Location, value: Value) {
        let known = self.values.get(location);
        if known.is_some_and(|known| *known == value) {
            return;
        }
        let is_known = known.is_none() && !matches!(value, Value::Unknown(_));
        let value = if is_known { value } else { unknown(location) };
        self.values.insert(location.clone(), value);
    }
}

/// A value as found by the next program that is not known.
fn unknown(location: &Location) -> Value {
    Value::Unknown(Unknown::text(location.to_string()))
}

/// The use that a program makes of the variables that outlive programs.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct VariableUse {
    /// The locations that it asks for without certainly having written them before.
    wanted: BTreeSet<Location>,
    /// The values that it may have written.
    pub(crate) written: FoundVariables,
    parameters: Parameters,
    externals: Arc<ExternalNames>,
}

impl VariableUse {
    pub(crate) fn new(parameters: Parameters, externals: &Arc<ExternalNames>) -> Self {
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

    /// Notes a parameter or a whole variable that is asked for without an earlier write.
    pub(crate) fn want(&mut self, location: Location) {
        if self.outlives(&location) {
            self.wanted.insert(location);
        }
    }

    /// A value is written, or may be.
    pub(crate) fn write(&mut self, location: &Location, value: &Value) {
        match location {
            Location::Parameter(Owner::Program, _) => {
                if self.parameters == Parameters::Kept {
                    self.written.write(location, value.clone());
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
    pub(crate) fn write_name(&mut self, name: &VariableName, value: &Value) {
        let whole = Location::named(name.at(Subscripts::default()));
        if !self.outlives(&whole) {
            return;
        }
        let value = if name.is_element() {
            unknown(&whole)
        } else {
            value.clone()
        };
        if self.externals.is_own_array(name.array()) {
            // What no program has written before is 0.
            self.written.write(&whole, Value::Number(0.0));
        }
        self.written.write(&whole, value);
    }

    fn outlives(&self, location: &Location) -> bool {
        match location {
            Location::Parameter(..) => self.parameters == Parameters::Kept,
            Location::Variable(name) => match name.family() {
                VariableFamily::Parameter => self.parameters == Parameters::Kept,
                VariableFamily::Shared => true,
                _ => self.externals.is_own(name),
            },
            Location::Elements(_) | Location::Parameters => false,
        }
    }
}
