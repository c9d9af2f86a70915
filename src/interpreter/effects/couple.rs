//! Commands that define, enable and release coupling groups (R2.47).

use crate::comp::AxisIndex;
use crate::interpreter::coordinates::simplified::{Holds, Simplification};
use crate::interpreter::run::at::At;
use crate::interpreter::run::interpreter::Interpreter;
use crate::text::Span;

impl Interpreter {
    pub(in crate::interpreter) fn define_coupling(
        &mut self,
        rest: &str,
        axes: Vec<AxisIndex>,
        at: &At<'_>,
    ) {
        let group = self.group_of(rest, at);
        self.work.wrote = true;
        let changed = self.state.couplings.define(&group, axes);
        self.mark_coupled(changed);
    }

    pub(in crate::interpreter) fn enable_coupling(&mut self, rest: &str, span: Span, at: &At<'_>) {
        let group = self.group_of(rest, at);
        self.simplify(Simplification::Coupling, Holds::On);
        if let Some(changed) = self.state.couplings.enable(&group) {
            self.mark_coupled(changed);
            self.lose_followers(&group);
        } else {
            // A group of the channel parameters: which axes it couples is not known offline.
            self.pass_over("#ENABLE AX LINK", span, at);
        }
    }

    /// Axes that follow others are anywhere from here on: `slave=master` (PM/207120267).
    fn lose_followers(&mut self, group: &str) {
        let groups = self.state.couplings.groups();
        let axes = groups.filter(|(name, _)| *name == group);
        let followers = axes.flat_map(|(_, axes)| axes.iter().step_by(2).copied());
        for axis in followers.collect::<Vec<_>>() {
            self.state.modal.forget_position(axis);
        }
    }

    /// Without a group the last one that was enabled is released.
    pub(in crate::interpreter) fn disable_coupling(&mut self, rest: &str, at: &At<'_>) {
        let group = self.group_of(rest, at);
        let changed = if group.is_empty() {
            self.state.couplings.release_last()
        } else {
            self.state.couplings.release(&group)
        };
        self.mark_coupled(changed);
        if !self.state.couplings.is_any() {
            self.simplify(Simplification::Coupling, Holds::Off);
        }
    }

    /// Couplings end with the program unless P-CHAN-00105 says otherwise; their definitions stay.
    pub(in crate::interpreter) fn release_couplings(&mut self) {
        let changed = self.state.couplings.release_all();
        self.mark_coupled(changed);
        self.simplify(Simplification::Coupling, Holds::Off);
    }

    /// Any coupling may be in force, or none.
    pub(in crate::interpreter) fn doubt_couplings(&mut self) {
        let changed = self.state.couplings.doubt();
        if !changed.is_empty() {
            self.simplify(Simplification::Coupling, Holds::On);
        }
        for axis in &changed {
            self.state.modal.forget_position(*axis);
        }
        self.mark_coupled(changed);
    }

    /// These axes may be coupled by groups whose members are unknown.
    pub(in crate::interpreter) fn doubt_definitions(&mut self, axes: &[AxisIndex]) {
        let changed = self.state.couplings.doubt_definitions(axes);
        self.mark_coupled(changed);
    }

    fn mark_coupled(&mut self, changed: Vec<AxisIndex>) {
        for axis in changed {
            let coupling = self.state.couplings.of(axis);
            self.state.compensation.set_coupled(axis, coupling);
        }
    }

    /// The axes that a definition of a coupling group names; `None` for any other command.
    pub(in crate::interpreter) fn defined_axes(
        &self,
        name: &str,
        rest: &str,
    ) -> Option<Vec<AxisIndex>> {
        match name {
            "#SET AX LINK" | "#AX LINK" => Some(self.axes_in(rest)),
            "#SET AX LINK NBR" | "#AX LINK NBR" => Some(self.axes_by_number(rest)),
            _ => None,
        }
    }

    /// The coupling group that `[1, …]` or `[P1+1]` names; empty without one.
    fn group_of(&mut self, rest: &str, at: &At<'_>) -> String {
        let inside = rest.trim_start().strip_prefix('[').unwrap_or_default();
        let text = inside.split([',', ']']).next().unwrap_or_default().trim();
        match self.number_in(text, at) {
            Some(number) => number.round().to_string(),
            None => text.to_owned(),
        }
    }

    pub(in crate::interpreter) fn axes_in(&self, text: &str) -> Vec<AxisIndex> {
        names_in(text)
            .filter_map(|word| self.machine.find(word))
            .collect()
    }

    /// The axes that a command names, or else all.
    pub(in crate::interpreter) fn axes_or_all(&self, rest: &str) -> Vec<AxisIndex> {
        let named = self.axes_in(rest);
        if named.is_empty() {
            (0..self.machine.axes.len()).map(AxisIndex::new).collect()
        } else {
            named
        }
    }

    /// The axes with the logical numbers of `[1, 8 = 2]`, the group left out.
    pub(in crate::interpreter) fn axes_by_number(&self, text: &str) -> Vec<AxisIndex> {
        let pairs = text.split_once(',').map_or("", |(_, pairs)| pairs);
        let numbers: Vec<u32> = names_in(pairs)
            .filter_map(|word| word.parse().ok())
            .collect();
        let axes = self.machine.axes.iter().enumerate();
        axes.filter(|(_, axis)| axis.number.is_some_and(|number| numbers.contains(&number)))
            .map(|(position, _)| AxisIndex::new(position))
            .collect()
    }
}

fn names_in(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
}
