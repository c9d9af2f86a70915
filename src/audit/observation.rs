//! The effect of one run of a program on each axis, and the selection at every motion, so that two runs can be compared (R10.8).

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::Arc;

use super::effect::{AuditedKind, FirstMotion, Scope, Selected, Site, WhyUnknown};
use super::runs::Within;
use crate::comp::{AxisIndex, Compensation, Kind, KindSet, Membership};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::{
    Certainty, Ended, EndedBy, Event, Executed, FoundStates, KindEffect, MovedAxis, Outcome,
    PossibleStates, RefusedMotion, Split, VariableUse, WayAnswer,
};
use crate::readings::QuestionSet;
use crate::text::Place;

/// Origin of the present state of a selection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum SelectionOrigin {
    /// A command that was executed.
    Command(Site),
    /// Cause not known offline.
    Doubt(WhyUnknown),
}

/// A motion and its executed block.
#[derive(Debug, Clone)]
pub(super) struct Moved {
    pub(super) seq: u64,
    pub(super) motion: FirstMotion,
    /// The line of the observed file that was executed or contained the call.
    pub(super) within: Option<u32>,
}

impl Moved {
    /// Returns it as a motion in a state that is not known.
    pub(super) fn possible(mut self) -> Self {
        self.motion.perhaps = true;
        self
    }
}

/// Effect of a run on one subject.
#[derive(Debug, Clone, Default)]
pub(super) struct Observed {
    /// The origin of its state at the end; before it, the last doubt about it.
    pub(super) last: Option<SelectionOrigin>,
    /// Whether a command of the program named the subject.
    pub(super) commanded: bool,
    /// The first motion in the state that the program found: the first certain one, else the first possible one.
    pub(super) inherited: Option<Moved>,
    /// The first motion away from its start-up state: the first certain one, else the first possible one.
    pub(super) astray: Option<Moved>,
    /// The selection at every motion.
    pub(super) motions: SelectionAtMotions,
    /// The selection after the last block that may have changed it.
    selected: Option<Selected>,
}

/// A side of a run that finds states open: the subjects are found in their start-up states, or away from them.
#[derive(Debug, Clone)]
pub(super) struct FoundSide {
    is_away: bool,
    /// The answer on this side to the condition of each subject; `None` for one that is not found open.
    answers: Vec<Option<WayAnswer>>,
}

impl FoundSide {
    /// Creates a side. `conditions` are those of the subjects whose first answers are that they are found selected.
    pub(super) fn new(scope: &Scope, is_away: bool, conditions: &[Option<u32>]) -> Self {
        let subjects = scope.subjects().iter().zip(conditions);
        let answers = subjects.map(|(subject, condition)| {
            let is_off = scope.selected_at_start(*subject, is_away) == Selected::Off;
            condition.map(|condition| WayAnswer {
                condition,
                sides: 1 << u8::from(is_off),
                of: 2,
            })
        });
        Self {
            is_away,
            answers: answers.collect(),
        }
    }
}

/// Effects of one run of a program.
#[derive(Debug, Clone)]
pub(super) struct Observation {
    /// The observed side of a run that finds states open.
    side: Option<FoundSide>,
    /// Whether the sides of a run that finds states open show the results of runs from their states.
    pub(super) is_of_sides: bool,
    pub(super) observed: Vec<Observed>,
    /// The reason for its end; `None` if the end was not observed.
    pub(super) by: Option<EndedBy>,
    /// The block of the main file that ended it.
    pub(super) end: Option<u32>,
    /// Messages about the file as a whole: it has no block, or is no program (R18.6).
    pub(super) about_file: Vec<Diagnostic>,
    /// The blocks of the main file that end it on some way.
    pub(super) ends: BTreeSet<u32>,
    /// Reason for a stop before the end.
    pub(super) stopped: Option<WhyUnknown>,
    /// The state that it left, by subject.
    pub(super) left: Vec<Selected>,
    /// The possible states where it left one unknown because ways differ, by subject.
    pub(super) possible: Vec<Option<PossibleStates>>,
    /// The subjects whose states it asked for before it set them, each with the first place.
    pub(super) asked: BTreeMap<usize, Site>,
    /// Blocks in the main program, or in the observed called file.
    pub(super) within: Within,
    /// The called files whose blocks it executed.
    pub(super) called: BTreeSet<Arc<str>>,
    /// The open questions whose readings decided something in it (R15.3).
    pub(super) rests_on: QuestionSet,
    /// Use of variables that outlive programs.
    pub(super) used: VariableUse,
    /// The main file.
    main: Option<Arc<str>>,
    /// The called file of the last block.
    last_called: Option<Arc<str>>,
    doubt: Option<WhyUnknown>,
    /// The reason for an effect of a block about which nothing is said.
    unsaid: &'static str,
    /// The error that the program reports itself.
    reported: Option<WhyUnknown>,
}

