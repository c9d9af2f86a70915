//! Axis couplings (R2.47): which groups `#SET AX LINK` defined and which of them are in force.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Coupling};

/// The coupling groups of a run.
///
/// Where a coupling command may or may not have been executed, no group is known any more until it
/// is redefined, and every axis that a group ever named may be coupled or not.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(in crate::interpreter) struct Couplings {
    groups: BTreeMap<String, Group>,
    /// The groups in force, in the order in which they were enabled.
    enabled: BTreeMap<u64, String>,
    /// How many groups in force couple each axis.
    holding: BTreeMap<AxisIndex, u32>,
    /// How often a group was enabled.
    turns: u64,
    /// Every axis that a group ever named.
    named: BTreeSet<AxisIndex>,
    /// Whether groups may be defined that are not known.
    vague: bool,
    /// Whether such groups may be in force.
    doubted: bool,
    /// Rises with every change.
    version: u64,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Group {
    axes: Vec<AxisIndex>,
    /// The turn at which it was enabled, while it is in force.
    enabled: Option<u64>,
}

impl Couplings {
    /// Whether a group is in force, or may be.
    pub(in crate::interpreter) fn is_any(&self) -> bool {
        self.doubted || !self.enabled.is_empty()
    }

    /// How many groups are defined.
    pub(in crate::interpreter) fn len(&self) -> usize {
        self.groups.len()
    }

    /// The groups that are known, with their axes.
    pub(in crate::interpreter) fn groups(&self) -> impl Iterator<Item = (&str, &[AxisIndex])> {
        let groups = self.groups.iter();
        groups.map(|(name, group)| (name.as_str(), group.axes.as_slice()))
    }

    /// The axes that groups may name which are not known.
    pub(in crate::interpreter) fn lost(&self) -> impl Iterator<Item = AxisIndex> {
        self.named.iter().copied().filter(|_| self.vague)
    }

    /// Rises with every change.
    pub(in crate::interpreter) fn version(&self) -> u64 {
        self.version
    }

    /// Whether a group in force couples the axis.
    pub(in crate::interpreter) fn of(&self, axis: AxisIndex) -> Coupling {
        if self.holding.contains_key(&axis) {
            Coupling::Active
        } else if self.doubted && self.named.contains(&axis) {
            Coupling::Perhaps
        } else {
            Coupling::None
        }
    }

    /// Redefines a group; one that is in force stays so with its new axes. Returns the axes whose
    /// coupling may have changed.
    pub(in crate::interpreter) fn define(
        &mut self,
        group: &str,
        axes: Vec<AxisIndex>,
    ) -> Vec<AxisIndex> {
        self.version = self.version.wrapping_add(1);
        let (was_enabled, mut changed) = self.take_out(group);
        changed.extend(&axes);
        self.named.extend(&axes);
        let defined = Group {
            axes,
            ..Group::default()
        };
        self.groups.insert(group.to_owned(), defined);
        if let Some(turn) = was_enabled {
            self.enable_at(group, turn);
        }
        changed
    }

    /// Groups whose members are unknown may name these axes.
    pub(in crate::interpreter) fn lose(&mut self, axes: impl IntoIterator<Item = AxisIndex>) {
        self.named.extend(axes);
        self.vague = true;
    }

    /// Some coupling command may have been executed. Returns the axes whose coupling may have
    /// changed.
    pub(in crate::interpreter) fn doubt(&mut self) -> Vec<AxisIndex> {
        self.release_all();
        self.version = self.version.wrapping_add(1);
        self.groups.clear();
        self.vague = true;
        self.doubted = true;
        self.named.iter().copied().collect()
    }

    /// Groups with these axes may have been defined, or redefined: that changes a coupling only
    /// where some group may be in force.
    pub(in crate::interpreter) fn doubt_definitions(
        &mut self,
        axes: &[AxisIndex],
    ) -> Vec<AxisIndex> {
        self.lose(axes.iter().copied());
        if self.doubted || !self.enabled.is_empty() {
            return self.doubt();
        }
        self.version = self.version.wrapping_add(1);
        self.groups.clear();
        Vec::new()
    }

