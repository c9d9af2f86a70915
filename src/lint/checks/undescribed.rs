//! FC408: a command to an axis that is not described, whose effect is therefore not known (R1.37, R18.2).

use crate::comp::{Kind, Selection};
use crate::diagnostic::{Code, Diagnostic};
use crate::lint::linter::{Linter, Taken};
use crate::lint::memory::place;

pub(super) fn lint(linter: &Linter<'_>, taken: &Taken<'_>) -> Option<Diagnostic> {
    let command = &taken.outcome.command;
    let axis = linter.machine.axis(taken.axis);
    let off = !matches!(command.selection, Selection::On(_));
    if axis.is_described() || !off || !command.selection.kinds().contains(Kind::Frict) {
        return None;
    }
    let name = &command.axis;
    let message = format!(
        "whether this leaves friction compensation of axis `{name}` off depends on a machine that \
         is not described"
    );
    Some(
        Diagnostic::new(Code::Fc408, place(taken.executed, command.span), message)
            .with_axis(name.clone())
            .with_help(axis.describing()),
    )
}