impl Observation {
    /// Returns the observation before a run.
    pub(super) fn new(scope: &Scope) -> Self {
        let count = scope.subjects().len();
        Self {
            side: None,
            is_of_sides: true,
            observed: vec![Observed::default(); count],
            by: None,
            end: None,
            about_file: Vec::new(),
            ends: BTreeSet::new(),
            stopped: None,
            reported: None,
            left: vec![Selected::Unknown; count],
            possible: vec![None; count],
            asked: BTreeMap::new(),
            within: Within::default(),
            called: BTreeSet::new(),
            rests_on: QuestionSet::default(),
            used: VariableUse::default(),
            main: None,
            last_called: None,
            doubt: None,
            unsaid: "what this block does is not known offline",
        }
    }

    /// Observes a side of a run that finds states open.
    pub(super) fn of_side(mut self, side: FoundSide) -> Self {
        self.side = Some(side);
        self
    }

    /// Observes a run in which names of axes may mean others.
    pub(super) fn of_exchanged_axes(mut self) -> Self {
        self.unsaid =
            "which axis this block means is not known: a program before it may have exchanged axes";
        self
    }

    /// Also observes a file that the program calls.
    pub(super) fn within(mut self, called: Option<&Arc<str>>) -> Self {
        self.within = called.map(Within::called).unwrap_or_default();
        self
    }

    /// Takes the run's use of variables that outlive programs. If a budget ended the run, what the rest of the program
    /// writes is unknown.
    pub(super) fn use_ends(&mut self, used: VariableUse) {
        self.used = used;
        if self.by == Some(EndedBy::Budget) {
            self.used.write_anything();
        }
    }

    /// Returns whether something stopped it before its end.
    pub(super) fn has_failed(&self) -> bool {
        let at_end = [EndedBy::M30, EndedBy::M02, EndedBy::EndOfFile];
        self.by.is_none_or(|by| !at_end.contains(&by))
    }

    /// Returns whether the control stops it in the state that it has: a motion lacks a compensation, or the program
    /// reports an error of its own.
    pub(super) fn is_refused(&self) -> bool {
        let code = self.stopped.as_ref().and_then(|why| why.code);
        self.by == Some(EndedBy::Error) && matches!(code, Some(Code::PErr70435 | Code::Fc318))
    }

    /// Takes an event of the run.
    pub(super) fn event(&mut self, scope: &Scope, event: &Event<'_>) {
        match event {
            Event::Started { compensation, .. } => self.start(scope, compensation),
            Event::Executed(executed) => self.executed(scope, executed),
            Event::Joined(_) => {}
            Event::Ended(ended) => {
                let said = ended.diagnostics.iter();
                let said = said.filter(|said| matches!(said.code, Code::Fc103 | Code::Fc104));
                self.about_file = said.cloned().collect();
                self.ended(scope, ended);
            }
        }
    }

    #[inline]
    fn executed(&mut self, scope: &Scope, executed: &Executed<'_>) {
        self.within.executed(executed);
        if executed.level.is_some() {
            self.calls(executed.file);
        } else if self.main.is_none() {
            self.main = Some(Arc::clone(executed.file));
        }
        for &(axis, kind) in &executed.aside.asked {
            self.ask(scope, executed, AuditedKind { axis, kind });
        }
        for refused in &executed.aside.refused {
            self.refused(scope, executed, refused);
        }
        let quiet = executed.outcomes.is_empty()
            && executed.changes.is_empty()
            && executed.doubted.is_empty()
            && executed.diagnostics.is_empty();
        if !quiet {
            self.deeds(scope, executed);
        }
        // The commands of a block act before its motion (R1.9).
        for motion in executed.motions() {
            self.moved(scope, executed, &motion);
        }
        if !quiet {
            self.stand(scope, executed);
        }
    }

