//! Variables by name, with their arrays, and their weight.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::interpreter::values::handover::{ArrayShape, Carried};
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::persistent::PersistentMap;
use crate::interpreter::values::value::{Value, ValueType};
use crate::syntax::{Subscripts, VariableName};

/// Number of bytes of a text or a name that count as one more value in the budget of values
/// (R2.60).
pub(crate) const WEIGHT: usize = 32;

/// A sum of weights. A damaged snapshot may hold any, so nothing here overflows.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Weight(pub(in crate::interpreter) usize);

impl Weight {
    pub(crate) fn add(&mut self, weight: usize) {
        self.0 = self.0.saturating_add(weight);
    }

    pub(crate) fn take(&mut self, weight: usize) {
        self.0 = self.0.saturating_sub(weight);
    }
}

/// Variables by name, those of an array under the array's name.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct VariableNames {
    pub(crate) names: PersistentMap<String, NamedVariable>,
    pub(crate) weight: Weight,
}

/// The value or array that a name denotes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct NamedVariable {
    pub(crate) scalar: Option<Value>,
    pub(crate) array: Option<Array>,
    /// The elements that were written.
    pub(crate) elements: PersistentMap<Subscripts, Value>,
    /// Set when some element was written, but it is not known which.
    pub(crate) lost: Option<Unknown>,
    /// Declaration, where it has one on some way.
    pub(crate) declared: Option<Declared>,
}

/// Declaration of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Declared {
    pub(crate) kind: ValueType,
    pub(crate) certainty: Sure,
}

/// Certainty of a declaration over the ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Sure {
    Certain,
    Possible,
}

/// Use of a name that its declaration does not allow (R2.102).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Misuse {
    /// An array without an index.
    NoIndex,
    /// An index outside the array.
    Outside,
    /// More or fewer indices than its dimensions.
    OtherCount(usize),
    /// An index on a variable that is no array.
    NoArray,
}

impl Declared {
    /// Returns the declaration where another way has another one, or none.
    fn join(mine: Option<Self>, theirs: Option<Self>) -> Option<Self> {
        let kind = match (mine, theirs) {
            (Some(mine), Some(theirs)) if mine == theirs => return Some(mine),
            (Some(mine), Some(theirs)) if mine.kind != theirs.kind => ValueType::Any,
            (mine, theirs) => mine.or(theirs)?.kind,
        };
        Some(Self {
            kind,
            certainty: Sure::Possible,
        })
    }
}

/// A declared array.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Array {
    /// `None` is a dimension that is not known.
    pub(crate) dimensions: Vec<Option<u32>>,
    /// The value of elements that were never written; unknown where a dimension is.
    pub(crate) default: Value,
}

impl Array {
    /// Returns whether the subscripts are, or may be, those of an element.
    pub(crate) fn has(&self, subscripts: &Subscripts) -> bool {
        let is_inside = |(number, size): (&i64, &Option<u32>)| {
            u32::try_from(*number).is_ok_and(|at| size.is_none_or(|size| at < size))
        };
        subscripts.numbers().is_some_and(|numbers| {
            numbers.len() == self.dimensions.len()
                && numbers.iter().zip(&self.dimensions).all(is_inside)
        })
    }
}

impl NamedVariable {
    pub(crate) fn element(&self, subscripts: &Subscripts) -> Option<Value> {
        if let Some(value) = self.elements.get(subscripts) {
            return Some(value.clone());
        }
        let array = self.array.as_ref();
        if array.is_some_and(|array| !array.has(subscripts)) {
            return None;
        }
        match &self.lost {
            Some(cause) => Some(Value::Unknown(cause.clone())),
            None => array.map(|array| array.default.clone()),
        }
    }

    /// Appends the values that the next program finds.
    pub(crate) fn carry(&self, name: &str, carried: &mut Carried) {
        if let Some(value) = &self.scalar {
            carried.variables.insert(name.to_owned(), value.clone());
        }
        if let Some(array) = &self.array {
            let shape = ArrayShape {
                dimensions: array.dimensions.clone(),
                default: array.default.clone(),
            };
            carried.arrays.insert(name.to_owned(), shape);
        }
        if let Some(cause) = &self.lost {
            carried.lost.insert(name.to_owned(), cause.clone());
        }
        for (subscripts, value) in self.elements.iter() {
            let element = VariableName::whole(name.to_owned()).at(subscripts.clone());
            carried.variables.insert(element.to_string(), value.clone());
        }
    }

