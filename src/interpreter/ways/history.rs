//! History of the switching of each kind of compensation on each axis, which every reader asks: which state it has on
//! which ways (R14.2), on which ways it is still as the program found it (R1.52), and which blocks left it so or may have
//! switched it since (R1.50).
//!
//! ```text
//! N10 $IF V.E.A == 1
//! N20   X[COMP OFF FRICT]
//! N30 $ENDIF
//! N40 M30
//! ```
//!
//! At N40, FRICT of X is off `if V.E.A == 1` and on otherwise, as found unless `V.E.A == 1`, and the command that
//! switched it off last is that of N20. Where ways meet, only kinds whose histories differ are joined.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Compensation, Kind, KindSet, Membership, Selection};
use crate::interpreter::values::rows;
use crate::interpreter::ways::possible_state::{PossibleStates, states_of, ways_of};
use crate::interpreter::ways::question::Condition;
use crate::interpreter::ways::set::{WayAnswer, WaySet};
use crate::interpreter::ways::words::{WayCondition, if_ways};
use crate::text::Place;

/// Number of blocks of one effect kept for a kind where ways meet; of more, the later lines are kept.
const MAX_KEPT: usize = 16;

/// A kind of an axis.
pub(crate) type AxisKind = (AxisIndex, Kind);

/// The ways on which a kind of an axis is selected, and those on which it is not.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
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

    /// Restricts both to the ways on which a condition has an answer, without naming it.
    pub(crate) fn given(&self, answer: WayAnswer) -> Self {
        Self {
            on: self.on.given(answer),
            off: self.off.given(answer),
        }
    }

    /// Renumbers the conditions of both.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> u32) -> Self {
        Self {
            on: self.on.renumbered(&number),
            off: self.off.renumbered(&number),
        }
    }

    /// Returns whether all conditions that it names are below a number.
    pub(crate) fn fits(&self, conditions: usize) -> bool {
        self.conditions().all(|it| (it as usize) < conditions)
    }

    /// Returns the conditions that both name.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = u32> {
        self.on.conditions().chain(self.off.conditions())
    }

    /// Returns the only selection that is possible on some ways.
    fn only_on(&self, ways: &WaySet) -> Option<Membership> {
        match (self.on.is_apart_from(ways), self.off.is_apart_from(ways)) {
            (false, true) => Some(Membership::In),
            (true, false) => Some(Membership::Out),
            _ => None,
        }
    }

    /// Returns the only selection that is possible.
    pub(crate) fn only(&self) -> Option<Membership> {
        match (self.on.is_never(), self.off.is_never()) {
            (false, true) => Some(Membership::In),
            (true, false) => Some(Membership::Out),
            _ => None,
        }
    }
}

/// Effect of a block on a kind; of the effects of one block, the later one counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum KindEffect {
    /// Switch off by a command.
    Off,
    /// Switch on by a command.
    On,
    /// Unknown switching of any kind (R2.52).
    Lost,
    /// A part of the program that may or may not be executed, or a change of the machine data, may switch it (R2.51,
    /// R2.92).
    Doubted,
}

impl KindEffect {
    const ALL: [Self; 4] = [Self::Off, Self::On, Self::Lost, Self::Doubted];
}

impl From<Selection> for KindEffect {
    fn from(selection: Selection) -> Self {
        match selection {
            Selection::On(_) => Self::On,
            Selection::Off(_) | Selection::OffAll => Self::Off,
        }
    }
}

/// Kinds that one earlier command each switched as a command does, on every way that leads to it, without anything in
/// between that may have switched them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct RepeatedSwitch {
    pub(crate) kinds: KindSet,
    /// The latest of those commands.
    pub(crate) site: Option<BlockSite>,
}

/// The blocks of one effect, by file and line.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "Vec<BlockSite>", from = "Vec<BlockSite>")]
struct BlockSites(BTreeMap<(Arc<str>, u32), BlockSite>);

impl From<Vec<BlockSite>> for BlockSites {
    fn from(sites: Vec<BlockSite>) -> Self {
        let line = |it: &BlockSite| (Arc::clone(&it.place.file), it.place.first_line);
        Self(sites.into_iter().map(|it| (line(&it), it)).collect())
    }
}

