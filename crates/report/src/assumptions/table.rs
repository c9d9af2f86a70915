//! The tables, read from their data files.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use serde::Deserialize;

use frictcomp::diagnostic::{Code, UnknownCode};
use frictcomp::interpreter::EndedBy;
use frictcomp::machine::AxisSet;

/// Assumptions about one subject.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Chapter {
    /// Subject of its assumptions.
    pub title: String,
    /// The assumptions by their rules.
    #[serde(rename = "assumption")]
    pub assumptions: Vec<Assumption>,
}

/// An assumption. The texts name codes and words of programs in backquotes.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Assumption {
    /// The rule, section or contradiction of `docs/rules` that it belongs to.
    pub rule: String,
    /// The assumption.
    pub sentence: String,
    /// Results that it changes.
    pub changes: String,
    /// Output by which a user sees it.
    pub shows: String,
    /// Cases in which a session depends on it; none if its records show none.
    #[serde(default)]
    pub when: Vec<When>,
}

/// A case in which a session depends on an assumption.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
#[non_exhaustive]
pub enum When {
    /// Every session.
    Always,
    /// Sessions without a description of the machine.
    NoMachine,
    /// Sessions in which something was passed over.
    PassedOver,
    /// Sessions that an error ended.
    Stopped,
    /// Sessions with this message.
    Reported(Code),
}

/// A known difference between frictcomp and the control that is not an assumption. The texts name codes
/// and words of programs in backquotes.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Difference {
    /// `purpose`, `not modelled`, or `simulation` for what a simulated machine does not have.
    pub kind: String,
    /// Subject.
    pub what: String,
    /// Known behaviour of the control; of the machine in a row `simulation`.
    pub control: String,
    /// Behaviour of frictcomp.
    pub frictcomp: String,
    /// The rule.
    pub rule: String,
}

/// Facts about a session that decide its assumptions.
#[derive(Debug, Clone)]
pub(crate) struct SessionFacts {
    /// The codes of its messages.
    pub(crate) reported: BTreeSet<Code>,
    /// Set of axes.
    pub(crate) axis_set: AxisSet,
    /// Number of words and commands passed over.
    pub(crate) passed_over: u64,
    /// End of its last program.
    pub(crate) ended: Option<EndedBy>,
}

/// Returns all assumptions that can change a result.
pub fn chapters() -> &'static [Chapter] {
    #[derive(Deserialize)]
    struct File {
        chapter: Vec<Chapter>,
    }
    static READ: LazyLock<Vec<Chapter>> = LazyLock::new(|| {
        let file: File = toml::from_str(include_str!("assumptions.toml")).expect(TESTED);
        file.chapter
    });
    &READ
}

/// Returns every known difference that is not an assumption.
pub fn differences() -> &'static [Difference] {
    #[derive(Deserialize)]
    struct File {
        difference: Vec<Difference>,
    }
    static READ: LazyLock<Vec<Difference>> = LazyLock::new(|| {
        let file: File = toml::from_str(include_str!("differences.toml")).expect(TESTED);
        file.difference
    });
    &READ
}

/// Reason why reading a table cannot fail.
const TESTED: &str = "the tables are part of the program, and the tests read them";

impl TryFrom<String> for When {
    type Error = UnknownCode;

    fn try_from(word: String) -> Result<Self, Self::Error> {
        Ok(match word.as_str() {
            "always" => Self::Always,
            "no machine" => Self::NoMachine,
            "passed over" => Self::PassedOver,
            "stopped" => Self::Stopped,
            code => Self::Reported(code.parse()?),
        })
    }
}

impl Assumption {
    /// Returns whether a session is known to depend on it.
    pub(crate) fn is_met(&self, met: &SessionFacts) -> bool {
        self.when.iter().any(|case| match case {
            When::Always => true,
            When::NoMachine => met.axis_set == AxisSet::AsTheyOccur,
            When::PassedOver => met.passed_over > 0,
            When::Stopped => met.ended == Some(EndedBy::Error),
            When::Reported(code) => met.reported.contains(code),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn met(reported: &[Code]) -> SessionFacts {
        SessionFacts {
            reported: reported.iter().copied().collect(),
            axis_set: AxisSet::Configured,
            passed_over: 0,
            ended: Some(EndedBy::M30),
        }
    }

    fn rules(met: &SessionFacts) -> Vec<&'static str> {
        let all = chapters().iter().flat_map(|chapter| &chapter.assumptions);
        let used = all.filter(|assumption| assumption.is_met(met));
        used.map(|assumption| assumption.rule.as_str()).collect()
    }

    #[test]
    fn what_was_reported_tells_what_was_assumed() {
        // R9.50
        assert!(rules(&met(&[Code::Fc303])).contains(&"R1.26"));
        assert!(rules(&met(&[Code::Fc912])).contains(&"R2.60"));
        assert!(rules(&met(&[Code::Fc402])).contains(&"R1.29"));
        assert!(!rules(&met(&[Code::Fc402])).contains(&"R2.60"));
    }

    #[test]
    fn the_end_of_a_run_tells_what_was_assumed() {
        // R9.50, R1.37, R2.47, R9.20
        let plain = met(&[]);
        assert!(!rules(&plain).contains(&"R1.37") && !rules(&plain).contains(&"R2.47"));
        let undescribed = SessionFacts {
            axis_set: AxisSet::AsTheyOccur,
            ..met(&[])
        };
        assert!(rules(&undescribed).contains(&"R1.37"));
        let passed = SessionFacts {
            passed_over: 1,
            ..met(&[])
        };
        assert!(rules(&passed).contains(&"R2.47"));
        let stopped = SessionFacts {
            ended: Some(EndedBy::Error),
            ..met(&[])
        };
        assert!(rules(&stopped).contains(&"R9.20") && !rules(&plain).contains(&"R9.20"));
    }

    #[test]
    fn a_code_that_shows_an_assumption_is_named_in_its_text() {
        // R9.50
        for assumption in chapters().iter().flat_map(|chapter| &chapter.assumptions) {
            for case in &assumption.when {
                if let When::Reported(code) = case {
                    let number = code.as_str().trim_start_matches("FC");
                    let named = assumption.shows.contains(code.as_str());
                    // `FC910 to FC914`
                    let in_range =
                        assumption
                            .shows
                            .split_once(" to FC")
                            .is_some_and(|(low, high)| {
                                low.rsplit("FC").next().is_some_and(|low| low <= number)
                                    && high.get(..3).is_some_and(|high| number <= high)
                            });
                    assert!(named || in_range, "{}: {code}", assumption.rule);
                }
            }
        }
    }
}
