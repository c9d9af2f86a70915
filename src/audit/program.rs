//! A program as a function from the states that it finds to the states that it leaves (R10.1).

use std::ops::ControlFlow;
use std::sync::Arc;

use serde::Serialize;

use super::effect::{Inherits, ProgramEffect, Site, WhyUnknown};
use super::observation::{AuditedKind, Deed, Observation, Observed, Scope, Selected};
use crate::comp::{Compensation, Kind, KindSet};
use crate::diagnostic::Code;
use crate::interpreter::{EndedBy, Event, Interpreter, Observer, Options, StopPolicy};
use crate::machine::{Machine, Setting};

/// Where a program ends, for a block that has to stand before the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum Ending {
    /// At M30 or M02 of a line of the main program.
    At(u32),
    /// Elsewhere: where the file ends, or in a program that it calls.
    Elsewhere,
}

/// What a program does to one kind of compensation of one axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AxisAudit {
    /// The axis.
    #[serde(skip)]
    pub axis: String,
    /// The kind.
    #[serde(skip)]
    pub kind: Kind,
    /// Whether it is selected at the start of the control.
    #[serde(skip)]
    pub on_at_start_up: bool,
    /// What it makes of the selection.
    pub effect: ProgramEffect,
    /// The last command that made it so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<Site>,
    /// Why the effect is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<WhyUnknown>,
    /// Whether the program moves the axis before any command of its own.
    pub inherits: Inherits,
}

impl AxisAudit {
    /// Whether the program leaves the axis away from its start-up state, whatever it found.
    pub fn leaves_away(&self) -> bool {
        match self.effect {
            ProgramEffect::LeavesOn => !self.on_at_start_up,
            ProgramEffect::LeavesOff => self.on_at_start_up,
            ProgramEffect::Keeps | ProgramEffect::Unknown => false,
        }
    }

    /// Whether it moves the axis in the state that it finds.
    pub fn is_inheritor(&self) -> bool {
        self.inherits.motion().is_some()
    }

    /// Whether anything about it is not known offline.
    pub fn is_unknown(&self) -> bool {
        self.effect == ProgramEffect::Unknown || self.inherits == Inherits::Unknown
    }

    /// Whether its effect is unknown because of what only the machine knows, or the state that the
    /// program finds; not because something stopped it.
    pub fn depends_on_the_machine(&self) -> bool {
        let code = self.reason.as_ref().and_then(|reason| reason.code);
        self.effect == ProgramEffect::Unknown
            && matches!(code, None | Some(Code::Fc901 | Code::Fc902))
    }

    /// The command that brings the axis back to its start-up state.
    pub fn way_home(&self) -> String {
        let way = if self.on_at_start_up { "ON" } else { "OFF" };
        format!("{}[COMP {way} {}]", self.axis, self.kind.as_str())
    }
}

/// What a program does, found by two runs.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ProgramAudit {
    /// The file, as the user named it.
    pub file: String,
    /// What it does to each configured axis and kind, in the order of the machine's axes.
    pub axes: Vec<AxisAudit>,
    /// Where it ends, when it starts with every axis in its start-up state.
    pub ending: Ending,
}

/// Audits the programs of one machine.
#[derive(Debug, Clone)]
pub struct Auditor {
    machine: Arc<Machine>,
    options: Options,
    settings: Vec<(String, Setting)>,
    scope: Scope,
}

