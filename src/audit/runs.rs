//! The conclusions from all runs of one program (R10.1), and the blocks that each executed in one file.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::effect::{Inherits, ProgramEffect, Scope, Selected, Site, WhyUnknown};
use super::observation::{Observation, SelectionOrigin};
use crate::interpreter::{EndedBy, Executed, VariableUse};
use crate::readings::QuestionSet;

/// The most axes and kinds whose states a program may ask for; the effect of one that asks for more is unknown.
const MOST_ASKED: usize = 3;

/// The states at the beginning of a run.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct RunStart {
    /// Whether the subjects that are not in `apart` start away from the start-up state.
    pub(super) is_away: bool,
    /// The subjects that start in the opposite state.
    pub(super) apart: BTreeSet<usize>,
}

impl RunStart {
    pub(super) const fn new(is_away: bool) -> Self {
        Self {
            is_away,
            apart: BTreeSet::new(),
        }
    }

    /// Returns whether a subject starts away from its start-up state.
    pub(super) fn is_away(&self, at: usize) -> bool {
        self.is_away != self.apart.contains(&at)
    }

    /// Returns this start with one subject in the opposite state.
    pub(super) fn but(&self, at: usize) -> Self {
        let mut other = self.clone();
        if !other.apart.remove(&at) {
            other.apart.insert(at);
        }
        other
    }
}

/// The runs of a program: from the start-up state, from the state away from it, and, if the program asks for states
/// that it finds, from those in between (R10.10).
#[derive(Debug, Clone)]
pub(super) struct ProgramRuns {
    pub(super) start_up: Observation,
    pub(super) away: Observation,
    pub(super) between: BTreeMap<RunStart, Observation>,
}

/// The start of the run from the start-up states.
static START_UP: RunStart = RunStart::new(false);
static AWAY: RunStart = RunStart::new(true);

impl ProgramRuns {
    fn all(&self) -> impl Iterator<Item = &Observation> {
        self.starts().map(|(_, run)| run)
    }

    /// Returns the runs, each with its start.
    pub(super) fn starts(&self) -> impl Iterator<Item = (&RunStart, &Observation)> {
        [(&START_UP, &self.start_up), (&AWAY, &self.away)]
            .into_iter()
            .chain(&self.between)
    }

    /// Returns the run from a start.
    pub(super) fn from(&self, start: &RunStart, scope: &Scope) -> Option<&Observation> {
        let is_away = start.is_away != (start.apart.len() == scope.subjects().len());
        if start.apart.is_empty() || start.apart.len() == scope.subjects().len() {
            return Some(if is_away { &self.away } else { &self.start_up });
        }
        self.between.get(start)
    }

    /// Returns the subjects whose states the program asks for before it sets them, with the first place.
    pub(super) fn asked(&self) -> BTreeMap<usize, Site> {
        let mut asked = BTreeMap::new();
        for (at, site) in self.all().flat_map(|run| &run.asked) {
            asked.entry(*at).or_insert_with(|| site.clone());
        }
        asked
    }

    /// Returns the called files whose blocks are executed.
    pub(super) fn called(&self) -> BTreeSet<Arc<str>> {
        let called = self.all().flat_map(|run| &run.called);
        called.cloned().collect()
    }

    /// Returns the open questions whose readings decided something.
    pub(super) fn rests_on(&self) -> QuestionSet {
        let questions = self.all().map(|run| run.rests_on);
        questions.fold(QuestionSet::default(), QuestionSet::union)
    }

    /// Returns the program's use of variables that outlive programs.
    pub(super) fn used(&self) -> VariableUse {
        let mut used = VariableUse::default();
        for run in self.all() {
            used.add(&run.used);
        }
        used
    }

