//! The verdict on a result in one or two sentences that a user can quote (R18.20).

use std::fmt;

use serde::Serialize;

use crate::wording::{leading, visible_line};
use frictcomp::diagnostic::Severity;
use frictcomp_recordings::identify::TraceFinding;

/// Standing of a result: as it should be or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Standing {
    /// A result that is as it should be.
    Good,
    /// A result that is not as it should be.
    Bad,
    /// A result that depends on what is not known.
    #[default]
    Open,
    /// The result is a measurement or a simulation that judges nothing.
    Plain,
}

impl Standing {
    /// Returns the word of a record, and the class of a sentence in HTML.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Bad => "bad",
            Self::Open => "open",
            Self::Plain => "plain",
        }
    }
}

/// Verdict on a result: what holds, where, how sure, and the cure. Text, HTML and JSON give the same one.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
#[non_exhaustive]
pub struct Headline {
    /// Standing of the result: as it should be or not.
    pub standing: Standing,
    /// The sentences, without a period at the end.
    pub text: String,
}

impl Headline {
    /// Creates a verdict.
    pub fn new(standing: Standing, text: impl Into<String>) -> Self {
        let text = text.into();
        Self { standing, text }
    }

    /// Returns the verdict with what it assumes, if anything, each assumption once.
    pub fn assuming(mut self, assumptions: impl IntoIterator<Item = String>) -> Self {
        let mut all: Vec<String> = Vec::new();
        for assumption in assumptions {
            if !all.contains(&assumption) {
                all.push(assumption);
            }
        }
        if !all.is_empty() {
            self.text = format!("{} ({})", self.text, all.join("; "));
        }
        self
    }
}

impl Headline {
    /// Returns the verdict followed by the first warning of some findings, which leaves a good verdict open.
    pub(crate) fn with_fault<'f>(
        self,
        findings: impl IntoIterator<Item = &'f TraceFinding>,
    ) -> Self {
        let mut findings = findings.into_iter();
        let Some(fault) = findings.find(|it| it.severity == Severity::Warning) else {
            return self;
        };
        let standing = match self.standing {
            Standing::Bad => Standing::Bad,
            Standing::Good | Standing::Open | Standing::Plain => Standing::Open,
        };
        let text = format!("{}; {}: {}", self.text, fault.code, fault.message);
        Self::new(standing, text)
    }

    /// Returns the verdict after a remark that has to be known first.
    pub(crate) fn after(&self, remark: &str) -> Self {
        Self::new(self.standing, format!("{remark}. {}", self.text))
    }

    /// Returns the verdict as a sentence of prose, with a capital letter unless it begins with a name.
    pub(crate) fn sentence(&self) -> String {
        let (first, _) = self.text.split_once(' ').unwrap_or((&self.text, ""));
        let is_word = first.bytes().all(|it| it.is_ascii_lowercase());
        match self.text.split_at_checked(1) {
            Some((letter, rest)) if is_word => format!("{}{rest}.", letter.to_ascii_uppercase()),
            _ => format!("{}.", self.text),
        }
    }
}

impl fmt::Display for Headline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&leading(&visible_line(&self.text)))
    }
}
