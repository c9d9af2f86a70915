//! How messages name a value that is not known offline, and what they advise (R2.50).

use crate::diagnostic::Advice;
use crate::syntax::is_command;

/// A value that is not known offline, and why.
pub(in crate::interpreter) fn unknown_value(name: &str) -> String {
    if is_settable(name) {
        format!("`{name}`, which only the machine knows")
    } else if is_command(name) {
        format!("`{name}`, whose result only the machine knows")
    } else {
        format!("`{name}`, which frictcomp does not know")
    }
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

/// How a user makes a value known.
pub(in crate::interpreter) fn how_to_set(name: &str) -> Advice {
    if is_command(name) {
        return format!("to check one case, assign the value in a block after `{name}`").into();
    }
    if !is_settable(name) {
        return format!("FC210, FC207 or FC902 shows where `{name}` first occurs").into();
    }
    Advice::SetVariable(name.to_owned())
}
