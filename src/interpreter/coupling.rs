//! Axis couplings (R2.47): which groups `#SET AX LINK` defined, which of them are in force, and what that means for
//! compensations and positions.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Coupling};
use crate::interpreter::control::ControlState;
use crate::language::{Certainty, Holds, Simplification};
use crate::machine::Machine;

/// The coupling groups of a run.
///
/// After a coupling command that may or may not have been executed, no group is known until it is
/// redefined. Every axis that a group ever named may then be coupled, or may be as soon as a group is
/// enabled, where only definitions changed and no group was in force.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Couplings {
    groups: BTreeMap<String, CoupledAxes>,
    /// The groups in force, in the order in which they were enabled.
    enabled: BTreeMap<u64, String>,
    /// Number of groups in force that couple each axis.
    holding: BTreeMap<AxisIndex, u32>,
    /// Number of groups in force in which each axis is a slave, and a master.
    #[serde(default)]
    sides: BTreeMap<AxisIndex, [u32; 2]>,
    /// Number of times a group was enabled.
    turns: u64,
    /// Every axis that a group ever named.
    named: BTreeSet<AxisIndex>,
    /// Whether unknown groups may be defined.
    vague: bool,
    /// Whether unknown groups may be in force.
    doubted: bool,
    /// Number of groups of the channel parameters in force, whose axes are unknown.
    unknown: u32,
    /// Axes that follow others by other commands, each with the one that it follows, by command.
    #[serde(default)]
    followers: BTreeMap<String, Vec<(AxisIndex, AxisIndex)>>,
    /// Axes that may follow any other one.
    #[serde(default)]
    strays: BTreeSet<AxisIndex>,
}

/// An axis, the one that it follows, `None` for any, and whether it certainly does.
pub(crate) type CouplingLink = (AxisIndex, Option<AxisIndex>, Certainty);

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct CoupledAxes {
    axes: Vec<AxisIndex>,
    /// The turn at which it was enabled, while it is in force.
    enabled: Option<u64>,
    /// Whether the channel parameters define the group, so that its axes are unknown.
    unknown: bool,
}

/// Limit on the groups in force, beyond any control; conflicts of further ones are not looked for.
const MOST_GROUPS: usize = 32;

impl CoupledAxes {
    /// Returns its pairs, slave and master, of which both are axes of the machine.
    fn pairs(&self) -> impl Iterator<Item = [AxisIndex; 2]> {
        let pairs = self.axes.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        pairs.filter(|[slave, master]| slave != master)
    }
}

impl PartialEq for Couplings {
    /// Returns whether the blocks that follow find the same couplings.
    fn eq(&self, other: &Self) -> bool {
        let groups = |couplings: &Self| {
            let groups = couplings.groups.iter();
            let groups =
                groups.map(|(name, group)| (name.clone(), group.axes.clone(), group.unknown));
            groups.collect::<Vec<_>>()
        };
        self.enabled.values().eq(other.enabled.values())
            && (&self.followers, &self.strays) == (&other.followers, &other.strays)
            && (&self.named, self.vague, self.doubted) == (&other.named, other.vague, other.doubted)
            && groups(self) == groups(other)
    }
}

impl Couplings {
    /// Returns whether an axis may move because another one does.
    #[inline]
    pub(crate) fn carry(&self) -> bool {
        self.doubted
            || !self.enabled.is_empty()
            || !self.followers.is_empty()
            || !self.strays.is_empty()
    }

    /// Returns the followers of each axis.
    pub(crate) fn links(&self) -> Vec<CouplingLink> {
        let groups = self
            .enabled
            .values()
            .filter_map(|name| self.groups.get(name));
        // `slave=master` (PM/207120267)
        let pairs = groups.flat_map(|group| group.axes.chunks_exact(2));
        let pairs = pairs.map(|pair| (pair[0], pair[1]));
        let certain = pairs.chain(self.followers.values().flatten().copied());
        let certain = certain.map(|(one, other)| (one, Some(other), Certainty::Certain));
        let is_doubted = self.is_doubted();
        let doubted = self.named.iter().filter(|_| is_doubted);
        let strays = self.strays.iter().chain(doubted);
        let strays = strays.map(|axis| (*axis, None, Certainty::Possible));
        certain.chain(strays).collect()
    }

