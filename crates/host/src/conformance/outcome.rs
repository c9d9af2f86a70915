//! The outcome of a case.

use std::path::PathBuf;

/// An expectation that is not met.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Mismatch {
    /// The file of the case.
    pub file: PathBuf,
    /// Expected state, with the reading.
    pub expected: String,
    /// Found state.
    pub found: String,
}

/// Outcome of a case.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct CaseOutcome {
    /// Whether the documents leave the case open.
    pub is_undecided: bool,
    /// Failed expectations; none where the case holds.
    pub failed: Vec<Mismatch>,
}

/// Outcome of all cases.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Totals {
    /// Number of cases.
    pub cases: usize,
    /// Number of cases that hold, with those that are undecided and hold under both readings.
    pub held: usize,
    /// Number of cases that the documents leave open.
    pub undecided: usize,
    /// Failed expectations.
    pub failed: Vec<Mismatch>,
}

impl Totals {
    /// Counts an outcome.
    pub fn add(&mut self, outcome: CaseOutcome) {
        self.cases += 1;
        self.held += usize::from(outcome.failed.is_empty());
        self.undecided += usize::from(outcome.is_undecided);
        self.failed.extend(outcome.failed);
    }
}
