//! The table.

use super::assumption::Assumption;
use super::{
    circle, command, contour, current, drives, identification, language, lists, motion, runs,
    stiction,
};

/// A part of the table.
#[derive(Debug, Clone, Copy)]
pub struct Chapter {
    /// Subject of its assumptions.
    pub title: &'static str,
    /// The assumptions by their rules.
    pub assumptions: &'static [Assumption],
}

/// All assumptions that can change a result.
pub const CHAPTERS: [Chapter; 11] = [
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
        title: "Drives",
        assumptions: drives::ASSUMED,
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
        title: "Stiction compensation",
        assumptions: stiction::ASSUMED,
    },
    Chapter {
        title: "Identification",
        assumptions: identification::ASSUMED,
    },
    Chapter {
        title: "The contour",
        assumptions: contour::ASSUMED,
    },
    Chapter {
        title: "Runs",
        assumptions: runs::ASSUMED,
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assumptions::{Met, When};
    use frictcomp::diagnostic::Code;
    use frictcomp::machine::AxisSet;
    use frictcomp::timeline::EndedBy;

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
