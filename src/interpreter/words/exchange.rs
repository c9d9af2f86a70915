//! Coupling groups (R2.47) and axis exchange: which axes the channel has, and under which names (TF5200 programming manual,
//! 206977419 and its neighbours).

use std::collections::BTreeSet;

use crate::comp::{AxisIndex, CompensationError, Coupling, Kind, KindSet};
use crate::diagnostic::Code;
use crate::interpreter::axes::{Addressed, AxisNameMeaning, ChannelAxes};
use crate::interpreter::block::BlockContext;
use crate::interpreter::control::ControlState;
use crate::interpreter::coupling::{CAXTRACK, GANTRY, LISTED, gear_of};
use crate::interpreter::executor::Executor;
use crate::interpreter::values::value::rounded;
use crate::interpreter::values::work_budget::ITEM;
use crate::language::{Exchange, FurtherWord, MembersBy, Moves, OnOff};
use crate::readings::Question;
use crate::syntax::Fault;
use crate::syntax::ast::{Argument, BracketArguments, Hash};
use crate::text::Span;

impl Executor {
    /// Defines a coupling group; the control does not change one that is in force.
    pub(crate) fn define_coupling(
        &mut self,
        by: MembersBy,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let axes = self.axes().members(by, &hash.brackets, at.text);
        let group = self.group_of(hash, at);
        match self.state.control.couplings.of_group(&group) {
            Coupling::Active => {
                let what =
                    format!("coupling group {group} is active, and the control does not change it");
                return Err(Fault::refused(Code::PErr20472, hash.span, what));
            }
            Coupling::Perhaps => {
                let what = "this coupling group may be active, which the control does not change";
                self.may_refuse(20472, what, hash.span, at);
            }
            Coupling::None => {}
        }
        if group == LISTED {
            let what = "coupling group 0 is that of the channel list, and a program defines it";
            self.may_refuse(20461, what, hash.span, at);
        }
        if let Some((number, what)) = impossible_pair(&hash.brackets, at.text) {
            self.may_refuse(number, &what, hash.span, at);
        }
        self.scratch.wrote = true;
        match axes {
            Some(axes) => self.state.control.define_coupling(&group, axes),
            None => self.state.control.forget_coupling(&group),
        }
        Ok(())
    }