    /// Axes follow others.
    pub(crate) fn follow(&mut self, command: String, pairs: Vec<(AxisIndex, AxisIndex)>) {
        self.followers.insert(command, pairs);
    }

    /// Returns whether axes follow others by a command.
    pub(crate) fn is_following(&self, command: &str) -> bool {
        self.followers.contains_key(command)
    }

    /// Ends the following of axes by a command.
    pub(crate) fn unfollow(&mut self, command: &str) {
        self.followers.remove(command);
    }

    /// Ends all following of axes other than by a coupling group.
    pub(crate) fn end_following(&mut self) {
        self.followers.clear();
        self.strays.clear();
    }

    /// Makes the following of axes uncertain, and lets these axes possibly follow others, too.
    pub(crate) fn havoc_followers(&mut self, axes: &[AxisIndex]) {
        let followers = std::mem::take(&mut self.followers);
        let followers = followers.into_values().flatten().map(|(axis, _)| axis);
        self.strays.extend(followers.chain(axes.iter().copied()));
    }

    /// Returns whether a group is in force, or may be.
    pub(crate) fn is_any(&self) -> bool {
        self.doubted || !self.enabled.is_empty()
    }

    /// Returns the pairs of axes that groups couple; `None` where that is not known.
    pub(crate) fn in_force(&self) -> Option<Vec<AxisIndex>> {
        let groups = self.enabled.values().map(|name| self.groups.get(name));
        let groups: Option<Vec<_>> = groups.collect();
        let axes = groups?.into_iter().flat_map(|group| &group.axes);
        (!self.is_doubted()).then(|| axes.copied().collect())
    }

    /// Returns whether axes may be coupled by a group whose axes are unknown.
    fn is_doubted(&self) -> bool {
        self.doubted || self.unknown > 0
    }

    /// Returns the number of defined groups.
    pub(crate) fn len(&self) -> usize {
        self.groups.len()
    }

    /// Returns the groups that are known, with their axes.
    pub(crate) fn groups(&self) -> impl Iterator<Item = (&str, &[AxisIndex])> {
        let groups = self.groups.iter().filter(|(_, group)| !group.unknown);
        groups.map(|(name, group)| (name.as_str(), group.axes.as_slice()))
    }

    /// Returns the axes that groups in force couple, or may.
    pub(crate) fn perhaps_in_force(&self) -> BTreeSet<AxisIndex> {
        if self.is_doubted() {
            self.named.clone()
        } else {
            self.holding.keys().copied().collect()
        }
    }

    /// Returns the axes of the groups that commands defined, or may have defined.
    pub(crate) fn perhaps_defined(&self) -> BTreeSet<AxisIndex> {
        let groups = self.groups.iter().filter(|(name, _)| *name != LISTED);
        let named = groups.flat_map(|(_, group)| &group.axes).copied();
        named.chain(self.lost()).collect()
    }

    /// Returns the axes that unknown groups may name.
    pub(crate) fn lost(&self) -> impl Iterator<Item = AxisIndex> {
        self.named.iter().copied().filter(|_| self.vague)
    }

    /// Returns whether the axis is coupled by a group in force, may be, or is not.
    pub(crate) fn of(&self, axis: AxisIndex) -> Coupling {
        if self.holding.contains_key(&axis) {
            Coupling::Active
        } else if self.is_doubted() && self.named.contains(&axis) {
            Coupling::Perhaps
        } else {
            Coupling::None
        }
    }

