//! The paths of a run beside the one that is executed: those that wait, in the order of the text, so that a block compares only
//! the first of them (R14.4); the states in which loops that only the machine ends begin their passes (R14.3); the effects of
//! programs that were called on other ways (R14.4).

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::diagnostic::Diagnostic;
use crate::interpreter::control::ControlState;
use crate::interpreter::executor::Executor;
use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::stack::{CallFrame, CallStack};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::rows;
use crate::interpreter::ways::path::Path;
use crate::interpreter::ways::set::WaySet;

/// The paths of a run beside the one that is executed: those that wait at their blocks, and the states in which others
/// were at the heads of loops and in calls.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct OtherPaths {
    pub(crate) waiting: WaitingPaths,
    /// The loops that are joined at their heads.
    pub(crate) loop_heads: LoopHeads,
    /// The effects of programs that were called on other ways.
    pub(crate) call_effects: CallEffects,
    /// Number of times that the program has used up its budget of ways.
    pub(crate) widened: u64,
    /// Messages on what came before the current block: paths that joined, a block that is not kept.
    #[serde(skip)]
    pub(crate) joined: Vec<Diagnostic>,
    /// Messages on what came before the current block that are withheld, because they were reported before or nothing
    /// differs.
    #[serde(skip)]
    pub(crate) joined_withheld: Vec<Diagnostic>,
}

impl OtherPaths {
    /// Lets the paths wait on which the run goes on elsewhere than after a block that it passes over.
    #[inline]
    pub(crate) fn let_leave(&mut self, here: &mut Executor) {
        if !here.scratch.left.is_empty() {
            here.scratch
                .left
                .drain(..)
                .for_each(|path| self.waiting.push(path));
        }
    }

    /// Returns the states that are kept of loops and calls.
    pub(crate) fn kept(&self) -> impl Iterator<Item = &Path> {
        self.loop_heads.states().chain(self.call_effects.states())
    }

    /// Returns the states of the control on all of them.
    pub(crate) fn controls_mut(&mut self) -> impl Iterator<Item = &mut ControlState> {
        let kept = self.loop_heads.states_mut();
        let kept = kept.chain(self.call_effects.states_mut());
        let paths = self.waiting.iter_mut().chain(kept);
        paths.map(|path| &mut path.control)
    }
}

/// The ways that wait; the one whose block comes first in the text is the last.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct WaitingPaths(Vec<Path>);

impl WaitingPaths {
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Path> {
        self.0.iter()
    }

    /// Returns the ways, whose places must stay as they are.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.0.iter_mut()
    }

    /// Takes all ways, the last of the text first.
    pub(crate) fn take_all(&mut self) -> Vec<Path> {
        std::mem::take(&mut self.0)
    }

    /// Adds a way that waits, after those that wait at the same block.
    pub(crate) fn push(&mut self, path: Path) {
        let frames = &path.control.frames;
        let is_later = |it: &Path| frames.order_of_execution(&it.control.frames).is_lt();
        let place = self.0.partition_point(is_later);
        self.0.insert(place, path);
    }

    /// Compares the first way with the block that would be executed next; `Greater` where no way waits.
    pub(crate) fn first_from(&self, here: &CallStack) -> Ordering {
        let first = self.0.last();
        first.map_or(Ordering::Greater, |path| {
            path.control.frames.order_of_execution(here)
        })
    }

    /// Takes the way whose block comes first in the text. One that may be at any of several labels goes on waiting at the
    /// next of them.
    pub(crate) fn take_first(&mut self) -> Option<Path> {
        let mut first = self.0.pop()?;
        if let Some(labels) = first.track.labels.take() {
            let here = first.control.frames.running().map_or(0, |frame| frame.next);
            let passed = labels.partition_point(|label| *label <= here);
            if let Some(next) = labels.get(passed) {
                let mut later = first.clone();
                if let Some(frame) = later.control.frames.running_mut() {
                    frame.next = *next;
                }
                later.track.labels = Some(labels);
                self.push(later);
            }
        }
        Some(first)
    }
}

/// A block in its context: the blocks to which the calls return, then the block itself.
pub(crate) type HeadPlace = Vec<PlaceInCall>;

