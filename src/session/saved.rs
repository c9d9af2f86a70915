//! What outlives the programs of a session: axis states, shared variables, value lists (R9.30).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::interpreter::Value;
use crate::lists::FrictionList;
use crate::machine::Machine;
use crate::syntax::{Kind, KindSet};

/// Why a saved state cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum StateError {
    /// It has another schema.
    #[error("the state has schema {found}, this version reads schema 1")]
    Schema {
        /// The schema that it has.
        found: u32,
    },
    /// It belongs to another machine.
    #[error("the state belongs to another machine: {difference}")]
    OtherMachine {
        /// What differs.
        difference: String,
    },
}

/// What outlives the programs of a session (R9.30).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedState {
    /// 1.
    pub schema: u32,
    /// The axes with what the start of the control read: another text is another machine.
    pub machine: Vec<String>,
    /// The state of each axis.
    pub axes: Vec<SavedAxis>,
    /// The `V.S.` variables.
    pub variables: BTreeMap<String, Value>,
}

/// What outlives the programs of a session on one axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedAxis {
    /// The axis.
    pub axis: String,
    /// The kinds that are selected.
    pub selected: KindSet,
    /// The kinds whose state is not known.
    pub unknown: KindSet,
    /// The table size that was reserved at start-up, P-COMP-00062.
    pub max_points: u32,
    /// The value list that was accepted.
    pub friction: Option<FrictionList>,
}

/// One line an axis with what only a start of the control reads. Value lists may be loaded anew
/// while the control runs and are no part of it.
pub(super) fn fingerprint(machine: &Machine) -> Vec<String> {
    let words = |kinds: KindSet| {
        let words: Vec<&str> = kinds.iter().map(Kind::keyword).collect();
        if words.is_empty() {
            "none".to_owned()
        } else {
            words.join("|")
        }
    };
    machine
        .axes
        .iter()
        .map(|axis| {
            let number = axis
                .number
                .map_or("-".to_owned(), |number| number.to_string());
            format!(
                "axis {} number {number} type {:?} configured {} manual {}",
                axis.name,
                axis.axis_type,
                words(axis.configured),
                words(axis.manual)
            )
        })
        .collect()
}

pub(super) fn difference(saved: &[String], here: &[String]) -> Option<String> {
    if saved.len() != here.len() {
        return Some(format!(
            "it has {} axes, this machine has {}",
            saved.len(),
            here.len()
        ));
    }
    saved
        .iter()
        .zip(here)
        .find(|(saved, here)| saved != here)
        .map(|(saved, here)| format!("it has `{saved}`, this machine has `{here}`"))
}
