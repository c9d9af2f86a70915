//! A way through a program (R14.1), from the block at which it is started (R2.96).
//!
//! A way that is executed beside the one that a motion or a debugger follows is its shadow (R14.8). It raises no event.
//! Where it joins the followed way, the axes that it moved stand at an unknown position: that stretch is not judged.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Compensation, Kind, Membership};
use crate::interpreter::block::{FailedAt, LastBlock, OwnEnd};
use crate::interpreter::control::ControlState;
use crate::interpreter::events::EndedBy;
use crate::interpreter::executor::RunState;
use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::stack::{CallFrame, CallStack, Seeking};
use crate::interpreter::values::externals::HeldVariable;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::plain::ConditionMeaning;
use crate::interpreter::values::rows;
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::history::History;
use crate::interpreter::ways::others::Arrival;
use crate::interpreter::ways::question::RememberedConditions;
use crate::interpreter::ways::set::WaySet;
use crate::syntax::VariableName;
use crate::syntax::ast::Owner;

/// The way of the run to its current block.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct RunTrack {
    /// The loops that were repeated, the outermost first.
    pub(crate) loops: Vec<Loop>,
    /// The answers of the machine that lead here.
    pub(crate) reach: WaySet,
    /// Conditions whose values nothing has written since they were asked.
    pub(crate) asked: Vec<AskedCondition>,
    /// Conditions on values of the machine whose answers may contradict later ones.
    pub(crate) readings: RememberedConditions,
    /// Values that follow from a condition on the way, with what they were before it.
    pub(crate) assumed: AssumedValues,
    /// The blocks with a skip mark that the way executes.
    pub(crate) marked: Option<Marked>,
    /// The loops whose condition was not known, by depth, file and opener.
    pub(crate) open_loops: BTreeSet<(usize, usize, EntryIndex)>,
    /// States before the program, until its searched block is reached.
    pub(crate) searching: Option<Box<EarlierStates>>,
    /// The error that has ended it, where the run goes on as if the failing command were not there (R9.20).
    #[serde(default)]
    pub(crate) failed: Option<Box<FailedAt>>,
    /// Relation to the followed way, where one is followed (R14.8).
    pub(crate) shadow: Shadow,
    /// The jump labels at which it continues, where it waits at the first of them and may also be at any other.
    pub(crate) labels: Option<Arc<[EntryIndex]>>,
}

/// A condition whose values only the program writes: asked again, it has the same answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct AskedCondition {
    pub(crate) condition: u32,
    pub(crate) meaning: Arc<ConditionMeaning>,
}

impl AskedCondition {
    /// Returns whether no value decides, so that it has one answer on all ways.
    pub(crate) fn reads_nothing(&self) -> bool {
        self.meaning.reads.is_empty()
    }
}

/// Adjacent blocks of one skip level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Marked {
    pub(crate) depth: usize,
    pub(crate) unit: usize,
    pub(crate) first: EntryIndex,
    pub(crate) after: EntryIndex,
}

/// Values that follow from conditions, with what was known before.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct AssumedValues(#[serde(with = "rows")] BTreeMap<Location, ValueBefore>);

/// Knowledge of a value before a condition.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ValueBefore {
    value: Option<Value>,
    /// Value set by the program, if the PLC had not acted since (R2.99).
    set: Option<HeldVariable>,
}

impl ValueBefore {
    /// Returns whether as much was known of a value, whatever the cause of an unknown one. A variable of the machine
    /// that was never written is as unknown as one that the PLC may have changed.
    fn is_like(&self, other: &Self, target: &Location, memory: &Memory) -> bool {
        let is_external = matches!(target, Location::Variable(name) if memory.may_change(name));
        let is_open = |it: &Self| match &it.value {
            Some(Value::Unknown(_)) => true,
            Some(_) => false,
            None => is_external,
        };
        self.set == other.set && (self.value == other.value || (is_open(self) && is_open(other)))
    }
}

