//! One row of the table, and when a session depends on it.

use std::collections::BTreeSet;

use frictcomp::diagnostic::Code;
use frictcomp::machine::AxisSet;
use frictcomp::timeline::EndedBy;

/// An assumption. The texts name codes and words of programs in backquotes.
#[derive(Debug, Clone, Copy)]
pub struct Assumption {
    /// The rule, section or contradiction of `docs/rules.md` that it belongs to.
    pub rule: &'static str,
    /// The assumption.
    pub sentence: &'static str,
    /// Results that it changes.
    pub changes: &'static str,
    /// Output by which a user sees it.
    pub shows: &'static str,
    /// Cases in which a session depends on it; none if its records tell of none.
    pub when: &'static [When],
}

/// A case in which a session depends on an assumption.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum When {
    /// In every session.
    Always,
    /// If no machine is described.
    NoMachine,
    /// If something was passed over.
    PassedOver,
    /// If an error ended it.
    Stopped,
    /// If this was reported.
    Reported(Code),
}

/// Facts about a session that decide its assumptions.
#[derive(Debug, Clone)]
pub(crate) struct Met {
    /// The codes of its messages.
    pub(crate) reported: BTreeSet<Code>,
    /// Set of axes.
    pub(crate) axis_set: AxisSet,
    /// Number of words and commands passed over.
    pub(crate) passed_over: u64,
    /// End of its last program.
    pub(crate) ended: Option<EndedBy>,
}

impl Assumption {
    /// Whether a session is known to depend on it.
    pub(crate) fn is_met(&self, met: &Met) -> bool {
        self.when.iter().any(|case| match case {
            When::Always => true,
            When::NoMachine => met.axis_set == AxisSet::AsTheyOccur,
            When::PassedOver => met.passed_over > 0,
            When::Stopped => met.ended == Some(EndedBy::Error),
            When::Reported(code) => met.reported.contains(code),
        })
    }
}
