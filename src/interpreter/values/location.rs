//! Locations of memory: parameters, variables, and elements of arrays.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::cause::Unknown;
use super::functions::numeric;
use super::value::{Slot, Value, rounded};
use crate::syntax::ast::Owner;
use crate::syntax::{Fault, Subscript, VariableName};
use crate::text::Span;

/// A location of memory, or several of which one is meant.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) enum Location {
    Parameter(Owner, u32),
    /// A variable, or an element of an array.
    Variable(VariableName),
    /// Some element of an array.
    Elements(VariableName),
    /// Some P parameter.
    Parameters,
}

impl Location {
    /// The parameter or variable of a name.
    pub(crate) fn named(name: VariableName) -> Self {
        match name.parameter_index() {
            Some(index) => Self::Parameter(Owner::Program, index),
            None => Self::Variable(name),
        }
    }

    /// The name under which the user gives its value.
    pub(crate) fn name(&self) -> VariableName {
        match self {
            Self::Parameter(Owner::Program, index) => VariableName::parameter(*index),
            Self::Parameter(Owner::Call, index) => VariableName::own_parameter(*index),
            Self::Variable(name) | Self::Elements(name) => name.clone(),
            Self::Parameters => VariableName::read("P"),
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(Owner::Program, index) => write!(f, "P{index}"),
            Self::Parameter(Owner::Call, index) => write!(f, "@P{index}"),
            Self::Variable(name) | Self::Elements(name) => write!(f, "{name}"),
            Self::Parameters => f.write_str("P"),
        }
    }
}

/// The location that an expression denotes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Denoted {
    pub(crate) location: Location,
    /// The value that decides which of several locations it is.
    pub(crate) decided_by: Option<Unknown>,
}

impl Denoted {
    /// One of several locations.
    pub(crate) fn any_of(location: Location, decided_by: Unknown) -> Self {
        Self {
            location,
            decided_by: Some(decided_by),
        }
    }

    /// The name of the variable, where it is one that is known.
    pub(crate) fn variable(&self) -> Option<&VariableName> {
        match &self.location {
            Location::Variable(name) => Some(name),
            _ => None,
        }
    }

    /// The location with the value that it has after an assignment.
    pub(crate) fn assigned(self, value: Value) -> (Location, Value) {
        let value = self.decided_by.map_or(value, Value::Unknown);
        (self.location, value)
    }

    /// Pops the number and the subscripts of a parameter (R2.72).
    pub(super) fn pop_parameter(
        owner: Owner,
        subscripts: usize,
        span: Span,
        stack: &mut Vec<Slot>,
    ) -> Result<Self, Box<Fault>> {
        let from = stack.len().saturating_sub(subscripts + 1);
        let mut numbers = Vec::with_capacity(subscripts + 1);
        let mut unknown = None;
        for slot in stack.drain(from..) {
            let value = slot?;
            let number = numeric(&value, span)?.map(|it| rounded(it).unwrap_or(i64::MAX));
            numbers.push(number);
            if let Value::Unknown(cause) = value {
                unknown = unknown.or(Some(cause));
            }
        }
        let index = numbers.first().copied().flatten();
        let index = index.map(|index| u32::try_from(index).unwrap_or(u32::MAX));
        Ok(match (index, unknown) {
            (Some(index), Some(cause)) => {
                Self::any_of(Location::Elements(VariableName::parameter(index)), cause)
            }
            (None, cause) => {
                let cause = cause.unwrap_or_else(|| Unknown::text("P"));
                Self::any_of(Location::Parameters, cause)
            }
            (Some(index), None) if subscripts == 0 => Location::Parameter(owner, index).into(),
            (Some(index), None) => {
                let numbers = numbers[1..].iter().flatten();
                let subscripts = numbers.map(|number| Subscript::Number(*number)).collect();
                Location::Variable(VariableName::parameter(index).at(subscripts)).into()
            }
        })
    }
}

impl From<Location> for Denoted {
    fn from(location: Location) -> Self {
        Self {
            location,
            decided_by: None,
        }
    }
}