impl AssumedValues {
    /// Assumes a value that applies on this way from here on.
    pub(crate) fn assume(&mut self, memory: &mut Memory, target: &Location, value: Value) {
        let before = match target {
            Location::Parameter(Owner::Program, index) => {
                let before = memory.parameter(*index);
                memory.set_parameter(*index, value);
                ValueBefore {
                    value: before,
                    set: None,
                }
            }
            Location::Variable(name) => {
                let before = ValueBefore {
                    value: memory.variable(name),
                    set: memory.release(name),
                };
                let told = before.set.as_ref().and_then(|held| held.with(&value));
                memory.set_variable(name, value);
                memory.hold_again(name, told);
                before
            }
            Location::Parameter(Owner::Call, _) | Location::Elements(_) | Location::Parameters => {
                return;
            }
        };
        self.0.entry(target.clone()).or_insert(before);
    }

    /// Withdraws the conclusions from conditions.
    pub(crate) fn undo(&mut self, memory: &mut Memory) {
        self.undo_but(&BTreeSet::new(), memory);
    }

    /// Withdraws those about variables that the PLC may write.
    pub(crate) fn undo_external(
        &mut self,
        is_it: impl Fn(&VariableName) -> bool,
        memory: &mut Memory,
    ) {
        let stays = |target: &&Location| !matches!(target, Location::Variable(name) if is_it(name) && memory.may_change(name));
        let kept = self.0.keys().filter(stays).cloned().collect();
        self.undo_but(&kept, memory);
    }

    /// Withdraws those about some variables that are not the value that the program itself had set.
    pub(crate) fn undo_of(&mut self, names: &[VariableName], memory: &mut Memory) {
        let stays = |target: &&Location| !matches!(target, Location::Variable(name) if names.contains(name) && memory.set_at(name).is_none());
        let kept = self.0.keys().filter(stays).cloned().collect();
        self.undo_but(&kept, memory);
    }