    /// Whether the blocks that follow find the same couplings.
    pub(in crate::interpreter) fn is_like(&self, other: &Self) -> bool {
        let groups = |couplings: &Self| {
            let groups = couplings.groups.iter();
            let groups = groups.map(|(name, group)| (name.clone(), group.axes.clone()));
            groups.collect::<Vec<_>>()
        };
        self.enabled.values().eq(other.enabled.values())
            && (&self.named, self.vague, self.doubted) == (&other.named, other.vague, other.doubted)
            && groups(self) == groups(other)
    }

    /// Whether it names no other axes than so many.
    pub(in crate::interpreter) fn fits(&self, axes: usize) -> bool {
        let members = self.groups.values().flat_map(|group| &group.axes);
        members
            .chain(self.holding.keys())
            .chain(&self.named)
            .all(|axis| axis.get() < axes)
    }

    /// Puts a group into force; the axes whose coupling may have changed, where it may be defined.
    pub(in crate::interpreter) fn enable(&mut self, group: &str) -> Option<Vec<AxisIndex>> {
        let Some(known) = self.groups.get(group) else {
            let lost = self.vague && !self.named.is_empty();
            return lost.then(|| {
                self.version = self.version.wrapping_add(1);
                self.doubted = true;
                self.named.iter().copied().collect()
            });
        };
        let axes = known.axes.clone();
        self.release(group);
        self.turns = self.turns.wrapping_add(1);
        self.enable_at(group, self.turns);
        Some(axes)
    }

    fn enable_at(&mut self, group: &str, turn: u64) {
        self.version = self.version.wrapping_add(1);
        if let Some(known) = self.groups.get_mut(group) {
            known.enabled = Some(turn);
            for &axis in &known.axes {
                let times = self.holding.entry(axis).or_default();
                *times = times.saturating_add(1);
            }
            self.enabled.insert(turn, group.to_owned());
        }
    }

    /// Releases a group; the axes whose coupling may have changed.
    pub(in crate::interpreter) fn release(&mut self, group: &str) -> Vec<AxisIndex> {
        self.take_out(group).1
    }

    /// Releases a group; the turn at which it was enabled, and its axes, if it was in force.
    fn take_out(&mut self, group: &str) -> (Option<u64>, Vec<AxisIndex>) {
        let known = self.groups.get_mut(group);
        let Some((known, turn)) = known.and_then(|known| {
            let turn = known.enabled.take()?;
            Some((known, turn))
        }) else {
            return (None, Vec::new());
        };
        self.version = self.version.wrapping_add(1);
        self.enabled.remove(&turn);
        for axis in &known.axes {
            let times = self.holding.get(axis).copied().unwrap_or_default();
            if times > 1 {
                self.holding.insert(*axis, times - 1);
            } else {
                self.holding.remove(axis);
            }
        }
        (Some(turn), known.axes.clone())
    }

    /// Releases the group that was enabled last; the axes whose coupling may have changed.
    pub(in crate::interpreter) fn release_last(&mut self) -> Vec<AxisIndex> {
        match self.enabled.pop_last() {
            Some((_, group)) => self.release(&group),
            None => Vec::new(),
        }
    }

    /// Releases every group, known or not; the axes whose coupling may have changed.
    pub(in crate::interpreter) fn release_all(&mut self) -> Vec<AxisIndex> {
        if !self.doubted && self.enabled.is_empty() {
            return Vec::new();
        }
        self.version = self.version.wrapping_add(1);
        self.doubted = false;
        self.enabled.clear();
        self.holding.clear();
        for group in self.groups.values_mut() {
            group.enabled = None;
        }
        self.named.iter().copied().collect()
    }
}
