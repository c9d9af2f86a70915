//! The ways through the program: where they part, which is executed next, where they meet and end (R14.1).
//!
//! At a condition that only the machine knows, the run parts: each way continues with its own copy of the state of the
//! control. The way that is first in the text is executed first; ways that reach the same block are joined there. So each
//! block is executed once for all ways that lead to it, whatever the conditions before it (R14.4).

use std::collections::BTreeMap;

use crate::comp::{AxisIndex, Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::block::{LastBlock, OwnEnd};
use crate::interpreter::control::ControlState;
use crate::interpreter::drive::loops::watches;
use crate::interpreter::events::{EndedBy, ProgramEnd, StoppedState};
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::options::Branches;
use crate::interpreter::programs::calls::Finder;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::stack::ControlStep;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::others::OtherPaths;
use crate::interpreter::ways::path::{BranchSide, EndedPath, Meeting, Path};
use crate::interpreter::ways::possible_state::{change_since, shown, ways_of};
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::ways::words::{limit_to, of_axes};
use crate::language::Group;
use crate::text::in_a_row;

impl Executor {
    /// Continues with a way.
    pub(crate) fn enter_path(&mut self, path: Path) {
        let Path {
            control,
            track,
            parted: _,
        } = path;
        (self.state.control, self.state.track) = (control, track);
        self.state.watching = watches(&self.state.track);
        self.version += 1;
    }
}

impl OtherPaths {
    /// Continues with the way that is first in the text. Returns whether there is one.
    fn enter_first(&mut self, here: &mut Executor) -> bool {
        let first = self.waiting.take_first();
        first.map(|path| here.enter_path(path)).is_some()
    }

    /// Continues with the way that is first in the text, joined with those at the same block. Returns
    /// whether there are any.
    #[cold]
    pub(crate) fn choose_path(&mut self, here: &mut Executor) -> bool {
        let mut joined = false;
        loop {
            let first = self.waiting.first_from(&here.state.control.frames);
            if first.is_gt() {
                return joined;
            }
            let Some(other) = self.waiting.take_first() else {
                return joined;
            };
            if first.is_eq() {
                self.join_path(here, other);
                joined = true;
            } else {
                let mine = here.state.leave_path();
                here.enter_path(other);
                here.scratch.moves.forget_last();
                self.waiting.push(mine);
            }
        }
    }

    /// Joins another way that reaches the block that is executed next.
    pub(crate) fn join_path(&mut self, here: &mut Executor, mut other: Path) {
        let mut mine = here.state.leave_path();
        let parted = what_parts(&mine, &other);
        let condition = parted.and_then(|number| here.state.conditions.get(number as usize));
        let cause = condition.map_or_else(|| Unknown::Ways, |found| found.cause.clone());
        mine.undo_differing(&mut other);
        let before = [mine.control.clone(), other.control.clone()];
        for path in [&mine, &other] {
            here.charge_copies(&path.control, &path.track.reach);
        }
        let both_count = mine.track.failed.is_some() == other.track.failed.is_some();
        let differing = mine.join(other, &cause);
        here.state.work.charge_reading(ITEM * differing);
        here.enter_path(mine);
        here.scratch.moves.forget_last();
        if both_count {
            self.tell_join(here, &before, parted);
        }
        if self.waiting.is_empty() {
            here.state.track.shadow.moves_alone = false;
        }
    }

    /// Reports, once for each condition, what differs where two ways join (FC901).
    fn tell_join(&mut self, here: &mut Executor, sides: &[ControlState; 2], parted: Option<u32>) {
        let Some(condition) = parted.and_then(|number| {
            let found = here.state.conditions.get(number as usize);
            found.cloned()
        }) else {
            return;
        };
        let place = condition.place.clone();
        let mut kinds = here.state.control.differing_kinds(sides);
        for (kind, axes) in &mut kinds {
            axes.retain(|axis| {
                let key = (&place.file, place.first_line, kind, axis.get());
                here.state.is_new_word(&format!("{key:?}"))
            });
        }
        kinds.retain(|_, axes| !axes.is_empty());
        let mut keys = Vec::new();
        let mut shown = Vec::new();
        for (kind, axes) in &kinds {
            let names: Vec<&str> = axes
                .iter()
                .map(|axis| here.machine.axis(*axis).name.as_str())
                .collect();
            keys.extend(names.iter().map(|axis| format!("{kind} {axis}")));
            shown.push(of_axes(*kind, &names));
        }
        let [mine, theirs] = sides;
        let variables = mine.memory.differing_variables(&theirs.memory);
        let has_moved = here.options.takes_motions() && here.state.track.has_undecided_motion();
        let others = [
            (has_moved, "the motions on the way here"),
            (mine.couplings != theirs.couplings, "the axis couplings"),
            (
                mine.channel_axes != theirs.channel_axes,
                "the axes of the channel",
            ),
            (mine.cycles != theirs.cycles, "the modal cycles in force"),
            (
                differ_in_words(mine, theirs),
                "the modal G functions in force",
            ),
        ];
        let others = others.into_iter().filter(|(differ, _)| *differ);
        let named = variables.iter().map(|name| format!("`{name}`"));
        let named: Vec<String> = named
            .chain(others.map(|(_, name)| name.to_owned()))
            .collect();
        keys.extend(named.iter().cloned());
        let cause = &condition.cause;
        here.state.mentioned.enter(cause, || place.clone());
        let is_new = !keys.is_empty() && here.state.mentioned.is_new(cause, keys, &place);
        let mut said = about(&condition, &outcome_in_words(&shown, &named));
        here.state.limit_to_reach(&mut said, parted);
        // Whether an error ends the program is said at its block.
        if is_new && condition.kind != ConditionKind::Stop {
            self.joined.push(said);
        } else {
            self.joined_withheld.push(said);
        }
    }
}

impl RunState {
    /// Reports a condition that is asked on some ways only as such, whatever its own answer.
    pub(crate) fn limit_to_reach(&self, said: &mut Diagnostic, condition: Option<u32>) {
        let mut reach = self.track.reach.clone();
        if let Some(own) = condition {
            reach.havoc(own);
        }
        if !reach.is_always() {
            limit_to(said, &ways_of(&reach, &self.conditions));
        }
    }
}

impl ControlState {
    /// Returns the kinds in which two ways differ, with their axes.
    fn differing_kinds(&self, sides: &[ControlState; 2]) -> BTreeMap<Kind, Vec<AxisIndex>> {
        let mut kinds: BTreeMap<Kind, Vec<AxisIndex>> = BTreeMap::new();
        let [mine, theirs] = sides.each_ref().map(|control| &control.compensation);
        for axis in (0..mine.len()).map(AxisIndex::new) {
            for kind in self.compensation.unknown(axis).iter() {
                if mine.state(axis, kind) != theirs.state(axis, kind) {
                    kinds.entry(kind).or_default().push(axis);
                }
            }
        }
        kinds
    }
}

/// Returns whether two ways differ in G functions other than that of the motion.
fn differ_in_words(mine: &ControlState, theirs: &ControlState) -> bool {
    let differs = |group: &Group| mine.modal.differs_in(&theirs.modal, *group);
    let groups = Group::ALL.iter().filter(|group| **group != Group::Motion);
    groups.into_iter().any(differs)
}

/// Describes the differences where ways meet: kinds of compensation, and anything else.
fn outcome_in_words(kinds: &[String], others: &[String]) -> String {
    let switched = format!("{} may be on or off", in_a_row(kinds));
    let is_one = matches!(others, [only] if only.starts_with('`'));
    let verb = if is_one { "is" } else { "are" };
    let unknown = format!("{} {verb} not known", in_a_row(others));
    match (kinds, others) {
        ([_, ..], [_, ..]) => format!("{switched}, and {unknown}"),
        ([], _) => unknown,
        (_, []) => switched,
    }
}

fn about(condition: &Condition, outcome: &str) -> Diagnostic {
    let cause = &condition.cause;
    if let Some(kept) = &condition.kept {
        let file = &condition.place.file;
        let message = format!(
            "this condition has another answer only if {}: after it {outcome}",
            change_since(kept).in_words((file, condition.place.start().line), file)
        );
        let mut said = Diagnostic::new(Code::Fc901, condition.place.clone(), message);
        said.lower(Severity::Info);
        return said.with_help(cause.advice());
    }
    let asks = match condition.kind {
        ConditionKind::Skip(_) => format!(
            "whether the control executes the blocks of {cause} depends on a switch of the machine"
        ),
        ConditionKind::Probe => format!(
            "whether this jump is taken depends on {}",
            cause.seen_from(&condition.place.file)
        ),
        ConditionKind::Jump => {
            format!(
                "where this jump goes depends on {}",
                cause.seen_from(&condition.place.file)
            )
        }
        ConditionKind::Call(_) => {
            format!(
                "what this call leaves depends on {}",
                cause.seen_from(&condition.place.file)
            )
        }
        ConditionKind::Stop => format!("whether {cause} ends the program is not documented"),
        ConditionKind::Restart => "after this error the control is reset, or restarted".to_owned(),
        ConditionKind::Branch
        | ConditionKind::Case
        | ConditionKind::Loop
        | ConditionKind::Found(..)
        | ConditionKind::Search => {
            format!(
                "this condition depends on {}",
                cause.seen_from(&condition.place.file)
            )
        }
    };
    let message = format!("{asks}: after it {outcome}");
    Diagnostic::new(Code::Fc901, condition.place.clone(), message).with_help(cause.advice())
}

/// Returns the condition that separates two ways.
fn what_parts(mine: &Path, other: &Path) -> Option<u32> {
    let (mine, theirs) = (&mine.track.reach, &other.track.reach);
    let both: Vec<u32> = mine.conditions().chain(theirs.conditions()).collect();
    let deciding = both.iter().copied().filter(|number| {
        let answers = |ways: &WaySet| {
            ways.ways().iter().try_fold(0, |sides, way| {
                let found = way.iter().find(|answer| answer.condition == *number);
                found.map(|answer| sides | answer.sides)
            })
        };
        let pair = answers(mine).zip(answers(theirs));
        pair.is_some_and(|(mine, theirs)| mine & theirs == 0)
    });
    deciding.max().or_else(|| both.iter().copied().max())
}

impl OtherPaths {
    /// Ends a way. Returns the end of the run if no other way continues.
    #[cold]
    pub(crate) fn end_path(&mut self, here: &mut Executor, by: EndedBy) -> Option<EndedBy> {
        let is_covered = std::mem::take(&mut here.scratch.ending.covered);
        let is_alone = self.waiting.is_empty() && here.state.ended.is_empty();
        if is_alone {
            return Some(by);
        }
        if by == EndedBy::Budget && !here.scratch.ending.endless && !is_covered {
            // The effects of the other ways are not known.
            self.waiting.clear();
            here.state.ended.clear();
            here.havoc_all(&Unknown::Ways);
            return Some(by);
        }
        let never_ends = std::mem::take(&mut here.scratch.ending.endless);
        if never_ends {
            here.reset_after_stop();
            let said = here.scratch.ending.over.last();
            here.scratch.ending.at = said.map(|said| OwnEnd {
                place: said.place.clone(),
                is_passed_into: false,
            });
        }
        if !is_covered {
            if by == EndedBy::EndOfFile && !here.state.control.frames.is_empty() {
                let missing = here.state.missing_end().map(|mut missing| {
                    here.state.limit_to_reach(&mut missing, None);
                    missing
                });
                here.scratch.ending.over.extend(missing);
            }
            let ended = here.ended_path(by);
            here.state.ended.push(ended);
        }
        if self.enter_first(here) {
            here.scratch.moves.forget_last();
            return None;
        }
        let last = here.state.ended.pop()?;
        here.scratch.ending.at = last.at;
        here.state.last = last.last;
        here.enter_path(last.path);
        Some(last.by)
    }

    /// Joins the ways through the program at its end. Where the run has gone on after errors, one that an error has
    /// ended counts only if no other went on, and the states at the errors are apart (R9.20).
    #[cold]
    pub(crate) fn meet_ended(&mut self, here: &mut Executor, by: EndedBy) -> MetWays {
        if !std::mem::take(&mut here.scratch.ending.covered) {
            let own = here.ended_path(by);
            here.state.ended.push(own);
        }
        let ended = std::mem::take(&mut here.state.ended).into_iter().rev();
        let (failed, own): (Vec<_>, Vec<_>) =
            ended.partition(|end| end.path.track.failed.is_some());
        let is_stop = |end: &EndedPath| matches!(end.by, EndedBy::Error | EndedBy::Budget);
        let (mut stopped, mut all): (Vec<_>, Vec<_>) = own.into_iter().partition(is_stop);
        stopped.sort_by_key(|end| end.by != EndedBy::Error);
        let is_apart = all.is_empty() && !failed.is_empty();
        let apart = if is_apart {
            all = failed;
            stopped
        } else {
            all.append(&mut stopped);
            Vec::new()
        };
        let ends = here.state.ends_of(&all);
        let stopped = here.state.stopped(&apart);
        let mut ways = all.into_iter();
        let Some(EndedPath {
            path, by, at, last, ..
        }) = ways.next()
        else {
            return MetWays { by, ends, stopped };
        };
        let is_stop = matches!(by, EndedBy::Error | EndedBy::Budget);
        here.scratch.ending.endless = by == EndedBy::Budget;
        here.scratch.ending.at = at.filter(|_| !is_stop);
        here.state.last = last;
        here.enter_path(path);
        for other in ways {
            self.join_path(here, other.path);
        }
        MetWays { by, ends, stopped }
    }
}

/// The end of a program on whose ways it ended differently.
pub(crate) struct MetWays {
    pub(crate) by: EndedBy,
    /// Each end, that of the dry run first.
    pub(crate) ends: Vec<ProgramEnd>,
    /// The state at the errors after which the run went on.
    pub(crate) stopped: Option<StoppedState>,
}

impl RunState {
    /// Returns the places where ways end, each once.
    fn ends_of(&self, ended: &[EndedPath]) -> Vec<ProgramEnd> {
        let mut ends: Vec<ProgramEnd> = Vec::new();
        for end in ended {
            let place = end.at.as_ref().map(|at| at.place.clone());
            let Some(place) = place.or_else(|| end.last.as_ref().map(LastBlock::place)) else {
                continue;
            };
            let mut compensation = end.path.control.compensation.clone();
            let _ = compensation.program_end();
            if let Some(known) = ends.iter_mut().find(|it| it.place == place) {
                for axis in (0..compensation.len()).map(AxisIndex::new) {
                    let kinds = known.compensation.differing(&compensation, axis);
                    known.compensation.havoc(axis, kinds, &mut Vec::new());
                }
                continue;
            }
            let number = end.path.track.reach.conditions().max();
            let cause = number.and_then(|number| self.conditions.get(number as usize));
            ends.push(ProgramEnd {
                place,
                by: end.by,
                is_passed_into: end.at.as_ref().is_some_and(|at| at.is_passed_into),
                cause: cause
                    .filter(|_| !ends.is_empty())
                    .map(|found| found.cause.clone()),
                compensation,
            });
        }
        ends
    }

    /// Returns the state that errors leave, as one.
    fn stopped(&self, ended: &[EndedPath]) -> Option<StoppedState> {
        let mut ways = ended.iter().map(|end| end.path.clone());
        let mut all = ways.next()?;
        for way in ways {
            all.join(way, &Unknown::RemedyClass);
        }
        let mut control = all.control;
        let _ = control.compensation.program_end();
        let state = (&control.compensation, &control.history);
        Some(StoppedState {
            ends: self.ends_of(ended),
            possible: shown(state, &WaySet::always(), &self.conditions),
            history: control.history,
            compensation: control.compensation,
        })
    }
}

impl RunState {
    /// Returns FC310 at the last executed block; a program without any block is reported as such (R18.6).
    pub(crate) fn missing_end(&self) -> Option<Diagnostic> {
        let place = self.last.as_ref()?.place();
        let message = "the program ends here without M30 or M02";
        Some(Diagnostic::new(Code::Fc310, place, message).with_help("end it with `M30`"))
    }
}

impl OtherPaths {
    /// Parts the ways after the block that asked.
    #[cold]
    pub(crate) fn take_sides(
        &mut self,
        here: &mut Executor,
        step: Option<&ControlStep>,
        finder: &mut dyn Finder,
    ) {
        let sides = std::mem::take(&mut here.sides);
        let meeting = here.meeting(&sides);
        let base = here.state.leave_path();
        self.let_wait(here, sides, meeting, &base, step, finder);
        if self.waiting.is_empty() {
            // No answer is possible: the ways were merged too far to tell. The run can only continue.
            here.enter_path(base);
        } else {
            self.enter_first(here);
        }
    }

    /// Parts the ways that jump from the one on which the block itself leads elsewhere, which goes on.
    #[cold]
    pub(crate) fn take_jumps(&mut self, here: &mut Executor, finder: &mut dyn Finder) {
        let sides = std::mem::take(&mut here.sides);
        let meeting = here.meeting(&sides);
        let next = here.state.control.frames.running().map(|it| it.next);
        let (own, jumps): (Vec<_>, Vec<_>) =
            sides.into_iter().partition(|side| Some(side.to) == next);
        let mut base = here.state.leave_path();
        self.let_wait(here, jumps, meeting, &base, None, finder);
        if let Some(own) = own.first() {
            let ways = base.track.reach.and(&own.ways);
            if !ways.is_never() {
                base.track.reach = ways;
            }
        }
        here.enter_path(base);
        let ways = here.state.track.reach.clone();
        here.state.go_on_with(ways);
    }

    /// Sides of a question wait at their blocks.
    fn let_wait(
        &mut self,
        here: &mut Executor,
        sides: Vec<BranchSide>,
        meeting: Option<Meeting>,
        base: &Path,
        step: Option<&ControlStep>,
        finder: &mut dyn Finder,
    ) {
        let next = base.control.frames.running().map_or(0, |it| it.next);
        let mut open: Vec<Path> = Vec::new();
        // The answer of a user is the one way that is followed.
        let is_chosen = here.options.branches == Branches::OneFollowed && meeting.is_none();
        for side in sides {
            let ways = base.track.reach.and(&side.ways);
            if ways.is_never() {
                continue;
            }
            here.charge_copies(&base.control, &base.track.reach);
            here.enter_path(base.clone());
            here.state.track.reach = ways;
            let (to, is_back) = (side.to, side.to < next);
            here.state.apply_side(side);
            if let Some(meeting) = meeting.filter(|meeting| meeting.entry != to) {
                here.state.track.shadow.until.get_or_insert(meeting);
            }
            // Ways that lead back join at the loop's head, as other ways do.
            let goes_on = if is_back && !is_chosen {
                self.come_back(here, to, finder)
            } else {
                ControlStep::Jump(to)
            };
            if let ControlStep::Jump(to) = goes_on {
                here.state.control.set_next(to);
                // A program that the block calls runs on each way.
                if let Some(call @ ControlStep::Call(_)) = step
                    && self.follow(here, call.clone()).is_break()
                {
                    here.scratch.ending.covered = false;
                    continue;
                }
                open.push(here.state.leave_path());
            }
        }
        here.version += 1;
        for path in open {
            self.waiting.push(path);
        }
    }
}

impl Executor {
    /// Returns whether a user has chosen that the block jumps.
    pub(crate) fn is_jump_chosen(&self) -> bool {
        let next = self.state.control.frames.running().map(|it| it.next);
        self.options.branches == Branches::OneFollowed
            && matches!(self.sides.as_slice(), [only] if Some(only.to) != next)
    }

    /// Returns the block at which the sides of a question meet again, where one way is followed and the others are its
    /// shadows.
    fn meeting(&self, sides: &[BranchSide]) -> Option<Meeting> {
        if !self.options.follows_one_way() || sides.len() < 2 {
            return None;
        }
        let frames = &self.state.control.frames;
        let frame = frames.running()?;
        let marked = sides.iter().find_map(|side| side.marked);
        let index = self.programs.index(frame.unit);
        let asked = frames.entry().filter(|asked| index.is_linked(*asked));
        let entry = match (marked, asked) {
            (Some(marked), _) => marked.after,
            (None, Some(asked)) => index.links(asked).end + 1,
            (None, None) => frame.next,
        };
        Some(Meeting {
            depth: frames.depth(),
            unit: frame.unit,
            entry,
        })
    }
}

impl RunState {
    fn apply_side(&mut self, side: BranchSide) {
        let control = &mut self.control;
        if let Some(frame) = control.frames.running_mut() {
            frame.seeking = side.seeking;
        }
        if let Some((axis, kind, state)) = side.state {
            control.history.close(axis, KindSet::of(kind));
            control.compensation.decide(axis, kind, state);
        }
        control
            .history
            .narrow(&self.track.reach, &mut control.compensation);
        for (target, value) in &side.values {
            let track = &mut self.track;
            track
                .assumed
                .assume(&mut control.memory, target, value.clone());
        }
        if side.marked.is_some() {
            self.track.marked = side.marked;
        }
        self.track.labels = side.labels;
    }
}

impl ControlState {
    fn set_next(&mut self, to: EntryIndex) {
        if let Some(frame) = self.frames.running_mut() {
            frame.next = to;
        }
    }
}
