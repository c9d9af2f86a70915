//! Messages that are collected before they are reported.

use std::collections::BTreeMap;

use super::codes::Code;
use super::message::Diagnostic;

/// Number of messages listed for one file; further ones are counted (R2.85).
pub const MAX_MESSAGES: usize = 10_000;

/// Messages that are collected before they are reported: a limited number is kept, the rest are counted by code.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Collected {
    /// The messages.
    pub said: Vec<Diagnostic>,
    /// Number of further messages by code.
    pub unsaid: BTreeMap<Code, u64>,
}

impl Collected {
    /// Takes a message. One more is kept than is reported, for the place from which the rest are only counted.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.said.len() <= MAX_MESSAGES {
            self.said.push(diagnostic);
        } else {
            *self.unsaid.entry(diagnostic.code).or_default() += 1;
        }
    }

    /// Takes the messages of another collection.
    pub fn append(&mut self, other: &Self) {
        for diagnostic in &other.said {
            self.push(diagnostic.clone());
        }
        for (code, times) in &other.unsaid {
            *self.unsaid.entry(*code).or_default() += times;
        }
    }

    /// Whether there are no messages.
    pub fn is_empty(&self) -> bool {
        self.said.is_empty()
    }
}

impl Extend<Diagnostic> for Collected {
    fn extend<T: IntoIterator<Item = Diagnostic>>(&mut self, messages: T) {
        messages.into_iter().for_each(|message| self.push(message));
    }
}
