//! State and messages of the lints.

use super::memory::{LeftAwayNotice, ProgramEffects, SessionStates, SwitchAfterMove};
use crate::comp::{AxisIndex, Compensation, Kind, State};
use crate::diagnostic::Diagnostic;
use crate::interpreter::{BlockMotion, Executed, Outcome, WayCondition};
use crate::machine::Machine;
use crate::readings::{Question, QuestionSet};
use crate::text::Place;

/// A diagnostic at the end of a program, with the executed block that it is about.
#[derive(Debug, Clone, serde::Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct EndNote {
    /// The executed block that it is about.
    pub seq: u64,
    /// The message.
    pub diagnostic: Diagnostic,
}

/// A kind of an axis that a program leaves away from its start-up state.
pub(crate) struct LeftAway {
    pub(crate) axis: AxisIndex,
    pub(crate) kind: Kind,
    /// FC401 or FC407.
    pub(crate) note: EndNote,
}

/// A command that the control accepted.
pub(super) struct Taken<'a> {
    pub(super) axis: AxisIndex,
    pub(super) outcome: &'a Outcome,
    pub(super) executed: &'a Executed<'a>,
}

/// Working memory of the lints while a program runs.
pub(crate) struct Linter<'m> {
    pub(super) machine: &'m Machine,
    pub(super) states: &'m mut SessionStates,
    /// The name of the program after `%`, else its file.
    pub(super) program: String,
    pub(super) memory: ProgramEffects,
    /// The file of the program.
    pub(super) file: String,
    /// Place of the first block.
    pub(super) begin: Option<Place>,
    /// The states of friction compensation that the program found, by axis.
    found: Vec<State>,
    /// Changes of friction compensation on axes that moved just before.
    pub(super) jumps: Vec<SwitchAfterMove>,
    /// The way on which the last block was executed.
    pub(super) branch: Option<Vec<Vec<WayCondition>>>,
}

impl<'m> Linter<'m> {
    /// Creates the lints for a program.
    pub(crate) fn new(machine: &'m Machine, states: &'m mut SessionStates, file: &str) -> Self {
        Self {
            memory: ProgramEffects::new(machine.axes.len()),
            machine,
            states,
            program: file.to_owned(),
            file: file.to_owned(),
            begin: None,
            found: Vec::new(),
            jumps: Vec::new(),
            branch: None,
        }
    }

    /// Records the states with which the program starts.
    pub(crate) fn starts(&mut self, with: &Compensation) {
        let axes = (0..with.len()).map(AxisIndex::new);
        self.found = axes.map(|axis| with.state(axis, Kind::Frict)).collect();
        for axis in (0..with.len()).map(AxisIndex::new) {
            let is_at_start_up = self.found(axis) == self.states.start_up(axis, Kind::Frict);
            self.memory.inherited(axis).is_settled = is_at_start_up;
        }
    }

    /// Returns the messages about motions in states that the program found, which no later motion outweighed (R18.4).
    pub(crate) fn held(&mut self) -> impl Iterator<Item = EndNote> {
        self.memory.held().map(|held| EndNote {
            seq: held.seq,
            diagnostic: held.said,
        })
    }

    /// Returns the state of friction compensation that the program found.
    pub(super) fn found(&self, axis: AxisIndex) -> State {
        let start_up = || self.states.start_up(axis, Kind::Frict);
        self.found.get(axis.get()).copied().unwrap_or_else(start_up)
    }

    /// Sets the name of the program.
    pub(crate) fn named(&mut self, name: &str) {
        name.clone_into(&mut self.program);
    }

    /// Returns whether every axis that a block moves has moved before, so that the block is nothing new, and no check
    /// is waiting for the next motion.
    #[inline]
    pub(crate) fn knows(&self, moves: &BlockMotion) -> bool {
        !self.memory.has_new(moves)
            && self.jumps.is_empty()
            && (moves.also_moved().is_empty() || self.memory.knows_all(moves.also_moved()))
    }

    /// Returns the questions about the start of the control whose answers decide the states in which the program moved
    /// axes (R1.29, R1.40, R15.3).
    pub(crate) fn rests_on(&self) -> QuestionSet {
        let mut questions = QuestionSet::default();
        for (at, of) in self.machine.axes.iter().enumerate() {
            let axis = AxisIndex::new(at);
            let memory = self.memory.axis(axis);
            let unswitched = of.configured.intersection(self.states.unswitched(axis));
            for kind in unswitched.iter() {
                let did = memory.kind(kind);
                let counts = kind == Kind::Frict || of.required.contains(kind) || did.is_commanded;
                if counts && (did.moved_before.is_some() || did.refused) {
                    questions.insert(if of.manual.contains(kind) {
                        Question::ManualActivation
                    } else {
                        Question::Restart
                    });
                }
            }
        }
        questions
    }

    /// Records the outcome of a note of [`end`](Self::end).
    pub(crate) fn settle(&mut self, left: &LeftAway, notice: LeftAwayNotice) {
        self.states.set_notice(left.axis, left.kind, notice);
    }

    pub(super) fn name(&self, axis: AxisIndex) -> &str {
        &self.machine.axis(axis).name
    }
}
