//! Messages on a command at its place: FC402, FC405 and FC408.

use crate::comp::{Kind, Selection};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::Executed;
use crate::lint::linter::{Linter, Taken};
use crate::lint::memory::place;

/// Returns FC402: a command that repeats an earlier one of the program, or switches off a kind that is not configured
/// (R1.51, R18.3).
pub(super) fn repeated(linter: &Linter<'_>, taken: &Taken<'_>) -> Option<Diagnostic> {
    let memory = linter.memory.axis(taken.axis);
    let command = &taken.outcome.command;
    let kinds = command.selection.kinds();
    let place = place(taken.executed, command.span);
    let (what, name) = (what(command.selection), &command.axis);
    let say = |message| Diagnostic::new(Code::Fc402, place, message).with_axis(name.clone());
    let is_off = !matches!(command.selection, Selection::On(_));
    let useless = |kind| is_off && is_unconfigured(linter, taken, kind);
    let of_axis = &linter.machine.axis(taken.axis).frict_comp_origin;
    // The program counts on an axis that is not compensated (R18.3).
    let is_mistaken = kinds.contains(Kind::Frict) && useless(Kind::Frict);
    let advised = |said: Diagnostic| {
        if !is_mistaken {
            return said;
        }
        said.with_help(format!(
            "P-AXIS-00522 (lr_param.frict_comp) of axis `{name}` is 0 ({of_axis}); set it to 1 if the axis is to be \
             compensated"
        ))
    };
    if (is_mistaken || memory.commanded) && kinds.iter().all(useless) {
        let message =
            format!("this command changes nothing: {what} of axis `{name}` is not configured");
        return Some(advised(say(message)));
    }
    if is_mistaken && command.selection != Selection::OffAll {
        let message = format!(
            "this command does not switch `{}` of axis `{name}`, which is not configured",
            Kind::Frict
        );
        return Some(advised(say(message)));
    }
    if !memory.commanded || taken.outcome.changes > 0 {
        // Setting the required state at program start is the recommended practice; or another way switched it before,
        // and this one did not.
        return None;
    }
    let repeated = &taken.outcome.repeated;
    if !kinds.without(repeated.kinds).iter().all(useless) {
        return None;
    }
    let state = if is_off { "off" } else { "on" };
    let said = say(format!(
        "this command repeats an earlier one: {what} of axis `{name}` is already {state}"
    ));
    // In a loop, the command repeats itself.
    let other = repeated
        .site
        .as_ref()
        .filter(|site| site.place != said.place);
    Some(match other {
        Some(site) => said.with_label(site.place.clone(), "the earlier one"),
        None => said,
    })
}

/// Returns whether the machine is known to lack a kind on the axis.
fn is_unconfigured(linter: &Linter<'_>, taken: &Taken<'_>, kind: Kind) -> bool {
    let compensation = taken.executed.compensation;
    linter.machine.axis(taken.axis).is_described() && !compensation.is_configured(taken.axis, kind)
}

fn what(selection: Selection) -> String {
    match selection {
        Selection::OffAll => "every compensation".to_owned(),
        Selection::On(kinds) | Selection::Off(kinds) => {
            let words: Vec<&str> = kinds.iter().map(Kind::as_str).collect();
            format!("`{}`", words.join(" "))
        }
    }
}

/// Returns FC408: a command to an axis that is not described, whose effect is therefore not known (R1.37, R18.2).
pub(super) fn undescribed(linter: &Linter<'_>, taken: &Taken<'_>) -> Option<Diagnostic> {
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

/// Returns FC405: the command takes effect before the motion of its block (R1.9, R1.55).
pub(super) fn shared_block(executed: &Executed<'_>) -> Option<Diagnostic> {
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
