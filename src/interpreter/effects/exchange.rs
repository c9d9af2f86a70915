//! Axis exchange: which axes the channel has, and under which names
//! (TF5200 programming manual, 206977419 and its neighbours).
//!
//! A name denotes the machine's axis of that name until the program changes it. An axis that is given
//! back keeps its compensation: what another channel does with it is reported when the programs of that
//! channel are checked.

use std::collections::BTreeSet;

use crate::comp::{AxisIndex, CompensationError, Kind, KindSet};
use crate::diagnostic::Code;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::channel_axes::{Addressed, AxisNameMeaning, ChannelAxes};
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::value::rounded;
use crate::interpreter::values::work_budget::ITEM;
use crate::language::{Exchange, FurtherWord};
use crate::readings::Question;
use crate::syntax::Fault;
use crate::syntax::ast::{Argument, BracketArguments, Hash};
use crate::text::Span;

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
            self.scratch.diagnostics.push(at.diagnostic(fault));
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
                self.scratch.diagnostics.push(at.diagnostic(fault));
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
            self.scratch.diagnostics.push(at.diagnostic(fault));
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
