//! The questions that the documents leave open: their names, their two readings, sets of them, and the readings of one
//! machine.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::facts::{FACTS, QuestionFacts};
use crate::comp::CncBuild;

/// A question that the documents leave open (R15.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Question {
    /// Effect of a keyword in lower case.
    LowerCase,
    /// Order of a command and the motion of its block.
    WithMotion,
    /// Report of a refusal by a syntax check.
    SyntaxCheck,
    /// Refusal to switch off an axis that is not configured.
    OffUnconfigured,
    /// Refusal to switch on without a value list.
    OnWithoutList,
    /// State after a reset.
    Reset,
    /// State after a restart.
    Restart,
    /// Precedence of two opposite commands in a block.
    OrderInBlock,
    /// Monitoring of a required compensation while homing.
    Homing,
    /// State of a kind with manual activation at the start of the control.
    ManualActivation,
    /// Stop of the path by a command.
    LookAhead,
    /// Effect of `$CONTINUE` in a `$SWITCH` outside a loop.
    ContinueInSwitch,
    /// State of an axis after an axis exchange.
    AxisExchange,
    /// Moment at which a skip level is read.
    SkipLevel,
    /// State after a write to the machine data.
    MachineData,
    /// Execution of commands in a block search.
    BlockSearch,
    /// End of the program by `#ERROR` without a remedy class.
    RemedyClass,
    /// Whole number that a variable of an integer type keeps of a fraction.
    WholeNumber,
    /// Acceptance of variables that no `#VAR` declares.
    Undeclared,
    /// Refusal of a jump into a loop or a `$SWITCH`.
    JumpInto,
    /// Refusal of two implicit calls in a block.
    TwoCalls,
    /// Refusal of COMP within the description of a contour or stroke.
    Described,
    /// Refusal to read a `V.E.` variable where the channel must not be flushed.
    ReadFlushes,
    /// Equality of numbers that differ by the rounding of a computation.
    NearlyEqual,
    /// Refusal of the program number `O1234`.
    ProgramNumber,
    /// Decay of the current before a reversal.
    Decay,
    /// Starts after which the current builds up.
    Start,
    /// Quantity that `delay_cycles` postpones.
    Delay,
    /// Current at standstill.
    Standstill,
    /// Current below the first point.
    Below,
}

impl Question {
    /// Every question, in the order of the rules.
    pub const ALL: [Self; 30] = [
        Self::LowerCase,
        Self::WithMotion,
        Self::SyntaxCheck,
        Self::OffUnconfigured,
        Self::OnWithoutList,
        Self::Reset,
        Self::Restart,
        Self::OrderInBlock,
        Self::Homing,
        Self::ManualActivation,
        Self::LookAhead,
        Self::ContinueInSwitch,
        Self::AxisExchange,
        Self::SkipLevel,
        Self::MachineData,
        Self::BlockSearch,
        Self::RemedyClass,
        Self::WholeNumber,
        Self::Undeclared,
        Self::JumpInto,
        Self::TwoCalls,
        Self::Described,
        Self::ReadFlushes,
        Self::NearlyEqual,
        Self::ProgramNumber,
        Self::Decay,
        Self::Start,
        Self::Delay,
        Self::Standstill,
        Self::Below,
    ];

    /// Returns the facts about the question.
    pub fn facts(self) -> &'static QuestionFacts {
        &FACTS[self as usize]
    }

    /// Returns the question of a rule, `R1.28`.
    pub fn of_rule(rule: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|question| question.facts().rule == rule)
    }

    /// Returns the reading of this name.
    pub fn reading(self, name: &str) -> Option<Alternative> {
        let mut both = [Alternative::First, Alternative::Second].into_iter();
        both.find(|reading| self.name_of(*reading) == name)
    }

    /// Returns the name of a reading.
    pub fn name_of(self, reading: Alternative) -> &'static str {
        self.facts().readings[reading as usize]
    }
}

/// One of the two readings of a question, in the order of [`QuestionFacts::readings`](super::QuestionFacts::readings).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Alternative {
    /// The first reading.
    First,
    /// The second reading.
    Second,
}

/// A set of questions, such as those on whose answers a result rests (R15.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct QuestionSet(u32);

impl QuestionSet {
    /// Adds a question.
    pub fn insert(&mut self, question: Question) {
        self.0 |= 1 << question as u32;
    }

    /// Returns whether a question is in the set.
    pub fn contains(self, question: Question) -> bool {
        self.0 & 1 << question as u32 != 0
    }

    /// Returns the questions of either set.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the questions, in the order of their rules.
    pub fn iter(self) -> impl Iterator<Item = Question> {
        Question::ALL
            .into_iter()
            .filter(move |it| self.contains(*it))
    }
}

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
    /// Assumption: no control was asked.
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

    /// Returns whether the second reading of a question is in force.
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
