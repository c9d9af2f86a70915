//! The programs of one machine together: which leave an axis away from its start-up state, and which inherit it, in a given
//! order, too (R10.6).

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use serde::Serialize;

use super::effect::{FirstMotion, Inherits, ProgramEffect, Selected, Site, WhyUnknown};
use super::mending::{Cure, Mending};
use super::observation::{Moved, Observation, SelectionOrigin};
use super::program::{Auditor, AxisAudit, ProgramAudit};
use crate::comp::Kind;
use crate::interpreter::{EndedBy, Event, FoundVariables, Interpreter, Observer, PossibleStates};
use crate::readings::{Question, QuestionSet};
use crate::timeline::ReadingsInForce;

/// The programs of one machine.
#[derive(Debug, Clone, Default)]
pub struct Archive {
    programs: Vec<ProgramAudit>,
}

/// The side of a hazard on which it is mended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MendedEnd {
    /// The programs that leave an axis away from its start-up state.
    Leavers,
    /// The programs that inherit it.
    Inheritors,
    /// The side with fewer programs, for each axis.
    Smaller,
}

/// Effect of all programs on one kind of compensation of one axis. Programs are named by their
/// position in [`Archive::programs`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct AxisFinding {
    /// Name of the axis.
    pub axis: String,
    /// Kind of compensation.
    pub kind: Kind,
    /// Whether compensation is selected at the start of the control.
    pub on_at_start_up: bool,
    /// The position of the axis and kind in [`ProgramAudit::axes`].
    pub at: usize,
    /// The programs that leave it away from its start-up state.
    pub leavers: Vec<usize>,
    /// The programs that move the axis in the state that they find.
    pub inheritors: Vec<usize>,
    /// The programs that may move it in the state that they find.
    pub possible_inheritors: Vec<usize>,
    /// The programs in both lists: the second run of each differs from its first (R1.53).
    pub both: Vec<usize>,
    /// The programs of which it is not known offline what they leave or inherit.
    pub unknown: Vec<usize>,
    /// The programs among these whose effect is not known: any of them may leave it away from its start-up state.
    pub unknown_leavers: Vec<usize>,
    /// The programs among these of which it is not known whether they move it in the state that they find.
    pub unknown_inheritors: Vec<usize>,
}

impl AxisFinding {
    /// Returns the number of ordered pairs of a program that leaves the axis away from its start-up state and one that
    /// inherits it (R10.2).
    pub fn hazards(&self) -> u64 {
        let count = |list: &[usize]| u64::try_from(list.len()).unwrap_or(u64::MAX);
        count(&self.leavers).saturating_mul(count(&self.inheritors))
    }

    /// Returns the number of ordered pairs of a program that leaves the axis away from the start-up state and one that
    /// may move it in that state (R10.7).
    pub fn possible_hazards(&self) -> u64 {
        let count = |list: &[usize]| u64::try_from(list.len()).unwrap_or(u64::MAX);
        count(&self.leavers).saturating_mul(count(&self.possible_inheritors))
    }

    /// Returns the programs that move, or may move, the axis in the state that they find, in their order.
    pub fn movers(&self) -> Vec<usize> {
        let both = self.inheritors.iter().chain(&self.possible_inheritors);
        let mut movers: Vec<usize> = both.copied().collect();
        movers.sort_unstable();
        movers
    }

    /// Returns the side with fewer programs; where it is not known which programs inherit it, those that leave it.
    pub fn cure(&self) -> Cure {
        match (self.leavers.len(), self.movers().len()) {
            (0, _) => Cure::None,
            (_, 0) if self.unknown_inheritors.is_empty() => Cure::None,
            (leavers, inheritors) if inheritors == 0 || leavers <= inheritors => Cure::Leavers,
            _ => Cure::Inheritors,
        }
    }

    /// Returns whether a hazard cannot be ruled out: a program leaves it away from its start-up state, or may, and one
    /// inherits that, or may (R10.2).
    pub fn is_worth_a_warning(&self) -> bool {
        let has_leaver = !(self.leavers.is_empty() && self.unknown_leavers.is_empty());
        has_leaver && !(self.movers().is_empty() && self.unknown_inheritors.is_empty())
    }
}

impl Archive {
    /// Leaves out the axes that nothing describes and no program switches: there is nothing to leave or inherit.
    #[must_use]
    pub fn without_unswitched(mut self) -> Self {
        let first = self.programs.first().map_or(&[][..], |first| &first.axes);
        let counts = |at: usize| {
            let mut programs = self.programs.iter().map(|program| &program.axes[at]);
            programs.any(|axis| axis.is_described || axis.is_commanded)
        };
        let counting: Vec<bool> = (0..first.len()).map(counts).collect();
        for program in &mut self.programs {
            let mut counting = counting.iter().copied();
            program.axes.retain(|_| counting.next().unwrap_or(true));
        }
        self
    }

    /// Adds a program.
    pub fn push(&mut self, program: ProgramAudit) {
        self.programs.push(program);
    }

    /// Returns the values that each program finds in variables that outlive programs, after any other (R2.34).
    pub fn found(&self) -> FoundVariables {
        let mut found = FoundVariables::default();
        for program in &self.programs {
            found.add(&program.used.written);
        }
        found
    }

    /// Returns the positions of the programs that found other values in the variables they read than
    /// [`found`](Self::found) gives: these must run again.
    pub fn unsettled(&self) -> Vec<usize> {
        let found = self.found();
        let is_unsettled = |(_, program): &(usize, &ProgramAudit)| {
            program.found.wanted_by(&program.used) != found.wanted_by(&program.used)
        };
        let programs = self.programs.iter().enumerate();
        let unsettled = programs.filter(is_unsettled);
        unsettled.map(|(position, _)| position).collect()
    }

