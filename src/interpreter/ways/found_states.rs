//! Questions about the ways on which a program has not yet switched the state that it found (R1.52, R14.5).

use super::history::{AxisKind, History, Split};
use super::possible_state::{PossibleStates, states_of, ways_of};
use super::question::Condition;
use super::set::WaySet;
use super::words::{WayCondition, if_ways};
use crate::comp::{AxisIndex, Compensation, Kind};

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
    pub(crate) history: &'a History,
    pub(crate) reach: &'a WaySet,
    pub(crate) conditions: &'a [Condition],
}

impl FoundStates<'_> {
    /// The possible states of a kind, with some of the ways to each.
    pub(crate) fn states_of(
        self,
        kind: (&Compensation, AxisKind),
        split: &Split,
    ) -> PossibleStates {
        states_of(kind, split, (self.reach, self.conditions))
    }

    /// Whether a kind of an axis may still be in the state that the program found.
    pub(crate) fn has(self, axis: AxisIndex, kind: Kind) -> bool {
        let ways = self.history.found_ways(axis, kind);
        ways.is_none_or(|ways| !ways.is_apart_from(self.reach))
    }

    /// Whether it is on all ways, except where a value changes that the program set.
    pub(crate) fn is_always(self, axis: AxisIndex, kind: Kind) -> bool {
        let ways = self.history.found_ways(axis, kind);
        self.are_all(self.reach) && ways.is_none_or(|ways| self.are_all(ways))
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
        FoundOn(self.history.found((axis, kind), self.reach))
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
        let ways = self.history.found((axis, kind), self.reach);
        if ways.is_never() {
            UntouchedOn::Never
        } else if self.are_all(&ways) {
            UntouchedOn::Always
        } else {
            UntouchedOn::If(if_ways(&ways_of(&ways, self.conditions), file))
        }
    }
}