    fn undo_but(&mut self, kept: &BTreeSet<Location>, memory: &mut Memory) {
        let (stay, go) = std::mem::take(&mut self.0)
            .into_iter()
            .partition(|(target, _)| kept.contains(target));
        self.0 = stay;
        let go: BTreeMap<Location, ValueBefore> = go;
        for (target, before) in go {
            match (target, before.value) {
                (Location::Parameter(_, index), Some(value)) => {
                    memory.set_parameter(index, value);
                }
                (Location::Parameter(_, index), None) => memory.delete_parameter(index),
                (Location::Variable(name), Some(value)) => {
                    memory.set_variable(&name, value);
                    memory.hold_again(&name, before.set);
                }
                (Location::Variable(name), None) => memory.delete(&name),
                (Location::Elements(_) | Location::Parameters, _) => {}
            }
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

fn value_of(memory: &Memory, target: &Location) -> Option<Value> {
    match target {
        Location::Parameter(_, index) => memory.parameter(*index),
        Location::Variable(name) => memory.variable(name),
        Location::Elements(_) | Location::Parameters => None,
    }
}

impl RunTrack {
    /// Drops conclusions from conditions about a value that is written.
    #[inline]
    pub(crate) fn write(&mut self, location: &Location, memory: &mut Memory) {
        if !self.readings.is_empty() {
            self.readings.write(location);
        }
        if !self.asked.is_empty() || !self.assumed.is_empty() {
            self.havoc_written(location, memory);
        }
    }

    #[cold]
    fn havoc_written(&mut self, location: &Location, memory: &mut Memory) {
        if let Location::Elements(_) | Location::Parameters = location {
            return self.write_anything(memory);
        }
        self.assumed.0.remove(location);
        self.asked
            .retain(|asked| !asked.meaning.reads.contains(location));
    }

    /// Drops all conclusions, since anything may be written.
    pub(crate) fn write_anything(&mut self, memory: &mut Memory) {
        self.assumed.undo(memory);
        self.asked.clear();
        self.readings.clear();
    }

    /// Drops conclusions about the parameters and variables of the level, since another program runs.
    pub(crate) fn change_level(&mut self, depth: usize) {
        let is_own = |target: &Location| match target {
            Location::Parameter(owner, _) => *owner == Owner::Call,
            Location::Variable(name) => name.family().is_of_level(),
            Location::Elements(_) | Location::Parameters => true,
        };
        self.asked
            .retain(|asked| !asked.meaning.reads.iter().any(is_own));
        self.readings.havoc(is_own);
        self.open_loops.retain(|(of, ..)| *of <= depth);
    }

    /// Merges another way that reaches the same block.
    fn join(&mut self, other: &Self) {
        let Self {
            loops,
            reach,
            asked,
            // Joined before, using the conditions that both ways name.
            readings: _,
            // Undone before.
            assumed: _,
            marked,
            open_loops,
            searching,
            // In both or in none.
            failed: _,
            shadow,
            labels,
        } = other;
        if self.loops.len() < loops.len() {
            self.loops.clone_from(loops);
        }
        self.reach.or(reach);
        // A condition that reads nothing is not written on any way.
        self.asked
            .retain(|mine| asked.contains(mine) || mine.reads_nothing());
        for theirs in asked.iter().filter(|asked| asked.reads_nothing()) {
            if !self.asked.contains(theirs) {
                self.asked.push(theirs.clone());
            }
        }
        if self.marked != *marked {
            self.marked = None;
        }
        self.open_loops.extend(open_loops);
        if searching.is_none() {
            self.searching = None;
        }
        self.shadow.join(shadow);
        if self.labels.is_none() {
            self.labels.clone_from(labels);
        }
    }
}

/// A way through the program: the state of the control on it, and how it got there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Path {
    pub(crate) control: ControlState,
    pub(crate) track: RunTrack,
    /// The executed block at which it parted last.
    pub(crate) parted: u64,
}

impl Path {
    /// Joins another way that reaches the same block: what differs becomes unknown. Returns how many values do. Beside
    /// a way that the control may take, one that an error has ended does not count.
    pub(crate) fn join(&mut self, mut other: Self, cause: &Unknown) -> usize {
        if self.track.failed.is_some() != other.track.failed.is_some() {
            if self.track.failed.is_some() {
                *self = other;
            }
            return 0;
        }
        self.undo_differing(&mut other);
        self.join_readings(&other);
        let differing = self.control.join(
            &other.control,
            [&self.track.reach, &other.track.reach],
            cause,
        );
        self.track.join(&other.track);
        self.parted = self.parted.max(other.parted);
        differing
    }

    fn join_readings(&mut self, other: &Self) {
        if self.track.readings != other.track.readings {
            let named = [&self.conditions(), &other.conditions()];
            self.track.readings.join(&other.track.readings, named);
        }
    }

    /// Returns the conditions that its ways name.
    pub(crate) fn conditions(&self) -> BTreeSet<u32> {
        let named = self.control.history.conditions();
        named.chain(self.track.reach.conditions()).collect()
    }

    /// Withdraws conclusions from a condition that does not hold on both ways.
    pub(crate) fn undo_differing(&mut self, other: &mut Self) {
        let (mine, theirs) = (&mut self.track.assumed, &mut other.track.assumed);
        if !(mine.is_empty() && theirs.is_empty()) {
            let common = |(target, before): (&Location, &ValueBefore)| {
                let memories = [&self.control.memory, &other.control.memory];
                let now = memories.map(|memory| value_of(memory, target));
                let theirs = theirs.0.get(target).filter(|_| now[0] == now[1])?;
                let is_like = before.is_like(theirs, target, memories[0]);
                is_like.then(|| target.clone())
            };
            let common: BTreeSet<Location> = mine.0.iter().filter_map(common).collect();
            mine.undo_but(&common, &mut self.control.memory);
            theirs.undo_but(&common, &mut other.control.memory);
        }
    }

    /// Returns whether everything that another way may do from the same block is done on this one, too.
    pub(crate) fn covers(&self, other: &Self, cause: &Unknown) -> bool {
        let mut both = self.clone();
        both.join(other.clone(), cause);
        both.control == self.control && both.track.reach == self.track.reach
    }
}

impl Path {
    /// Joins another way that begins a pass of the loop at whose head this state is kept. The conditions that only that
    /// way has asked are left out of what leads here: they are asked in every pass.
    pub(crate) fn take_in(&mut self, way: Self, cause: &Unknown) -> Arrival {
        let named: BTreeSet<u32> = self.track.reach.conditions().collect();
        let mut reach = way.track.reach.clone();
        for condition in way.track.reach.conditions() {
            if !named.contains(&condition) {
                reach.havoc(condition);
            }
        }
        let mut both = self.clone();
        both.join(way, cause);
        both.track.reach.clone_from(&self.track.reach);
        both.track.reach.or(&reach);
        if both.control == self.control && both.track.reach == self.track.reach {
            return Arrival::Covered;
        }
        *self = both;
        Arrival::Grown
    }
}

impl RunState {
    /// Ends a way by an error. Ways that it ends at one block, in passes of a loop, are kept as one.
    pub(crate) fn end_way(&mut self, way: EndedPath) {
        let mut ended = self.ended.iter_mut().rev();
        let is_same = |it: &&mut EndedPath| {
            it.by == way.by
                && it.at == way.at
                && it.path.track.failed.is_some() == way.path.track.failed.is_some()
        };
        match ended.find(is_same) {
            Some(same) => _ = same.path.join(way.path, &Unknown::RemedyClass),
            None => self.ended.push(way),
        }
    }

    /// Returns the part of the way that later ways to the same block are compared with.
    pub(crate) fn arriving(&self) -> Path {
        let track = &self.track;
        Path {
            control: self.control.clone(),
            track: RunTrack {
                reach: track.reach.clone(),
                asked: track.asked.clone(),
                assumed: track.assumed.clone(),
                failed: track.failed.clone(),
                ..RunTrack::default()
            },
            parted: self.seq,
        }
    }
}

/// A way that has ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EndedPath {
    pub(crate) path: Path,
    pub(crate) by: EndedBy,
    pub(crate) at: Option<OwnEnd>,
    pub(crate) last: Option<LastBlock>,
}

/// Target of one answer of the machine.
#[derive(Debug, Clone)]
pub(crate) struct BranchSide {
    /// The ways on which it is given.
    pub(crate) ways: WaySet,
    pub(crate) to: EntryIndex,
    pub(crate) seeking: Option<Seeking>,
    /// Values that follow from it.
    pub(crate) values: Vec<(Location, Value)>,
    /// The state of a kind that follows from it.
    pub(crate) state: Option<(AxisIndex, Kind, Membership)>,
    pub(crate) marked: Option<Marked>,
    /// The jump labels at which it continues, where it may be any of them.
    pub(crate) labels: Option<Arc<[EntryIndex]>>,
}

impl BranchSide {
    /// Returns a side that leads to a block and implies nothing else.
    pub(crate) fn to(ways: WaySet, to: EntryIndex) -> Self {
        Self {
            ways,
            to,
            seeking: None,
            values: Vec::new(),
            state: None,
            marked: None,
            labels: None,
        }
    }
}

impl CallStack {
    /// Returns which of two ways is executed first: the one that comes first in the text, a called program before the
    /// rest of its caller. Ways at the same block are equal.
    pub(crate) fn order_of_execution(&self, other: &Self) -> Ordering {
        for (mine, theirs) in self.iter().zip(other.iter()) {
            match order(mine).cmp(&order(theirs)) {
                Ordering::Equal if mine.waiting != theirs.waiting => return Ordering::Greater,
                Ordering::Equal => {}
                order => return order,
            }
        }
        let running = [self, other].map(Self::running);
        let [mine, theirs] = running.map(|frame| frame.and_then(|frame| frame.seeking.as_ref()));
        let by_search = match mine {
            _ if mine == theirs => Ordering::Equal,
            None => Ordering::Less,
            Some(_) => Ordering::Greater,
        };
        other.depth().cmp(&self.depth()).then(by_search)
    }
}

/// Returns the key that orders two levels of call stacks.
fn order(frame: &CallFrame) -> impl Ord + use<> {
    let left = frame.passage.map_or(0, |passage| passage.left);
    let waiting = frame.waiting.len();
    (
        frame.unit,
        frame.section,
        Reverse(left),
        frame.next,
        Reverse(waiting),
        frame.level,
    )
}

/// A loop that was repeated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Loop {
    /// Number of nested calls down to the program that holds it.
    pub(crate) depth: usize,
    pub(crate) unit: usize,
    pub(crate) section: usize,
    /// The block that opens it, or to which it goes back, and the last one from which it does.
    pub(crate) head: EntryIndex,
    pub(crate) from: EntryIndex,
    /// The block with which a pass begins.
    pub(crate) target: EntryIndex,
    pub(crate) passes: u64,
    /// The executed block at which it was first repeated.
    pub(crate) since: u64,
    /// The state at the start of an earlier pass.
    pub(crate) mark: Option<Box<Mark>>,
    /// Counters, once it is known that nothing else changes any more.
    pub(crate) endless: Option<Vec<Location>>,
    /// The state at the beginning of the last pass, where the loop is left on some ways and followed (R14.3).
    pub(crate) last: Option<Box<Path>>,
}

