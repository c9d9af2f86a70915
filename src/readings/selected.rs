//! The readings of one machine.

use std::collections::BTreeMap;

use super::question::Alternative;
use super::question::Question;
use crate::comp::CncBuild;

/// Build and date of an answer of a control (R15.2).
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Confirmation {
    /// The build of the control that answered.
    pub build: CncBuild,
    /// The date of the answer, as written.
    pub date: String,
}

/// Basis of a reading (R15.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Basis<'a> {
    /// No control was asked.
    Assumed,
    /// The configuration selects it, without an answer of this build.
    Selected,
    /// A control of this build answered.
    Confirmed(&'a Confirmation),
}

/// Readings of the open questions on a machine.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Readings {
    selected: BTreeMap<Question, Alternative>,
    confirmed: BTreeMap<Question, Confirmation>,
}

impl Readings {
    /// Selects a reading.
    pub fn select(&mut self, question: Question, reading: Alternative) {
        self.selected.insert(question, reading);
    }

    /// Records that a control confirmed the reading in force.
    pub fn confirm(&mut self, question: Question, confirmation: Confirmation) {
        self.confirmed.insert(question, confirmation);
    }

    /// Returns the reading in force; `None` if none is assumed or selected.
    pub fn of(&self, question: Question) -> Option<Alternative> {
        let selected = self.selected.get(&question).copied();
        selected.or(question.facts().assumed)
    }

    /// Whether the second reading of a question is in force.
    pub fn takes_second(&self, question: Question) -> bool {
        self.of(question) == Some(Alternative::Second)
    }

    /// Returns the name of the reading in force, `unknown` if there is none.
    pub fn name(&self, question: Question) -> &'static str {
        self.of(question)
            .map_or("unknown", |reading| question.name_of(reading))
    }

    /// Returns the confirmation of an answer, on any build.
    pub fn confirmation(&self, question: Question) -> Option<&Confirmation> {
        self.confirmed.get(&question)
    }

    /// Returns the basis of the reading in force on a machine of this build. An answer applies only to the build that
    /// gave it (R15.2).
    pub fn basis(&self, question: Question, build: Option<CncBuild>) -> Basis<'_> {
        let confirmed = self.confirmed.get(&question);
        match confirmed.filter(|it| Some(it.build) == build) {
            Some(confirmation) if self.of(question).is_some() => Basis::Confirmed(confirmation),
            _ if self.selected.contains_key(&question) => Basis::Selected,
            _ => Basis::Assumed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R15.1, R15.2: each question is known by its rule, and its readings by their names.
    #[test]
    fn every_question_has_two_readings_under_a_rule_of_its_own() {
        for (at, question) in Question::ALL.into_iter().enumerate() {
            assert_eq!(question as usize, at);
            let facts = question.facts();
            assert_eq!(Question::of_rule(facts.rule), Some(question));
            let [first, second] = facts.readings;
            assert_eq!(question.reading(first), Some(Alternative::First));
            assert_eq!(question.reading(second), Some(Alternative::Second));
        }
    }

    /// R15.2: an answer applies to the build that gave it.
    #[test]
    fn an_answer_of_another_build_confirms_nothing() {
        let [own, other] = [[3, 1, 3081, 5], [3, 1, 3132, 0]].map(CncBuild::new);
        let mut readings = Readings::default();
        let confirmation = Confirmation {
            build: own,
            date: "2026-01-31".to_owned(),
        };
        readings.confirm(Question::Reset, confirmation.clone());
        let standing = |build| readings.basis(Question::Reset, build);
        assert_eq!(standing(Some(own)), Basis::Confirmed(&confirmation));
        assert_eq!(standing(Some(other)), Basis::Assumed);
        assert_eq!(standing(None), Basis::Assumed);
    }
}
