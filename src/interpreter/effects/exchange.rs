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
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::values::value::rounded;
use crate::interpreter::values::work_budget::ITEM;
use crate::readings::Question;
use crate::syntax::Fault;
use crate::syntax::ast::Hash;

/// Kind of an exchange command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Exchange {
    /// The named axes come.
    Request,
    /// The named axes go.
    Release,
    /// The named axes come; all others go.
    Define,
    /// The axes are again those of an earlier moment.
    Restore,
    /// Axes come or go in a way that no public page describes.
    Undescribed,
}

/// The exchange commands by their first words.
const COMMANDS: [(&str, Exchange); 8] = [
    ("#ACHSTAUSCH", Exchange::Undescribed),
    ("#CALL AX", Exchange::Request),
    ("#AX REQUEST", Exchange::Request),
    ("#PUT AX", Exchange::Release),
    ("#AX RELEASE", Exchange::Release),
    ("#SET AX", Exchange::Define),
    ("#AX DEF", Exchange::Define),
    ("#LOAD CONFIG", Exchange::Restore),
];

impl Interpreter {
    /// Executes an exchange command.
    pub(in crate::interpreter) fn exchange_axes(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let Some(exchange) = exchange(&hash.name) else {
            return;
        };
        self.state.control.modal.hash(&hash.name);
        let rest = &*hash.code(at.text);
        let every = |word: &str| hash.name.ends_with(word) || rest.trim_start().starts_with(word);
        if every("DEFAULT") {
            self.state.control.channel_axes = ChannelAxes::default();
        }
        let mut names = groups(rest).flat_map(|group| names_of(exchange, group));
        if let Some(name) = names.find(|name| !name.bytes().all(is_name_byte)) {
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
            Exchange::Restore if self.state.control.channel_axes == ChannelAxes::default() => {}
            Exchange::Restore => self.state.control.havoc_exchange(),
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
            Exchange::Request => self.request_axes(rest, at),
            Exchange::Release if every("ALL") => self.release_others(&[]),
            Exchange::Release => {
                let names = groups(rest).flat_map(|group| names_of(exchange, group));
                names.for_each(|name| self.release_axis(name));
            }
            Exchange::Define => {
                if !every("DEFAULT") {
                    let names = groups(rest).flat_map(|group| names_of(exchange, group));
                    self.release_others(&names.collect::<Vec<_>>());
                }
                self.request_axes(rest, at);
            }
        }
    }

    fn request_axes(&mut self, rest: &str, at: &BlockContext<'_>) {
        for group in groups(rest) {
            let (Some(name), number) = axis_of(&group) else {
                continue;
            };
            let number = number.and_then(|number| self.number_in(number, at));
            let number = number.and_then(rounded).and_then(|n| u32::try_from(n).ok());
            let meaning = self.requested(name, number);
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
    pub(in crate::interpreter) fn return_to_start(&mut self, axis: AxisIndex) {
        let start = self.machine.compensation();
        let kinds = KindSet::of(Kind::Frict);
        let control = &mut self.state.control;
        control.possible.replace(axis, kinds);
        control.untouched.switch(axis, kinds);
        control.last_commands.forget(axis, kinds);
        let changes = &mut self.scratch.changes;
        control
            .compensation
            .return_to(&start, (axis, kinds), changes);
    }

    /// Returns the axis of a name after a request with this logical axis number, if it is known. An axis
    /// of the machine without a number is taken to be the one of that name.
    fn requested(&self, name: &str, number: Option<u32>) -> Option<AxisNameMeaning> {
        let number = number?;
        let axes = self.machine.axes.iter();
        let by_number = axes.clone().position(|axis| axis.number == Some(number));
        let by_name = axes
            .clone()
            .position(|axis| axis.name == name && axis.number.is_none());
        let found = by_number.or(by_name)?;
        Some(AxisNameMeaning::Axis(AxisIndex::new(found)))
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
            .effort
            .charge(ITEM + self.machine.axes.len() + names.len());
        for name in &gone {
            self.release_axis(name);
        }
    }
}

impl ControlState {
    /// The axis that a COMP command switches under the current names.
    pub(in crate::interpreter) fn addressed(
        &self,
        name: &str,
    ) -> Result<Addressed, CompensationError> {
        Ok(match self.channel_axes.meaning(name) {
            None => Addressed::Axis(self.compensation.resolve(name)?),
            Some(AxisNameMeaning::Axis(axis)) => Addressed::Axis(axis),
            Some(AxisNameMeaning::Released(axis)) => Addressed::Absent(axis),
            Some(AxisNameMeaning::Unknown) => Addressed::Any,
        })
    }

    /// An exchange that may or may not have been executed.
    pub(in crate::interpreter) fn havoc_exchange(&mut self) {
        self.channel_axes.doubtful = true;
    }

    /// Whether the channel gave an axis away and does not have it under any name.
    fn was_released(&self, axis: AxisIndex) -> bool {
        let names = self.channel_axes.names.values();
        let mut names = names.copied();
        names.any(|meaning| meaning == AxisNameMeaning::Released(Some(axis)))
    }
}

fn exchange(name: &str) -> Option<Exchange> {
    let begins = |words: &str| {
        let rest = name.strip_prefix(words);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let is_coupling = name.starts_with("#SET AX LINK");
    let row = COMMANDS.iter().find(|(words, _)| begins(words));
    row.filter(|_| !is_coupling).map(|(_, exchange)| *exchange)
}

/// Whether a `#` command exchanges axes.
pub(in crate::interpreter) fn is_exchange(name: &str) -> bool {
    exchange(name).is_some()
}

/// The words of each bracket, `[X, 1, 0][Y, 2, 1]`.
fn groups(text: &str) -> impl Iterator<Item = Vec<&str>> {
    let brackets = text.split('[').skip(1);
    brackets.map(|group| {
        let inside = group.split(']').next().unwrap_or_default();
        inside.split(',').map(str::trim).collect()
    })
}

/// The names of a bracket: `[X, B]` and `[NAME=X]` of a release, one of a request.
fn names_of(exchange: Exchange, group: Vec<&str>) -> Vec<&str> {
    match exchange {
        Exchange::Release => {
            let names = group.into_iter();
            names
                .map(|name| keyed(name, "NAME").unwrap_or(name))
                .collect()
        }
        Exchange::Request | Exchange::Define => axis_of(&group).0.into_iter().collect(),
        Exchange::Restore | Exchange::Undescribed => Vec::new(),
    }
}

/// The value of a key, `X` of `NAME = X NR = 1`.
fn keyed<'a>(words: &'a str, key: &str) -> Option<&'a str> {
    let (_, rest) = words.split_once(key)?;
    let value = rest.trim_start().strip_prefix('=')?;
    value.split_whitespace().next()
}

fn is_name_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// The name and the logical number of a bracket, `X, 1, 0` or `NAME=X NR=1 IDX=0`; no name where
/// it holds switches for conflicts, `NAM, NBR, IDX`.
fn axis_of<'a>(group: &[&'a str]) -> (Option<&'a str>, Option<&'a str>) {
    let first = group.first().copied().unwrap_or_default();
    if first.contains('=') {
        let value = |key: &str| group.iter().find_map(|words| keyed(words, key));
        return (value("NAME").or(Some(first)), value("NR"));
    }
    if first.is_empty() || matches!(first, "NAM" | "NBR" | "IDX" | "FAST") {
        return (None, None);
    }
    (Some(first), group.get(1).copied())
}
