//! The messages that stop a program.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::block_context::BlockContext;
use super::event::EndedBy;
use crate::diagnostic::{Code, Collected, Diagnostic, Severity};
use crate::interpreter::ways::words::seen_from;
use crate::machine::HarmlessWords;
use crate::syntax::Fault;
use crate::text::Place;

/// A single message.
pub(crate) fn one(diagnostic: Diagnostic) -> Collected {
    let mut notes = Collected::default();
    notes.push(diagnostic);
    notes
}

/// Whether a diagnostic stops the control.
pub(crate) fn stops(diagnostic: &Diagnostic) -> bool {
    diagnostic.code.severity() == Severity::Error
}

/// Returns the reason for the end of a program that one of these diagnostics stops.
pub(crate) fn ended_by(said: &[Diagnostic]) -> EndedBy {
    let bound = |diagnostic: &Diagnostic| diagnostic.code.is_budget();
    match said.iter().find(|diagnostic| stops(diagnostic)) {
        Some(diagnostic) if bound(diagnostic) => EndedBy::Budget,
        _ => EndedBy::Error,
    }
}

/// Whether a fault is about a word that the user declares harmless.
pub(crate) fn is_harmless(words: &HarmlessWords, fault: &Fault, text: &str) -> bool {
    fault.code == Code::Fc210 && words.has_command(fault.span.of(text))
}

/// The block at whose error the control stops, and the dry run goes on (R9.20).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct FailedAt {
    seq: u64,
    file: Arc<str>,
    line: u32,
    by: EndedBy,
}

impl FailedAt {
    /// The executed block `seq`, with its messages.
    pub(crate) fn new(seq: u64, at: &BlockContext<'_>, said: &[Diagnostic]) -> Self {
        Self {
            seq,
            file: Arc::clone(at.file),
            line: at.line,
            by: ended_by(said),
        }
    }

    /// Says on a message about what follows that the control stops before it.
    pub(crate) fn mark(&self, said: &mut Diagnostic, seq: u64) {
        let is_here = |end: &Place| *end.file == *self.file && end.start().line == self.line;
        if seq == self.seq
            || said.code.is_about_text()
            || self.by == EndedBy::Budget
            || said.ends.iter().any(is_here)
        {
            return;
        }
        let place = seen_from((&self.file, self.line), &said.place.file);
        let words = format!("mend {place} first: the control stops there");
        said.advice.push(words.into());
    }
}
