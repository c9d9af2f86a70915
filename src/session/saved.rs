//! State that outlives the programs of a session: axis states and their makers, variables, value
//! lists (R9.30, R9.32).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::comp::{Kind, KindSet};
use crate::interpreter::Unknown;
use crate::interpreter::{ArrayShape, Carried, CarriedWays, Value};
use crate::lint::Maker;
use crate::lists::FrictionList;
use crate::lists::Origin;
use crate::machine::{Axis, AxisSet, Machine};

/// The number of the format that is written.
pub const STATE_SCHEMA: u32 = 4;

/// Reason why a saved state cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum StateError {
    /// State with another schema.
    #[error("the state has schema {found}; this version reads schema 1 to {STATE_SCHEMA}")]
    Schema {
        /// The schema that it has.
        found: u32,
    },
    /// State of another machine.
    #[error("the state belongs to another machine: {difference}")]
    OtherMachine {
        /// The difference.
        difference: String,
    },
    /// State that contradicts itself.
    #[error("it is damaged ({reason})")]
    Damaged {
        /// The fault, in words.
        reason: String,
    },
}

/// State that outlives the programs of a session (R9.30).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct SavedState {
    /// 4; the files of schema 3 have a checksum, too; a state of schema 1 has neither what made a state nor
    /// anything below `variables`.
    pub schema: u32,
    /// The axes with what the start of the control read: another text is another machine.
    pub machine: Vec<String>,
    /// The state of each axis.
    pub axes: Vec<SavedAxis>,
    /// The `V.S.` variables, and others that programs wrote.
    pub variables: BTreeMap<String, Value>,
    /// Declared arrays.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub arrays: BTreeMap<String, ArrayShape>,
    /// P parameters, where the machine keeps them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<u32, Value>,
    /// Macros with their code.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub macros: BTreeMap<String, String>,
    /// Macros that may have been redefined in an unknown way.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub lost_macros: BTreeMap<String, Unknown>,
    /// Coupling groups with the names of their axes.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub couplings: BTreeMap<String, Vec<String>>,
    /// The axes that coupling groups with unknown members may name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lost_couplings: Vec<String>,
    /// The kinds that are unknown because ways through earlier programs differ, with those ways.
    #[serde(default, skip_serializing_if = "CarriedWays::is_empty")]
    pub ways: CarriedWays,
    /// Arrays in which some element was written, though it is not known which.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub lost: BTreeMap<String, Unknown>,
    /// Set when some kept P parameter was written, though it is not known which.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lost_parameters: Option<Unknown>,
}

/// State of one axis that outlives the programs of a session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct SavedAxis {
    /// Name of the axis.
    pub axis: String,
    /// The kinds that are selected.
    pub selected: KindSet,
    /// The kinds whose state is not known.
    pub unknown: KindSet,
    /// The kinds whose parameters a program wrote into the machine data (R2.92).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rewritten: Option<KindSet>,
    /// The table size that was reserved at start-up, P-COMP-00062.
    pub max_points: u32,
    /// The value list that was accepted.
    pub friction: Option<FrictionList>,
    /// The kinds that are not in its start-up state, with the block that made them so.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub away: Vec<SavedAway>,
    /// Whether a program named the axis, where no configuration lists the axes.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub occurred: bool,
    /// The programmed position, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<f64>,
}

/// A kind that is not in its start-up state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct SavedAway {
    /// Kind of compensation.
    pub kind: Kind,
    /// The block that made it so, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<Maker>,
    /// Whether the user silenced the message on it (R9.24).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub allowed: bool,
}