    /// Records a called file.
    fn calls(&mut self, file: &Arc<str>) {
        let is_last = |last: &Arc<str>| Arc::ptr_eq(last, file);
        if self.last_called.as_ref().is_some_and(is_last) {
            return;
        }
        self.last_called = Some(Arc::clone(file));
        if self.main.as_ref() != Some(file) && !self.called.contains(file) {
            self.called.insert(Arc::clone(file));
        }
    }

    /// Records that the program reads the state of a subject (R1.35).
    fn ask(&mut self, scope: &Scope, executed: &Executed<'_>, asked: AuditedKind) {
        for at in scope.of_axis(asked.axis) {
            if scope.subjects()[at] == asked && executed.found.has(asked.axis, asked.kind) {
                self.depends_on(at, executed);
            }
        }
    }

    /// Records that what the program does depends on the state in which it found a subject.
    fn depends_on(&mut self, at: usize, executed: &Executed<'_>) {
        self.is_of_sides = false;
        self.asked.entry(at).or_insert_with(|| site(executed));
    }

    /// Records a motion that the control refuses in the state that the program found (R1.36).
    fn refused(&mut self, scope: &Scope, executed: &Executed<'_>, refused: &RefusedMotion) {
        for at in scope.of_axis(refused.axis) {
            if scope.subjects()[at].kind != refused.lacks {
                continue;
            }
            self.depends_on(at, executed);
            let perhaps = !refused.ways.is_empty();
            let known = self.observed[at].inherited.as_ref();
            if known.is_some_and(|known| perhaps || !known.motion.perhaps) {
                continue;
            }
            self.observed[at].inherited = Some(Moved {
                seq: executed.seq,
                motion: FirstMotion {
                    site: site(executed),
                    motion: refused.motion,
                    is_refused: true,
                    perhaps,
                    ways: refused.ways.clone(),
                },
                within: self.within.line(),
            });
        }
    }

    fn start(&mut self, scope: &Scope, compensation: &Compensation) {
        for (observed, subject) in self.observed.iter_mut().zip(scope.subjects()) {
            observed.selected = Some(match &self.side {
                Some(side) => scope.selected_at_start(*subject, side.is_away),
                None => Selected::of(compensation, *subject),
            });
        }
    }

    fn stand(&mut self, scope: &Scope, executed: &Executed<'_>) {
        for at in 0..self.observed.len() {
            let (selected, _) = self.selected(scope, at, (executed.compensation, executed.found));
            self.observed[at].selected = Some(selected);
        }
    }