    /// Returns the starts still to be tried: each subject that the program asks for may be in either state,
    /// independently of the others.
    pub(super) fn missing(&self, scope: &Scope) -> Vec<RunStart> {
        let asked: Vec<usize> = self.asked().into_keys().collect();
        if asked.len() > MOST_ASKED || scope.subjects().len() < 2 {
            return Vec::new();
        }
        let mut missing = Vec::new();
        for some in 0..1_u32 << asked.len() {
            let apart = asked.iter().enumerate();
            let apart = apart.filter(|(place, _)| some >> place & 1 == 1);
            let apart: BTreeSet<usize> = apart.map(|(_, at)| *at).collect();
            for is_away in [false, true] {
                let start = RunStart {
                    is_away,
                    apart: apart.clone(),
                };
                let is_new = !apart.is_empty() && apart.len() < scope.subjects().len();
                if is_new && !self.between.contains_key(&start) {
                    missing.push(start);
                }
            }
        }
        missing
    }

    pub(super) fn stopped(&self) -> Option<&Observation> {
        self.all().find(|run| run.has_failed())
    }

    /// Returns whether a command is about a subject.
    pub(super) fn is_commanded(&self, at: usize) -> bool {
        self.all().any(|run| run.observed[at].commanded)
    }

    pub(super) fn effect(&self, scope: &Scope, at: usize) -> ProgramEffect {
        let subject = scope.subjects()[at];
        if self.asked().len() > MOST_ASKED {
            return ProgramEffect::Unknown;
        }
        let is_lost =
            |run: &Observation| run.left[at] == Selected::Unknown && run.possible[at].is_none();
        if self.all().any(is_lost) || !self.is_decided(scope, at) {
            return ProgramEffect::Unknown;
        }
        let keeps = |(start, run): (&RunStart, &Observation)| {
            scope.selected_at_start(subject, start.is_away(at)) == run.left[at]
        };
        if self.starts().all(keeps) {
            return ProgramEffect::Keeps;
        }
        let first = self.start_up.left[at];
        match first {
            _ if self.all().any(|run| run.left[at] != first) => ProgramEffect::Depends,
            Selected::On => ProgramEffect::LeavesOn,
            Selected::Off => ProgramEffect::LeavesOff,
            Selected::Unknown => ProgramEffect::Depends,
        }
    }

    /// Returns whether its ends decide what it leaves. An error leaves away what is away there, or may be (R18.10);
    /// where a program that is stopped otherwise would have led is not known, unless it stops for what it found.
    fn is_decided(&self, scope: &Scope, at: usize) -> bool {
        let mut failed = self.all().filter(|run| run.has_failed());
        if !self.start_up.has_failed() {
            return failed.all(Observation::is_refused);
        }
        let start_up = scope.selected_at_start(scope.subjects()[at], false);
        self.start_up.left[at] != start_up && failed.all(|run| run.by == Some(EndedBy::Error))
    }

    pub(super) fn reason(&self, at: usize, name: &dyn Fn(usize) -> String) -> WhyUnknown {
        if let Some(run) = self.stopped() {
            return run.stopped.clone().unwrap_or_else(|| WhyUnknown {
                code: None,
                message: "the program was stopped".to_owned(),
                site: None,
            });
        }
        let lasts = self.all().map(|run| run.observed[at].last.as_ref());
        let doubt = lasts.flatten().find_map(|last| match last {
            SelectionOrigin::Doubt(reason) => Some(reason.clone()),
            SelectionOrigin::Command(_) => None,
        });
        if let Some(doubt) = doubt {
            return doubt;
        }
        let asked = self.asked();
        let names: Vec<String> = asked.keys().map(|asked| name(*asked)).collect();
        let message = match names.as_slice() {
            [] => "it depends on the state that the program finds".to_owned(),
            names => format!(
                "it depends on {}, which the program finds",
                names.join(", ")
            ),
        };
        let site = asked.into_values().next();
        WhyUnknown {
            code: None,
            message,
            site: site.or_else(|| self.command(at)),
        }
    }

