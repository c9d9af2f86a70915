//! FC405: the command takes effect before the motion of its block (R1.9, R1.55).

use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::Executed;
use crate::lint::memory::place;

pub(super) fn lint(executed: &Executed<'_>) -> Option<Diagnostic> {
    if executed.moved.is_empty() {
        return None;
    }
    let mut outcomes = executed.outcomes.iter();
    let command = &outcomes.find(|outcome| outcome.result.is_ok())?.command;
    Some(
        Diagnostic::new(
            Code::Fc405,
            place(executed, command.span),
            "COMP and motion share a block; the command takes effect before the motion",
        )
        .with_axis(command.axis.clone())
        .with_help("write the command in a separate block"),
    )
}
