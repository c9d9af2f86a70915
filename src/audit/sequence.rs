//! The effect of programs that run in a given order (R10.6).

use std::ops::ControlFlow;

use serde::Serialize;

use super::effect::{FirstMotion, Site, WhyUnknown};
use super::observation::{Observation, SelectionOrigin};
use super::program::Auditor;
use super::scope::Selected;
use crate::comp::Kind;
use crate::interpreter::{EndedBy, Event, Interpreter, Observer, PossibleStates};
use crate::readings::{Question, QuestionSet};
use crate::timeline::ReadingsInForce;

/// Programs that run in a given order on one machine.
pub struct Sequence<'a> {
    auditor: &'a Auditor,
    interpreter: Interpreter,
    /// The program that left each subject as it is, if that is not its start-up state.
    left_by: Vec<Option<String>>,
    /// Whether a program switched each subject though nothing describes its axis (R18.2).
    lost: Vec<bool>,
    /// The open questions whose readings decided something so far.
    rests_on: QuestionSet,
}

/// Effect of one program of the order.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Step {
    /// The file, as the order names it.
    pub file: String,
    /// Reason for a stop before its end; the next program starts with the states at that stop.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<WhyUnknown>,
    /// Effects on each axis and kind.
    #[serde(skip)]
    pub axes: Vec<StepAxis>,
    /// The readings on which the states after it rest (R15.3).
    #[serde(skip_serializing_if = "ReadingsInForce::is_empty")]
    pub rests_on: ReadingsInForce,
}

/// Effect on an axis.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct StepAxis {
    /// Name of the axis.
    #[serde(skip)]
    pub axis: String,
    /// Kind of compensation.
    #[serde(skip)]
    pub kind: Kind,
    /// The selection at its start: `on`, `off` or `unknown`.
    pub start: Selected,
    /// The selection at its end.
    pub end: Selected,
    /// The possible states at its end, each with the ways to it, if ways differ.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub possible: Option<PossibleStates>,
    /// Whether it is selected at the start of the control.
    #[serde(skip)]
    pub start_up: Selected,
    /// The last command that made it what it is at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<Site>,
    /// The first motion of the axis away from its start-up state.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub away: Option<FirstMotion>,
    /// The program that left it so, if the motion comes before any command of this program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_by: Option<String>,
}

impl<'a> Sequence<'a> {
    /// Starts a sequence right after the start of the control.
    pub fn new(auditor: &'a Auditor) -> Self {
        let scope = auditor.scope();
        Self {
            interpreter: auditor.interpreter(scope.start_up().clone()),
            left_by: vec![None; scope.subjects().len()],
            lost: vec![false; scope.subjects().len()],
            rests_on: QuestionSet::default(),
            auditor,
        }
    }

    /// Runs the next program. One stopped by an error leaves the states reached so far; a reset
    /// does not change them (R1.28).
    ///
    /// # Errors
    /// Those of `run`.
    pub fn step<E>(
        &mut self,
        file: &str,
        mut run: impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<Step, E> {
        let scope = self.auditor.scope();
        let start = self.interpreter.compensation().clone();
        let mut observation = Observation::new(scope);
        run(&mut self.interpreter, &mut |event: Event<'_>| {
            observation.event(scope, &event);
            ControlFlow::Continue(())
        })?;
        let mut axes = Vec::with_capacity(scope.subjects().len());
        for (at, subject) in scope.subjects().iter().enumerate() {
            let observed = &observation.observed[at];
            let start_up = Selected::of(scope.start_up(), *subject);
            let is_described = scope.is_described(at);
            self.lost[at] |= observed.commanded && !is_described;
            if !is_described && !self.lost[at] {
                continue;
            }
            let is_lost = self.lost[at];
            let known = |selected| if is_lost { Selected::Unknown } else { selected };
            let begin = known(Selected::of(&start, *subject));
            let end = known(observation.left[at]);
            let inherits = observed.inherited.as_ref().map(|moved| moved.seq);
            let away = observed.astray.as_ref();
            let is_found = away.is_some_and(|away| Some(away.seq) == inherits);
            axes.push(StepAxis {
                axis: self.auditor.name(*subject).to_owned(),
                kind: subject.kind,
                start: begin,
                end,
                possible: observation.possible[at].clone(),
                start_up,
                by: match &observed.last {
                    Some(SelectionOrigin::Command(site)) => Some(site.clone()),
                    _ => None,
                },
                away: away.map(|moved| moved.motion.clone()),
                left_by: self.left_by[at].clone().filter(|_| is_found),
            });
            if end == start_up {
                self.left_by[at] = None;
            } else if observed.last.is_some() || begin != end {
                self.left_by[at] = Some(file.to_owned());
            }
        }
        let has_failed = matches!(observation.by, Some(EndedBy::Error | EndedBy::Budget));
        self.rests_on = self.rests_on.union(self.interpreter.rests_on());
        if has_failed && self.left_by.iter().any(Option::is_some) {
            self.rests_on.insert(Question::Reset);
        }
        Ok(Step {
            file: file.to_owned(),
            rests_on: self.auditor.readings(self.rests_on),
            stopped: observation.stopped.filter(|_| has_failed),
            axes,
        })
    }
}
