//! `#MACHINE DATA`, which writes a parameter of an axis while the program runs (R2.92; TF5200
//! Programming manual, 207492747).

use crate::comp::{AxisIndex, Kind, KindSet, State};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::values::value::rounded;
use crate::machine::Machine;
use crate::syntax::ast::Hash;

/// Target of a write to the machine data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::interpreter) enum WriteTarget {
    /// A parameter of friction compensation.
    Friction,
    /// Another parameter.
    Other,
}

/// An axis as the command names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AxisName<'a> {
    Name(&'a str),
    Number(&'a str),
}

/// Whether a `#` command writes machine data.
pub(in crate::interpreter) fn is_machine_data(name: &str) -> bool {
    let rest = name.strip_prefix("#MACHINE DATA");
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
}

/// Returns the target in the text of a command.
pub(in crate::interpreter) fn written(text: &str) -> WriteTarget {
    let text = text.to_ascii_lowercase();
    let is_friction = text.contains("frict_comp") || text.contains("p-axis-00522");
    if is_friction {
        WriteTarget::Friction
    } else {
        WriteTarget::Other
    }
}

/// Whether the text of a command sets P-AXIS-00522 to 1.
pub(in crate::interpreter) fn enables(text: &str) -> bool {
    let text = text.to_ascii_lowercase();
    let keys = ["p-axis-00522", "lr_param.frict_comp"];
    let value = keys.iter().find_map(|key| Some(text.split_once(key)?.1));
    let value = value.map(|value| number(value.trim_start_matches([' ', '\t', '='])));
    value.is_some_and(|value| value == "1")
}

impl Interpreter {
    /// The axes whose list a command transfers again, with the kinds that NC commands have set there:
    /// all kinds where it writes a parameter of friction compensation.
    pub(in crate::interpreter) fn transferred(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Vec<(AxisIndex, KindSet)> {
        let text = &*hash.code(at.text);
        let axes = match named(text) {
            Some(AxisName::Number(number)) => {
                let number = self.number_in(number, at).and_then(rounded);
                numbered(&self.machine, number)
            }
            other => plainly_named(&self.machine, other, text),
        };
        let start = self.machine.compensation();
        let now = &self.state.control.compensation;
        let is_lost = |axis: AxisIndex, kind: &Kind| {
            let (now, start) = (now.state(axis, *kind), start.state(axis, *kind));
            written(text) == WriteTarget::Friction || (now != start && now != State::Unknown)
        };
        let lost = axes.into_iter().map(|axis| {
            let kinds = Kind::ALL.into_iter().filter(|kind| is_lost(axis, kind));
            (axis, kinds.collect::<KindSet>())
        });
        lost.filter(|(_, kinds)| !kinds.is_empty()).collect()
    }

    /// The axes that the command may name in a region that may or may not be executed.
    pub(in crate::interpreter) fn perhaps_transferred(&self, text: &str) -> Vec<AxisIndex> {
        match named(text) {
            Some(AxisName::Number(number)) => {
                let number = number.parse().ok().and_then(rounded);
                numbered(&self.machine, number)
            }
            other => plainly_named(&self.machine, other, text),
        }
    }
}

/// The axis of a command: `AX=X`, `AX X`, `AXNR=1`, with blanks and in either case.
fn named(text: &str) -> Option<AxisName<'_>> {
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c.is_ascii_alphanumeric()) {
        rest = &rest[at..];
        let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '-'));
        let (word, after) = rest.split_at(end.unwrap_or(rest.len()));
        let value = after.trim_start().trim_start_matches('=').trim_start();
        if word.eq_ignore_ascii_case("AX") {
            let end = value.find(|c: char| c.is_whitespace() || matches!(c, ']' | ','));
            return Some(AxisName::Name(&value[..end.unwrap_or(value.len())]));
        }
        if word.eq_ignore_ascii_case("AXNR") {
            return Some(AxisName::Number(number(value)));
        }
        rest = after;
    }
    None
}

/// The expression at the start of a text.
fn number(text: &str) -> &str {
    if !text.starts_with('[') {
        let end = text.find(|c: char| c.is_whitespace() || matches!(c, ']' | ','));
        return &text[..end.unwrap_or(text.len())];
    }
    let mut depth = 0_usize;
    let end = text.char_indices().find(|(_, c)| {
        match c {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0
    });
    &text[..end.map_or(text.len(), |(at, _)| at + 1)]
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

/// The axis of a name. A command that names none writes to any axis, unless it is about the channel.
fn plainly_named(machine: &Machine, named: Option<AxisName<'_>>, text: &str) -> Vec<AxisIndex> {
    match named {
        Some(AxisName::Name(name)) => {
            let name = name.trim_matches('"');
            let upper = name.to_ascii_uppercase();
            let found = machine.find(name).or_else(|| machine.find(&upper));
            found.into_iter().collect()
        }
        _ if text.to_ascii_uppercase().contains("P-CHAN") => Vec::new(),
        _ => numbered(machine, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_named_in_each_form() {
        // R2.92
        for text in [
            "[AX=X P-AXIS-00522=0]",
            "[SYN AX=X P-AXIS-00522 0]",
            "[ ax = X p-axis-00522 = 0 ]",
            "[AX X,P-AXIS-00522=0]",
        ] {
            assert_eq!(named(text), Some(AxisName::Name("X")), "{text}");
            assert_eq!(written(text), WriteTarget::Friction, "{text}");
        }
        assert_eq!(
            named("[AXNR=[P1 + 1] a=2]"),
            Some(AxisName::Number("[P1 + 1]"))
        );
        assert_eq!(named("[AXNR 2 a=2]"), Some(AxisName::Number("2")));
        assert_eq!(named("[P-CHAN-00001=0]"), None);
        assert_eq!(written("[AX=X kenngr.swe_pos=1]"), WriteTarget::Other);
        assert!(enables("[AX=X P-AXIS-00522=1]") && enables("[AX X lr_param.frict_comp 1]"));
        assert!(!enables("[AX=X P-AXIS-00522=0]") && !enables("[AX=X P-AXIS-00522=10]"));
        assert!(is_machine_data("#MACHINE DATA SYN") && !is_machine_data("#MACHINE DATABASE"));
    }
}
