//! Values that one program hands to the next: what a program finds in the variables that outlive programs, how it uses them, and
//! what it leaves (R2.34, R9.32).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::interpreter::lasting::LastingState;
use crate::interpreter::values::externals::ExternalNames;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::memory::{Memory, is_kept};
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::possible_state::CarriedWays;
use crate::machine::Parameters;
use crate::syntax::ast::Owner;
use crate::syntax::{Subscripts, VariableFamily, VariableName};

/// Values in the variables that outlive programs, if it is known which programs write them: `V.S.`, and P
/// parameters where a program start keeps them; and what else programs leave of the control.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FoundVariables {
    /// The value that each has if it exists: known if every write is of the same value.
    values: BTreeMap<Location, Value>,
    /// Set where any of them may have been written.
    anything: bool,
    /// What outlives programs besides.
    lasting: LastingState,
}

impl FoundVariables {
    /// Adds the values that other programs write.
    pub(crate) fn add(&mut self, other: &Self) {
        self.anything |= other.anything;
        self.lasting.add(&other.lasting);
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

    /// Returns the locations that may exist, with their values; none is known where anything may have been written.
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

    pub(crate) fn lasting(&self) -> &LastingState {
        &self.lasting
    }

    /// Returns whether a program may have left exchanged axes.
    pub(crate) fn may_exchange_axes(&self) -> bool {
        self.lasting.exchanged
    }

    /// Adds what a program leaves of the control.
    pub(crate) fn leave(&mut self, lasting: &LastingState) {
        self.lasting.add(lasting);
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

/// Returns a value as found by the next program that is not known.
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

    /// Records that anything may be written: the effect of the program is unknown.
    pub(crate) fn write_anything(&mut self) {
        self.written.anything = true;
    }

    /// Notes a parameter or a whole variable that is asked for without an earlier write.
    pub(crate) fn want(&mut self, location: Location) {
        if self.outlives(&location) {
            self.wanted.insert(location);
        }
    }

    /// Records that a value is written, or may be.
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

    /// Records the write of a variable, or of an element of an array, of which no value is followed from program to
    /// program.
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
            // A variable that no program has written is 0.
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

/// A declared array without its elements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ArrayShape {
    /// Number of elements of each dimension; `None` where it is not known.
    pub dimensions: Vec<Option<u32>>,
    /// The value of elements that were never written.
    pub default: Value,
}

/// State other than that of the axes that programs leave to the next one.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Carried {
    /// Variables and elements of arrays, by their full names.
    pub variables: BTreeMap<String, Value>,
    /// Arrays of which some element was written, but it is not known which, with the value that made it
    /// so.
    pub lost: BTreeMap<String, Unknown>,
    /// Declared arrays.
    pub arrays: BTreeMap<String, ArrayShape>,
    /// P parameters, where the machine keeps them.
    pub parameters: BTreeMap<u32, Value>,
    /// Set when some kept parameter was written, but it is not known which.
    pub lost_parameters: Option<Unknown>,
    /// Macros with their code.
    pub macros: BTreeMap<String, String>,
    /// Macros that may have been redefined, with the value that made it so.
    pub lost_macros: BTreeMap<String, Unknown>,
    /// The coupling groups that `#SET AX LINK` defined, with the names of their axes.
    pub couplings: BTreeMap<String, Vec<String>>,
    /// The kinds that are unknown because ways differ.
    pub ways: CarriedWays,
    /// The axes that coupling groups with unknown members may name.
    pub lost_couplings: Vec<String>,
}