impl From<BlockSites> for Vec<BlockSite> {
    fn from(sites: BlockSites) -> Self {
        sites.0.into_values().collect()
    }
}

impl BlockSites {
    fn join(&mut self, other: &Self) {
        for (line, site) in &other.0 {
            self.0.entry(line.clone()).or_insert_with(|| site.clone());
        }
        while self.0.len() > MAX_KEPT {
            self.0.pop_first();
        }
    }

    fn latest(&self) -> Option<&BlockSite> {
        self.0.values().max_by_key(|site| site.seq)
    }
}

/// History of a kind of an axis in the running program.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
struct KindHistory {
    /// The ways on which it is as the program found it; `None` for all that lead here.
    found: Option<WaySet>,
    /// The ways to each state where they differ; a kind that is unknown without them may be in any state on any way.
    states: Option<Split>,
    /// The blocks of each effect: the commands that are the last ones on some way, and what may have switched it since.
    sites: [BlockSites; KindEffect::ALL.len()],
}

impl KindHistory {
    fn sets(&self) -> impl Iterator<Item = &WaySet> {
        let states = self.states.iter().flat_map(|it| [&it.on, &it.off]);
        states.chain(&self.found)
    }

    fn found_on(&self, reach: &WaySet) -> WaySet {
        self.found
            .as_ref()
            .map_or_else(|| reach.clone(), |ways| ways.and(reach))
    }

    /// Returns the block with an effect, where nothing else has any on the ways of `reach`.
    fn only(&self, effect: KindEffect, reach: &WaySet) -> Option<&BlockSite> {
        let blocks: usize = self.sites.iter().map(|sites| sites.0.len()).sum();
        let site = self.sites[effect as usize].latest();
        site.filter(|_| blocks == 1 && self.found_on(reach).is_never())
    }

    /// Joins everything but the states. `reach` has the ways to this history and to the other.
    fn join(&mut self, other: &Self, reach: [&WaySet; 2]) {
        if self.found != other.found {
            let mut found = self.found_on(reach[0]);
            found.or(&other.found_on(reach[1]));
            self.found = Some(found);
        }
        self.join_sites(other);
    }

    fn join_sites(&mut self, other: &Self) {
        for (mine, theirs) in self.sites.iter_mut().zip(&other.sites) {
            mine.join(theirs);
        }
    }
}

/// The histories of all kinds of all axes. One without an entry is as the program found it on every way.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct History(#[serde(with = "rows")] BTreeMap<AxisKind, Arc<KindHistory>>);

/// A state of the compensation and its history, with the ways on which the control has it.
pub(crate) struct HistorySide<'a> {
    pub(crate) compensation: &'a Compensation,
    pub(crate) history: &'a History,
    pub(crate) reach: &'a WaySet,
}

