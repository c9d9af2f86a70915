//! Names of values that are not known offline in messages, and the advice on them (R2.50).

use std::sync::Arc;

use super::externals::SetVariable;
use crate::diagnostic::Advice;
use crate::language::is_command;

/// The name of a skip level as a cause.
const SKIP: &str = "skip level ";

/// The name of a missing program as a cause.
const PROGRAM: &str = "program ";

/// The signal of a probe as a cause (R2.91).
pub(in crate::interpreter) const PROBE: &str = "the signal of the probe";

/// The remedy class of `#ERROR` that is left out, as a cause (R2.100).
pub(in crate::interpreter) const ERROR_COMMAND: &str = "#ERROR";

/// A skip level as the deciding value (R2.90).
pub(in crate::interpreter) fn skip_level(level: u8) -> Arc<str> {
    format!("{SKIP}{level}").into()
}

/// The skip level that decides, where one does.
pub(in crate::interpreter) fn decided_level(name: &str) -> Option<u8> {
    name.strip_prefix(SKIP)?.parse().ok()
}

/// A missing program as the deciding value (R2.83, R2.95).
pub(in crate::interpreter) fn program(name: &str) -> Arc<str> {
    format!("{PROGRAM}{name}").into()
}

/// A value that is not known offline, with the reason, as seen from a file.
pub(in crate::interpreter) fn unknown_value(name: &str, file: &str) -> String {
    if let Some(set) = SetVariable::of(name) {
        set.seen_from(file)
    } else if decided_level(name).is_some() {
        format!("{name}, a switch of the machine")
    } else if name == PROBE {
        format!("{name}, which only the machine knows")
    } else if let Some(program) = name.strip_prefix(PROGRAM) {
        let of = if is_word(program) { "of " } else { "" };
        format!("the program {of}`{program}`, which is missing")
    } else if name.starts_with("V.S.") {
        format!("`{name}`, which a program before this one may have left")
    } else if is_settable(name) {
        format!("`{name}`, which only the machine knows")
    } else if name == ERROR_COMMAND {
        format!("what the control does at `{name}`")
    } else if is_command(name) {
        format!("`{name}`, whose result only the machine knows")
    } else {
        format!("`{name}`, which frictcomp does not know")
    }
}

/// Whether a missing program is named by the G word that calls it (R2.94).
fn is_word(program: &str) -> bool {
    let number = program.strip_prefix('G').unwrap_or_default();
    !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit())
}

/// Whether a name is one of a parameter or variable.
fn is_settable(name: &str) -> bool {
    let name = name.strip_prefix('@').unwrap_or(name);
    name.starts_with("V.")
        || name.starts_with("v.")
        || name
            .strip_prefix(['P', 'p'])
            .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        || matches!(name.as_bytes(), [b'A'..=b'Z'])
}

/// Returns the advice by which a user makes a value known.
pub(in crate::interpreter) fn how_to_set(name: &str) -> Advice {
    if let Some(level) = decided_level(name) {
        return Advice::SetSkip(level);
    }
    if name == PROBE {
        return "set the state afterwards, for example with `X[COMP ON FRICT]`".into();
    }
    if let Some(program) = name.strip_prefix(PROGRAM) {
        if is_word(program) {
            return format!("FC325 says how to describe `{program}`").into();
        }
        return format!("give frictcomp `{program}`, or say in `[machine.external_keeps]` that it keeps parameters").into();
    }
    if name == ERROR_COMMAND {
        return "`RC=0` lets the program go on, `RC=2` stops it".into();
    }
    if is_command(name) {
        return format!("to check one case, assign the value in a block after `{name}`").into();
    }
    if !is_settable(name) {
        return format!("FC210, FC207 or FC902 shows where `{name}` first occurs").into();
    }
    Advice::SetVariable(name_of(name).to_owned())
}

/// The name by which a user knows a value that is not known offline.
pub(in crate::interpreter) fn name_of(cause: &str) -> &str {
    SetVariable::of(cause).map_or(cause, |set| set.name)
}