    /// Returns the selection of a subject on the observed side, with the ways to each state where they still differ.
    fn selected(
        &self,
        scope: &Scope,
        at: usize,
        (compensation, found): (&Compensation, FoundStates<'_>),
    ) -> (Selected, Option<Split>) {
        let subject @ AuditedKind { axis, kind } = scope.subjects()[at];
        let selected = Selected::of(compensation, subject);
        let Some(side) = &self.side else {
            return (selected, None);
        };
        let split = found.history.states(axis, kind);
        match (side.answers[at], split) {
            (None, _) if !compensation.is_configured(axis, kind) => {
                (scope.selected_at_start(subject, side.is_away), None)
            }
            _ if selected != Selected::Unknown => (selected, None),
            (Some(answer), Some(split)) => {
                let split = split.given(answer);
                match split.only() {
                    Some(Membership::In) => (Selected::On, None),
                    Some(Membership::Out) => (Selected::Off, None),
                    None => (Selected::Unknown, Some(split)),
                }
            }
            _ => (Selected::Unknown, None),
        }
    }

    /// Returns the possible states of a kind on the observed side. The sides cannot be told apart where sets were
    /// widened.
    fn possible_of(
        &mut self,
        (compensation, found): (&Compensation, FoundStates<'_>),
        kind: (AxisIndex, Kind),
        split: &Split,
    ) -> PossibleStates {
        let possible = found.states_of((compensation, kind), split);
        self.is_of_sides &= !possible.is_widened();
        possible
    }

    /// Returns the selection of a subject with its possible states, on the observed side.
    fn stood(&mut self, scope: &Scope, at: usize, executed: &Executed<'_>) -> Stood {
        let AuditedKind { axis, kind } = scope.subjects()[at];
        let states = (executed.compensation, executed.found);
        let (selected, split) = self.selected(scope, at, states);
        let own = split.map(|split| self.possible_of(states, (axis, kind), &split));
        self.is_of_sides &= selected != Selected::Unknown || own.is_some();
        let possible = match self.side {
            Some(_) => own.as_ref(),
            None => executed.possible_of(axis, kind),
        };
        Stood::new(selected, possible)
    }

    #[inline(never)]
    fn deeds(&mut self, scope: &Scope, executed: &Executed<'_>) {
        self.heed(executed);
        for outcome in executed.outcomes {
            self.command(scope, executed, outcome);
        }
        for change in executed.changes {
            let kinds = KindSet::of(change.kind);
            self.doubts(scope, (change.axis, kinds), executed);
        }
        for &(axis, kinds) in executed.doubted {
            self.doubts(scope, (axis, kinds), executed);
        }
    }

    /// Records what is not known, and what stops the program.
    fn heed(&mut self, executed: &Executed<'_>) {
        let site = site(executed);
        for said in executed.diagnostics {
            if matches!(said.code, Code::Fc901 | Code::Fc902 | Code::Fc908) {
                self.is_of_sides &= said.code != Code::Fc908;
                self.doubt = Some(reason(said, Some(site.clone())));
            }
            if said.code == Code::Fc318 {
                self.reported = Some(reason(said, Some(site.clone())));
            }
        }
        if executed.stopped {
            let errors = executed.diagnostics.iter();
            let mut errors = errors.filter(|said| said.severity == Severity::Error);
            self.stopped = errors.next().map(|said| reason(said, Some(site)));
        }
    }

    fn command(&mut self, scope: &Scope, executed: &Executed<'_>, outcome: &Outcome) {
        let name = &outcome.command.axis;
        let kinds = outcome.command.selection.kinds();
        if let Some(at) = scope.undescribed(name) {
            if kinds.contains(scope.subjects()[at].kind) {
                let observed = &mut self.observed[at];
                observed.commanded = true;
                observed.last = Some(SelectionOrigin::Doubt(WhyUnknown {
                    code: Some(Code::Fc408),
                    message: format!("nothing describes axis `{name}`"),
                    site: Some(site(executed)),
                }));
            }
            return;
        }
        let Ok(axis) = outcome.result else {
            return;
        };
        for at in scope.of_axis(axis) {
            if kinds.contains(scope.subjects()[at].kind) {
                self.observed[at].commanded = true;
            }
        }
    }

    /// Returns the kinds of an axis that a block leaves unknown.
    fn doubts(
        &mut self,
        scope: &Scope,
        (axis, kinds): (AxisIndex, KindSet),
        executed: &Executed<'_>,
    ) {
        let lost = executed.compensation.unknown(axis).intersection(kinds);
        if lost.is_empty() {
            return;
        }
        for at in scope.of_axis(axis) {
            let kind = scope.subjects()[at].kind;
            if lost.contains(kind) {
                self.is_of_sides &= executed.found.history.states(axis, kind).is_some();
                let reason = self.doubt.clone().unwrap_or_else(|| WhyUnknown {
                    code: None,
                    message: self.unsaid.to_owned(),
                    site: Some(site(executed)),
                });
                self.observed[at].last = Some(SelectionOrigin::Doubt(reason));
            }
        }
    }

    #[inline]
    fn moved(&mut self, scope: &Scope, executed: &Executed<'_>, motion: &MovedAxis) {
        let is_certain = motion.certainty == Certainty::Certain;
        for at in scope.of_axis(motion.axis) {
            let subject = scope.subjects()[at];
            let stood = self.stood(scope, at, executed);
            let selected = stood.selected;
            let is_at_start_up = (selected == Selected::On) == scope.is_on_at_start_up(subject)
                && selected != Selected::Unknown;
            let observed = &mut self.observed[at];
            if !is_certain && let Some(before) = observed.selected {
                // The motion may come before whatever the block may switch.
                observed.motions.note(Stood::new(before, None));
            }
            observed.motions.note(stood);
            let (axis, kind) = (subject.axis, subject.kind);
            let is_known = !executed.found.has(axis, kind)
                || observed.inherited.as_ref().is_some_and(|known| {
                    let is_sure = is_certain && executed.found.is_always(axis, kind);
                    !known.motion.perhaps || !is_sure
                });
            let is_open = selected == Selected::Unknown;
            let is_sure = is_certain && !is_open;
            let is_as_sure = |known: &Moved| !is_sure || !known.motion.perhaps;
            let is_seen = is_at_start_up || observed.astray.as_ref().is_some_and(is_as_sure);
            if is_known && is_seen {
                continue;
            }
            let mut moved = moved_at(executed, self.within.line(), motion);
            let observed = &mut self.observed[at];
            if !is_known {
                let mut inherited = moved.clone();
                inherited.motion.ways = executed.found.ways(axis, kind);
                inherited.motion.perhaps |= !inherited.motion.ways.is_empty();
                observed.inherited = Some(inherited);
            }
            if !is_seen {
                moved.motion.perhaps |= is_open;
                observed.astray = Some(moved);
            }
        }
    }

    fn ended(&mut self, scope: &Scope, ended: &Ended<'_>) {
        self.by = Some(ended.by);
        self.within.ended();
        let of_main = |place: &&Place| self.main.as_ref() == Some(&place.file);
        self.end = ended.at.filter(of_main).map(|place| place.first_line);
        let ends = ended.ends.iter().map(|end| &end.place).filter(of_main);
        self.ends = ends.map(|place| place.first_line).collect();
        let states = (ended.compensation, ended.found);
        for (at, &AuditedKind { axis, kind }) in scope.subjects().iter().enumerate() {
            let (selected, split) = self.selected(scope, at, states);
            self.left[at] = selected;
            self.possible[at] = if self.side.is_some() {
                split.map(|split| self.possible_of(states, (axis, kind), &split))
            } else {
                let mut possible = ended.possible.iter();
                possible
                    .find(|it| (it.axis, it.kind) == (axis, kind))
                    .cloned()
            };
            self.is_of_sides &= selected != Selected::Unknown || self.possible[at].is_some();
        }
        for (at, observed) in self.observed.iter().enumerate() {
            if observed.commanded && !scope.is_described(at) {
                self.left[at] = Selected::Unknown;
            }
        }
        let has_failed = matches!(ended.by, EndedBy::Error | EndedBy::Budget);
        if has_failed && self.stopped.is_none() {
            let said = ended.diagnostics.first();
            let said = said.map(|said| reason(said, Some(site_of(said))));
            let reported = self.reported.take().filter(|_| ended.by == EndedBy::Error);
            self.stopped = reported.or(said).or_else(|| {
                Some(WhyUnknown {
                    code: None,
                    message: "the program was stopped".to_owned(),
                    site: None,
                })
            });
        }
        self.take_origins(scope, ended);
    }
}

impl Observation {
    /// Records the origins of the states at the end: of several ways, the command that leads away.
    fn take_origins(&mut self, scope: &Scope, ended: &Ended<'_>) {
        let subjects = scope.subjects().iter().enumerate();
        for (at, &AuditedKind { axis, kind }) in subjects {
            let is_on = match self.left[at] {
                Selected::Unknown if self.possible[at].is_none() => {
                    let observed = &mut self.observed[at];
                    let doubt = || self.doubt.clone().map(SelectionOrigin::Doubt);
                    observed.last = observed.last.take().or_else(doubt);
                    continue;
                }
                Selected::Unknown => !scope.is_on_at_start_up(AuditedKind { axis, kind }),
                selected => selected == Selected::On,
            };
            let effect = if is_on {
                KindEffect::On
            } else {
                KindEffect::Off
            };
            let command = ended.found.history.latest(axis, kind, effect);
            self.observed[at].last = command.map(|command| {
                SelectionOrigin::Command(Site {
                    file: Arc::clone(&command.place.file),
                    line: command.place.first_line,
                })
            });
        }
    }
}

fn moved_at(executed: &Executed<'_>, within: Option<u32>, motion: &MovedAxis) -> Moved {
    Moved {
        seq: executed.seq,
        motion: FirstMotion {
            site: site(executed),
            motion: motion.kind,
            is_refused: false,
            perhaps: motion.certainty == Certainty::Possible,
            ways: executed.branch.unwrap_or_default().to_vec(),
        },
        within,
    }
}

fn site(executed: &Executed<'_>) -> Site {
    Site {
        file: Arc::clone(executed.file),
        line: executed.line,
    }
}

fn site_of(said: &Diagnostic) -> Site {
    Site {
        file: Arc::clone(&said.place.file),
        line: said.place.start().line,
    }
}

fn reason(said: &Diagnostic, site: Option<Site>) -> WhyUnknown {
    WhyUnknown {
        code: Some(said.code),
        message: said.message.clone(),
        site,
    }
}

/// Number of changes kept individually; for the rest only a fingerprint is compared.
const MOST: usize = 4096;

/// The selection at a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stood {
    pub(super) selected: Selected,
    /// A digest of the ways to each state, if more than one is possible.
    pub(super) ways: u64,
}

impl Stood {
    /// Returns the selection of a subject, with its possible states if there are several.
    pub(super) fn new(selected: Selected, possible: Option<&PossibleStates>) -> Self {
        let mut digest = DefaultHasher::new();
        if let Some(possible) = possible {
            // Inserted blocks shift the lines.
            possible.without_lines().hash(&mut digest);
        }
        Self {
            selected,
            ways: possible.map_or(0, |_| digest.finish()),
        }
    }
}

/// The selection of one kind on one axis at every motion, in the order of the run.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct SelectionAtMotions {
    stretches: Vec<(Stood, u64)>,
    /// A digest of the changes that are not kept.
    rest: u64,
}

