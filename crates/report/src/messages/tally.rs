//! What the messages of a list add up to.

use std::collections::BTreeMap;

use frictcomp::diagnostic::Severity;

/// How many files were looked at and how many diagnostics of each severity were said.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tally {
    /// Files that were looked at.
    pub files: u64,
    /// Diagnostics by severity.
    pub counts: BTreeMap<Severity, u64>,
}

impl Tally {
    /// Counts a diagnostic.
    pub fn count(&mut self, severity: Severity) {
        *self.counts.entry(severity).or_default() += 1;
    }

    /// How many diagnostics of a severity were said.
    pub fn of(&self, severity: Severity) -> u64 {
        self.counts.get(&severity).copied().unwrap_or_default()
    }
}