impl Loop {
    /// Returns the section that contains it.
    pub(crate) fn program(&self) -> ProgramId {
        ProgramId {
            unit: self.unit,
            section: self.section,
        }
    }

    /// Returns its place among the loops whose condition is not known.
    pub(crate) fn place(&self) -> (usize, usize, EntryIndex) {
        (self.depth, self.unit, self.head)
    }

    /// Returns whether its counters are below a bound.
    pub(crate) fn fits(&self, bound: u64) -> bool {
        let marked = self.mark.as_ref().map_or(0, |mark| mark.pass);
        self.passes.max(marked) < bound
    }
}

impl Loop {
    /// Returns whether the loop contains a jump back, or is the one that jumps.
    pub(crate) fn is_around(&self, place: ProgramId, head: EntryIndex, from: EntryIndex) -> bool {
        let around = self.head < head && from <= self.from;
        self.program() == place && (self.head == head || around)
    }

    /// Returns whether the state is compared at this pass, or kept to be compared with.
    pub(crate) fn is_due(&self) -> bool {
        self.mark.is_some() || (self.passes >= FIRST_LOOK && self.passes.is_power_of_two())
    }
}

/// The state at the start of a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Mark {
    pub(crate) pass: u64,
    pub(crate) control: ControlState,
    pub(crate) occurred: Vec<bool>,
}