/// A block of a program that runs: its file, the block, the passes of the executed part that are left, and the calls
/// that come before the block.
pub(crate) type PlaceInCall = (usize, EntryIndex, u64, usize);

/// The state in which a loop begins its passes: the join of all of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LoopHead {
    /// The block that opens the loop, and the last one from which it goes back.
    pub(crate) blocks: RangeInclusive<EntryIndex>,
    pub(crate) state: Path,
}

/// The loops that are joined at their heads. The state of one is kept while a loop around it is repeated: a way that
/// adds nothing to it ends there, so that loops in one another do not multiply their passes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct LoopHeads(#[serde(with = "rows")] BTreeMap<HeadPlace, LoopHead>);

/// Contribution of a way to the head that it reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arrival {
    /// No contribution: earlier passes have done all that it may do.
    Covered,
    /// Further states, with which the next pass begins.
    Grown,
}

impl LoopHeads {
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    pub(crate) fn states(&self) -> impl Iterator<Item = &Path> {
        self.0.values().map(|head| &head.state)
    }

    fn states_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.0.values_mut().map(|head| &mut head.state)
    }

    pub(crate) fn has(&self, place: &HeadPlace) -> bool {
        self.0.contains_key(place)
    }

    pub(crate) fn get(&self, place: &HeadPlace) -> Option<&LoopHead> {
        self.0.get(place)
    }

    pub(crate) fn insert(&mut self, place: HeadPlace, head: LoopHead) {
        self.0.insert(place, head);
    }

    /// Takes a way that reaches a head. Returns the state with what it adds.
    pub(crate) fn arrive(&mut self, place: &HeadPlace, way: Path) -> Option<(Arrival, &Path)> {
        let head = self.0.get_mut(place)?;
        let arrival = head.state.take_in(way, &Unknown::Passes);
        Some((arrival, &head.state))
    }

    /// Drops the heads among blocks of the running program, and in the programs that these blocks call. The passes of a
    /// `$FOR` begin at the block after its opener, which may open one of these loops.
    pub(crate) fn drop_within(&mut self, calls: &CallStack, blocks: &RangeInclusive<EntryIndex>) {
        let range = places(calls, blocks);
        let is_around = |place: &HeadPlace, head: &LoopHead| {
            place.len() == calls.depth() && head.blocks.start() < blocks.start()
        };
        self.0
            .retain(|place, head| !range.contains(place) || is_around(place, head));
    }

    /// Drops the others.
    pub(crate) fn drop_without(&mut self, calls: &CallStack, blocks: &RangeInclusive<EntryIndex>) {
        let range = places(calls, blocks);
        self.0.retain(|place, _| range.contains(place));
    }
}

/// Returns the place of a block of the running program.
pub(crate) fn head_place(calls: &CallStack, block: EntryIndex) -> HeadPlace {
    place_at(calls, calls.depth(), block)
}

/// Returns the place of a block of the program at a depth of calls.
pub(crate) fn place_at(calls: &CallStack, depth: usize, block: EntryIndex) -> HeadPlace {
    let mut place: HeadPlace = calls.iter().take(depth).map(CallFrame::place).collect();
    if let Some(last) = place.last_mut() {
        last.1 = block;
    }
    place
}

impl CallFrame {
    /// Returns the next block, which calls return to.
    pub(crate) fn place(&self) -> PlaceInCall {
        let left = self.passage.map_or(0, |passage| passage.left);
        (self.unit, self.next, left, self.waiting.len())
    }
}

/// Returns the places of blocks of the running program, and of those that they call: a call returns to the block after
/// it.
fn places(calls: &CallStack, blocks: &RangeInclusive<EntryIndex>) -> std::ops::Range<HeadPlace> {
    head_place(calls, *blocks.start())..head_place(calls, blocks.end().saturating_add(2))
}

/// A program, with the depth of calls at which it runs.
pub(crate) type CalledAt = (usize, ProgramId);

