//! A program as a function from the states that it finds to the states that it leaves (R10.1).

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::Serialize;

use super::effect::{AuditedKind, Inherits, ProgramEffect, Scope, Site, WhyUnknown};
use super::mending::Cure;
use super::observation::{FoundSide, Observation};
use super::runs::{ProgramRuns, RunStart};
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
    /// M30 or M02 in a line of the main program.
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
    /// Whether compensation is selected at the start of the control.
    #[serde(skip)]
    pub on_at_start_up: bool,
    /// Whether a source describes the compensation of the axis; without one, the axis may be configured for it (R18.2).
    #[serde(skip)]
    pub is_described: bool,
    /// Whether a command of the program switches it.
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
    /// Inheritance of the state by a motion before any command of the program.
    pub inherits: Inherits,
}

impl AxisAudit {
    /// Returns whether the program leaves the axis away from its start-up state, on all or some ways.
    pub fn leaves_away(&self) -> bool {
        match self.effect {
            ProgramEffect::LeavesOn => !self.on_at_start_up,
            ProgramEffect::LeavesOff => self.on_at_start_up,
            ProgramEffect::Depends => self.possible.is_some(),
            ProgramEffect::Keeps | ProgramEffect::Unknown => false,
        }
    }

    /// Takes what an earlier run showed it to leave away from the start-up state, if that is not known any more.
    pub(super) fn still_leaves(&mut self, earlier: &Self) {
        if self.effect == ProgramEffect::Unknown && earlier.leaves_away() {
            *self = Self {
                inherits: self.inherits.clone(),
                ..earlier.clone()
            };
        }
    }

    /// Returns the ways on which it leaves the axis away from its start-up state, in words as seen from a file:
    /// `if skip level 1 is on`; `None` if it does so on all of them.
    pub fn leaves_away_when(&self, file: &str) -> Option<String> {
        let possible = self.possible.as_ref()?;
        let is_away = |state: State| (state == State::Inactive) == self.on_at_start_up;
        possible.when(is_away, file)
    }

    /// Returns whether it moves the axis in the state that it finds.
    pub fn is_inheritor(&self) -> bool {
        let motion = self.inherits.motion();
        motion.is_some_and(|motion| !motion.perhaps)
    }

    /// Returns whether it may move the axis in the state that it finds.
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

    /// Returns whether anything about it is not known offline.
    pub fn is_unknown(&self) -> bool {
        self.effect == ProgramEffect::Unknown || self.inherits == Inherits::Unknown
    }

    /// Returns whether its effect is unknown because it depends on values that only the machine knows or on the state
    /// that the program finds, not because something stopped the program.
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