/// The pass after which a loop is first examined, then at each doubling.
const FIRST_LOOK: u64 = 32;

/// The states at an earlier block, which apply where the machine did not execute what follows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EarlierStates {
    pub(crate) compensation: Compensation,
    pub(crate) history: History,
}

/// The block at which the sides of a question meet: a side is a shadow up to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Meeting {
    /// Number of nested calls down to its program.
    pub(crate) depth: usize,
    pub(crate) unit: usize,
    pub(crate) entry: EntryIndex,
}

/// Relation of a way to the followed one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Shadow {
    /// Place at which the way is followed again; `None` for the followed way.
    pub(crate) until: Option<Meeting>,
    /// The axes that shadows may have moved since the last event.
    pub(crate) moved: BTreeSet<AxisIndex>,
    /// Whether the followed way has moved where another one did not go.
    pub(crate) moves_alone: bool,
}

impl Shadow {
    /// Merges another way that reaches the same block: they are followed if one of them is.
    pub(crate) fn join(&mut self, other: &Self) {
        if other.until.is_none() {
            self.until = None;
        }
        self.moved.extend(&other.moved);
        self.moves_alone |= other.moves_alone;
    }
}

impl RunTrack {
    /// Returns whether the way raises no events.
    #[inline]
    pub(crate) fn is_shadow(&self) -> bool {
        self.shadow.until.is_some()
    }

    /// Returns whether motions on the ways that lead here are not those of all ways.
    pub(crate) fn has_undecided_motion(&self) -> bool {
        self.shadow.moves_alone || !self.shadow.moved.is_empty()
    }

    /// Follows a shadow again that has come to the block at which the sides of its question meet, and so the last way
    /// that is left.
    #[inline]
    pub(crate) fn follow_again(&mut self, frames: &CallStack, is_last: bool) {
        let Some(meeting) = self.shadow.until else {
            return;
        };
        let is_there = frames.running().is_some_and(|frame| {
            (frames.depth(), frame.unit, frame.next) == (meeting.depth, meeting.unit, meeting.entry)
        });
        if is_last || is_there {
            self.shadow.until = None;
        }
    }
}