impl HistorySide<'_> {
    /// Returns the ways to each state of a kind; `None` where they are not known.
    fn split(&self, (axis, kind): AxisKind) -> Option<Split> {
        if self.compensation.unknown(axis).contains(kind) {
            let split = self.history.states(axis, kind)?;
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

    /// Returns whether a kind is unknown on both sides, with the same ways to its states.
    fn is_open_alike(&self, (axis, kind): AxisKind, theirs: &Self) -> bool {
        let is_unknown = |it: &Self| it.compensation.unknown(axis).contains(kind);
        is_unknown(self)
            && is_unknown(theirs)
            && self.is_parameterised_alike((axis, kind), theirs)
            && self.history.states(axis, kind) == theirs.history.states(axis, kind)
    }

    fn is_parameterised_alike(&self, (axis, kind): AxisKind, theirs: &Self) -> bool {
        let both = [self, theirs].map(|it| it.compensation.is_parameterised(axis, kind));
        both[0] == both[1]
    }

    /// Returns the ways of both sides to each state of a kind; `None` where they are not known.
    fn join_states(&self, key: AxisKind, theirs: &Self) -> Option<Split> {
        let (mut split, other) = self.split(key).zip(theirs.split(key))?;
        split.on.or(&other.on);
        split.off.or(&other.off);
        Some(split).filter(|_| self.is_parameterised_alike(key, theirs))
    }
}

impl History {
    /// Returns the histories of kinds of which only the ways to their states are known.
    pub(crate) fn of_states(states: impl IntoIterator<Item = (AxisKind, Split)>) -> Self {
        let mut history = Self::default();
        for ((axis, kind), split) in states {
            history.open(axis, kind, split);
        }
        history
    }

    /// Begins a program, which finds the states that the one before it left.
    pub(crate) fn begin_program(&mut self) {
        self.change_all(|kind| {
            kind.found = None;
            kind.sites = Default::default();
        });
    }

    /// Records that a command switches kinds of an axis: on this way it is the last one.
    pub(crate) fn switch(&mut self, axis: AxisIndex, selection: Selection, site: BlockSite) {
        let mut switched = KindHistory {
            found: Some(WaySet::never()),
            ..KindHistory::default()
        };
        switched.sites[KindEffect::from(selection) as usize] = vec![site].into();
        let switched = Arc::new(switched);
        for kind in selection.kinds().iter() {
            self.0.insert((axis, kind), Arc::clone(&switched));
        }
    }

    /// Records that a block may have switched kinds of an axis.
    pub(crate) fn doubt(
        &mut self,
        (axis, kinds): (AxisIndex, KindSet),
        effect: KindEffect,
        site: BlockSite,
    ) {
        let site = BlockSites::from(vec![site]);
        for kind in kinds.iter() {
            self.change((axis, kind), |it| it.sites[effect as usize].join(&site));
        }
    }

    /// Records that something other than a command sets kinds of an axis.
    pub(crate) fn set(&mut self, axis: AxisIndex, kinds: KindSet) {
        let set = Arc::new(KindHistory {
            found: Some(WaySet::never()),
            ..KindHistory::default()
        });
        for kind in kinds.iter() {
            self.0.insert((axis, kind), Arc::clone(&set));
        }
    }

    /// Forgets the places of all commands, since a restart of the control comes after all blocks.
    pub(crate) fn forget_sites(&mut self) {
        self.change_all(|kind| kind.sites = Default::default());
    }

    /// Ends the distinction of ways by the states of kinds of an axis, which are known, or may be any on any way.
    pub(crate) fn close(&mut self, axis: AxisIndex, kinds: KindSet) {
        for kind in kinds.iter() {
            if self.states(axis, kind).is_some() {
                self.change((axis, kind), |it| it.states = None);
            }
        }
    }

    /// Ends the distinction of ways by the states of all kinds of all axes.
    pub(crate) fn close_all(&mut self) {
        self.change_all(|kind| kind.states = None);
    }

    /// Gives a kind of an axis either state, each on its ways.
    pub(crate) fn open(&mut self, axis: AxisIndex, kind: Kind, split: Split) {
        self.change((axis, kind), |it| it.states = Some(split));
    }

    /// Returns whether the state of some kind differs between ways.
    #[inline]
    pub(crate) fn is_open(&self) -> bool {
        self.0.values().any(|kind| kind.states.is_some())
    }

    /// Returns the ways to the states of a kind of an axis, where they differ.
    pub(crate) fn states(&self, axis: AxisIndex, kind: Kind) -> Option<&Split> {
        self.0.get(&(axis, kind))?.states.as_ref()
    }

    /// Returns the kinds whose states differ between ways.
    pub(crate) fn open_kinds(&self) -> impl Iterator<Item = (AxisKind, &Split)> {
        let kinds = self.0.iter();
        kinds.filter_map(|(key, kind)| Some((*key, kind.states.as_ref()?)))
    }

    /// Returns the ways to a block on which a kind is as the program found it.
    pub(crate) fn found(&self, key: AxisKind, reach: &WaySet) -> WaySet {
        let known = self.0.get(&key);
        known.map_or_else(|| reach.clone(), |kind| kind.found_on(reach))
    }

    /// Returns the ways on which a kind is as the program found it, as they are; `None` for all that lead to the block.
    fn found_ways(&self, axis: AxisIndex, kind: Kind) -> Option<&WaySet> {
        self.0.get(&(axis, kind))?.found.as_ref()
    }

    /// Returns the latest of the blocks with an effect on a kind of an axis.
    pub(crate) fn latest(
        &self,
        axis: AxisIndex,
        kind: Kind,
        effect: KindEffect,
    ) -> Option<&BlockSite> {
        self.0.get(&(axis, kind))?.sites[effect as usize].latest()
    }

    /// Returns the latest of all blocks with an effect on a kind of an axis.
    pub(crate) fn last(&self, axis: AxisIndex, kind: Kind) -> Option<(KindEffect, &BlockSite)> {
        let effects = KindEffect::ALL.into_iter();
        let sites = effects.filter_map(|it| Some((it, self.latest(axis, kind, it)?)));
        sites.max_by_key(|(_, site)| site.seq)
    }

    /// Returns the kinds of an axis that a command switches as an earlier one did on all ways of `reach`.
    pub(crate) fn repeated(
        &self,
        axis: AxisIndex,
        selection: Selection,
        reach: &WaySet,
    ) -> RepeatedSwitch {
        let effect = KindEffect::from(selection);
        let mut repeated = RepeatedSwitch::default();
        for kind in selection.kinds().iter() {
            let known = self.0.get(&(axis, kind));
            let Some(site) = known.and_then(|known| known.only(effect, reach)) else {
                continue;
            };
            repeated.kinds.insert(kind);
            if repeated.site.as_ref().is_none_or(|it| it.seq < site.seq) {
                repeated.site = Some(site.clone());
            }
        }
        repeated
    }

    /// Restricts the history to some ways: whatever they all agree on is known.
    pub(crate) fn narrow(&mut self, ways: &WaySet, compensation: &mut Compensation) {
        let known: Vec<(AxisKind, Membership)> = self
            .open_kinds()
            .filter_map(|(key, split)| Some((key, split.only_on(ways)?)))
            .collect();
        for ((axis, kind), only) in known {
            compensation.decide(axis, kind, only);
            self.close(axis, KindSet::of(kind));
        }
    }

    /// Forgets the answer to a condition, which is asked again.
    pub(crate) fn havoc(&mut self, condition: u32) {
        for kind in self.0.values_mut() {
            if kind
                .sets()
                .any(|ways| ways.conditions().any(|it| it == condition))
            {
                let KindHistory { found, states, .. } = Arc::make_mut(kind);
                let states = states.iter_mut().flat_map(|it| [&mut it.on, &mut it.off]);
                states.chain(found).for_each(|ways| ways.havoc(condition));
            }
        }
    }

    /// Joins the states of two ways that meet: those to `compensation`, on the ways of `reach`, and theirs.
    pub(crate) fn join(
        &mut self,
        compensation: &mut Compensation,
        reach: &WaySet,
        theirs: &HistorySide<'_>,
    ) {
        compensation.join_rewritten(theirs.compensation);
        let axes = (0..compensation.len()).map(AxisIndex::new);
        let differing = axes.flat_map(|axis| {
            let kinds = compensation.differing(theirs.compensation, axis);
            kinds
                .iter()
                .map(move |kind| (axis, kind))
                .collect::<Vec<_>>()
        });
        let differing: BTreeSet<AxisKind> = differing.collect();
        let mut keys = differing.clone();
        if *self != *theirs.history {
            keys.extend(self.0.keys().chain(theirs.history.0.keys()));
        }
        for key @ (axis, kind) in keys {
            let mine = HistorySide {
                compensation,
                history: self,
                reach,
            };
            let (known, other) = (self.0.get(&key), theirs.history.0.get(&key));
            let is_alike = !differing.contains(&key) || mine.is_open_alike(key, theirs);
            if is_alike && known == other {
                continue;
            }
            let states = (!is_alike).then(|| mine.join_states(key, theirs));
            let mut joined = known.map(|it| KindHistory::clone(it)).unwrap_or_default();
            if known != other {
                let other = other.map(|it| KindHistory::clone(it)).unwrap_or_default();
                joined.join(&other, [reach, theirs.reach]);
            }
            if let Some(states) = states {
                let only = states.as_ref().and_then(|it| it.only_on(&WaySet::always()));
                match only {
                    Some(only) => compensation.decide(axis, kind, only),
                    None => compensation.havoc(axis, KindSet::of(kind), &mut Vec::new()),
                }
                joined.states = states.filter(|_| only.is_none());
            }
            self.change(key, |it| *it = joined);
        }
    }

    /// Returns the ways of each kind that are compared where ways meet.
    pub(crate) fn sets(&self) -> impl Iterator<Item = &WaySet> {
        self.0.values().flat_map(|kind| kind.sets())
    }

    /// Returns the conditions that ways name.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = u32> {
        self.sets().flat_map(WaySet::conditions)
    }

    /// Returns whether all axes and conditions that it names are below a number of each.
    pub(crate) fn fits(&self, axes: usize, conditions: usize) -> bool {
        self.0.keys().all(|(axis, _)| axis.get() < axes)
            && self.conditions().all(|it| (it as usize) < conditions)
    }

    fn change(&mut self, key: AxisKind, change: impl FnOnce(&mut KindHistory)) {
        let mut kind = self.0.remove(&key).unwrap_or_default();
        change(Arc::make_mut(&mut kind));
        if *kind != KindHistory::default() {
            self.0.insert(key, kind);
        }
    }

    fn change_all(&mut self, change: impl Fn(&mut KindHistory)) {
        self.0.retain(|_, kind| {
            change(Arc::make_mut(kind));
            **kind != KindHistory::default()
        });
    }
}

