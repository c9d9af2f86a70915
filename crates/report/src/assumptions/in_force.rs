//! The readings of open questions on which results rest (R15.3).

use std::collections::BTreeSet;

use serde::Serialize;

use frictcomp::machine::Machine;
use frictcomp::readings::{Basis, Question, QuestionSet};

/// A reading on which results rest.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[non_exhaustive]
pub struct ReadingInForce {
    #[serde(skip)]
    question: Question,
    /// The rule of the question, `R1.28`.
    pub rule: &'static str,
    /// The name of the reading.
    pub reading: &'static str,
    /// Meaning of the reading.
    pub meaning: &'static str,
    /// `assumed`, `selected` by the configuration, or `confirmed` by a control of this build.
    pub basis: &'static str,
    /// The build of the control that confirmed it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub build: Option<String>,
    /// The date of its answer, as written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
}

/// The readings on which results rest, each once.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
#[serde(transparent)]
pub struct ReadingsInForce(BTreeSet<ReadingInForce>);

impl ReadingsInForce {
    /// Returns the readings of a machine for these questions. A question of which neither reading is
    /// taken decides nothing.
    pub fn of(questions: QuestionSet, machine: &Machine) -> Self {
        let (readings, build) = (&machine.readings, machine.build);
        let decided = questions.iter();
        let decided = decided.filter_map(|it| Some((it, readings.of(it)?)));
        let in_force = decided.map(|(question, reading)| {
            let (basis, confirmed) = match readings.basis(question, build) {
                Basis::Assumed => ("assumed", None),
                Basis::Selected => ("selected", None),
                Basis::Confirmed(it) => ("confirmed", Some(it)),
            };
            ReadingInForce {
                question,
                basis,
                rule: question.facts().rule,
                reading: question.name_of(reading),
                meaning: question.facts().meanings[reading as usize],
                build: confirmed.map(|it| it.build.to_string()),
                date: confirmed.map(|it| it.date.clone()),
            }
        });
        Self(in_force.collect())
    }

    /// Adds those of other results.
    pub fn extend(&mut self, others: Self) {
        self.0.extend(others.0);
    }

    /// Returns whether nothing rests on a reading.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the remark on them, `None` without any.
    pub fn in_words(&self) -> Option<String> {
        let named: Vec<String> = self.0.iter().map(ReadingInForce::in_words).collect();
        if named.is_empty() {
            return None;
        }
        let is_open = self.0.iter().any(|it| it.basis != "confirmed");
        let ask = if is_open {
            " (`frictcomp ask` asks the control)"
        } else {
            ""
        };
        Some(format!("Rests on {}{ask}", named.join("; ")))
    }
}

impl ReadingInForce {
    fn in_words(&self) -> String {
        let basis = match &self.build {
            Some(build) => format!("confirmed on {build}"),
            None if self.basis == "selected" => "selected in frictcomp.toml".to_owned(),
            None => self.basis.to_owned(),
        };
        format!("{}, {basis}: {}", self.rule, self.meaning)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::comp::CncBuild;
    use frictcomp::readings::{Alternative, Confirmation};

    #[test]
    fn each_reading_says_its_basis() {
        // R15.3
        let mut machine = Machine::enabled(["X"]);
        let build = CncBuild::new([3, 1, 3132, 0]);
        machine.build = Some(build);
        machine
            .readings
            .select(Question::OrderInBlock, Alternative::Second);
        let date = "2026-05-01".to_owned();
        let answer = Confirmation { build, date };
        machine.readings.confirm(Question::Reset, answer);
        let mut asked = QuestionSet::default();
        assert_eq!(ReadingsInForce::of(asked, &machine).in_words(), None);
        asked.insert(Question::Reset);
        let words = |asked| ReadingsInForce::of(asked, &machine).in_words();
        let confirmed = "Rests on R1.28, confirmed on V3.1.3132.00: a reset keeps the state";
        assert_eq!(words(asked).as_deref(), Some(confirmed));
        asked.insert(Question::OrderInBlock);
        asked.insert(Question::WithMotion);
        // Neither reading is taken: both are shown.
        asked.insert(Question::BlockSearch);
        let all = "Rests on R1.9, assumed: the motion of a block with COMP is made in the new state; \
                   R1.28, confirmed on V3.1.3132.00: a reset keeps the state; R1.31, selected in \
                   frictcomp.toml: the first of two opposite commands wins (`frictcomp ask` asks the control)";
        assert_eq!(words(asked).as_deref(), Some(all));
        let records = serde_json::to_value(ReadingsInForce::of(asked, &machine)).expect("JSON");
        assert_eq!(records[1]["basis"], "confirmed");
        assert_eq!(records[1]["build"], "V3.1.3132.00");
        assert_eq!(records[0].get("build"), None);
    }
}
