//! A program as a function from the states that it finds to the states that it leaves (R10.1).

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::Serialize;

use super::cure::Cure;
use super::effect::{Inherits, ProgramEffect, Site, WhyUnknown};
use super::observation::Observation;
use super::runs::{ProgramRuns, RunStart};
use super::scope::{AuditedKind, Scope};
use crate::comp::{Compensation, Kind, KindSet, State};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::{
    Event, FoundVariables, Interpreter, Observer, Options, PossibleStates, StopPolicy, VariableUse,
    WayCondition,
};
use crate::machine::{Machine, Setting};
use crate::readings::QuestionSet;
use crate::timeline::ReadingsInForce;

/// The end of a program, before which a mending block goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum Ending {
    /// At M30 or M02 of a line of the main program.
    At(u32),
    /// Elsewhere: where the file ends, or in a program that it calls.
    Elsewhere,
}

/// Effect of a program on one kind of compensation of one axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AxisAudit {
    /// Name of the axis.
    #[serde(skip)]
    pub axis: String,
    /// Kind of compensation.
    #[serde(skip)]
    pub kind: Kind,
    /// Whether it is selected at the start of the control.
    #[serde(skip)]
    pub on_at_start_up: bool,
    /// Whether anything says if the axis is configured for it; if nothing does, it may be (R18.2).
    #[serde(skip)]
    pub is_described: bool,
    /// Whether a command of the program is about it.
    #[serde(skip)]
    pub is_commanded: bool,
    /// Effect on the selection.
    pub effect: ProgramEffect,
    /// The last command that made it so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<Site>,
    /// The possible final states of an axis found in its start-up state, each with the ways to it, if the program may
    /// leave the axis away from that state (R14.6).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub possible: Option<PossibleStates>,
    /// The reason for which the effect is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<WhyUnknown>,
    /// Whether the program moves the axis before any of its own commands.
    pub inherits: Inherits,
}

impl AxisAudit {
    /// Whether the program leaves the axis away from its start-up state, on all or some ways.
    pub fn leaves_away(&self) -> bool {
        match self.effect {
            ProgramEffect::LeavesOn => !self.on_at_start_up,
            ProgramEffect::LeavesOff => self.on_at_start_up,
            ProgramEffect::Depends => self.possible.is_some(),
            ProgramEffect::Keeps | ProgramEffect::Unknown => false,
        }
    }

    /// Returns the ways on which it leaves the axis away from its start-up state, in words as seen from a file: `if
    /// skip level 1 is on`; `None` if it does so on all of them.
    pub fn leaves_away_when(&self, file: &str) -> Option<String> {
        let possible = self.possible.as_ref()?;
        let is_away = |state: State| (state == State::Inactive) == self.on_at_start_up;
        possible.when(is_away, file)
    }

    /// Whether it moves the axis in the state that it finds.
    pub fn is_inheritor(&self) -> bool {
        let motion = self.inherits.motion();
        motion.is_some_and(|motion| !motion.perhaps)
    }

    /// Whether it may move the axis in the state that it finds.
    pub fn may_inherit(&self) -> bool {
        let motion = self.inherits.motion();
        motion.is_some_and(|motion| motion.perhaps)
    }

    /// Returns the origin of the mending: the command that leaves the selection away from its start-up state, the
    /// block that makes it unknown, or the motion in the inherited state.
    pub fn cause(&self, cure: Cure) -> Option<&Site> {
        let doubt = || self.reason.as_ref().and_then(|reason| reason.site.as_ref());
        match cure {
            Cure::Inheritors => self.inherits.motion().map(|motion| &motion.site),
            Cure::Leavers | Cure::None => self.by.as_ref().or_else(doubt),
        }
    }

    /// Whether anything about it is not known offline.
    pub fn is_unknown(&self) -> bool {
        self.effect == ProgramEffect::Unknown || self.inherits == Inherits::Unknown
    }

    /// Whether its effect is unknown because it depends on values that only the machine knows or on the state that the
    /// program finds, not because something stopped the program.
    pub fn depends_on_the_machine(&self) -> bool {
        let code = self.reason.as_ref().and_then(|reason| reason.code);
        self.effect == ProgramEffect::Unknown
            && matches!(code, None | Some(Code::Fc901 | Code::Fc902 | Code::Fc908))
    }

    /// Returns the command that brings the axis back to its start-up state.
    pub fn way_home(&self) -> String {
        let way = if self.on_at_start_up { "ON" } else { "OFF" };
        format!("{}[COMP {way} {}]", self.axis, self.kind.as_str())
    }
}

/// Effects of a program, found by its runs.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ProgramAudit {
    /// The file, as the user named it.
    pub file: String,
    /// Effects on each configured axis and kind, in the order of the machine's axes.
    pub axes: Vec<AxisAudit>,
    /// The end of the run that starts with every axis in its start-up state.
    pub ending: Ending,
    /// Messages about the file as a whole: it has no block, or is no program (R18.6).
    pub about_file: Vec<Diagnostic>,
    /// The files of other programs whose blocks it executes, by their names.
    pub called: BTreeSet<Arc<str>>,
    /// The open questions whose readings decided something in its runs (R15.3).
    pub rests_on: QuestionSet,
    /// Use of variables that outlive programs, by its runs.
    pub(super) used: VariableUse,
    /// The values that the runs found in those variables.
    pub(super) found: Arc<FoundVariables>,
}