/// Words of an executed block that switched a kind, may have switched it, or moved an axis.
#[derive(Debug, Clone, Eq, Serialize, Deserialize)]
pub(crate) struct BlockSite {
    /// The executed block.
    pub(crate) seq: u64,
    pub(crate) place: Place,
}

impl PartialEq for BlockSite {
    /// Compares two blocks; one that a loop repeats counts as equal.
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place
    }
}

impl BlockSite {
    /// Returns the block as named by a message in a file: `line 4`, or `sub.nc:4`.
    pub(crate) fn seen_from(&self, file: &str) -> String {
        let (place, line) = (&self.place, self.place.start().line);
        if *place.file == *file {
            format!("line {line}")
        } else {
            format!("{}:{line}", place.file)
        }
    }
}

/// The ways to a block on which the state is the one that the program found.
#[derive(Debug, Clone)]
pub(crate) enum UntouchedOn {
    /// All ways.
    Always,
    /// No way.
    Never,
    /// Some of the ways, in words: `if V.E.A == 2 (line 12)`.
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
    /// Returns the possible states of a kind, with some of the ways to each.
    pub(crate) fn states_of(
        self,
        kind: (&Compensation, AxisKind),
        split: &Split,
    ) -> PossibleStates {
        states_of(kind, split, (self.reach, self.conditions))
    }