impl SavedState {
    /// Checks that the state is one of a machine: each of its axes once, by name, and nothing that contradicts that.
    pub(super) fn check(&self, machine: &Machine) -> Result<(), StateError> {
        if !(1..=STATE_SCHEMA).contains(&self.schema) {
            return Err(StateError::Schema { found: self.schema });
        }
        let mut here = fingerprint(machine);
        for (axis, line) in machine.axes.iter().zip(&mut here) {
            if self.is_assumed_anew(axis, machine) {
                *line = fingerprint_of(axis, KindSet::NONE);
            }
        }
        if let Some(difference) = difference(&self.machine, &here) {
            return Err(StateError::OtherMachine { difference });
        }
        let damaged = |reason: String| Err(StateError::Damaged { reason });
        for axis in &machine.axes {
            let name = &axis.name;
            let mut entries = self.axes.iter().filter(|entry| entry.axis == *name);
            let Some(entry) = entries.next() else {
                return damaged(format!("axis `{name}` is missing"));
            };
            if entries.next().is_some() {
                return damaged(format!("axis `{name}` occurs twice"));
            }
            let kinds = entry.selected.iter().chain(entry.unknown.iter());
            let mut surplus = kinds.filter(|kind| !axis.configured.contains(*kind));
            if let Some(kind) = surplus.next() {
                let keyword = kind.as_str();
                return damaged(format!("`{keyword}` of axis `{name}` is not configured"));
            }
        }
        if !self.ways.fits(machine) {
            return damaged("a possible state is not one of the machine".to_owned());
        }
        let known = |entry: &&SavedAxis| machine.find(&entry.axis).is_none();
        match self.axes.iter().find(known) {
            Some(entry) => damaged(format!("the machine has no axis `{}`", entry.axis)),
            None => Ok(()),
        }
    }

    /// Returns whether only an assumption about an axis is new: where no machine is described, the user enables the
    /// axes that the programs of each run need.
    pub(super) fn is_assumed_anew(&self, axis: &Axis, machine: &Machine) -> bool {
        machine.axis_set == AxisSet::AsTheyOccur
            && axis.frict_comp_origin == Origin::Assumed
            && self.machine.contains(&fingerprint_of(axis, KindSet::NONE))
    }

    pub(super) fn into_carried(self) -> Carried {
        Carried {
            variables: self.variables,
            arrays: self.arrays,
            parameters: self.parameters,
            macros: self.macros,
            lost_macros: self.lost_macros,
            couplings: self.couplings,
            lost_couplings: self.lost_couplings,
            ways: self.ways,
            lost: self.lost,
            lost_parameters: self.lost_parameters,
        }
    }
}

/// Returns a value that can be written and read again. A number that is not finite becomes unknown.
pub(super) fn storable((name, value): (String, Value)) -> (String, Value) {
    match value {
        Value::Number(number) if !number.is_finite() => {
            let cause = Unknown::text(name.as_str());
            (name, Value::Unknown(cause))
        }
        value => (name, value),
    }
}

/// Returns one line per axis with the data that only a start of the control reads. Value lists may
/// be loaded again while the control runs and are not included.
pub(super) fn fingerprint(machine: &Machine) -> Vec<String> {
    let lines = machine.axes.iter();
    lines
        .map(|axis| fingerprint_of(axis, axis.configured))
        .collect()
}

fn fingerprint_of(axis: &Axis, configured: KindSet) -> String {
    let words = |kinds: KindSet| {
        let words: Vec<&str> = kinds.iter().map(Kind::as_str).collect();
        if words.is_empty() {
            "none".to_owned()
        } else {
            words.join("|")
        }
    };
    let number = axis
        .number
        .map_or("-".to_owned(), |number| number.to_string());
    format!(
        "axis {} number {number} type {:?} configured {} manual {}",
        axis.name,
        axis.axis_type,
        words(configured),
        words(axis.manual)
    )
}

/// Returns the difference between the machines; the order of the axes does not count.
fn difference(saved: &[String], here: &[String]) -> Option<String> {
    if saved.len() != here.len() {
        return Some(format!(
            "it has {} axes; this machine has {}",
            saved.len(),
            here.len()
        ));
    }
    let sorted = |lines: &[String]| {
        let mut lines = lines.to_vec();
        lines.sort_unstable();
        lines
    };
    sorted(saved)
        .iter()
        .zip(&sorted(here))
        .find(|(saved, here)| saved != here)
        .map(|(saved, here)| format!("it has `{saved}`; this machine has `{here}`"))
}