    /// Runs a program with every axis found in its start-up state or away from it, once where that is enough (R10.1).
    /// `run` runs it on an interpreter: the host knows where its text comes from and where called programs are.
    ///
    /// # Errors
    /// The errors of `run`.
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
        if let Some([start_up, away]) = self.observe_sides(called, run)? {
            return Ok(ProgramRuns {
                start_up,
                away,
                between: BTreeMap::new(),
            });
        }
        self.observe_each(called, run)
    }

    /// Runs a program once with the states that it finds open. Returns what it does from the start-up states and from
    /// those away from them; `None` where it depends on them.
    fn observe_sides<E>(
        &self,
        called: Option<&Arc<str>>,
        run: &mut impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<Option<[Observation; 2]>, E> {
        let mut axes = self.machine.axes.iter();
        if axes.any(|axis| !axis.monitored().is_empty()) {
            return Ok(None);
        }
        let mut interpreter = self.interpreter(self.scope.start_up().clone());
        let configured = self.scope.start_up();
        let subjects = self.scope.subjects().iter();
        let conditions: Vec<Option<u32>> = subjects
            .map(|&AuditedKind { axis, kind }| {
                let is_open = configured.is_configured(axis, kind);
                is_open.then(|| interpreter.here.find_open(axis, kind))?
            })
            .collect();
        let side = |is_away| {
            let side = FoundSide::new(&self.scope, is_away, &conditions);
            self.observation(called).of_side(side)
        };
        let mut sides = [false, true].map(side);
        self.watch(&mut interpreter, &mut sides, run)?;
        Ok(sides.iter().all(|it| it.is_of_sides).then_some(sides))
    }

    /// Runs a program from each start on which what it does may depend.
    fn observe_each<E>(
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

    /// Returns the observation before a run.
    fn observation(&self, called: Option<&Arc<str>>) -> Observation {
        let observation = Observation::new(&self.scope).within(called);
        if self.found.may_exchange_axes() {
            observation.of_exchanged_axes()
        } else {
            observation
        }
    }

    fn observe_from<E>(
        &self,
        (start, called): (&RunStart, Option<&Arc<str>>),
        run: &mut impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<Observation, E> {
        let from = self.scope.found(|at| start.is_away(at));
        let mut interpreter = self.interpreter(from);
        let mut observation = [self.observation(called)];
        self.watch(&mut interpreter, &mut observation, run)?;
        let [observation] = observation;
        Ok(observation)
    }

    /// Runs a program on an interpreter.
    fn watch<E>(
        &self,
        interpreter: &mut Interpreter,
        observations: &mut [Observation],
        run: &mut impl FnMut(&mut Interpreter, &mut dyn Observer) -> Result<(), E>,
    ) -> Result<(), E> {
        interpreter.here.find(&self.found);
        run(interpreter, &mut |event: Event<'_>| {
            for observation in &mut *observations {
                observation.event(&self.scope, &event);
            }
            ControlFlow::Continue(())
        })?;
        let used = interpreter.here.take_use();
        for observation in observations {
            observation.rests_on = interpreter.rests_on();
            observation.use_ends(used.clone());
        }
        Ok(())
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

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use frictcomp_testing::generator::{Choices, NcProgram, Profile, Style};

    use super::*;
    use crate::interpreter::NoFiles;
    use crate::text::SourceFile;

    const MACHINE: &str = "[machine.programs]\nM06 = \"m6.nc\"\n\
        [[axis]]\nname = \"X\"\nenable = true\n\
        [[axis]]\nname = \"Y\"\nenable = true\n\
        [[axis]]\nname = \"Z\"\nfrict_comp = true\n\
        [[axis]]\nname = \"C\"\ntype = \"R\"\nenable = true\n\
        [[axis]]\nname = \"W\"\nfrict_comp = false\n";

    #[test]
    fn one_run_with_open_states_shows_what_the_run_from_each_start_does() {
        // R10.1, R10.10
        let machine = Machine::from_toml(MACHINE).expect("a machine");
        let auditor = Auditor::new(machine, Options::default(), &[], KindSet::of(Kind::Frict));
        let profiles = [
            Profile::ASKED_ONCE,
            Profile::ASKED_AGAIN,
            Profile::SHARED,
            Profile::EXECUTED,
            Profile::ARCHIVED,
        ];
        let mut decided = 0;
        for seed in 1..=1000 {
            let profile = &profiles[usize::try_from(seed).expect("small") % profiles.len()];
            let mut program = NcProgram::choose(profile, &mut Choices::of_seed(seed));
            let text = program.write(Style::default());
            let mut run = |interpreter: &mut Interpreter, listen: &mut dyn Observer| {
                let source = SourceFile::new("a.nc", text.as_str());
                let _ = interpreter.program(source, &mut NoFiles, listen);
                Ok::<(), Infallible>(())
            };
            let Ok(sides) = auditor.observe_sides(None, &mut run);
            let Ok(each) = auditor.observe_each(None, &mut run);
            let Some([start_up, away]) = sides else {
                continue;
            };
            decided += 1;
            let one = ProgramRuns {
                start_up,
                away,
                between: BTreeMap::new(),
            };
            let what = format!("seed {seed}:\n{text}");
            assert!(each.between.is_empty(), "{what}");
            for (mine, theirs) in [(&one.start_up, &each.start_up), (&one.away, &each.away)] {
                assert_eq!(mine.ends, theirs.ends, "{what}");
                assert_eq!(mine.stopped, theirs.stopped, "{what}");
                for (mine, theirs) in mine.observed.iter().zip(&theirs.observed) {
                    assert_eq!(mine.motions, theirs.motions, "{what}");
                }
            }
            assert_eq!(auditor.axes(&one), auditor.axes(&each), "{what}");
            assert_eq!(one.called(), each.called(), "{what}");
            assert_eq!(one.rests_on(), each.rests_on(), "{what}");
        }
        assert!(decided > 800, "only {decided} programs");
    }
}
