//! The executed blocks of a run, each in a few bytes.

use std::collections::HashMap;

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::timeline::{Row, StateView};

/// So many blocks are kept for the timeline.
pub(crate) const MOST_ROWS: usize = 4_000_000;

/// One executed block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KeptRow {
    pub(crate) line: u32,
    pub(crate) states: u32,
    pub(crate) file: u16,
    /// How many lines it has.
    pub(crate) lines: u8,
    /// The depth of calls, 0 in the main program.
    pub(crate) level: u8,
}

/// The executed blocks, and the states after them.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    pub(crate) kept: Vec<KeptRow>,
    /// The rows that change a state.
    pub(crate) changed: Vec<u32>,
    /// The names of the files.
    pub(crate) files: Vec<String>,
    /// Every combination of states that occurs, the one at the start first.
    vectors: Vec<Vec<State>>,
    known: HashMap<Vec<State>, u32>,
    /// The states of the last row, and what they were made of.
    current: u32,
    version: Option<u64>,
    /// Executed blocks, also those beyond the kept ones.
    pub(crate) blocks: u64,
}

impl Rows {
    /// Takes a block.
    pub(crate) fn push(&mut self, row: &Row<'_>) {
        self.blocks += 1;
        let before = self.current;
        self.see(row.state);
        if self.kept.len() >= MOST_ROWS {
            return;
        }
        let file = self.file(row.file);
        let at = u32::try_from(self.kept.len()).unwrap_or(u32::MAX);
        if before != self.current {
            self.changed.push(at);
        }
        let breaks = row.text.bytes().filter(|byte| *byte == b'\n').count();
        self.kept.push(KeptRow {
            line: row.line,
            states: self.current,
            file,
            lines: u8::try_from(breaks + 1).unwrap_or(u8::MAX),
            level: u8::try_from(row.level.unwrap_or_default()).unwrap_or(u8::MAX),
        });
    }

    /// The states after a row; of those before the first row without a number.
    pub(crate) fn states(&self, row: Option<usize>) -> &[State] {
        let vector = row.map_or(0, |row| self.kept[row].states);
        let vector = usize::try_from(vector).unwrap_or(usize::MAX);
        self.vectors.get(vector).map_or(&[], Vec::as_slice)
    }

    /// The axes whose state a row changes.
    pub(crate) fn changes(&self, row: usize) -> Vec<usize> {
        let (before, after) = (self.states(row.checked_sub(1)), self.states(Some(row)));
        let axes = before.iter().zip(after).enumerate();
        axes.filter_map(|(axis, (before, after))| (before != after).then_some(axis))
            .collect()
    }

    fn file(&mut self, name: &str) -> u16 {
        let last = self.kept.last().map(|row| row.file);
        if let Some(last) = last
            && self.files[usize::from(last)] == name
        {
            return last;
        }
        let known = self.files.iter().position(|known| known == name);
        let at = known.unwrap_or_else(|| {
            self.files.push(name.to_owned());
            self.files.len() - 1
        });
        u16::try_from(at).unwrap_or(u16::MAX)
    }

    /// The states of the moment: after the end, those that the program leaves.
    pub(crate) fn current(&self) -> &[State] {
        let current = usize::try_from(self.current).unwrap_or(usize::MAX);
        self.vectors.get(current).map_or(&[], Vec::as_slice)
    }

    /// Makes the states of a moment the current ones; the first are those of the start.
    pub(crate) fn see(&mut self, state: StateView<'_>) {
        if self.version == Some(state.version) {
            return;
        }
        self.version = Some(state.version);
        let axes = 0..state.machine.axes.len();
        let vector: Vec<State> = axes
            .map(|axis| state.state(AxisIndex::new(axis), Kind::Frict))
            .collect();
        if let Some(&known) = self.known.get(&vector) {
            self.current = known;
            return;
        }
        self.current = u32::try_from(self.vectors.len()).unwrap_or(u32::MAX);
        self.known.insert(vector.clone(), self.current);
        self.vectors.push(vector);
    }
}