    /// Returns whether a kind of an axis may still be in the state that the program found.
    pub(crate) fn has(self, axis: AxisIndex, kind: Kind) -> bool {
        let ways = self.history.found_ways(axis, kind);
        ways.is_none_or(|ways| !ways.is_apart_from(self.reach))
    }

    /// Returns whether it is on all ways, except where a value changes that the program set.
    pub(crate) fn is_always(self, axis: AxisIndex, kind: Kind) -> bool {
        let ways = self.history.found_ways(axis, kind);
        self.are_all(self.reach) && ways.is_none_or(|ways| self.are_all(ways))
    }

    fn are_all(self, ways: &WaySet) -> bool {
        ways.is_always() || !ways.is_never() && ways_of(ways, self.conditions).is_empty()
    }

    /// Returns all ways that lead to the block.
    pub(crate) fn on_all(self) -> FoundOn {
        FoundOn(self.reach.clone())
    }

    /// Returns the ways on which a kind of an axis still is in that state.
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

    /// Returns the ways on which a kind of an axis still is in that state, each a list of conditions that hold
    /// together; none where it is on all of them, or on no way.
    pub(crate) fn ways(self, axis: AxisIndex, kind: Kind) -> Vec<Vec<WayCondition>> {
        self.ways_of(&self.on(axis, kind))
    }

    /// Returns the ways on which a kind of an axis still is in that state, as seen from a file.
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
