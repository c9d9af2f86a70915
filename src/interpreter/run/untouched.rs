//! The ways on which a program has not yet switched the state that it found (R1.52, R14.5).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::condition::Condition;
use super::possible_state::ways_of;
use super::way_condition::{WayCondition, if_ways};
use super::way_set::WaySet;
use crate::comp::{AxisIndex, Kind, KindSet};
use crate::interpreter::values::rows;

/// Axis and kind → the ways on which no command of the program has switched it. A kind without an entry
/// was switched on no way.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Untouched(#[serde(with = "rows")] BTreeMap<(AxisIndex, Kind), WaySet>);

impl Untouched {
    /// A program begins.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// A command switches kinds of an axis.
    pub(crate) fn switch(&mut self, axis: AxisIndex, kinds: KindSet) {
        for kind in kinds.iter() {
            self.0.insert((axis, kind), WaySet::never());
        }
    }

    /// Joins two ways that meet. `reach` holds the ways to this one and to the other.
    pub(crate) fn join(&mut self, other: &Self, reach: [&WaySet; 2]) {
        if self == other {
            return;
        }
        let keys: Vec<_> = self.0.keys().chain(other.0.keys()).copied().collect();
        for key in keys {
            let mut left = self.of(key, reach[0]);
            left.or(&other.of(key, reach[1]));
            self.0.insert(key, left);
        }
    }

    /// A condition is asked again.
    pub(crate) fn havoc(&mut self, condition: u32) {
        self.0.values_mut().for_each(|ways| ways.havoc(condition));
    }

    /// The ways of each kind.
    pub(crate) fn sets(&self) -> impl Iterator<Item = &WaySet> {
        self.0.values()
    }

    /// The conditions that ways name.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = u32> {
        self.0.values().flat_map(WaySet::conditions)
    }

    /// Whether all axes and conditions that it names are below a number of each.
    pub(crate) fn fits(&self, axes: usize, conditions: usize) -> bool {
        self.0.keys().all(|(axis, _)| axis.get() < axes)
            && self.conditions().all(|it| (it as usize) < conditions)
    }

    fn of(&self, key: (AxisIndex, Kind), reach: &WaySet) -> WaySet {
        self.0
            .get(&key)
            .map_or_else(|| reach.clone(), |ways| ways.and(reach))
    }
}

/// The ways to a block on which the state is the one that the program found.
#[derive(Debug, Clone)]
pub(crate) enum UntouchedOn {
    /// On all of them.
    Always,
    /// On none.
    Never,
    /// On some, in words: `if V.E.A == 2 (line 12)`.
    If(String),
}

/// The ways on which a state is the one that the program found.
#[derive(Debug, Clone)]
pub(crate) struct FoundOn(WaySet);

impl FoundOn {
    /// Returns whether it is all ways that lead to a block.
    pub(crate) fn is_all_of(&self, found: FoundStates<'_>) -> bool {
        self.0 == *found.reach
    }

    /// Returns whether it is every way of the program.
    pub(crate) fn is_always(&self) -> bool {
        self.0.is_always()
    }

    /// Adds the ways of another motion.
    pub(crate) fn or(&mut self, other: &Self) {
        self.0.or(&other.0);
    }
}

/// Kinds that a program has not yet switched at a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FoundStates<'a> {
    pub(crate) untouched: &'a Untouched,
    pub(crate) reach: &'a WaySet,
    pub(crate) conditions: &'a [Condition],
}

impl FoundStates<'_> {
    /// Whether a kind of an axis may still be in the state that the program found.
    pub(crate) fn has(self, axis: AxisIndex, kind: Kind) -> bool {
        match self.untouched.0.get(&(axis, kind)) {
            None => true,
            Some(ways) => !ways.is_never() && !ways.and(self.reach).is_never(),
        }
    }

    /// Whether it is on all ways, except where a value changes that the program set.
    pub(crate) fn is_always(self, axis: AxisIndex, kind: Kind) -> bool {
        let untouched = self.untouched.0.get(&(axis, kind));
        self.are_all(self.reach) && untouched.is_none_or(|ways| self.are_all(ways))
    }

    fn are_all(self, ways: &WaySet) -> bool {
        ways.is_always() || !ways.is_never() && ways_of(ways, self.conditions).is_empty()
    }

    /// All ways that lead to the block.
    pub(crate) fn on_all(self) -> FoundOn {
        FoundOn(self.reach.clone())
    }

    /// The ways on which a kind of an axis still is in that state.
    pub(crate) fn on(self, axis: AxisIndex, kind: Kind) -> FoundOn {
        FoundOn(self.untouched.of((axis, kind), self.reach))
    }

    /// Ways as lists of conditions that hold together; none where they are all.
    pub(crate) fn ways_of(self, on: &FoundOn) -> Vec<Vec<WayCondition>> {
        if on.0.is_always() {
            return Vec::new();
        }
        ways_of(&on.0, self.conditions)
    }

    /// The ways on which a kind of an axis still is in that state, each a list of conditions that hold
    /// together; none where it is on all of them, or on no way.
    pub(crate) fn ways(self, axis: AxisIndex, kind: Kind) -> Vec<Vec<WayCondition>> {
        self.ways_of(&self.on(axis, kind))
    }

    /// The ways on which a kind of an axis still is in that state, as seen from a file.
    pub(crate) fn of(self, axis: AxisIndex, kind: Kind, file: &str) -> UntouchedOn {
        let ways = self.untouched.of((axis, kind), self.reach);
        if ways.is_never() {
            UntouchedOn::Never
        } else if self.are_all(&ways) {
            UntouchedOn::Always
        } else {
            UntouchedOn::If(if_ways(&ways_of(&ways, self.conditions), file))
        }
    }
}
