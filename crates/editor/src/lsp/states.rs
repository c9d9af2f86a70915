//! The states before and after each block of a run, in every pass (R12.3).

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use frictcomp::comp::{Kind, State};
use frictcomp::interpreter::PossibleStates;
use frictcomp::timeline::{Join, Row, StateView};

/// Passes through one block that differ in their states; further ones are counted with the last.
const MOST_PASSES: u32 = 64;

/// Friction compensation of each axis of the machine at a moment.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct StateSet {
    /// The states; `None` where the axis is not listed.
    states: Vec<Option<State>>,
    /// Possible states if a state is unknown because ways differ (R14.2).
    possible: Vec<PossibleStates>,
}

static NOTHING: StateSet = StateSet {
    states: Vec::new(),
    possible: Vec::new(),
};

impl StateSet {
    fn of(state: StateView<'_>) -> Self {
        let mut states = vec![None; state.machine.axes.len()];
        for (axis, _) in state.axes() {
            states[axis.get()] = Some(state.state(axis, Kind::Frict));
        }
        let possible = state.possible.iter();
        let possible = possible.filter(|it| it.kind == Kind::Frict).cloned();
        Self {
            states,
            possible: possible.collect(),
        }
    }

    /// Returns the states before a block that leaves these.
    fn before(&self, row: &Row<'_>) -> Self {
        let mut found = self.clone();
        let changes = row.changes.iter().rev();
        for change in changes.filter(|it| it.kind == Kind::Frict) {
            found.states[change.axis.get()] = Some(change.from);
            found.possible.retain(|it| it.axis != change.axis);
        }
        found
    }

    /// Returns the state of an axis; `None` where it is not listed.
    pub(super) fn state(&self, axis: usize) -> Option<State> {
        self.states.get(axis).copied().flatten()
    }

    fn possible(&self, axis: usize) -> Option<&PossibleStates> {
        self.possible.iter().find(|it| it.axis.get() == axis)
    }

    /// Returns the state of an axis in words, as seen from a file: `active`, or
    /// `unknown (inactive if V.E.A == 2 (line 12), else active)`.
    pub(super) fn told(&self, axis: usize, file: &str) -> Option<String> {
        let state = self.state(axis)?;
        Some(match self.possible(axis) {
            Some(possible) => format!("{state} ({})", possible.in_words(file)),
            None => state.to_string(),
        })
    }
}

/// A number for a set of states.
type SetIndex = u32;

/// Mark for no further pass.
const NONE: u32 = u32::MAX;

/// Passes through a block with the same states.
#[derive(Debug, Clone, Copy)]
struct StateVisits {
    before: SetIndex,
    after: SetIndex,
    /// Number of executions; 0 for a block that was not executed.
    times: u32,
    /// The next pass with other states.
    next: u32,
}

const NEVER: StateVisits = StateVisits {
    before: 0,
    after: 0,
    times: 0,
    next: NONE,
};

/// The passes through the blocks of a file, by the lines on which they start, from 1.
#[derive(Debug)]
struct FileVisits {
    name: Arc<str>,
    lines: Vec<StateVisits>,
    further: Vec<StateVisits>,
    /// Blocks before which ways meet: the states on the last way, and those where they meet.
    met: BTreeMap<u32, Vec<(SetIndex, SetIndex)>>,
}

/// Passes through a block with the same states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pass<'a> {
    /// The states before the block.
    pub(super) before: &'a StateSet,
    /// The states after it.
    pub(super) after: &'a StateSet,
    /// Number of executions.
    pub(super) times: u32,
}

/// The states of a run.
#[derive(Debug, Default)]
pub(super) struct StateBook {
    axes: Vec<String>,
    sets: Vec<Arc<StateSet>>,
    numbers: HashMap<Arc<StateSet>, SetIndex>,
    /// The current states, and the version of the view that they were taken from.
    now: SetIndex,
    version: Option<u64>,
    files: Vec<FileVisits>,
    by_name: HashMap<Arc<str>, usize>,
    /// The file of the last block.
    file: usize,
    /// The last line of the main program that was reached.
    last: Option<u32>,
}

impl StateBook {
    /// Takes the states before the first block.
    pub(super) fn begin(&mut self, state: StateView<'_>) {
        if self.axes.is_empty() {
            let axes = state.machine.axes.iter();
            self.axes = axes.map(|axis| axis.name.clone()).collect();
        }
        self.see(state);
    }

