//! The severity from which a command fails.

use std::collections::{BTreeMap, BTreeSet};

use clap::ValueEnum;

use frictcomp::comp::Kind;
use frictcomp::diagnostic::Severity;

/// The lowest severity that gives exit status 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum FailOn {
    /// An error of the control or of a list.
    #[default]
    Error,
    /// A warning or an error.
    Warning,
    /// Any message.
    Info,
    /// An error, or a state that is not known at a program's end or where its axis moves.
    Unknown,
    /// Nothing.
    Never,
}

impl FailOn {
    /// Whether this severity gives the status 1.
    pub(super) fn counts(self, severity: Severity) -> bool {
        self.least().is_some_and(|least| severity >= least)
    }

    fn least(self) -> Option<Severity> {
        match self {
            Self::Error | Self::Unknown => Some(Severity::Error),
            Self::Warning => Some(Severity::Warning),
            Self::Info => Some(Severity::Info),
            Self::Never => None,
        }
    }

    /// Returns the exit status for unknown states, given by their names (R2.98).
    pub(super) fn unknown_status(self, unknown: &BTreeSet<String>) -> u8 {
        if self == Self::Unknown && !unknown.is_empty() {
            super::exit::FOUND
        } else {
            super::exit::CLEAN
        }
    }

    /// Returns the remark on unknown states, where they give the status 1.
    pub(super) fn unknown_remark(self, unknown: &BTreeSet<String>) -> Option<String> {
        let named: Vec<&str> = unknown.iter().map(String::as_str).collect();
        let named = named.join(", ");
        (self.unknown_status(unknown) != super::exit::CLEAN)
            .then(|| format!("not known at the end of a program or where the axis moves: {named}"))
    }

    /// Returns the exit status for the number of diagnostics at each severity (R9.26).
    pub(super) fn status(self, counts: &BTreeMap<Severity, u64>) -> u8 {
        let mut said = counts.iter().filter(|(_, count)| **count > 0);
        if said.any(|(severity, _)| self.counts(*severity)) {
            super::exit::FOUND
        } else {
            super::exit::CLEAN
        }
    }
}

/// Returns the name of a kind of an axis whose state is unknown.
pub(super) fn of_axis(axis: &str, kind: Kind) -> String {
    format!("`{kind}` of `{axis}`")
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
        // R2.98
        let unknown = BTreeSet::from(["FRICT of X".to_owned()]);
        assert_eq!(FailOn::Unknown.status(&counts), 1);
        assert_eq!(FailOn::Unknown.unknown_status(&unknown), 1);
        assert_eq!(FailOn::Error.unknown_status(&unknown), 0);
        assert_eq!(FailOn::Unknown.unknown_status(&BTreeSet::new()), 0);
    }
}
