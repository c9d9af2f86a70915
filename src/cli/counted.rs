//! A sink that counts what goes through it, for the exit status and the progress line.

use std::ops::ControlFlow;

use clap::ValueEnum;

use super::progress::Progress;
use crate::diagnostic::Severity;
use crate::report::Tally;
use crate::timeline::{Record, Sink};

/// From which severity on the exit status is 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum FailOn {
    /// An error of the control or of a list.
    #[default]
    Error,
    /// A warning or an error.
    Warning,
    /// Anything at all.
    Info,
    /// Nothing.
    Never,
}

impl FailOn {
    /// The exit status for what was counted (R9.26).
    pub(super) fn status(self, tally: &Tally) -> u8 {
        let severity = match self {
            Self::Error => Severity::Error,
            Self::Warning => Severity::Warning,
            Self::Info => Severity::Info,
            Self::Never => return super::exit::CLEAN,
        };
        if tally.reaches(severity) {
            super::exit::FOUND
        } else {
            super::exit::CLEAN
        }
    }
}

/// Blocks between two looks at the clock.
const STEP: u64 = 1 << 16;

/// Counts diagnostics on their way to a report.
pub(super) struct Counted<'a> {
    inner: &'a mut dyn Sink,
    tally: Tally,
    blocks: u64,
    progress: Progress,
}

impl<'a> Counted<'a> {
    pub(super) fn new(inner: &'a mut dyn Sink) -> Self {
        Self {
            inner,
            tally: Tally::default(),
            blocks: 0,
            progress: Progress::beside_output(),
        }
    }

    /// Takes the progress line away and gives what was counted.
    pub(super) fn finish(self) -> Tally {
        self.tally
    }

    fn step(&mut self) {
        self.blocks += 1;
        if self.blocks.is_multiple_of(STEP) {
            self.progress.show(|| format!("{} blocks", self.blocks));
        }
    }
}

impl Sink for Counted<'_> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Machine(diagnostic) => self.tally.count(diagnostic.severity),
            Record::Block(row) => {
                for diagnostic in row.diagnostics {
                    self.tally.count(diagnostic.severity);
                }
                self.step();
            }
            Record::End(end) => {
                for note in end.notes {
                    self.tally.count(note.diagnostic.severity);
                }
            }
            Record::Session { .. } | Record::Program { .. } | Record::Summary(_) => {}
        }
        self.inner.record(record)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_follows_the_severity_that_counts() {
        // R9.26
        let mut tally = Tally::default();
        assert_eq!(FailOn::Info.status(&tally), 0);
        tally.count(Severity::Warning);
        assert_eq!(FailOn::Error.status(&tally), 0);
        assert_eq!(FailOn::Warning.status(&tally), 1);
        assert_eq!(FailOn::Info.status(&tally), 1);
        tally.count(Severity::Error);
        assert_eq!(FailOn::Error.status(&tally), 1);
        assert_eq!(FailOn::Never.status(&tally), 0);
    }
}