    /// Takes a block.
    #[inline]
    pub(super) fn block(&mut self, row: &Row<'_>) {
        let mut before = self.now;
        if self.version != Some(row.state.version) {
            self.see(row.state);
            if row.branch.is_some() {
                before = self.before(row, before);
            }
        }
        self.enter(row.file);
        self.files[self.file].visit(row.line, (before, self.now));
        if row.level.is_none() {
            self.last = Some(row.line);
        }
    }

    /// Takes a place where ways meet.
    #[cold]
    pub(super) fn join(&mut self, join: &Join<'_>) {
        let before = self.now;
        self.see(join.state);
        if before == self.now {
            return;
        }
        self.enter(join.file);
        let met = self.files[self.file].met.entry(join.line).or_default();
        if met.len() < MOST_PASSES as usize && !met.contains(&(before, self.now)) {
            met.push((before, self.now));
        }
    }

    /// Takes the states at the end of the program.
    pub(super) fn end(&mut self, state: StateView<'_>) {
        self.see(state);
    }

    fn see(&mut self, state: StateView<'_>) {
        self.now = self.number(StateSet::of(state));
        self.version = Some(state.version);
    }

    /// Returns the states before a block of a branch, whose first block does not follow the one executed
    /// before it.
    #[cold]
    fn before(&mut self, row: &Row<'_>, last: SetIndex) -> SetIndex {
        let found = self.set(self.now).before(row);
        if found.states == self.set(last).states {
            last
        } else {
            self.number(found)
        }
    }

    #[inline]
    fn enter(&mut self, file: &str) {
        let known = self.files.get(self.file).map(|it| &*it.name) == Some(file);
        if !known {
            self.file = self.file_of(file);
        }
    }

    #[cold]
    fn file_of(&mut self, name: &str) -> usize {
        if let Some(at) = self.by_name.get(name) {
            return *at;
        }
        let name: Arc<str> = name.into();
        self.by_name.insert(Arc::clone(&name), self.files.len());
        self.files.push(FileVisits {
            name,
            lines: Vec::new(),
            further: Vec::new(),
            met: BTreeMap::new(),
        });
        self.files.len() - 1
    }

    #[cold]
    fn number(&mut self, set: StateSet) -> SetIndex {
        if let Some(number) = self.numbers.get(&set) {
            return *number;
        }
        let number = index(self.sets.len());
        let set = Arc::new(set);
        self.sets.push(Arc::clone(&set));
        self.numbers.insert(set, number);
        number
    }

    fn set(&self, number: SetIndex) -> &StateSet {
        self.sets
            .get(number as usize)
            .map_or(&NOTHING, AsRef::as_ref)
    }

    /// Returns the axes of the machine, in the order of a set.
    pub(super) fn axes(&self) -> &[String] {
        &self.axes
    }

    /// Returns whether a block of a file was executed.
    pub(super) fn has(&self, file: &str) -> bool {
        self.by_name.contains_key(file)
    }

