//! Commands that define, enable and release coupling groups (R2.47).

use crate::comp::AxisIndex;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::language::{FurtherWord, Holds, MembersBy, Moves, OnOff, Simplification};
use crate::syntax::ast::{Argument, BracketArguments, Hash};

impl Executor {
    pub(crate) fn define_coupling(
        &mut self,
        hash: &Hash,
        axes: Vec<AxisIndex>,
        at: &BlockContext<'_>,
    ) {
        let group = self.group_of(hash, at);
        self.scratch.wrote = true;
        let changed = self.state.control.couplings.define(&group, axes);
        self.state.control.mark_coupled(changed);
    }

    /// Without a group that of the channel list comes into force (PM/207133579).
    pub(crate) fn enable_coupling(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let mut group = self.group_of(hash, at);
        if group.is_empty() {
            group.push_str(LISTED);
        }
        let channel = &self.machine.channel;
        if group == LISTED && channel.is_whole && channel.coupled.is_empty() {
            let what = "the channel list defines no coupling group 0";
            self.may_refuse(None, what, hash.span, at);
        }
        self.enable_group(&group);
    }

    /// Defines the coupling group of the channel list (P-CHAN-00037, P-CHAN-00038), if all its axes are known.
    pub(crate) fn define_listed_couplings(&mut self) {
        let machine = &self.machine;
        let numbers = machine.channel.coupled.iter().flatten();
        let axes: Option<Vec<_>> = numbers
            .map(|number| machine.axis_numbered(*number))
            .collect();
        if let Some(axes) = axes.filter(|axes| !axes.is_empty()) {
            let changed = self.state.control.couplings.define(LISTED, axes);
            self.state.control.mark_coupled(changed);
        }
    }

    fn enable_group(&mut self, group: &str) {
        self.simplify(Simplification::Coupling, Holds::On);
        let axes = (0..self.machine.axes.len()).map(AxisIndex::new);
        let changed = self.state.control.couplings.enable(group, axes);
        self.state.control.mark_coupled(changed);
        self.state.control.lose_followers(group);
    }

    /// Couplings come into force as a group of these pairs.
    pub(crate) fn restore_couplings(&mut self, group: &str, axes: Vec<AxisIndex>) {
        let changed = self.state.control.couplings.define(group, axes);
        self.state.control.mark_coupled(changed);
        self.enable_group(group);
    }

    /// Without a group the last one that was enabled is released.
    pub(crate) fn disable_coupling(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let group = self.group_of(hash, at);
        let changed = if group.is_empty() {
            self.state.control.couplings.release_last()
        } else {
            self.state.control.couplings.release(&group)
        };
        self.state.control.mark_coupled(changed);
        if !self.state.control.couplings.is_any() {
            self.simplify(Simplification::Coupling, Holds::Off);
        }
    }

    /// Couplings end with the program unless P-CHAN-00105 says otherwise; their definitions stay.
    pub(crate) fn release_couplings(&mut self) {
        let changed = self.state.control.couplings.release_all();
        self.state.control.mark_coupled(changed);
        self.simplify(Simplification::Coupling, Holds::Off);
    }

    /// Any coupling may be in force, or none.
    pub(crate) fn havoc_couplings(&mut self) {
        let changed = self.state.control.couplings.havoc();
        self.state.control.couplings.havoc_followers(&[]);
        if !changed.is_empty() {
            self.simplify(Simplification::Coupling, Holds::On);
        }
        for axis in &changed {
            self.state.control.modal.havoc_position(*axis);
        }
        self.state.control.mark_coupled(changed);
    }

    /// Commands by which an axis follows others, apart from the coupling groups (R10.7).
    pub(crate) fn couple_by(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let command = hash.command;
        let Some(motion) = command.motion else {
            return;
        };
        let off = command.has(FurtherWord::Off);
        match motion.moves {
            Moves::Gantry if off => self.state.control.couplings.unfollow(GANTRY),
            Moves::Gantry => {
                let mut axes = self.axes_in(&hash.brackets, at.text);
                axes.dedup();
                if axes.len() < 2 {
                    axes = (0..self.machine.axes.len()).map(AxisIndex::new).collect();
                    return self.state.control.couplings.havoc_followers(&axes);
                }
                let pairs = axes
                    .iter()
                    .flat_map(|one| axes.iter().map(|other| (*one, *other)));
                let pairs = pairs.filter(|(one, other)| one != other).collect();
                self.state
                    .control
                    .couplings
                    .follow(GANTRY.to_owned(), pairs);
            }
            Moves::Follower => {
                let switch = if off { OnOff::Off } else { OnOff::On };
                self.link_gear(&hash.brackets, switch, at);
            }
            _ => {}
        }
    }

