//! The states before and after each block of a run, in every pass through it (R12.3).

use std::collections::HashMap;
use std::sync::Arc;

use frictcomp::comp::{Kind, State};
use frictcomp::timeline::{Row, StateView};

/// Passes through one block that differ in their states; further ones are counted with the last.
const MOST_PASSES: u32 = 64;

/// The state of friction compensation of each axis of the machine; `None` where it is not listed.
pub(super) type StateSet = [Option<State>];

/// A number for a set of states.
type SetIndex = u32;

/// No further pass.
const NONE: u32 = u32::MAX;

/// Passes through a block with the same states.
#[derive(Debug, Clone, Copy)]
struct Visit {
    before: SetIndex,
    after: SetIndex,
    /// How often; 0 where the block was not executed.
    times: u32,
    /// The next pass with other states.
    next: u32,
}

const NEVER: Visit = Visit {
    before: 0,
    after: 0,
    times: 0,
    next: NONE,
};

/// The passes through the blocks of a file, by the lines on which they start, from 1.
#[derive(Debug)]
struct FileVisits {
    name: Arc<str>,
    lines: Vec<Visit>,
    further: Vec<Visit>,
}

/// Passes through a block with the same states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pass<'a> {
    /// The states before the block.
    pub(super) before: &'a StateSet,
    /// The states after it.
    pub(super) after: &'a StateSet,
    /// How often.
    pub(super) times: u32,
}

/// The states of a run.
#[derive(Debug, Default)]
pub(super) struct StateBook {
    axes: Vec<String>,
    sets: Vec<Box<StateSet>>,
    numbers: HashMap<Box<StateSet>, SetIndex>,
    /// The states now, and the version of the view that they were taken from.
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
    /// The states before the first block.
    pub(super) fn begin(&mut self, state: StateView<'_>) {
        if self.axes.is_empty() {
            let axes = state.machine.axes.iter();
            self.axes = axes.map(|axis| axis.name.clone()).collect();
        }
        self.now = self.number(state);
        self.version = Some(state.version);
    }

    /// Takes a block.
    #[inline]
    pub(super) fn block(&mut self, row: &Row<'_>) {
        let before = self.now;
        if self.version != Some(row.state.version) {
            self.version = Some(row.state.version);
            self.now = self.number(row.state);
        }
        let known = self.files.get(self.file).map(|it| &*it.name) == Some(row.file);
        if !known {
            self.file = self.file_of(row.file);
        }
        self.files[self.file].visit(row.line, (before, self.now));
        if row.level.is_none() {
            self.last = Some(row.line);
        }
    }

    /// The states when the program has ended.
    pub(super) fn end(&mut self, state: StateView<'_>) {
        self.now = self.number(state);
        self.version = Some(state.version);
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
        });
        self.files.len() - 1
    }

    #[cold]
    fn number(&mut self, state: StateView<'_>) -> SetIndex {
        let mut set: Box<StateSet> = vec![None; self.axes.len()].into();
        for (axis, _) in state.axes() {
            set[axis.get()] = Some(state.state(axis, Kind::Frict));
        }
        if let Some(number) = self.numbers.get(&set) {
            return *number;
        }
        let number = index(self.sets.len());
        self.sets.push(set.clone());
        self.numbers.insert(set, number);
        number
    }

    fn set(&self, number: SetIndex) -> &StateSet {
        self.sets
            .get(number as usize)
            .map(AsRef::as_ref)
            .unwrap_or_default()
    }

    /// The axes of the machine, in the order of a set.
    pub(super) fn axes(&self) -> &[String] {
        &self.axes
    }

    /// Whether a block of a file was executed.
    pub(super) fn has(&self, file: &str) -> bool {
        self.by_name.contains_key(file)
    }

    /// The passes through the block that starts on a line of a file, from 1.
    pub(super) fn passes(&self, file: &str, line: u32) -> Vec<Pass<'_>> {
        let visits = self.by_name.get(file).map(|at| &self.files[*at]);
        let visits = visits.into_iter().flat_map(|file| file.of(line));
        visits.map(|visit| self.pass(visit)).collect()
    }

    /// The line of the last executed block of a file that starts on a line or before it, from 1.
    pub(super) fn executed_up_to(&self, file: &str, line: u32) -> Option<u32> {
        let lines = &self.files[*self.by_name.get(file)?].lines;
        let end = lines.len().min(line as usize);
        let found = lines[..end].iter().rposition(|visit| visit.times > 0)?;
        u32::try_from(found + 1).ok()
    }

    /// The lines of the executed blocks of a file, from 1, each with all its passes.
    pub(super) fn executed(&self, file: &str) -> impl Iterator<Item = (u32, Vec<Pass<'_>>)> {
        let file = self.by_name.get(file).map(|at| &self.files[*at]);
        file.into_iter().flat_map(move |file| {
            let lines = file.lines.iter().zip(1..);
            let executed = lines.filter(|(first, _)| first.times > 0);
            executed
                .map(move |(_, line)| (line, file.of(line).map(|visit| self.pass(visit)).collect()))
        })
    }

    /// The lines of the blocks of a file that change a state, from 1, each with all its passes.
    pub(super) fn switching(&self, file: &str) -> impl Iterator<Item = (u32, Vec<Pass<'_>>)> {
        let file = self.by_name.get(file).map(|at| &self.files[*at]);
        file.into_iter().flat_map(move |file| {
            let lines = file.lines.iter().zip(1..);
            lines.filter_map(move |(first, line)| {
                let switches = |visit: &Visit| visit.before != visit.after;
                let plain = first.next == NONE && !switches(first);
                if first.times == 0 || plain || !file.of(line).any(|visit| switches(&visit)) {
                    return None;
                }
                Some((line, file.of(line).map(|visit| self.pass(visit)).collect()))
            })
        })
    }

    fn pass(&self, visit: Visit) -> Pass<'_> {
        Pass {
            before: self.set(visit.before),
            after: self.set(visit.after),
            times: visit.times,
        }
    }

    /// The states at the end, and the last line of the main program, from 1.
    pub(super) fn at_end(&self) -> (&StateSet, Option<u32>) {
        (self.set(self.now), self.last)
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
            *visit = Visit {
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
        self.further.push(Visit {
            before,
            after,
            times: 1,
            next: NONE,
        });
    }

    fn of(&self, line: u32) -> impl Iterator<Item = Visit> {
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