    /// Enables a coupling group: the named one, or without a name that of the channel list (PM/207133579).
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
        if let Some((number, axis)) = self.state.control.couplings.conflict(&group) {
            let name = &self.machine.axis(axis).name;
            let what = format!("axis `{name}` is in another active coupling group");
            self.may_refuse(number, &what, hash.span, at);
        }
        self.check_slaves(&group, hash.span, at);
        self.state.control.enable_coupling(&group, &self.machine);
    }

    /// FC328: a slave that the operator moves, or that is a main axis by the lists of the machine (TF5200 Diagnosis, pages
    /// 251694475, 251681419).
    fn check_slaves(&mut self, group: &str, span: Span, at: &BlockContext<'_>) {
        let manual = &self.state.control.modal.manual;
        let slaves = self.state.control.couplings.slaves(group);
        let (mut by_hand, mut main) = (None, None);
        for axis in slaves {
            by_hand = by_hand.or(manual.contains(&axis).then_some(axis));
            main = main.or(self.is_main(axis).then_some(axis));
        }
        let name = |axis: AxisIndex| self.machine.axis(axis).name.clone();
        let by_hand = by_hand.map(|axis| {
            let what = format!("slave `{}` is in manual mode, by G201", name(axis));
            (20470, what)
        });
        let main = main.map(|axis| {
            let what = format!("slave `{}` is a main axis of the channel", name(axis));
            (20467, what)
        });
        for (number, what) in by_hand.into_iter().chain(main) {
            self.may_refuse(number, &what, span, at);
        }
    }

    /// Whether an axis has the index 0, 1 or 2 in its channel, by the lists of the machine, and the program has exchanged none.
    fn is_main(&self, axis: AxisIndex) -> bool {
        let are_own = self.state.control.channel_axes.are_own();
        are_own && self.machine.axis(axis).is_main
    }

    /// Releases a coupling group: the named one, or without a name the last one enabled.
    pub(crate) fn disable_coupling(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let group = self.group_of(hash, at);
        self.state.control.disable_coupling(&group);
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
                let axes = self.axes();
                let mut members = axes.given(&hash.brackets, at.text);
                members.dedup();
                if members.len() < 2 {
                    let all: Vec<_> = axes.all().collect();
                    return self.state.control.couplings.havoc_followers(&all);
                }
                let pairs = members
                    .iter()
                    .flat_map(|one| members.iter().map(|other| (*one, *other)));
                let pairs = pairs.filter(|(one, other)| one != other).collect();
                let couplings = &mut self.state.control.couplings;
                couplings.follow(GANTRY.to_owned(), pairs);
            }
            Moves::Follower => {
                let switch = if off { OnOff::Off } else { OnOff::On };
                self.link_gear(&hash.brackets, switch, at);
            }
            _ => {}
        }
    }

    /// Links a gear: `#GEAR LINK [TARGET=X AX1=Y NUM1=1 DENOM1=2]` (PM/546229387), `#CAXTRACK ON [AX=C]`.
    fn link_gear(&mut self, arguments: &BracketArguments, switch: OnOff, at: &BlockContext<'_>) {
        let axes = self.axes();
        let after = |key| {
            let named = arguments.after_beginning(key, at.text);
            let axes = named.filter_map(|axis| axes.argument(axis, at.text));
            axes.collect::<Vec<_>>()
        };
        let off = switch == OnOff::Off;
        let (targets, sources) = (after("TARGET"), after("AX"));
        let turned = sources.first().copied().or_else(|| axes.named("C"));
        let target = targets.first().copied();
        let key = target.map_or_else(|| CAXTRACK.to_owned(), gear_of);
        let control = &mut self.state.control;
        match target {
            None if off => control.couplings.end_following(),
            Some(_) if off => control.couplings.unfollow(&key),
            Some(target) if !sources.is_empty() => {
                control.modal.havoc_position(target);
                let pairs = sources.into_iter().map(|source| (target, source)).collect();
                control.couplings.follow(key, pairs);
            }
            Some(_) if control.couplings.is_following(&key) => {}
            Some(target) => control.couplings.havoc_followers(&[target]),
            None => {
                let turned: Vec<AxisIndex> = turned.into_iter().collect();
                control.couplings.havoc_followers(&turned);
            }
        }
    }

    /// Couples an axis to its master by `X[MC_GearIn Master=2 …]`: the master is a logical axis number (PM/208379531).
    pub(crate) fn gear_in(
        &mut self,
        axis: AxisIndex,
        arguments: &BracketArguments,
        at: &BlockContext<'_>,
    ) {
        let master = arguments.after("MASTER", at.text);
        let master = master.and_then(|master| self.axes().argument(master, at.text));
        let couplings = &mut self.state.control.couplings;
        match master {
            Some(master) => couplings.follow(gear_of(axis), vec![(axis, master)]),
            None => couplings.havoc_followers(&[axis]),
        }
    }

    /// Returns the coupling group that `[1, …]` or `[P1+1]` names; empty without one.
    fn group_of(&mut self, hash: &Hash, at: &BlockContext<'_>) -> String {
        let Some(group) = hash.brackets.iter().next() else {
            return String::new();
        };
        match self.argument_number(group, at) {
            Some(number) => number.round().to_string(),
            None => group.span.of(at.text).to_owned(),
        }
    }

    /// Executes an exchange command.
    pub(crate) fn exchange_axes(&mut self, exchange: Exchange, hash: &Hash, at: &BlockContext<'_>) {
        let control = &mut self.state.control;
        control.modal.hash(hash.command);
        let command = hash.command;
        if command.has(FurtherWord::Default) {
            control.channel_axes = ChannelAxes::default();
        }
        let exchanged = NamedInExchange {
            arguments: &hash.brackets,
            text: at.text,
        };
        let names = exchanged.names(exchange);
        if exchange == Exchange::Release {
            self.check_coupled(&names, hash, at);
        }
        let control = &mut self.state.control;
        if let Some(name) = names.iter().find(|name| !name.bytes().all(is_name_byte)) {
            control.channel_axes.havoc();
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
        let axes = &mut control.channel_axes;
        match exchange {
            Exchange::Undescribed => {
                axes.havoc();
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
            Exchange::Release => names
                .into_iter()
                .for_each(|name| axes.release(&self.machine, name)),
            Exchange::Define => {
                if !command.has(FurtherWord::Default) {
                    self.release_others(&names);
                }
                self.request_axes(exchanged, at);
            }
        }
    }

    /// FC328: an axis is released that takes part in an active coupling (TF5200 Diagnosis, page 251820683).
    fn check_coupled(&mut self, names: &[&str], hash: &Hash, at: &BlockContext<'_>) {
        let couplings = &self.state.control.couplings;
        if !couplings.is_any() {
            return;
        }
        let lookup = self.axes();
        let released = if hash.command.has(FurtherWord::All) {
            lookup.path()
        } else {
            names.iter().filter_map(|name| lookup.named(name)).collect()
        };
        let mut coupled = released.into_iter();
        let Some(axis) = coupled.find(|axis| couplings.of(*axis) != Coupling::None) else {
            return;
        };
        let name = &self.machine.axis(axis).name;
        let what = format!("axis `{name}` is released while it is in an active coupling");
        self.may_refuse_alike(20545, &what, hash.span, at);
    }

    /// Releases every axis but those of these names.
    fn release_others(&mut self, stay: &[&str]) {
        let axes = &mut self.state.control.channel_axes;
        let count = axes.release_others(&self.machine, stay);
        self.state.work.charge(ITEM + count);
    }

    fn request_axes(&mut self, exchanged: NamedInExchange<'_>, at: &BlockContext<'_>) {
        let (mut names, mut numbers) = (BTreeSet::new(), BTreeSet::new());
        for (name, number) in exchanged.axes() {
            let number = number.and_then(|number| self.argument_number(number, at));
            let number = number.and_then(rounded).and_then(|n| u32::try_from(n).ok());
            let axis = number.and_then(|number| self.machine.axis_numbered(number));
            self.check_request(name, number, (&mut names, &mut numbers), at);
            if number.is_some() && axis.is_none() {
                self.say_without_number(name, at);
            }
            if let Some(axis) = axis
                && self.state.control.channel_axes.has_released(axis)
            {
                self.state.rests_on.insert(Question::AxisExchange);
                if self.machine.readings.takes_second(Question::AxisExchange) {
                    self.return_to_start(axis);
                }
            }
            let channel = &mut self.state.control.channel_axes;
            channel.request(&self.machine, name, axis);
        }
    }

    /// Returns friction compensation of an axis to that of the start of the control, where the machine is read so.
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

    /// Reports FC328: an axis or a name is asked for twice, or a name that the channel has (R2.106).
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
        let channel = &self.state.control.channel_axes;
        let present = match channel.meaning_on(&self.machine, name) {
            Some(AxisNameMeaning::Axis(axis)) => self.machine.axis(axis).number,
            _ => None,
        };
        if present.is_some() && number.is_some() && present != number {
            let what = format!("the channel has another axis with the name `{name}`");
            self.may_refuse(21261, &what, span, at);
        }
    }

    /// Reports FC902: the axes of the machine have no numbers, so that the meaning of a name is not known (R2.106).
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
}

