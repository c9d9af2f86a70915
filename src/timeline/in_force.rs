//! The readings of open questions on which results rest (R15.3).

use std::collections::BTreeSet;

use serde::Serialize;

use crate::machine::Machine;
use crate::readings::{Basis, Question, QuestionSet};

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
    /// Returns the readings of a machine for these questions. A question without a reading in force decides nothing.
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

    /// Returns the readings in the order of their questions.
    pub fn iter(&self) -> impl Iterator<Item = &ReadingInForce> {
        self.0.iter()
    }
}
