//! The interface of formats of messages.

use std::fmt;

use serde_json::Value;

use frictcomp::diagnostic::Diagnostic;

use super::tally::Tally;
use crate::document::Headline;

/// Writer of messages: a beginning, a part for each message, an end.
pub(super) trait MessageFormat: fmt::Debug {
    /// Appends the text before the first message.
    fn open(&mut self, _out: &mut Vec<u8>) {}

    /// Takes an examined program.
    fn program(&mut self, _name: &str) {}

    /// Appends a message.
    fn message(&mut self, out: &mut Vec<u8>, message: &Diagnostic);

    /// Appends a record of another kind, if the format has records.
    fn record(&mut self, _out: &mut Vec<u8>, _record: &Value) {}

    /// Takes the verdict on everything: a last line for people, a member of the summary of records.
    fn headline(&mut self, _out: &mut Vec<u8>, _headline: &Headline) {}

    /// Appends the text after the last message.
    fn close(&mut self, _out: &mut Vec<u8>, _tally: &Tally) {}
}