impl ControlState {
    /// Returns the axis that a COMP command switches under the current names.
    pub(crate) fn addressed(&self, name: &str) -> Result<Addressed, CompensationError> {
        Ok(match self.channel_axes.meaning(name) {
            None => Addressed::Axis(self.compensation.resolve(name)?),
            Some(AxisNameMeaning::Axis(axis)) => Addressed::Axis(axis),
            Some(AxisNameMeaning::Released(axis)) => Addressed::Absent(axis),
            Some(AxisNameMeaning::Unknown) => Addressed::Any,
        })
    }
}

/// The axes in the brackets of an exchange command.
#[derive(Clone, Copy)]
struct NamedInExchange<'a> {
    arguments: &'a BracketArguments,
    text: &'a str,
}

impl<'a> NamedInExchange<'a> {
    /// Returns the names: of `[X, B]` and `[NAME=X]` of a release, of each bracket of a request.
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

    /// Returns the name and the logical number of each bracket, `[X, 1, 0]` or `[NAME=X NR=1 IDX=0]`, unless it holds
    /// switches for conflicts, `[NAM, NBR, IDX]`.
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

    /// Returns the value of a key, `X` of `NAME = X NR = 1`.
    fn keyed(self, arguments: &[Argument], key: &str) -> Option<&'a str> {
        let argument = arguments.iter().find(|it| self.has_key(it, key))?;
        Some(argument.span.of(self.text))
    }

    /// Returns the text of arguments without commas in between.
    fn whole(self, item: &[Argument]) -> &'a str {
        let start = item.first().map(|first| first.key.unwrap_or(first.span));
        let whole = start.zip(item.last());
        whole.map_or("", |(start, last)| start.to(last.span).of(self.text))
    }
}

fn is_name_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Returns why the control refuses the pairs of a coupling group, with the number of its error.
fn impossible_pair(arguments: &BracketArguments, text: &str) -> Option<(u32, String)> {
    let pairs: Vec<[&str; 2]> = arguments.pairs(text).collect();
    pairs.iter().enumerate().find_map(|(at, &[slave, master])| {
        if slave == master {
            return Some((20475, format!("axis `{slave}` would be its own master")));
        }
        if pairs[..at].iter().any(|other| other[0] == slave) {
            return Some((20476, format!("axis `{slave}` would have two masters")));
        }
        let is_master = pairs.iter().any(|other| other[1] == slave);
        is_master.then(|| (20477, format!("axis `{slave}` would be master and slave")))
    })
}
