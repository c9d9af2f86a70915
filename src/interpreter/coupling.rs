//! Axis couplings (R2.47): which groups `#SET AX LINK` defined and which of them are in force.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::comp::AxisIndex;

/// The coupling groups of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Couplings {
    groups: BTreeMap<String, Group>,
    /// The groups in force, in the order in which they were enabled.
    enabled: BTreeMap<u64, String>,
    /// How many groups in force couple each axis.
    holding: BTreeMap<AxisIndex, u32>,
    /// How often a group was enabled.
    turns: u64,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Group {
    axes: Vec<AxisIndex>,
    /// The turn at which it was enabled, while it is in force.
    enabled: Option<u64>,
}

impl Couplings {
    /// How many groups are defined.
    pub(super) fn len(&self) -> usize {
        self.groups.len()
    }

    /// The groups that are defined, with their axes.
    pub(super) fn groups(&self) -> impl Iterator<Item = (&str, &[AxisIndex])> {
        let groups = self.groups.iter();
        groups.map(|(name, group)| (name.as_str(), group.axes.as_slice()))
    }

    /// Whether a group in force couples the axis.
    pub(super) fn holds(&self, axis: AxisIndex) -> bool {
        self.holding.contains_key(&axis)
    }

    /// Defines a group anew; one that is in force stays so with its new axes.
    pub(super) fn define(&mut self, group: &str, axes: Vec<AxisIndex>) {
        let was_enabled = self.release(group);
        self.groups.insert(
            group.to_owned(),
            Group {
                axes,
                enabled: None,
            },
        );
        if let Some(turn) = was_enabled {
            self.enable_at(group, turn);
        }
    }

    /// Whether it names no other axes than so many.
    pub(super) fn fits(&self, axes: usize) -> bool {
        let members = self.groups.values().flat_map(|group| &group.axes);
        members
            .chain(self.holding.keys())
            .all(|axis| axis.get() < axes)
    }

    /// Puts a group into force; whether it is defined.
    pub(super) fn enable(&mut self, group: &str) -> bool {
        if !self.groups.contains_key(group) {
            return false;
        }
        self.release(group);
        self.turns = self.turns.wrapping_add(1);
        self.enable_at(group, self.turns);
        true
    }

    fn enable_at(&mut self, group: &str, turn: u64) {
        if let Some(known) = self.groups.get_mut(group) {
            known.enabled = Some(turn);
            for &axis in &known.axes {
                let times = self.holding.entry(axis).or_default();
                *times = times.saturating_add(1);
            }
            self.enabled.insert(turn, group.to_owned());
        }
    }

    /// Releases a group; the turn at which it was enabled, if it was in force.
    pub(super) fn release(&mut self, group: &str) -> Option<u64> {
        let known = self.groups.get_mut(group)?;
        let turn = known.enabled.take()?;
        self.enabled.remove(&turn);
        for axis in &known.axes {
            let times = self.holding.get(axis).copied().unwrap_or_default();
            if times > 1 {
                self.holding.insert(*axis, times - 1);
            } else {
                self.holding.remove(axis);
            }
        }
        Some(turn)
    }

    /// Releases the group that was enabled last.
    pub(super) fn release_last(&mut self) {
        if let Some((_, group)) = self.enabled.pop_last() {
            self.release(&group);
        }
    }

    /// Releases every group; whether any was in force.
    pub(super) fn release_all(&mut self) -> bool {
        let any = !self.enabled.is_empty();
        while !self.enabled.is_empty() {
            self.release_last();
        }
        any
    }
}