    /// Takes the audit of a program that has run again. Its earlier effects count as well, so that the repetition
    /// terminates, and a state that it certainly leaves after a start of the control stays known.
    pub fn settle(&mut self, position: usize, mut program: ProgramAudit) {
        let before = &mut self.programs[position];
        program.used.add(&before.used);
        for (axis, earlier) in program.axes.iter_mut().zip(&before.axes) {
            axis.still_leaves(earlier);
        }
        *before = program;
    }

    /// Returns the programs in the order in which they were added.
    pub fn programs(&self) -> &[ProgramAudit] {
        &self.programs
    }

    /// Returns the open questions whose readings decide how the programs affect each other (R15.3): the state that a
    /// program leaves reaches the next one unless a reset between them takes it back (R1.28).
    pub fn rests_on(&self) -> QuestionSet {
        let questions = self.programs.iter().map(|program| program.rests_on);
        let mut questions = questions.fold(QuestionSet::default(), QuestionSet::union);
        let mut axes = self.programs.iter().flat_map(|program| &program.axes);
        if axes.any(AxisAudit::leaves_away) {
            questions.insert(Question::Reset);
        }
        questions
    }

    /// Returns the effect of all programs together, for each axis and kind in the machine's order.
    pub fn findings(&self) -> Vec<AxisFinding> {
        let first = self.programs.first().map_or(&[][..], |first| &first.axes);
        first
            .iter()
            .enumerate()
            .map(|(at, axis)| self.finding(at, axis))
            .collect()
    }

    fn finding(&self, at: usize, axis: &AxisAudit) -> AxisFinding {
        let those = |are: fn(&AxisAudit) -> bool| {
            let programs = self.programs.iter().enumerate();
            let those = programs.filter(|(_, program)| are(&program.axes[at]));
            those.map(|(position, _)| position).collect()
        };
        AxisFinding {
            axis: axis.axis.clone(),
            kind: axis.kind,
            on_at_start_up: axis.on_at_start_up,
            at,
            leavers: those(AxisAudit::leaves_away),
            inheritors: those(AxisAudit::is_inheritor),
            possible_inheritors: those(AxisAudit::may_inherit),
            both: those(|axis| axis.leaves_away() && axis.is_inheritor()),
            unknown: those(AxisAudit::is_unknown),
            unknown_leavers: those(|axis| axis.effect == ProgramEffect::Unknown),
            unknown_inheritors: those(|axis| axis.inherits == Inherits::Unknown),
        }
    }

    /// Returns the mendings of each program, by its position, that leave no hazard. A program that may leave an axis
    /// away from its start-up state, depending on a value of the machine, counts as a leaver; one stopped by an error
    /// or a budget has to be mended by hand first.
    pub fn to_mend(&self, end: MendedEnd) -> BTreeMap<usize, Vec<Mending>> {
        let mut wanted: BTreeMap<usize, Vec<Mending>> = BTreeMap::new();
        for finding in self.findings() {
            let first = self.programs.first().and_then(|it| it.axes.get(finding.at));
            let is_described = first.is_some_and(|axis| axis.is_described);
            if !finding.is_worth_a_warning() || !is_described {
                continue;
            }
            let cure = match end {
                MendedEnd::Inheritors => Cure::Inheritors,
                MendedEnd::Smaller if finding.cure() == Cure::Inheritors => Cure::Inheritors,
                MendedEnd::Leavers | MendedEnd::Smaller => Cure::Leavers,
            };
            let programs: Vec<usize> = if cure == Cure::Inheritors {
                finding.movers()
            } else {
                let unknown = finding.unknown.iter().filter(|&&program| {
                    self.programs[program].axes[finding.at].depends_on_the_machine()
                });
                finding.leavers.iter().chain(unknown).copied().collect()
            };
            let at = finding.at;
            for program in programs {
                let mendings = wanted.entry(program).or_default();
                mendings.push(Mending { at, cure });
            }
        }
        wanted
    }
}

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
    /// Selection at the start of the control.
    #[serde(skip)]
    pub start_up: Selected,
    /// The last command that made it what it is at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<Site>,
    /// The first motion of the axis away from its start-up state: the first certain one, else the first possible one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub away: Option<FirstMotion>,
    /// The program that left it so, if the motion comes before any command of this program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_by: Option<String>,
}

impl StepAxis {
    /// Returns whether its first motion away from its start-up state is certain, and so is that state.
    pub fn moves_certainly(&self) -> bool {
        let away = self.away.as_ref();
        away.is_some_and(|away| !away.perhaps && away.ways.is_empty())
    }
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
    /// The errors of `run`.
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
            let was_lost = self.lost[at];
            self.lost[at] |= observed.commanded && !is_described;
            if !is_described && !self.lost[at] {
                continue;
            }
            let is_lost = self.lost[at];
            let known = |selected| if is_lost { Selected::Unknown } else { selected };
            let begin = known(Selected::of(&start, *subject));
            let end = known(observation.left[at]);
            let inherits = observed.inherited.as_ref().map(|moved| moved.seq);
            let away = if was_lost {
                observed.inherited.clone().map(Moved::possible)
            } else {
                observed.astray.clone()
            };
            let is_found = away.as_ref().is_some_and(|it| Some(it.seq) == inherits);
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
                away: away.map(|moved| moved.motion),
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
