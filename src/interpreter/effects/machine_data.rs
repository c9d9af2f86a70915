//! `#MACHINE DATA`, which writes a parameter of an axis while the program runs (R2.92; TF5200
//! Programming manual, 207492747).

use crate::comp::{AxisIndex, Kind, KindSet, State};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::value::rounded;
use crate::machine::Machine;
use crate::syntax::ast::{BracketArguments, Hash, Operand};

/// Target of a write to the machine data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WriteTarget {
    /// A parameter of friction compensation.
    Friction,
    /// Another parameter.
    Other,
}

/// Returns the target of a command.
pub(crate) fn written(arguments: &BracketArguments, text: &str) -> WriteTarget {
    let is_friction = |key| arguments.mention(key, text);
    if FRICTION_KEYS.into_iter().any(is_friction) {
        WriteTarget::Friction
    } else {
        WriteTarget::Other
    }
}

/// The parameters of friction compensation, and P-AXIS-00522 among them.
const FRICTION_KEYS: [&str; 2] = ["frict_comp", "p-axis-00522"];

/// Whether a command sets P-AXIS-00522 to 1.
pub(crate) fn enables(arguments: &BracketArguments, text: &str) -> bool {
    let keys = ["P-AXIS-00522", "lr_param.frict_comp"];
    let value = keys.iter().find_map(|key| arguments.after(key, text));
    value.is_some_and(|value| value.value == Some(Operand::Number(1.0)))
}

impl Executor {
    /// The axes whose list a command transfers again, with the kinds that NC commands have set there:
    /// all kinds where it writes a parameter of friction compensation.
    pub(crate) fn transferred(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Vec<(AxisIndex, KindSet)> {
        let (arguments, text) = (&hash.brackets, at.text);
        let axes = match arguments.after("AXNR", text) {
            Some(number) => {
                let number = self.argument_number(number, at).and_then(rounded);
                numbered(&self.machine, number)
            }
            None => named(&self.machine, arguments, text),
        };
        let start = self.machine.compensation();
        let now = &self.state.control.compensation;
        let is_lost = |axis: AxisIndex, kind: &Kind| {
            let (now, start) = (now.state(axis, *kind), start.state(axis, *kind));
            let is_open = self.state.control.history.states(axis, *kind).is_some();
            written(arguments, text) == WriteTarget::Friction
                || (now != start && (now != State::Unknown || is_open))
        };
        let lost = axes.into_iter().map(|axis| {
            let kinds = Kind::ALL.into_iter().filter(|kind| is_lost(axis, kind));
            (axis, kinds.collect::<KindSet>())
        });
        lost.filter(|(_, kinds)| !kinds.is_empty()).collect()
    }

    /// The axes that the command may name in blocks that are passed over.
    pub(crate) fn perhaps_transferred(
        &self,
        arguments: &BracketArguments,
        text: &str,
    ) -> Vec<AxisIndex> {
        match arguments.after("AXNR", text) {
            Some(number) => {
                let number = number.logical_number(text).map(i64::from);
                numbered(&self.machine, number)
            }
            None => named(&self.machine, arguments, text),
        }
    }
}

/// The axes with a logical number; those without one may have any.
fn numbered(machine: &Machine, number: Option<i64>) -> Vec<AxisIndex> {
    let number = number.and_then(|number| u32::try_from(number).ok());
    let has = |wanted: Option<u32>| {
        let axes = machine.axes.iter().enumerate();
        let axes = axes.filter(move |(_, axis)| axis.number == wanted);
        axes.map(|(axis, _)| AxisIndex::new(axis))
            .collect::<Vec<_>>()
    };
    match number {
        None => (0..machine.axes.len()).map(AxisIndex::new).collect(),
        Some(_) if has(number).is_empty() => has(None),
        Some(_) => has(number),
    }
}

/// The axis of a name, in either case. A command that names none writes to any axis, unless it is about the channel.
fn named(machine: &Machine, arguments: &BracketArguments, text: &str) -> Vec<AxisIndex> {
    match arguments.after("AX", text) {
        Some(argument) => {
            let name = argument.quoted(text).unwrap_or(argument.span.of(text));
            let mut axes = machine.axes.iter();
            let mut in_capitals = || axes.position(|axis| axis.name.eq_ignore_ascii_case(name));
            let found = machine
                .find(name)
                .or_else(|| in_capitals().map(AxisIndex::new));
            found.into_iter().collect()
        }
        None if arguments.mention("p-chan", text) => Vec::new(),
        None => numbered(machine, None),
    }
}
