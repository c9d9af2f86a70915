//! The messages that stop a program.

use super::event::EndedBy;
use crate::diagnostic::{Code, Collected, Diagnostic, Severity};
use crate::machine::HarmlessWords;
use crate::syntax::Fault;

/// A single message.
pub(in crate::interpreter) fn one(diagnostic: Diagnostic) -> Collected {
    let mut notes = Collected::default();
    notes.push(diagnostic);
    notes
}

/// Whether a diagnostic stops the control.
pub(in crate::interpreter) fn stops(diagnostic: &Diagnostic) -> bool {
    diagnostic.code.severity() == Severity::Error
}

/// Returns the reason for the end of a program that one of these diagnostics stops.
pub(in crate::interpreter) fn ended_by(said: &[Diagnostic]) -> EndedBy {
    let bound = |diagnostic: &Diagnostic| diagnostic.code.is_budget();
    match said.iter().find(|diagnostic| stops(diagnostic)) {
        Some(diagnostic) if bound(diagnostic) => EndedBy::Budget,
        _ => EndedBy::Error,
    }
}

/// Whether a fault is about a word that the user declares harmless.
pub(in crate::interpreter) fn is_harmless(
    words: &HarmlessWords,
    fault: &Fault,
    text: &str,
) -> bool {
    fault.code == Code::Fc210 && words.has_command(fault.span.of(text))
}