    /// Returns whether a group is in force, or may be; one without a known number may be any.
    pub(crate) fn of_group(&self, group: &str) -> Coupling {
        let is_known = !group.is_empty() && group.bytes().all(|it| it.is_ascii_digit());
        let known = self.groups.get(group);
        if is_known && known.is_some_and(|group| group.enabled.is_some()) {
            Coupling::Active
        } else if self.doubted || (!is_known && self.is_any()) {
            Coupling::Perhaps
        } else {
            Coupling::None
        }
    }

    /// Forgets the definition of a group, and returns the axes that it coupled.
    fn forget(&mut self, group: &str) -> Vec<AxisIndex> {
        let changed = self.release(group);
        self.groups.remove(group);
        changed
    }

    /// Returns an axis of a group that is to be enabled and that another group in force does not admit, with the number
    /// of the error (R2.114).
    pub(crate) fn conflict(&self, group: &str) -> Option<(u32, AxisIndex)> {
        if self.enabled.len() > MOST_GROUPS {
            return None;
        }
        let known = self.groups.get(group)?;
        let is_in = |axis: AxisIndex, side: usize| {
            let sides = self.sides.get(&axis);
            known.enabled.is_none() && sides.is_some_and(|sides| sides[side] > 0)
        };
        known.pairs().find_map(|[slave, master]| {
            let found = [(slave, 0, 21283), (slave, 1, 21284), (master, 0, 21285)];
            let found = found
                .into_iter()
                .find(|(axis, side, _)| is_in(*axis, *side));
            found.map(|(axis, _, number)| (number, axis))
        })
    }

    /// The slaves of a group that is known.
    pub(crate) fn slaves(&self, group: &str) -> impl Iterator<Item = AxisIndex> {
        let known = self.groups.get(group).into_iter();
        known.flat_map(|group| group.pairs().map(|[slave, _]| slave))
    }

    /// Counts the axes of a group that comes into force, or is released.
    fn count(&mut self, pairs: &[[AxisIndex; 2]], change: impl Fn(u32) -> u32) {
        for pair in pairs {
            for (side, axis) in pair.iter().enumerate() {
                let sides = self.sides.entry(*axis).or_default();
                sides[side] = change(sides[side]);
                if *sides == [0; 2] {
                    self.sides.remove(axis);
                }
            }
        }
    }

    /// Defines a group, which is then not in force. Returns the axes whose coupling may have changed.
    pub(crate) fn define(&mut self, group: &str, axes: Vec<AxisIndex>) -> Vec<AxisIndex> {
        let mut changed = self.release(group);
        changed.extend(&axes);
        self.named.extend(&axes);
        let defined = CoupledAxes {
            axes,
            ..CoupledAxes::default()
        };
        self.groups.insert(group.to_owned(), defined);
        changed
    }

    /// Groups whose members are unknown may name these axes.
    pub(crate) fn lose(&mut self, axes: impl IntoIterator<Item = AxisIndex>) {
        self.named.extend(axes);
        self.vague = true;
    }

    /// Makes the groups unknown, since some coupling command may have been executed. Returns the axes whose coupling
    /// may have changed.
    pub(crate) fn havoc(&mut self) -> Vec<AxisIndex> {
        self.release_all();
        self.groups.clear();
        self.vague = true;
        self.doubted = true;
        self.named.iter().copied().collect()
    }

    /// Merges other couplings, which may be in force instead. Returns the axes whose coupling may have changed.
    pub(crate) fn join(&mut self, other: &Self) -> Vec<AxisIndex> {
        if self == other {
            return Vec::new();
        }
        self.named.extend(&other.named);
        let mut followers: Vec<AxisIndex> = other.strays.iter().copied().collect();
        let pairs = other.followers.values().flatten();
        followers.extend(pairs.map(|(axis, _)| *axis));
        self.havoc_followers(&followers);
        self.havoc()
    }

