//! Coupling groups (R2.47) and axis exchange: which axes the channel has, and under which names (TF5200 programming manual,
//! 206977419 and its neighbours).
//!
//! A name denotes the machine's axis of that name until the program changes it. An axis that is given back keeps its
//! compensation: what another channel does with it is reported when the programs of that channel are checked.

use std::collections::BTreeSet;

use crate::comp::{AxisIndex, CompensationError, Kind, KindSet};
use crate::diagnostic::Code;
use crate::interpreter::block::BlockContext;
use crate::interpreter::control::{Addressed, AxisNameMeaning, ChannelAxes, ControlState};
use crate::interpreter::executor::Executor;
use crate::interpreter::values::value::rounded;
use crate::interpreter::values::work_budget::ITEM;
use crate::language::{Exchange, FurtherWord, Holds, MembersBy, Moves, OnOff, Simplification};
use crate::readings::Question;
use crate::syntax::Fault;
use crate::syntax::ast::{Argument, BracketArguments, Hash};
use crate::text::Span;

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

impl Executor {
    /// Executes an exchange command.
    pub(crate) fn exchange_axes(&mut self, exchange: Exchange, hash: &Hash, at: &BlockContext<'_>) {
        self.state.control.modal.hash(hash.command);
        let command = hash.command;
        if command.has(FurtherWord::Default) {
            self.state.control.channel_axes = ChannelAxes::default();
        }
        let exchanged = NamedInExchange {
            arguments: &hash.brackets,
            text: at.text,
        };
        let names = exchanged.names(exchange);
        if let Some(name) = names.iter().find(|name| !name.bytes().all(is_name_byte)) {
            self.state.control.havoc_exchange();
            let message = format!(
                "`{name}` is not an axis name; which axes `{}` exchanges is not known, and a COMP command after it may \
                 switch any axis",
                hash.name
            );
            let fault = Fault::new(Code::Fc210, hash.span, message)
                .with_help("separate names and numbers with commas");
            self.scratch.messages.diagnostics.push(at.diagnostic(fault));
            return;
        }
        match exchange {
            Exchange::Undescribed => {
                self.state.control.havoc_exchange();
                let fault = Fault::new(
                    Code::Fc902,
                    hash.span,
                    format!(
                        "which axes `{}` exchanges is not documented; a COMP command after it may switch any axis",
                        hash.name
                    ),
                );
                self.scratch.messages.diagnostics.push(at.diagnostic(fault));
            }
            Exchange::Request => self.request_axes(exchanged, at),
            Exchange::Release if command.has(FurtherWord::All) => self.release_others(&[]),
            Exchange::Release => names.into_iter().for_each(|name| self.release_axis(name)),
            Exchange::Define => {
                if !command.has(FurtherWord::Default) {
                    self.release_others(&names);
                }
                self.request_axes(exchanged, at);
            }
        }
    }

    fn request_axes(&mut self, exchanged: NamedInExchange<'_>, at: &BlockContext<'_>) {
        let (mut names, mut numbers) = (BTreeSet::new(), BTreeSet::new());
        for (name, number) in exchanged.axes() {
            let number = number.and_then(|number| self.argument_number(number, at));
            let number = number.and_then(rounded).and_then(|n| u32::try_from(n).ok());
            let meaning = self.requested(number);
            self.check_request(name, number, (&mut names, &mut numbers), at);
            if number.is_some() && meaning.is_none() {
                self.say_without_number(name, at);
            }
            if let Some(AxisNameMeaning::Axis(axis)) = meaning
                && self.state.control.was_released(axis)
            {
                self.state.rests_on.insert(Question::AxisExchange);
                if self.machine.readings.takes_second(Question::AxisExchange) {
                    self.return_to_start(axis);
                }
            }
            let names = &mut self.state.control.channel_axes.names;
            let own = self.machine.find(name);
            if own.is_some() && meaning == own.map(AxisNameMeaning::Axis) {
                names.remove(name);
            } else {
                names.insert(name.to_owned(), meaning.unwrap_or(AxisNameMeaning::Unknown));
            }
        }
    }

    /// Friction compensation of an axis is that of the start of the control, where the machine is read
    /// so.
    pub(crate) fn return_to_start(&mut self, axis: AxisIndex) {
        let start = self.machine.compensation();
        let kinds = KindSet::of(Kind::Frict);
        let control = &mut self.state.control;
        control.history.set(axis, kinds);
        let changes = &mut self.scratch.changes;
        control
            .compensation
            .return_to(&start, (axis, kinds), changes);
    }

    /// Returns the axis of a name after a request with this logical axis number, if it is known.
    fn requested(&self, number: Option<u32>) -> Option<AxisNameMeaning> {
        let axis = self.machine.axis_numbered(number?)?;
        Some(AxisNameMeaning::Axis(axis))
    }

    /// FC328: an axis or a name is asked for twice, or a name that the channel has (R2.106).
    fn check_request<'n>(
        &mut self,
        name: &'n str,
        number: Option<u32>,
        (asked, logical): (&mut BTreeSet<&'n str>, &mut BTreeSet<u32>),
        at: &BlockContext<'_>,
    ) {
        let span = Span::new(0, at.text.trim_end().len());
        if number.is_some_and(|number| !logical.insert(number)) {
            self.may_refuse(21256, "one axis is asked for twice", span, at);
        }
        if !asked.insert(name) {
            let what = format!("the name `{name}` is given twice");
            self.may_refuse(21258, &what, span, at);
        }
        let meaning = self.state.control.channel_axes.meaning(name);
        let own = self.machine.find(name).map(AxisNameMeaning::Axis);
        let present = match meaning.or(own) {
            Some(AxisNameMeaning::Axis(axis)) => self.machine.axis(axis).number,
            _ => None,
        };
        if present.is_some() && number.is_some() && present != number {
            let what = format!("the channel has another axis with the name `{name}`");
            self.may_refuse(21261, &what, span, at);
        }
    }

