//! The severity from which a command fails.

use std::collections::{BTreeMap, BTreeSet};

use clap::ValueEnum;

use frictcomp::comp::Kind;
use frictcomp::diagnostic::Severity;

/// A word of `--fail-on`; a list of them gives exit status 1 for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FailOnWord {
    /// Nothing
    Never,
    /// Any message
    Info,
    /// A warning or an error
    Warning,
    /// An error of the control or of a list
    Error,
    /// A state that is not known at a program's end or where its axis moves, besides the severity
    /// that is named or the default
    Unknown,
}

impl FailOnWord {
    fn severity(self) -> Option<Severity> {
        match self {
            Self::Info => Some(Severity::Info),
            Self::Warning => Some(Severity::Warning),
            Self::Error => Some(Severity::Error),
            Self::Never | Self::Unknown => None,
        }
    }
}

/// What gives exit status 1 (R18.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FailOn {
    least: Option<Severity>,
    unknown: bool,
}

impl FailOn {
    /// Creates the condition that the words of a command describe; `unknown` alone adds to the command's default.
    pub(crate) fn new(words: &[FailOnWord], default: Severity) -> Self {
        let names_severity = words.iter().any(|word| *word != FailOnWord::Unknown);
        let named = words.iter().filter_map(|word| word.severity()).min();
        Self {
            least: if names_severity { named } else { Some(default) },
            unknown: words.contains(&FailOnWord::Unknown),
        }
    }

    /// Creates the condition of a command that judges.
    pub(crate) fn judging(words: &[FailOnWord]) -> Self {
        Self::new(words, Severity::Warning)
    }

    /// Whether this severity gives the status 1.
    pub(crate) fn counts(self, severity: Severity) -> bool {
        self.least.is_some_and(|least| severity >= least)
    }

    /// Returns the exit status for unknown states, given by their names (R2.98).
    pub(crate) fn unknown_status(self, unknown: &BTreeSet<String>) -> u8 {
        if self.unknown && !unknown.is_empty() {
            crate::output::FOUND
        } else {
            crate::output::CLEAN
        }
    }

    /// Returns the remark on unknown states, where they give the status 1.
    pub(crate) fn unknown_remark(self, unknown: &BTreeSet<String>) -> Option<String> {
        let named: Vec<&str> = unknown.iter().map(String::as_str).collect();
        let named = named.join(", ");
        (self.unknown_status(unknown) != crate::output::CLEAN)
            .then(|| format!("not known at the end of a program or where the axis moves: {named}"))
    }

    /// Returns the exit status for the number of diagnostics at each severity (R9.26).
    pub(crate) fn status(self, counts: &BTreeMap<Severity, u64>) -> u8 {
        let mut said = counts.iter().filter(|(_, count)| **count > 0);
        if said.any(|(severity, _)| self.counts(*severity)) {
            crate::output::FOUND
        } else {
            crate::output::CLEAN
        }
    }
}

/// Returns the name of a kind of an axis whose state is unknown.
pub(crate) fn of_axis(axis: &str, kind: Kind) -> String {
    format!("`{kind}` of `{axis}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_follows_the_severity_that_counts() {
        // R9.26, R18.1
        use FailOnWord::{Error, Info, Never, Unknown, Warning};
        let judging = FailOn::judging;
        let mut counts = BTreeMap::new();
        assert_eq!(judging(&[Info]).status(&counts), 0);
        counts.insert(Severity::Warning, 1);
        assert_eq!(judging(&[]).status(&counts), 1);
        assert_eq!(FailOn::new(&[], Severity::Error).status(&counts), 0);
        assert_eq!(judging(&[Error]).status(&counts), 0);
        assert_eq!(judging(&[Warning]).status(&counts), 1);
        assert_eq!(judging(&[Error, Info]).status(&counts), 1);
        counts.insert(Severity::Error, 1);
        assert_eq!(judging(&[Error]).status(&counts), 1);
        assert_eq!(judging(&[Never]).status(&counts), 0);
        // R2.98
        let unknown = BTreeSet::from(["FRICT of X".to_owned()]);
        assert_eq!(judging(&[Unknown]).status(&counts), 1);
        assert_eq!(judging(&[Never, Unknown]).status(&counts), 0);
        assert_eq!(judging(&[Never, Unknown]).unknown_status(&unknown), 1);
        assert_eq!(judging(&[Error]).unknown_status(&unknown), 0);
        assert_eq!(judging(&[Unknown]).unknown_status(&BTreeSet::new()), 0);
    }
}
