//! The possible states where there is more than one, each with the ways that lead to it (R14.2).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::way_set::WaySet;
use crate::comp::{AxisIndex, Compensation, Kind, KindSet, Membership};
use crate::interpreter::values::rows;

/// The ways on which a kind of an axis is selected, and those on which it is not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Split {
    pub(crate) on: WaySet,
    pub(crate) off: WaySet,
}

impl Split {
    /// Restricts both to some ways.
    pub(crate) fn and(&self, ways: &WaySet) -> Self {
        Self {
            on: self.on.and(ways),
            off: self.off.and(ways),
        }
    }

    /// Renumbers the conditions of both.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> u32) -> Self {
        Self {
            on: self.on.renumbered(&number),
            off: self.off.renumbered(&number),
        }
    }

    /// Whether all conditions that it names are below a number.
    pub(crate) fn fits(&self, conditions: usize) -> bool {
        self.conditions().all(|it| (it as usize) < conditions)
    }

    fn conditions(&self) -> impl Iterator<Item = u32> {
        self.on.conditions().chain(self.off.conditions())
    }

    fn havoc(&mut self, condition: u32) {
        self.on.havoc(condition);
        self.off.havoc(condition);
    }
}

/// The states of kinds that are unknown because ways differ. A kind that is unknown and not among
/// them may be in any state on any way.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct PossibleKinds(#[serde(with = "rows")] BTreeMap<(AxisIndex, Kind), Split>);

impl FromIterator<((AxisIndex, Kind), Split)> for PossibleKinds {
    fn from_iter<I: IntoIterator<Item = ((AxisIndex, Kind), Split)>>(splits: I) -> Self {
        Self(splits.into_iter().collect())
    }
}

impl PossibleKinds {
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn of(&self, axis: AxisIndex, kind: Kind) -> Option<&Split> {
        self.0.get(&(axis, kind))
    }

    /// Replaces the possible states of kinds of an axis.
    pub(crate) fn replace(&mut self, axis: AxisIndex, kinds: KindSet) {
        if !self.is_empty() {
            self.0
                .retain(|(of, kind), _| *of != axis || !kinds.contains(*kind));
        }
    }

    /// The ways on which a kind of an axis is selected, and those on which it is not.
    pub(crate) fn insert(&mut self, axis: AxisIndex, kind: Kind, split: Split) {
        self.0.insert((axis, kind), split);
    }

    /// The kinds that have possible states.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&(AxisIndex, Kind), &Split)> {
        self.0.iter()
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Whether all axes and conditions that it names are below a number of each.
    pub(crate) fn fits(&self, axes: usize, conditions: usize) -> bool {
        let mut splits = self.0.iter();
        splits.all(|((axis, _), split)| axis.get() < axes && split.fits(conditions))
    }

    /// The conditions that ways name.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = u32> {
        self.0.values().flat_map(Split::conditions)
    }

    /// A condition is asked again.
    pub(crate) fn havoc(&mut self, condition: u32) {
        for split in self.0.values_mut() {
            split.havoc(condition);
        }
    }

    /// The run continues on some ways only: whatever they all agree on is known.
    pub(crate) fn narrow(&mut self, ways: &WaySet, compensation: &mut Compensation) {
        self.0.retain(|(axis, kind), split| {
            let left = split.and(ways);
            let only = match (left.on.is_never(), left.off.is_never()) {
                (false, true) => Membership::In,
                (true, false) => Membership::Out,
                _ => return true,
            };
            compensation.decide(*axis, *kind, only);
            false
        });
    }
}

/// A state of the compensation with the ways on which the control has it.
pub(crate) struct PossibleSide<'a> {
    pub(crate) compensation: &'a Compensation,
    pub(crate) possible: &'a PossibleKinds,
    pub(crate) reach: &'a WaySet,
}

impl PossibleSide<'_> {
    /// The ways on which a kind is selected; `None` where that is not known.
    fn split(&self, axis: AxisIndex, kind: Kind) -> Option<Split> {
        if self.compensation.unknown(axis).contains(kind) {
            let split = self.possible.of(axis, kind)?;
            return Some(split.and(self.reach));
        }
        let (reach, never) = (self.reach.clone(), WaySet::never());
        Some(if self.compensation.selected(axis).contains(kind) {
            Split {
                on: reach,
                off: never,
            }
        } else {
            Split {
                on: never,
                off: reach,
            }
        })
    }
}

/// Joins the states of two ways that meet.
pub(crate) fn join(
    mine: &PossibleSide<'_>,
    theirs: &PossibleSide<'_>,
) -> (Compensation, PossibleKinds) {
    let mut compensation = mine.compensation.clone();
    let mut possible = PossibleKinds::default();
    for axis in (0..compensation.len()).map(AxisIndex::new) {
        for kind in mine
            .compensation
            .differing(theirs.compensation, axis)
            .iter()
        {
            let is_same = mine.compensation.is_parameterised(axis, kind)
                == theirs.compensation.is_parameterised(axis, kind);
            let splits = mine.split(axis, kind).zip(theirs.split(axis, kind));
            let Some((mut split, other)) = splits.filter(|_| is_same) else {
                compensation.havoc(axis, KindSet::of(kind), &mut Vec::new());
                continue;
            };
            split.on.or(&other.on);
            split.off.or(&other.off);
            match (split.on.is_never(), split.off.is_never()) {
                (false, true) => compensation.decide(axis, kind, Membership::In),
                (true, false) => compensation.decide(axis, kind, Membership::Out),
                _ => {
                    compensation.havoc(axis, KindSet::of(kind), &mut Vec::new());
                    possible.0.insert((axis, kind), split);
                }
            }
        }
    }
    (compensation, possible)
}
