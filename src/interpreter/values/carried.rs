//! State that outlives programs, apart from the states of the axes, as data (R2.34, R9.32): variables,
//! arrays, macros, kept parameters, coupling groups.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::cause::Unknown;
use super::value::Value;
use crate::interpreter::ways::carried::CarriedWays;

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
