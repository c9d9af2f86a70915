//! The ways through the program: which is executed next, and where they meet (R14.1).
//!
//! At a condition that only the machine knows, the run parts: each way continues with its own copy of
//! the state of the control. The way that is first in the text is executed first; ways that reach the
//! same block are joined there. So each block is executed once for all ways that lead to it, whatever
//! the conditions before it (R14.4).

use std::collections::BTreeMap;

use super::endless::watches;
use crate::comp::{AxisIndex, Kind};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::run::block_scratch::BlockScratch;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::path::Path;
use crate::interpreter::run::state::RunState;
use crate::interpreter::run::waiting_paths::FirstWaiting;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::possible_state::{change_since, ways_of};
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::ways::words::{limit_to, of_axes};
use crate::language::Group;

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
    pub(crate) fn enter_first(&mut self, here: &mut Executor) -> bool {
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
            if first == FirstWaiting::After {
                return joined;
            }
            let Some(other) = self.waiting.take_first() else {
                return joined;
            };
            if first == FirstWaiting::Here {
                self.join_path(here, other);
                joined = true;
            } else {
                let mine = here.state.leave_path();
                here.enter_path(other);
                here.scratch.havoc_last_motion();
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
        here.scratch.havoc_last_motion();
        if both_count {
            self.tell_join(here, &before, parted);
        }
        if self.waiting.is_empty() {
            here.state.track.shadow.moves_alone = false;
        }
    }

    /// Reports, once for each condition, what differs where two ways join (FC901).
    pub(crate) fn tell_join(
        &mut self,
        here: &mut Executor,
        sides: &[ControlState; 2],
        parted: Option<u32>,
    ) {
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
    /// A condition that is asked on some ways only is reported as such, whatever its own answer.
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

impl BlockScratch {
    /// The block before was executed on another way.
    pub(crate) fn havoc_last_motion(&mut self) {
        self.moved.clear();
        self.aside.last_moved.clear();
    }
}

impl ControlState {
    /// The kinds in which two ways differ, with their axes.
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

/// Whether two ways differ in G functions other than that of the motion.
fn differ_in_words(mine: &ControlState, theirs: &ControlState) -> bool {
    let differs = |group: &Group| mine.modal.differs_in(&theirs.modal, *group);
    let groups = Group::ALL.iter().filter(|group| **group != Group::Motion);
    groups.into_iter().any(differs)
}

/// What differs where ways meet: kinds of compensation, and anything else.
fn outcome_in_words(kinds: &[String], others: &[String]) -> String {
    let switched = format!("{} may be on or off", kinds.join(", "));
    let is_one = matches!(others, [only] if only.starts_with('`'));
    let verb = if is_one { "is" } else { "are" };
    let unknown = format!("{} {verb} not known", others.join(", "));
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

/// The condition that separates two ways.
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