/// The effect of a program on the states in which it was called.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct CallEffect {
    /// The join of these states, with the called program alone on the call stack.
    entry: Path,
    /// The join of the states in which it came back, with an empty call stack; `None` where no way comes back.
    exit: Option<Path>,
    /// The blocks to which the last executed call returns.
    pub(crate) context: HeadPlace,
    /// The conditions by which the ways to the calls differ: the effect holds whatever their answers.
    left_out: BTreeSet<u32>,
}

impl CallEffect {
    pub(crate) fn of(entry: Path, context: HeadPlace) -> Self {
        Self {
            entry,
            exit: None,
            context,
            left_out: BTreeSet::new(),
        }
    }

    pub(crate) fn entry(&self) -> &Path {
        &self.entry
    }

    pub(crate) fn states(&self) -> impl Iterator<Item = &Path> {
        self.exit.iter().chain([&self.entry])
    }

    fn states_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.exit.iter_mut().chain([&mut self.entry])
    }

    /// Takes a call of the program in a further state.
    pub(crate) fn take_in(&mut self, way: Path, cause: &Unknown) -> Arrival {
        let mut both = self.entry.clone();
        let mut left_out = self.left_out.clone();
        let reach = &mut both.track.reach;
        for condition in reach
            .conditions()
            .collect::<BTreeSet<_>>()
            .into_iter()
            .rev()
        {
            if way.track.reach.is_within(reach) {
                break;
            }
            reach.havoc(condition);
            left_out.insert(condition);
        }
        let reach = reach.clone();
        let named: BTreeSet<u32> = reach.conditions().collect();
        let others = way.track.reach.conditions();
        left_out.extend(others.filter(|condition| !named.contains(condition)));
        both.join(way, cause);
        both.track.reach = reach;
        leave_out(&left_out, &mut both);
        if both.control == self.entry.control && both.track.reach == self.entry.track.reach {
            return Arrival::Covered;
        }
        (self.entry, self.left_out) = (both, left_out);
        Arrival::Grown
    }

    /// Merges a way that comes back from the last call.
    pub(crate) fn come_back(&mut self, way: Path, cause: &Unknown) {
        match &mut self.exit {
            Some(exit) => _ = exit.join(way, cause),
            None => self.exit = Some(way),
        }
    }

    /// Returns the state after the call on some ways; `None` where none of them comes back.
    pub(crate) fn after(&self, reach: &WaySet) -> Option<Path> {
        let mut exit = self.exit.clone()?;
        leave_out(&self.left_out, &mut exit);
        let mut reach = reach.clone();
        let before: BTreeSet<u32> = self.entry.conditions();
        for condition in exit.conditions().difference(&before) {
            reach.havoc(*condition);
        }
        exit.track.reach = reach.and(&exit.track.reach);
        if exit.track.reach.is_never() {
            return None;
        }
        let control = &mut exit.control;
        control
            .history
            .narrow(&exit.track.reach, &mut control.compensation);
        Some(exit)
    }
}

fn leave_out(conditions: &BTreeSet<u32>, state: &mut Path) {
    for condition in conditions {
        state.track.reach.havoc(*condition);
        state.control.history.havoc(*condition);
    }
}

/// The effects of programs, once following the ways through their calls takes much work: calls multiply their ways.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct CallEffects(#[serde(with = "rows")] BTreeMap<CalledAt, CallEffect>);

impl CallEffects {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn get_mut(&mut self, called: CalledAt) -> Option<&mut CallEffect> {
        self.0.get_mut(&called)
    }

    pub(crate) fn insert(&mut self, called: CalledAt, effect: CallEffect) {
        self.0.insert(called, effect);
    }

    pub(crate) fn remove(&mut self, called: CalledAt) {
        self.0.remove(&called);
    }

    pub(crate) fn states(&self) -> impl Iterator<Item = &Path> {
        self.0.values().flat_map(CallEffect::states)
    }

    fn states_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.0.values_mut().flat_map(CallEffect::states_mut)
    }
}

/// Returns the blocks to which the calls of a call stack down to a depth return.
pub(crate) fn context(calls: &CallStack, depth: usize) -> HeadPlace {
    let callers = calls.iter().take(depth.saturating_sub(1));
    callers.map(CallFrame::place).collect()
}