    /// Returns the passes through the block that starts on a line of a file, from 1.
    pub(super) fn passes(&self, file: &str, line: u32) -> Vec<Pass<'_>> {
        let visits = self.by_name.get(file).map(|at| &self.files[*at]);
        let visits = visits.into_iter().flat_map(|file| file.of(line));
        visits.map(|visit| self.pass(visit)).collect()
    }

    /// Returns the line of the last executed block of a file that starts on a line or before it, from 1.
    pub(super) fn executed_up_to(&self, file: &str, line: u32) -> Option<u32> {
        let lines = &self.files[*self.by_name.get(file)?].lines;
        let end = lines.len().min(line as usize);
        let found = lines[..end].iter().rposition(|visit| visit.times > 0)?;
        u32::try_from(found + 1).ok()
    }

    /// Returns the lines of the executed blocks of a file, from 1, each with all its passes.
    pub(super) fn executed(&self, file: &str) -> impl Iterator<Item = (u32, Vec<Pass<'_>>)> {
        let file = self.by_name.get(file).map(|at| &self.files[*at]);
        file.into_iter().flat_map(move |file| {
            let lines = file.lines.iter().zip(1..);
            let executed = lines.filter(|(first, _)| first.times > 0);
            executed
                .map(move |(_, line)| (line, file.of(line).map(|visit| self.pass(visit)).collect()))
        })
    }

    /// Returns the lines of the blocks of a file that change a state, from 1, each with all its passes.
    pub(super) fn switching(&self, file: &str) -> impl Iterator<Item = (u32, Vec<Pass<'_>>)> {
        let file = self.by_name.get(file).map(|at| &self.files[*at]);
        file.into_iter().flat_map(move |file| {
            let lines = file.lines.iter().zip(1..);
            lines.filter_map(move |(first, line)| {
                let switches = |visit: &StateVisits| visit.before != visit.after;
                let plain = first.next == NONE && !switches(first);
                if first.times == 0 || plain || !file.of(line).any(|visit| switches(&visit)) {
                    return None;
                }
                Some((line, file.of(line).map(|visit| self.pass(visit)).collect()))
            })
        })
    }

    /// Returns the lines of the blocks of a file before which ways meet, from 1, each with the states that become
    /// unknown there, in words.
    pub(super) fn meeting(&self, file: &str) -> impl Iterator<Item = (u32, String)> {
        let met = self.by_name.get(file).map(|at| &self.files[*at].met);
        let met = met.into_iter().flatten();
        met.filter_map(move |(line, passes)| {
            let axes = self.axes.iter().enumerate();
            let told = axes.filter_map(|(at, axis)| Some((axis, self.meets(at, passes, file)?)));
            let told: Vec<String> = told.map(|(axis, told)| format!("{axis}: {told}")).collect();
            (!told.is_empty()).then(|| (*line, told.join(", ")))
        })
    }

    /// Returns the states that become possible for an axis where ways join; only `unknown` where
    /// passes differ.
    fn meets(&self, axis: usize, passes: &[(SetIndex, SetIndex)], file: &str) -> Option<String> {
        let joined = passes.iter().filter_map(|(before, after)| {
            let (before, after) = (self.set(*before), self.set(*after));
            let possible = after.possible(axis)?;
            (before.possible(axis) != Some(possible)).then(|| after.told(axis, file))?
        });
        let mut joined: Vec<String> = joined.collect();
        joined.dedup();
        match joined.as_slice() {
            [] => None,
            [told] => Some(told.clone()),
            _ => Some(State::Unknown.to_string()),
        }
    }

    fn pass(&self, visit: StateVisits) -> Pass<'_> {
        Pass {
            before: self.set(visit.before),
            after: self.set(visit.after),
            times: visit.times,
        }
    }

    /// Returns the states at the end.
    pub(super) fn at_end(&self) -> &StateSet {
        self.set(self.now)
    }

    /// Returns the last line of the main program that was reached, from 1.
    pub(super) fn last(&self) -> Option<u32> {
        self.last
    }
}

impl FileVisits {
    #[inline]
    fn visit(&mut self, line: u32, (before, after): (SetIndex, SetIndex)) {
        let at = line.saturating_sub(1) as usize;
        if at >= self.lines.len() {
            self.lines.resize(at + 1, NEVER);
        }
        let visit = &mut self.lines[at];
        if visit.times == 0 {
            *visit = StateVisits {
                before,
                after,
                times: 1,
                next: NONE,
            };
        } else if (visit.before, visit.after) == (before, after) {
            visit.times = visit.times.saturating_add(1);
        } else {
            self.visit_again(at, (before, after));
        }
    }

    #[cold]
    fn visit_again(&mut self, at: usize, (before, after): (SetIndex, SetIndex)) {
        let (mut next, mut passes) = (self.lines[at].next, 1);
        let mut last = None;
        while let Some(visit) = self.further.get_mut(next as usize) {
            passes += 1;
            if (visit.before, visit.after) == (before, after) || passes == MOST_PASSES {
                visit.times = visit.times.saturating_add(1);
                return;
            }
            last = Some(next);
            next = visit.next;
        }
        let new = index(self.further.len());
        match last.and_then(|last| self.further.get_mut(last as usize)) {
            Some(last) => last.next = new,
            None => self.lines[at].next = new,
        }
        self.further.push(StateVisits {
            before,
            after,
            times: 1,
            next: NONE,
        });
    }

    fn of(&self, line: u32) -> impl Iterator<Item = StateVisits> {
        let first = self.lines.get(line.saturating_sub(1) as usize).copied();
        let first = first.filter(|visit| visit.times > 0);
        std::iter::successors(first, |visit| {
            self.further.get(visit.next as usize).copied()
        })
    }
}

fn index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(NONE - 1)
}