    /// Returns whether all axes that it names are below a number.
    pub(crate) fn fits(&self, axes: usize) -> bool {
        let members = self.groups.values().flat_map(|group| &group.axes);
        let pairs = self.followers.values().flatten();
        let followers = pairs.flat_map(|(one, other)| [one, other]);
        members
            .chain(followers)
            .chain(&self.strays)
            .chain(self.holding.keys())
            .chain(&self.named)
            .all(|axis| axis.get() < axes)
    }

    /// Puts a group into force. Returns the axes whose coupling may have changed. One that no command defined is a
    /// group of the channel parameters, which may couple any axis of the machine.
    pub(crate) fn enable(
        &mut self,
        group: &str,
        axes: impl Iterator<Item = AxisIndex>,
    ) -> Vec<AxisIndex> {
        if !self.groups.contains_key(group) {
            self.named.extend(axes);
            if self.vague {
                self.doubted = true;
                return self.named.iter().copied().collect();
            }
            let unknown = CoupledAxes {
                unknown: true,
                ..CoupledAxes::default()
            };
            self.groups.insert(group.to_owned(), unknown);
        }
        self.release(group);
        self.turns = self.turns.wrapping_add(1);
        if let Some(known) = self.groups.get_mut(group) {
            known.enabled = Some(self.turns);
            self.unknown = self.unknown.saturating_add(u32::from(known.unknown));
            for &axis in &known.axes {
                let times = self.holding.entry(axis).or_default();
                *times = times.saturating_add(1);
            }
            let pairs: Vec<_> = known.pairs().collect();
            self.enabled.insert(self.turns, group.to_owned());
            self.count(&pairs, |groups| groups.saturating_add(1));
        }
        self.axes_of(group)
    }

    /// Returns the axes that a group couples, or may couple.
    fn axes_of(&self, group: &str) -> Vec<AxisIndex> {
        match self.groups.get(group) {
            Some(group) if group.unknown => self.named.iter().copied().collect(),
            Some(group) => group.axes.clone(),
            None => Vec::new(),
        }
    }

    /// Releases a group. Returns the axes whose coupling may have changed.
    pub(crate) fn release(&mut self, group: &str) -> Vec<AxisIndex> {
        let known = self.groups.get_mut(group);
        let Some((known, turn)) = known.and_then(|known| {
            let turn = known.enabled.take()?;
            Some((known, turn))
        }) else {
            return Vec::new();
        };
        self.unknown = self.unknown.saturating_sub(u32::from(known.unknown));
        self.enabled.remove(&turn);
        for axis in &known.axes {
            let times = self.holding.get(axis).copied().unwrap_or_default();
            if times > 1 {
                self.holding.insert(*axis, times - 1);
            } else {
                self.holding.remove(axis);
            }
        }
        let pairs: Vec<_> = self
            .groups
            .get(group)
            .into_iter()
            .flat_map(CoupledAxes::pairs)
            .collect();
        self.count(&pairs, |groups| groups.saturating_sub(1));
        self.axes_of(group)
    }

    /// Releases the last enabled group. Returns the axes whose coupling may have changed.
    pub(crate) fn release_last(&mut self) -> Vec<AxisIndex> {
        match self.enabled.pop_last() {
            Some((_, group)) => self.release(&group),
            None => Vec::new(),
        }
    }

    /// Releases every group, known or not. Returns the axes whose coupling may have changed.
    pub(crate) fn release_all(&mut self) -> Vec<AxisIndex> {
        if !self.doubted && self.enabled.is_empty() {
            return Vec::new();
        }
        self.doubted = false;
        self.unknown = 0;
        self.enabled.clear();
        self.holding.clear();
        self.sides.clear();
        for group in self.groups.values_mut() {
            group.enabled = None;
        }
        self.named.iter().copied().collect()
    }
}

impl ControlState {
    pub(crate) fn define_coupling(&mut self, group: &str, axes: Vec<AxisIndex>) {
        let changed = self.couplings.define(group, axes);
        self.mark_coupled(changed);
    }