    /// FC902: the axes of the machine have no numbers, so that the meaning of a name is not known (R2.106).
    fn say_without_number(&mut self, name: &str, at: &BlockContext<'_>) {
        if self.machine.axes.iter().all(|axis| axis.number.is_some()) {
            return;
        }
        let message = format!(
            "which axis `{name}` means from here on is not known: the axes of the machine have no logical numbers, and \
             a COMP command with this name may switch any of them"
        );
        if self.state.is_new_word("axes without numbers") {
            let span = Span::new(0, at.text.trim_end().len());
            let fault = Fault::new(Code::Fc902, span, message)
                .with_help("write `number = …` in each `[[axis]]` of frictcomp.toml, or name the start-up list");
            self.scratch.messages.diagnostics.push(at.diagnostic(fault));
        }
    }

    fn release_axis(&mut self, name: &str) {
        let names = &mut self.state.control.channel_axes.names;
        let known = names.get(name).copied();
        let own = self.machine.find(name).map(AxisNameMeaning::Axis);
        let released = match known.or(own) {
            Some(AxisNameMeaning::Axis(axis)) => AxisNameMeaning::Released(Some(axis)),
            Some(AxisNameMeaning::Unknown) => AxisNameMeaning::Released(None),
            // The channel does not have it; the control does not mind.
            Some(AxisNameMeaning::Released(_)) | None => return,
        };
        names.insert(name.to_owned(), released);
    }

    /// Releases every axis but those of these names.
    fn release_others(&mut self, stay: &[&str]) {
        let names = &self.state.control.channel_axes.names;
        let is_here = |name: &str| !matches!(names.get(name), Some(AxisNameMeaning::Released(_)));
        let machine = self.machine.axes.iter().map(|axis| &axis.name);
        let gone: BTreeSet<String> = machine
            .chain(names.keys())
            .filter(|name| is_here(name) && !stay.contains(&name.as_str()))
            .cloned()
            .collect();
        self.state
            .work
            .charge(ITEM + self.machine.axes.len() + names.len());
        for name in &gone {
            self.release_axis(name);
        }
    }
}

impl ControlState {
    /// The axis that a COMP command switches under the current names.
    pub(crate) fn addressed(&self, name: &str) -> Result<Addressed, CompensationError> {
        Ok(match self.channel_axes.meaning(name) {
            None => Addressed::Axis(self.compensation.resolve(name)?),
            Some(AxisNameMeaning::Axis(axis)) => Addressed::Axis(axis),
            Some(AxisNameMeaning::Released(axis)) => Addressed::Absent(axis),
            Some(AxisNameMeaning::Unknown) => Addressed::Any,
        })
    }

    /// An exchange that may or may not have been executed.
    pub(crate) fn havoc_exchange(&mut self) {
        self.channel_axes.doubtful = true;
    }

    /// Whether the channel gave an axis away and does not have it under any name.
    fn was_released(&self, axis: AxisIndex) -> bool {
        let names = self.channel_axes.names.values();
        let mut names = names.copied();
        names.any(|meaning| meaning == AxisNameMeaning::Released(Some(axis)))
    }
}

/// The axes in the brackets of an exchange command.
#[derive(Clone, Copy)]
struct NamedInExchange<'a> {
    arguments: &'a BracketArguments,
    text: &'a str,
}

impl<'a> NamedInExchange<'a> {
    /// The names: of `[X, B]` and `[NAME=X]` of a release, of each bracket of a request.
    fn names(self, exchange: Exchange) -> Vec<&'a str> {
        match exchange {
            Exchange::Release => {
                let items = self.arguments.items();
                items
                    .map(|item| self.keyed(item, "NAME").unwrap_or(self.whole(item)))
                    .collect()
            }
            Exchange::Request | Exchange::Define => self.axes().map(|(name, _)| name).collect(),
            Exchange::Undescribed => Vec::new(),
        }
    }

    /// The name and the logical number of each bracket, `[X, 1, 0]` or `[NAME=X NR=1 IDX=0]`, unless it holds switches
    /// for conflicts, `[NAM, NBR, IDX]`.
    fn axes(self) -> impl Iterator<Item = (&'a str, Option<&'a Argument>)> {
        self.arguments.groups().filter_map(move |group| {
            let mut items = group.chunk_by(|one, other| one.item == other.item);
            let first = items.next()?;
            let whole = self.whole(first);
            if first.iter().any(|argument| argument.key.is_some()) {
                let number = group.iter().find(|it| self.has_key(it, "NR"));
                return Some((self.keyed(group, "NAME").unwrap_or(whole), number));
            }
            let is_switch = matches!(whole, "NAM" | "NBR" | "IDX" | "FAST");
            let number = items.next().and_then(<[_]>::first);
            (!is_switch).then_some((whole, number))
        })
    }

    fn has_key(self, argument: &Argument, key: &str) -> bool {
        argument.key.is_some_and(|it| it.of(self.text) == key)
    }

    /// The value of a key, `X` of `NAME = X NR = 1`.
    fn keyed(self, arguments: &[Argument], key: &str) -> Option<&'a str> {
        let argument = arguments.iter().find(|it| self.has_key(it, key))?;
        Some(argument.span.of(self.text))
    }

    /// The text of arguments without commas in between.
    fn whole(self, item: &[Argument]) -> &'a str {
        let start = item.first().map(|first| first.key.unwrap_or(first.span));
        let whole = start.zip(item.last());
        whole.map_or("", |(start, last)| start.to(last.span).of(self.text))
    }
}

fn is_name_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}