impl SelectionAtMotions {
    #[inline]
    pub(super) fn note(&mut self, stood: Stood) {
        match self.stretches.last_mut() {
            Some((last, count)) if *last == stood && self.rest == 0 => *count += 1,
            _ => self.change(stood),
        }
    }

    #[inline(never)]
    fn change(&mut self, stood: Stood) {
        if self.rest == 0 && self.stretches.len() < MOST {
            self.stretches.push((stood, 1));
            return;
        }
        // FNV-1a.
        let step = self.rest ^ stood.selected.digit() ^ stood.ways;
        self.rest = step.wrapping_mul(0x0100_0000_01b3).max(1);
    }

    /// Returns whether every motion of another run has the same selection as in this one, or the wanted one.
    pub(super) fn only_become(&self, after: &Self, wanted: Selected) -> bool {
        if self == after {
            return true;
        }
        if self.rest != 0 || after.rest != 0 {
            return false;
        }
        let (mut before, mut after) = (self.stretches.iter(), after.stretches.iter());
        let (mut old, mut new) = (before.next().copied(), after.next().copied());
        loop {
            let (Some((was, left)), Some((is, more))) = (old, new) else {
                return old.is_none() && new.is_none();
            };
            if was != is && is.selected != wanted {
                return false;
            }
            let common = left.min(more);
            let rest = |of: Stood, count: u64| (count > common).then(|| (of, count - common));
            old = rest(was, left).or_else(|| before.next().copied());
            new = rest(is, more).or_else(|| after.next().copied());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> SelectionAtMotions {
        let mut motions = SelectionAtMotions::default();
        for letter in text.chars() {
            let selected = match letter {
                '1' => Selected::On,
                '0' => Selected::Off,
                _ => Selected::Unknown,
            };
            motions.note(Stood::new(selected, None));
        }
        motions
    }

    #[test]
    fn motions_may_only_become_what_is_wanted() {
        // R10.8
        for (before, after, only) in [
            ("", "", true),
            ("1100", "1100", true),
            ("1100", "1111", true),
            ("0?0", "1?1", true),
            ("1100", "1000", false),
            ("110", "1100", false),
            ("11", "1?", false),
        ] {
            let found = of(before).only_become(&of(after), Selected::On);
            assert_eq!(found, only, "{before} {after}");
        }
    }
}