    /// Makes its value and that of every element unknown.
    pub(crate) fn havoc(&mut self, cause: &Unknown) {
        if let Some(scalar) = &mut self.scalar {
            *scalar = Value::Unknown(cause.clone());
        }
        self.elements.clear();
        self.lost = self
            .array
            .as_ref()
            .map(|_| cause.clone())
            .or(self.lost.take());
    }

    /// Makes unknown what differs from another variable of the name.
    fn join(&mut self, other: &Self, cause: &Unknown, weight: &mut Weight) {
        join_value(&mut self.scalar, other.scalar.as_ref(), cause);
        self.declared = Declared::join(self.declared, other.declared);
        if self.array != other.array {
            // An array that may have another shape has no known contents.
            self.array = self.array.take().or_else(|| other.array.clone());
            weight.take(self.elements_weight());
            self.elements.clear();
            self.lost.get_or_insert_with(|| cause.clone());
            return;
        }
        for key in self.elements.differing(&other.elements) {
            let mut mine = self.element(&key);
            join_value(&mut mine, other.element(&key).as_ref(), cause);
            if let Some(value) = mine {
                weight.add(self::weight(key.len(), &value));
                let length = key.len();
                if let Some(before) = self.elements.insert(key, value) {
                    weight.take(self::weight(length, &before));
                }
            }
        }
        if self.lost.is_none() {
            self.lost.clone_from(&other.lost);
        }
    }

    /// Returns the weight of its own value and of the declaration of the array.
    fn own_weight(&self, name: &str) -> usize {
        let array = self.array.as_ref().map(|array| &array.default);
        let values = self.scalar.iter().chain(array);
        values.map(|value| weight(name.len(), value)).sum()
    }

    fn elements_weight(&self) -> usize {
        let weight = |(key, value): (&Subscripts, &Value)| weight(key.len(), value);
        self.elements.iter().map(weight).sum()
    }

    /// Returns whether it is there on every way.
    pub(crate) fn is_certain(&self) -> bool {
        let is_known = |value: &Value| !matches!(value, Value::Unknown(_));
        let declared = self.declared.map(|it| it.certainty == Sure::Certain);
        declared.unwrap_or_else(|| self.scalar.as_ref().is_some_and(is_known))
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.scalar.is_none()
            && self.array.is_none()
            && self.lost.is_none()
            && self.declared.is_none()
            && self.elements.is_empty()
    }
}

impl VariableNames {
    /// Returns all values by name, those of an array element by element.
    pub(crate) fn held(&self) -> BTreeMap<VariableName, Value> {
        let mut held = BTreeMap::new();
        for (array, variable) in self.names.iter() {
            let whole = VariableName::whole(array.clone());
            for (subscripts, value) in variable.elements.iter() {
                held.insert(whole.at(subscripts.clone()), value.clone());
            }
            if let Some(value) = &variable.scalar {
                held.insert(whole, value.clone());
            }
        }
        held
    }

    pub(crate) fn value(&self, name: &VariableName) -> Option<Value> {
        let variable = self.names.get(name.array())?;
        if name.is_element() {
            variable.element(name.subscripts())
        } else {
            variable.scalar.clone()
        }
    }

    pub(crate) fn set(&mut self, name: &VariableName, value: Value) {
        let array = name.array().to_owned();
        let variable = self.names.slot(array, NamedVariable::default);
        let length = if name.is_element() {
            name.subscripts().len()
        } else {
            name.array().len()
        };
        self.weight.add(weight(length, &value));
        let before = if name.is_element() {
            variable.elements.insert(name.subscripts().clone(), value)
        } else {
            variable.scalar.replace(value)
        };
        self.weight
            .take(before.map_or(0, |before| weight(length, &before)));
    }

    pub(crate) fn declare_array(&mut self, name: &str, array: Array) {
        self.weight.add(weight(name.len(), &array.default));
        let variable = self.names.slot(name.to_owned(), NamedVariable::default);
        let before = variable.array.replace(array);
        self.weight
            .take(before.map_or(0, |before| weight(name.len(), &before.default)));
        variable.lost = None;
        self.drop_elements(name);
    }

    pub(crate) fn set_declared(&mut self, name: &str, declared: Declared) {
        let variable = self.names.slot(name.to_owned(), NamedVariable::default);
        variable.declared = Some(declared);
    }

    fn drop_elements(&mut self, name: &str) {
        if let Some(variable) = self.names.get_mut(name) {
            self.weight.take(variable.elements_weight());
            variable.elements.clear();
        }
    }

    pub(crate) fn array(&self, name: &str) -> Option<&Array> {
        self.names.get(name)?.array.as_ref()
    }

