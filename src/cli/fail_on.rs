//! The severity from which on a command fails.

use std::collections::BTreeMap;

use clap::ValueEnum;

use crate::diagnostic::Severity;

/// From which severity on the exit status is 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum FailOn {
    /// An error of the control or of a list.
    #[default]
    Error,
    /// A warning or an error.
    Warning,
    /// Any message.
    Info,
    /// Nothing.
    Never,
}

impl FailOn {
    /// Whether something of this severity gives the status 1.
    pub(super) fn counts(self, severity: Severity) -> bool {
        self.least().is_some_and(|least| severity >= least)
    }

    fn least(self) -> Option<Severity> {
        match self {
            Self::Error => Some(Severity::Error),
            Self::Warning => Some(Severity::Warning),
            Self::Info => Some(Severity::Info),
            Self::Never => None,
        }
    }

    /// The exit status for how many diagnostics were said at each severity (R9.26).
    pub(super) fn status(self, counts: &BTreeMap<Severity, u64>) -> u8 {
        let mut said = counts.iter().filter(|(_, count)| **count > 0);
        if said.any(|(severity, _)| self.counts(*severity)) {
            super::exit::FOUND
        } else {
            super::exit::CLEAN
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_follows_the_severity_that_counts() {
        // R9.26
        let mut counts = BTreeMap::new();
        assert_eq!(FailOn::Info.status(&counts), 0);
        counts.insert(Severity::Warning, 1);
        assert_eq!(FailOn::Error.status(&counts), 0);
        assert_eq!(FailOn::Warning.status(&counts), 1);
        assert_eq!(FailOn::Info.status(&counts), 1);
        counts.insert(Severity::Error, 1);
        assert_eq!(FailOn::Error.status(&counts), 1);
        assert_eq!(FailOn::Never.status(&counts), 0);
    }
}
