//! What frictcomp assumes where the documents leave something open: the one table, a file a
//! chapter. `docs/assumptions.md` and the part of a report that names what its run depends on are
//! made from it.

mod circle;
mod command;
mod current;
mod language;
mod lists;
mod motion;
mod runs;

use std::collections::BTreeSet;

use crate::diagnostic::Code;
use crate::machine::AxisSet;
use crate::timeline::EndedBy;

/// A part of the table.
#[derive(Debug, Clone, Copy)]
pub struct Chapter {
    /// What its assumptions are about.
    pub title: &'static str,
    /// The assumptions by their rules.
    pub assumptions: &'static [Assumption],
}

/// What is assumed at one point. The texts name codes and words of programs in backquotes.
#[derive(Debug, Clone, Copy)]
pub struct Assumption {
    /// The rule, section or contradiction of `docs/rules.md` that it belongs to.
    pub rule: &'static str,
    /// The assumption.
    pub sentence: &'static str,
    /// What it changes.
    pub changes: &'static str,
    /// How a user sees that it was assumed.
    pub shows: &'static str,
    /// When a session depends on it: in each of these cases, or in none that its records tell.
    pub when: &'static [When],
}

/// A case in which a session depends on an assumption.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// All assumptions that can change a result.
pub const CHAPTERS: [Chapter; 7] = [
    Chapter {
        title: "The COMP command",
        assumptions: command::ASSUMED,
    },
    Chapter {
        title: "The NC language",
        assumptions: language::ASSUMED,
    },
    Chapter {
        title: "Lists",
        assumptions: lists::ASSUMED,
    },
    Chapter {
        title: "The additive current",
        assumptions: current::ASSUMED,
    },
    Chapter {
        title: "Motion",
        assumptions: motion::ASSUMED,
    },
    Chapter {
        title: "The circular test",
        assumptions: circle::ASSUMED,
    },
    Chapter {
        title: "Runs",
        assumptions: runs::ASSUMED,
    },
];

/// What the records of a session tell about the assumptions that it depends on.
#[derive(Debug, Clone)]
pub(super) struct Met {
    /// The codes of its messages.
    pub(super) reported: BTreeSet<Code>,
    /// Which axes there are.
    pub(super) axis_set: AxisSet,
    /// How many words and commands were passed over.
    pub(super) passed_over: u64,
    /// How its last program ended.
    pub(super) ended: Option<EndedBy>,
}

impl Assumption {
    /// Whether a session is known to depend on it.
    pub(super) fn is_met(&self, met: &Met) -> bool {
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

    fn met(reported: &[Code]) -> Met {
        Met {
            reported: reported.iter().copied().collect(),
            axis_set: AxisSet::Configured,
            passed_over: 0,
            ended: Some(EndedBy::M30),
        }
    }

    fn rules(met: &Met) -> Vec<&'static str> {
        let all = CHAPTERS.iter().flat_map(|chapter| chapter.assumptions);
        let used = all.filter(|assumption| assumption.is_met(met));
        used.map(|assumption| assumption.rule).collect()
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
        let undescribed = Met {
            axis_set: AxisSet::AsTheyOccur,
            ..met(&[])
        };
        assert!(rules(&undescribed).contains(&"R1.37"));
        let passed = Met {
            passed_over: 1,
            ..met(&[])
        };
        assert!(rules(&passed).contains(&"R2.47"));
        let stopped = Met {
            ended: Some(EndedBy::Error),
            ..met(&[])
        };
        assert!(rules(&stopped).contains(&"R9.20") && !rules(&plain).contains(&"R9.20"));
    }

    #[test]
    fn a_code_that_shows_an_assumption_is_named_in_its_text() {
        // R9.50
        for assumption in CHAPTERS.iter().flat_map(|chapter| chapter.assumptions) {
            for case in assumption.when {
                if let When::Reported(code) = case {
                    let number = code.text().trim_start_matches("FC");
                    let named = assumption.shows.contains(code.text());
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