    pub(crate) fn havoc_elements(&mut self, name: &str, cause: &Unknown) {
        self.drop_elements(name);
        let variable = self.names.slot(name.to_owned(), NamedVariable::default);
        variable.lost = Some(cause.clone());
    }

    pub(crate) fn delete(&mut self, name: &VariableName) {
        let array = name.array();
        if !name.is_element() {
            self.drop_elements(array);
            if let Some(variable) = self.names.remove(array) {
                self.weight.take(variable.own_weight(array));
            }
            return;
        }
        let Some(variable) = self.names.get_mut(array) else {
            return;
        };
        let from = variable.elements.from(name.subscripts());
        let parts = from.take_while(|(key, _)| key.starts_with(name.subscripts()));
        let gone: Vec<Subscripts> = parts.map(|(key, _)| key.clone()).collect();
        for key in gone {
            if let Some(value) = variable.elements.remove(&key) {
                self.weight.take(weight(key.len(), &value));
            }
        }
        if variable.is_empty() {
            self.names.remove(array);
        }
    }

    pub(crate) fn differing(&self, other: &Self, differing: &mut Vec<Location>) -> Option<()> {
        if self.names.len() != other.names.len() {
            return None;
        }
        for name in &self.names.differing(&other.names) {
            let (mine, theirs) = self.names.get(name).zip(other.names.get(name))?;
            let same = mine.array == theirs.array
                && mine.lost == theirs.lost
                && mine.declared == theirs.declared
                && mine.elements.len() == theirs.elements.len();
            if !same {
                return None;
            }
            match (&mine.scalar, &theirs.scalar) {
                (Some(mine), Some(theirs)) => {
                    let target = || Location::Variable(VariableName::whole(name.clone()));
                    compare(mine, theirs, target, differing)?;
                }
                (None, None) => {}
                _ => return None,
            }
            for key in mine.elements.differing(&theirs.elements) {
                let element = || VariableName::whole(name.clone()).at(key.clone());
                let target = || Location::Variable(element());
                let pair = mine.elements.get(&key).zip(theirs.elements.get(&key))?;
                compare(pair.0, pair.1, target, differing)?;
            }
        }
        Some(())
    }

    /// Makes unknown what differs in another memory; returns the number of names that do.
    pub(crate) fn join(&mut self, other: &Self, cause: &Unknown) -> usize {
        let differing = self.names.differing(&other.names);
        let nothing = NamedVariable::default();
        for name in &differing {
            let theirs = other.names.get(name).unwrap_or(&nothing);
            self.join_name(name, theirs, cause);
        }
        differing.len()
    }

    /// Makes unknown what differs from another variable of a name.
    pub(crate) fn join_name(&mut self, name: &str, theirs: &NamedVariable, cause: &Unknown) {
        let mine = self.names.slot(name.to_owned(), NamedVariable::default);
        self.weight.take(mine.own_weight(name));
        mine.join(theirs, cause, &mut self.weight);
        self.weight.add(mine.own_weight(name));
    }

    pub(crate) fn weigh(&self) -> usize {
        let weight_of = |(name, variable): (&String, &NamedVariable)| {
            variable.own_weight(name) + variable.elements_weight()
        };
        self.names.iter().map(weight_of).sum()
    }
}

/// Joins the values of two ways: unknown where they differ.
pub(crate) fn join_value(mine: &mut Option<Value>, theirs: Option<&Value>, cause: &Unknown) {
    let joined = match (mine.as_ref(), theirs) {
        (Some(Value::Unknown(_)), _) => return,
        (mine, theirs) if mine == theirs => return,
        (_, Some(unknown @ Value::Unknown(_))) => unknown.clone(),
        _ => Value::Unknown(cause.clone()),
    };
    *mine = Some(joined);
}

/// Different numbers beyond which a comparison is given up.
const MAX_DIFFERING: usize = 16;

/// Compares two values under one name; `None` where they differ in more than a number.
pub(crate) fn compare(
    mine: &Value,
    theirs: &Value,
    target: impl Fn() -> Location,
    differing: &mut Vec<Location>,
) -> Option<()> {
    match (mine, theirs) {
        (mine, theirs) if mine == theirs => Some(()),
        (Value::Number(_), Value::Number(_)) if differing.len() < MAX_DIFFERING => {
            differing.push(target());
            Some(())
        }
        _ => None,
    }
}

/// Returns the weight of a value under a name of so many bytes.
pub(crate) fn weight(name: usize, value: &Value) -> usize {
    let text = match value {
        Value::Text(text) => text.len(),
        // The name of an unknown value is shared.
        Value::Number(_) | Value::Unknown(_) => 0,
    };
    1 + name / WEIGHT + text / WEIGHT
}