/// Audits the programs of one machine.
#[derive(Debug, Clone)]
pub struct Auditor {
    machine: Arc<Machine>,
    options: Options,
    settings: Vec<(String, Setting)>,
    scope: Scope,
    found: Arc<FoundVariables>,
}

impl Auditor {
    /// Creates an auditor for some kinds of compensation on a machine. `settings` are the values of variables that only
    /// the machine knows. An error of the control stops a program, whatever `options` say.
    pub fn new(
        machine: Machine,
        options: Options,
        settings: &[(String, Setting)],
        kinds: KindSet,
    ) -> Self {
        Self {
            scope: Scope::new(&machine, kinds),
            machine: Arc::new(machine),
            options: options.with_stop(StopPolicy::FirstError),
            settings: settings.to_vec(),
            found: Arc::default(),
        }
    }

    /// Sets the values that programs find in variables that outlive programs,
    /// [`Archive::found`](super::Archive::found); by default none.
    pub fn find(&mut self, found: FoundVariables) {
        self.found = Arc::new(found);
    }

    /// Returns the audited axes and kinds.
    pub fn scope(&self) -> &Scope {
        &self.scope
    }

    /// Returns the name of an axis.
    pub fn name(&self, subject: AuditedKind) -> &str {
        &self.machine.axis(subject.axis).name
    }

    /// Returns the machine's readings of some questions.
    pub(super) fn readings(&self, questions: QuestionSet) -> ReadingsInForce {
        ReadingsInForce::of(questions, &self.machine)
    }

    /// Returns an interpreter that starts with a state.
    pub(super) fn interpreter(&self, from: Compensation) -> Interpreter {
        let mut interpreter = Interpreter::new(Arc::clone(&self.machine), from, self.options);
        for (name, setting) in &self.settings {
            interpreter.set(name, setting);
        }
        interpreter
    }

    /// Runs a program twice, with every axis in its start-up state and with every axis away from it. `run` runs it on
    /// an interpreter: the host knows where its text comes from and where called programs are.
    ///
    /// # Errors
    /// Those of `run`.
    pub fn audit<E>(
        &self,
        file: &str,
        mut run: impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<ProgramAudit, E> {
        let runs = self.observe(None, &mut run)?;
        Ok(ProgramAudit {
            file: file.to_owned(),
            axes: self.axes(&runs),
            ending: match runs.start_up.end {
                Some(line) if runs.start_up.ends.len() == 1 => Ending::At(line),
                _ => Ending::Elsewhere,
            },
            about_file: runs.start_up.about_file.clone(),
            called: runs.called(),
            rests_on: runs.rests_on(),
            used: runs.used(),
            found: Arc::clone(&self.found),
        })
    }

    /// Runs a program and also observes a file that it calls.
    pub(super) fn observe<E>(
        &self,
        called: Option<&Arc<str>>,
        run: &mut impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<ProgramRuns, E> {
        let mut runs = ProgramRuns {
            start_up: self.observe_from((&RunStart::new(false), called), run)?,
            away: self.observe_from((&RunStart::new(true), called), run)?,
            between: BTreeMap::new(),
        };
        loop {
            let missing = runs.missing(&self.scope);
            if missing.is_empty() {
                return Ok(runs);
            }
            for start in missing {
                let observation = self.observe_from((&start, called), run)?;
                runs.between.insert(start, observation);
            }
        }
    }

    fn observe_from<E>(
        &self,
        (start, called): (&RunStart, Option<&Arc<str>>),
        run: &mut impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<Observation, E> {
        let from = self.scope.found(|at| start.is_away(at));
        let mut interpreter = self.interpreter(from);
        interpreter.find(&self.found);
        let mut observation = Observation::new(&self.scope).within(called);
        run(&mut interpreter, &mut |event: Event<'_>| {
            observation.event(&self.scope, &event);
            ControlFlow::Continue(())
        })?;
        observation.rests_on = interpreter.rests_on();
        observation.use_ends(interpreter.take_use());
        Ok(observation)
    }

    /// Returns the effect that the runs show, subject by subject.
    pub(super) fn axes(&self, runs: &ProgramRuns) -> Vec<AxisAudit> {
        let subjects = self.scope.subjects().iter().enumerate();
        let name = |at: usize| {
            let AuditedKind { axis, kind } = self.scope.subjects()[at];
            format!("`{}` of axis `{}`", kind, self.machine.axis(axis).name)
        };
        let found = |at: usize, is_away: bool| WayCondition::Found {
            axis: self.name(self.scope.subjects()[at]).to_owned(),
            compensation: self.scope.subjects()[at].kind,
            state: self.scope.state(at, is_away),
        };
        let audits = subjects.map(|(at, subject)| {
            let effect = runs.effect(&self.scope, at);
            let (by, reason) = match effect {
                ProgramEffect::Keeps => (None, None),
                ProgramEffect::Unknown => (None, Some(runs.reason(at, &name))),
                ProgramEffect::LeavesOn | ProgramEffect::LeavesOff | ProgramEffect::Depends => {
                    (runs.command(at), None)
                }
            };
            AxisAudit {
                axis: self.name(*subject).to_owned(),
                kind: subject.kind,
                on_at_start_up: self.scope.is_on_at_start_up(*subject)
                    || !self.scope.is_described(at),
                is_described: self.scope.is_described(at),
                is_commanded: runs.is_commanded(at),
                effect,
                by,
                possible: (effect == ProgramEffect::Depends)
                    .then(|| runs.possible(&self.scope, at, &found))
                    .flatten(),
                reason,
                inherits: runs.inherits(at),
            }
        });
        audits.collect()
    }
}