    /// Returns the last command on a subject.
    pub(super) fn command(&self, at: usize) -> Option<Site> {
        let lasts = self.all().map(|run| run.observed[at].last.as_ref());
        lasts.flatten().find_map(|last| match last {
            SelectionOrigin::Command(site) => Some(site.clone()),
            SelectionOrigin::Doubt(_) => None,
        })
    }

    pub(super) fn inherits(&self, at: usize) -> Inherits {
        let away = self.starts().filter(|(start, _)| start.is_away(at));
        let away: Vec<&Observation> = away.map(|(_, run)| run).collect();
        let inherited = away.iter().filter_map(|run| {
            let moved = run.observed[at].inherited.as_ref()?;
            Some(moved.motion.clone())
        });
        if let Some(motion) = inherited.min_by_key(|motion| motion.perhaps) {
            return Inherits::Motion(motion);
        }
        // A refusal in some found states has been tried without them, too.
        let are_all_tried = !self.start_up.has_failed() && self.asked().len() <= MOST_ASKED;
        let is_cut = |run: &&Observation| {
            let is_tried = are_all_tried && run.is_refused();
            run.has_failed() && !run.observed[at].commanded && !is_tried
        };
        if away.iter().any(is_cut) {
            Inherits::Unknown
        } else {
            Inherits::No
        }
    }
}

/// Number of blocks remembered before the end.
const LAST_BLOCKS: usize = 8;

/// The blocks that a run executed in one file and that a cure needs: those of the main program, or of a program that it
/// calls.
#[derive(Debug, Clone, Default)]
pub(super) struct Within {
    /// The called file; `None` for the main program.
    called: Option<Arc<str>>,
    /// The depth of the call while the file runs.
    depth: Option<u32>,
    /// The line of the first block.
    pub(super) first_line: Option<u32>,
    /// The lines of the last blocks before each return to the caller.
    pub(super) returns: BTreeSet<u32>,
    ring: [u32; LAST_BLOCKS],
    blocks: usize,
}

impl Within {
    /// Starts empty, for a file that the main program calls.
    pub(super) fn called(file: &Arc<str>) -> Self {
        Self {
            called: Some(Arc::clone(file)),
            ..Self::default()
        }
    }

    /// Returns whether the main program is observed.
    pub(super) fn is_of_main(&self) -> bool {
        self.called.is_none()
    }

    #[inline]
    pub(super) fn executed(&mut self, executed: &Executed<'_>) {
        match &self.called {
            None if executed.level.is_some() => {}
            None => self.block(executed.line),
            Some(_) => self.of_called(executed),
        }
    }

    #[inline]
    fn block(&mut self, line: u32) {
        self.first_line.get_or_insert(line);
        self.ring[self.blocks % LAST_BLOCKS] = line;
        self.blocks += 1;
    }

    fn of_called(&mut self, executed: &Executed<'_>) {
        let level = executed.level.unwrap_or_default();
        if self.depth.is_some_and(|depth| level > depth) {
            return;
        }
        let is_here = self.called.as_ref() == Some(executed.file);
        if !is_here {
            self.leave();
            return;
        }
        if self.depth != Some(level) {
            self.leave();
            self.depth = Some(level);
        }
        self.block(executed.line);
    }

    fn leave(&mut self) {
        if self.depth.take().is_some() {
            self.returns.extend(self.last_line());
        }
    }

    /// Ends the run, wherever it is.
    pub(super) fn ended(&mut self) {
        self.leave();
    }

    fn last_line(&self) -> Option<u32> {
        self.last_lines().next()
    }

    /// Returns the line of the file that is being executed or contains the call.
    pub(super) fn line(&self) -> Option<u32> {
        let runs = self.called.is_none() || self.depth.is_some();
        self.last_line().filter(|_| runs)
    }

    /// Returns the lines of the last executed blocks, the latest first.
    pub(super) fn last_lines(&self) -> impl Iterator<Item = u32> {
        let count = self.blocks.min(LAST_BLOCKS);
        (1..=count).map(|back| self.ring[(self.blocks - back) % LAST_BLOCKS])
    }
}
