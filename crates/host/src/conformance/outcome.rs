//! What came out of a case.

use std::path::PathBuf;

/// An expectation that does not hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mismatch {
    /// The file of the case.
    pub file: PathBuf,
    /// What is expected, and under which reading.
    pub expected: String,
    /// What was found.
    pub found: String,
}

/// What came out of a case.
#[derive(Debug, Clone, Default)]
pub struct CaseOutcome {
    /// Whether the documents leave it open.
    pub is_undecided: bool,
    /// What does not hold; nothing where the case holds.
    pub failed: Vec<Mismatch>,
}

/// What came out of all cases.
#[derive(Debug, Clone, Default)]
pub struct Totals {
    /// How many there are.
    pub cases: usize,
    /// How many hold, with those that are undecided and hold under both readings.
    pub held: usize,
    /// How many the documents leave open.
    pub undecided: usize,
    /// What does not hold.
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