impl Auditor {
    /// An auditor for some kinds of compensation on a machine. `settings` are the values of variables
    /// that only the machine knows. An error of the control stops a program, whatever `options` say.
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
        }
    }

    /// What is looked at.
    pub fn scope(&self) -> &Scope {
        &self.scope
    }

    /// The name of an axis.
    pub fn name(&self, subject: AuditedKind) -> &str {
        &self.machine.axis(subject.axis).name
    }

    /// An interpreter that starts with a state.
    pub(super) fn interpreter(&self, from: Compensation) -> Interpreter {
        let mut interpreter = Interpreter::new(Arc::clone(&self.machine), from, self.options);
        for (name, setting) in &self.settings {
            interpreter.set(name, setting);
        }
        interpreter
    }

    /// Runs a program twice, with every axis in its start-up state and with every axis away from it. `run` runs it on an interpreter: the host knows
    /// where its text comes from and where called programs are.
    ///
    /// # Errors
    /// Those of `run`.
    pub fn audit<E>(
        &self,
        file: &str,
        mut run: impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<ProgramAudit, E> {
        let runs = self.observe(&mut run)?;
        Ok(ProgramAudit {
            file: file.to_owned(),
            axes: runs.audit(self),
            ending: runs.start_up.end.map_or(Ending::Elsewhere, Ending::At),
        })
    }

    pub(super) fn observe<E>(
        &self,
        run: &mut impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<BothRuns, E> {
        Ok(BothRuns {
            start_up: self.observe_from(self.scope.start_up().clone(), run)?,
            away: self.observe_from(self.scope.away(), run)?,
        })
    }

    fn observe_from<E>(
        &self,
        from: Compensation,
        run: &mut impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<Observation, E> {
        let mut interpreter = self.interpreter(from);
        let mut observation = Observation::new(&self.scope);
        run(&mut interpreter, &mut |event: Event<'_>| {
            observation.event(&self.scope, event);
            ControlFlow::Continue(())
        })?;
        Ok(observation)
    }
}

/// A program that starts in its start-up state, and the same that starts away from it.
#[derive(Debug, Clone)]
pub(super) struct BothRuns {
    pub(super) start_up: Observation,
    pub(super) away: Observation,
}

impl BothRuns {
    pub(super) fn audit(&self, auditor: &Auditor) -> Vec<AxisAudit> {
        let subjects = auditor.scope.subjects().iter().enumerate();
        let audits = subjects.map(|(at, subject)| {
            let effect = self.effect(&auditor.scope, at);
            let (by, reason) = match effect {
                ProgramEffect::Keeps => (None, None),
                ProgramEffect::Unknown => (None, Some(self.reason(at))),
                ProgramEffect::LeavesOn | ProgramEffect::LeavesOff => (self.command(at), None),
            };
            AxisAudit {
                axis: auditor.name(*subject).to_owned(),
                kind: subject.kind,
                on_at_start_up: auditor.scope.is_on_at_start_up(*subject),
                effect,
                by,
                reason,
                inherits: self.inherits(at),
            }
        });
        audits.collect()
    }

    fn stopped(&self) -> Option<&Observation> {
        let has_failed = |run: &&Observation| {
            !matches!(
                run.by,
                Some(EndedBy::M30 | EndedBy::M02 | EndedBy::EndOfFile)
            )
        };
        [&self.start_up, &self.away].into_iter().find(has_failed)
    }

    fn effect(&self, scope: &Scope, at: usize) -> ProgramEffect {
        if self.stopped().is_some() {
            return ProgramEffect::Unknown;
        }
        let is_on = scope.is_on_at_start_up(scope.subjects()[at]);
        let (on, off) = if is_on {
            (Selected::On, Selected::Off)
        } else {
            (Selected::Off, Selected::On)
        };
        match (self.start_up.left[at], self.away.left[at]) {
            (start_up, away) if start_up == on && away == off => ProgramEffect::Keeps,
            (Selected::On, Selected::On) => ProgramEffect::LeavesOn,
            (Selected::Off, Selected::Off) => ProgramEffect::LeavesOff,
            _ => ProgramEffect::Unknown,
        }
    }

    fn reason(&self, at: usize) -> WhyUnknown {
        if let Some(run) = self.stopped() {
            return run.stopped.clone().unwrap_or_else(|| WhyUnknown {
                code: None,
                message: "the program was stopped".to_owned(),
                site: None,
            });
        }
        let lasts = [&self.start_up, &self.away].map(|run| run.observed[at].last.as_ref());
        let doubt = lasts.into_iter().flatten().find_map(|last| match last {
            Deed::Doubt(reason) => Some(reason.clone()),
            Deed::Command(_) => None,
        });
        doubt.unwrap_or_else(|| WhyUnknown {
            code: None,
            message: "it depends on the state that the program finds".to_owned(),
            site: self.command(at),
        })
    }

    /// The last command on a subject.
    fn command(&self, at: usize) -> Option<Site> {
        let lasts = [&self.start_up, &self.away].map(|run| run.observed[at].last.as_ref());
        lasts.into_iter().flatten().find_map(|last| match last {
            Deed::Command(site) => Some(site.clone()),
            Deed::Doubt(_) => None,
        })
    }

    fn inherits(&self, at: usize) -> Inherits {
        let (start_up, away) = (&self.start_up.observed[at], &self.away.observed[at]);
        let first = |observed: &Observed| observed.inherited.as_ref().map(|it| it.motion.clone());
        if let Some(motion) = first(start_up).or_else(|| first(away)) {
            return Inherits::Motion(motion);
        }
        // A command came first, and yet the state depends on what was found: a way that may have
        // passed the command over.
        let seq = |observed: &Observed| observed.doubtful.as_ref().map(|it| it.seq);
        if let Some(moved) = away.doubtful.as_ref()
            && seq(start_up).is_none_or(|seq| seq > moved.seq)
        {
            let mut motion = moved.motion.clone();
            motion.perhaps = true;
            return Inherits::Motion(motion);
        }
        match self.stopped() {
            Some(run) if !run.observed[at].commanded => Inherits::Unknown,
            _ => Inherits::No,
        }
    }
}