    /// Discards the definition of a group: once it is in force, any axis may be coupled.
    pub(crate) fn forget_coupling(&mut self, group: &str) {
        let changed = self.couplings.forget(group);
        self.mark_coupled(changed);
    }

    /// Defines the coupling group of the channel list (P-CHAN-00037, P-CHAN-00038), if all its axes are known.
    pub(crate) fn define_listed_coupling(&mut self, machine: &Machine) {
        let numbers = machine.channel.coupled.iter().flatten();
        let axes = numbers.map(|number| machine.axis_numbered(*number));
        let axes: Option<Vec<_>> = axes.collect();
        if let Some(axes) = axes.filter(|axes| !axes.is_empty()) {
            self.define_coupling(LISTED, axes);
        }
    }

    pub(crate) fn enable_coupling(&mut self, group: &str, machine: &Machine) {
        self.modal.simplify(Simplification::Coupling, Holds::On);
        let axes = (0..machine.axes.len()).map(AxisIndex::new);
        let changed = self.couplings.enable(group, axes);
        self.mark_coupled(changed);
        self.lose_followers(group);
    }

    /// Axes that follow others have unknown positions from here on: `slave=master` (PM/207120267).
    fn lose_followers(&mut self, group: &str) {
        let groups = self.couplings.groups();
        let axes = groups.filter(|(name, _)| *name == group);
        let followers = axes.flat_map(|(_, axes)| axes.iter().step_by(2).copied());
        for axis in followers.collect::<Vec<_>>() {
            self.modal.havoc_position(axis);
        }
    }

    /// Couplings come into force as a group of these pairs, and no others are.
    pub(crate) fn restore_couplings(&mut self, axes: Vec<AxisIndex>, machine: &Machine) {
        self.release_couplings();
        self.define_coupling(RESTORED, axes);
        self.enable_coupling(RESTORED, machine);
    }

    /// Releases a group; without a name the last one that was enabled.
    pub(crate) fn disable_coupling(&mut self, group: &str) {
        let changed = if group.is_empty() {
            self.couplings.release_last()
        } else {
            self.couplings.release(group)
        };
        self.mark_coupled(changed);
        if !self.couplings.is_any() {
            self.modal.simplify(Simplification::Coupling, Holds::Off);
        }
    }

    /// Releases all couplings; the definitions stay.
    pub(crate) fn release_couplings(&mut self) {
        let changed = self.couplings.release_all();
        self.mark_coupled(changed);
        self.modal.simplify(Simplification::Coupling, Holds::Off);
    }

    /// Makes all couplings uncertain: any may be in force, or none.
    pub(crate) fn havoc_couplings(&mut self) {
        let changed = self.couplings.havoc();
        self.couplings.havoc_followers(&[]);
        if !changed.is_empty() {
            self.modal.simplify(Simplification::Coupling, Holds::On);
        }
        for axis in &changed {
            self.modal.havoc_position(*axis);
        }
        self.mark_coupled(changed);
    }

    /// Couples possibly any axes.
    pub(crate) fn couple_any(&mut self, machine: &Machine) {
        let all = (0..machine.axes.len()).map(AxisIndex::new).collect();
        self.define_coupling(RESTORED, all);
        self.havoc_couplings();
    }

    fn mark_coupled(&mut self, changed: Vec<AxisIndex>) {
        for axis in changed {
            let coupling = self.couplings.of(axis);
            self.compensation.set_coupled(axis, coupling);
        }
    }
}

/// Returns the name of the gear of an axis.
pub(crate) fn gear_of(axis: AxisIndex) -> String {
    format!("gear {}", axis.get())
}

/// Name of the coupling group that the channel list defines.
pub(crate) const LISTED: &str = "0";

/// The group in which saved couplings are restored.
const RESTORED: &str = "1";

/// Names of the followers of other commands.
pub(crate) const GANTRY: &str = "gantry";
pub(crate) const CAXTRACK: &str = "track";
