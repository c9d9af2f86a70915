//! The totals of the messages of a list.

use std::collections::BTreeMap;

use frictcomp::diagnostic::Severity;
use frictcomp::timeline::ReadingsInForce;

/// Number of files examined, and of diagnostics of each severity.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Tally {
    /// Examined files.
    pub files: u64,
    /// Diagnostics by severity.
    pub counts: BTreeMap<Severity, u64>,
    /// The readings of open questions on which the results rest (R15.3).
    pub rests_on: ReadingsInForce,
}

impl Tally {
    /// Counts a diagnostic.
    pub fn count(&mut self, severity: Severity) {
        *self.counts.entry(severity).or_default() += 1;
    }

    /// Returns the number of diagnostics of a severity.
    pub fn of(&self, severity: Severity) -> u64 {
        self.counts.get(&severity).copied().unwrap_or_default()
    }
}