    /// `#GEAR LINK [TARGET=X AX1=Y NUM1=1 DENOM1=2]` (PM/546229387), `#CAXTRACK ON [AX=C]`.
    fn link_gear(&mut self, arguments: &BracketArguments, switch: OnOff, at: &BlockContext<'_>) {
        let after = |key| {
            let named = arguments.after_beginning(key, at.text);
            let axes = named.filter_map(|axis| self.axis_or_number(axis, at.text));
            axes.collect::<Vec<_>>()
        };
        let off = switch == OnOff::Off;
        let (targets, sources) = (after("TARGET"), after("AX"));
        let target = targets.first().copied();
        let key = target.map_or_else(|| CAXTRACK.to_owned(), gear_of);
        match target {
            None if off => self.state.control.couplings.end_following(),
            Some(_) if off => self.state.control.couplings.unfollow(&key),
            Some(target) if !sources.is_empty() => {
                self.state.control.modal.havoc_position(target);
                let pairs = sources.into_iter().map(|source| (target, source)).collect();
                self.state.control.couplings.follow(key, pairs);
            }
            Some(_) if self.state.control.couplings.is_following(&key) => {}
            Some(target) => self.state.control.couplings.havoc_followers(&[target]),
            None => {
                let turned = sources.first().copied().or_else(|| self.axis_named("C"));
                let turned: Vec<AxisIndex> = turned.into_iter().collect();
                self.state.control.couplings.havoc_followers(&turned);
            }
        }
    }

    /// `X[MC_GearIn Master=2 …]`: the master is a logical axis number (PM/208379531).
    pub(crate) fn gear_in(
        &mut self,
        axis: AxisIndex,
        arguments: &BracketArguments,
        at: &BlockContext<'_>,
    ) {
        let master = arguments.after("MASTER", at.text);
        match master.and_then(|master| self.axis_or_number(master, at.text)) {
            Some(master) => {
                let pairs = vec![(axis, master)];
                self.state.control.couplings.follow(gear_of(axis), pairs);
            }
            None => self.state.control.couplings.havoc_followers(&[axis]),
        }
    }

    fn axis_or_number(&self, argument: &Argument, text: &str) -> Option<AxisIndex> {
        let number = argument.logical_number(text);
        let by_number = || self.machine.axis_numbered(number?);
        self.axis_now(argument.span.of(text)).or_else(by_number)
    }

    /// The axes that a definition of a coupling group names.
    pub(crate) fn members(
        &self,
        by: MembersBy,
        arguments: &BracketArguments,
        text: &str,
    ) -> Vec<AxisIndex> {
        match by {
            MembersBy::Name => self.axes_in(arguments, text),
            MembersBy::Number => self.axes_by_number(arguments, text),
        }
    }

    /// The coupling group that `[1, …]` or `[P1+1]` names; empty without one.
    fn group_of(&mut self, hash: &Hash, at: &BlockContext<'_>) -> String {
        let Some(group) = hash.brackets.iter().next() else {
            return String::new();
        };
        match self.argument_number(group, at) {
            Some(number) => number.round().to_string(),
            None => group.span.of(at.text).to_owned(),
        }
    }

    /// The axes that a command names, or else all.
    pub(crate) fn axes_or_all(&self, arguments: &BracketArguments, text: &str) -> Vec<AxisIndex> {
        let named = self.axes_in(arguments, text);
        if named.is_empty() {
            (0..self.machine.axes.len()).map(AxisIndex::new).collect()
        } else {
            named
        }
    }

    pub(crate) fn axes_in(&self, arguments: &BracketArguments, text: &str) -> Vec<AxisIndex> {
        let words = arguments.words(text);
        words.filter_map(|word| self.axis_now(word)).collect()
    }

    /// The axes with the logical numbers of `[1, 8 = 2]`, the group left out.
    fn axes_by_number(&self, arguments: &BracketArguments, text: &str) -> Vec<AxisIndex> {
        let numbers = arguments.logical_numbers(text);
        let axes = self.machine.axes.iter().enumerate();
        axes.filter(|(_, axis)| axis.number.is_some_and(|number| numbers.contains(&number)))
            .map(|(position, _)| AxisIndex::new(position))
            .collect()
    }
}

impl ControlState {
    /// Axes that follow others have unknown positions from here on: `slave=master` (PM/207120267).
    fn lose_followers(&mut self, group: &str) {
        let groups = self.couplings.groups();
        let axes = groups.filter(|(name, _)| *name == group);
        let followers = axes.flat_map(|(_, axes)| axes.iter().step_by(2).copied());
        for axis in followers.collect::<Vec<_>>() {
            self.modal.havoc_position(axis);
        }
    }

    pub(crate) fn mark_coupled(&mut self, changed: Vec<AxisIndex>) {
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
const LISTED: &str = "0";

/// Names of the followers of other commands.
const GANTRY: &str = "gantry";
const CAXTRACK: &str = "track";
