//! The executed blocks of a run, each in a few bytes.

use std::collections::HashMap;
use std::sync::Arc;

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::interpreter::PossibleStates;
use frictcomp::timeline::{Row, StateView};

/// The maximum number of blocks that are kept for the timeline.
pub(crate) const MOST_ROWS: usize = 4_000_000;

/// One executed block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KeptRow {
    pub(crate) line: u32,
    pub(crate) states: u32,
    pub(crate) file: u16,
    /// Number of lines of the block.
    pub(crate) lines: u8,
    /// The depth of calls, 0 in the main program.
    pub(crate) level: u8,
}

/// Friction compensation of all axes at a moment.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct FrictionStates {
    pub(crate) states: Vec<State>,
    /// The possible states where a state is unknown because ways differ (R14.2).
    possible: Vec<PossibleStates>,
}

impl FrictionStates {
    fn of(view: StateView<'_>) -> Self {
        let axes = (0..view.machine.axes.len()).map(AxisIndex::new);
        let possible = view.possible.iter();
        let possible = possible.filter(|it| it.kind == Kind::Frict).cloned();
        Self {
            states: axes.map(|axis| view.state(axis, Kind::Frict)).collect(),
            possible: possible.collect(),
        }
    }

    /// Returns the possible states of axes, by their positions, in words as seen from a file.
    pub(crate) fn possible(&self, file: &str) -> Vec<(usize, String)> {
        let possible = self.possible.iter();
        possible
            .map(|it| (it.axis.get(), it.in_words(file)))
            .collect()
    }
}

/// The executed blocks, and the states after them.
#[derive(Debug, Default)]
pub(crate) struct ExecutedRows {
    pub(crate) kept: Vec<KeptRow>,
    /// The rows after which the states differ from those after the row above.
    pub(crate) changed: Vec<u32>,
    /// The axes that rows switch, by their positions.
    switched: Vec<(u32, usize)>,
    /// The names of the files.
    pub(crate) files: Vec<String>,
    /// Every combination of states that occurs, the one at the start first.
    moments: Vec<Arc<FrictionStates>>,
    known: HashMap<Arc<FrictionStates>, u32>,
    /// The states of the last row, and what they were made from.
    current: u32,
    version: Option<u64>,
    /// Executed blocks, including those that are not kept.
    pub(crate) blocks: u64,
}

impl ExecutedRows {
    /// Adds a block.
    pub(crate) fn push(&mut self, row: &Row<'_>) {
        self.blocks += 1;
        let above = self.kept.last().map_or(0, |above| above.states);
        self.see(row.state);
        if self.kept.len() >= MOST_ROWS {
            return;
        }
        let file = self.file(row.file);
        let at = u32::try_from(self.kept.len()).unwrap_or(u32::MAX);
        if above != self.current {
            self.changed.push(at);
        }
        let switched = row.changes.iter().filter(|it| it.kind == Kind::Frict);
        let switched = switched.filter(|it| it.from != it.to);
        self.switched.extend(switched.map(|it| (at, it.axis.get())));
        let breaks = row.text.bytes().filter(|byte| *byte == b'\n').count();
        self.kept.push(KeptRow {
            line: row.line,
            states: self.current,
            file,
            lines: u8::try_from(breaks + 1).unwrap_or(u8::MAX),
            level: u8::try_from(row.level.unwrap_or_default()).unwrap_or(u8::MAX),
        });
    }

    /// Returns the states after a row; without a number, those before the first row.
    pub(crate) fn states(&self, row: Option<usize>) -> &[State] {
        self.moment(row).map_or(&[], |moment| &moment.states)
    }

    /// Returns the moment after a row; without a number, the one before the first row.
    pub(crate) fn moment(&self, row: Option<usize>) -> Option<&FrictionStates> {
        self.numbered(row.map_or(0, |row| self.kept[row].states))
    }

    fn numbered(&self, moment: u32) -> Option<&FrictionStates> {
        let moment = usize::try_from(moment).unwrap_or(usize::MAX);
        self.moments.get(moment).map(AsRef::as_ref)
    }

    /// Returns the axes whose state a row changes.
    pub(crate) fn changes(&self, row: usize) -> Vec<usize> {
        let row = u32::try_from(row).unwrap_or(u32::MAX);
        let from = self.switched.partition_point(|(at, _)| *at < row);
        let of_row = self.switched[from..].iter();
        let of_row = of_row.take_while(|(at, _)| *at == row);
        of_row.map(|(_, axis)| *axis).collect()
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

    /// Returns the states of the moment: after the end, those that the program leaves.
    pub(crate) fn current(&self) -> Option<&FrictionStates> {
        self.numbered(self.current)
    }

    /// Makes the states of a moment the current ones; the first are those of the start.
    pub(crate) fn see(&mut self, state: StateView<'_>) {
        if self.version == Some(state.version) {
            return;
        }
        self.version = Some(state.version);
        let moment = FrictionStates::of(state);
        if let Some(&known) = self.known.get(&moment) {
            self.current = known;
            return;
        }
        self.current = u32::try_from(self.moments.len()).unwrap_or(u32::MAX);
        let moment = Arc::new(moment);
        self.known.insert(Arc::clone(&moment), self.current);
        self.moments.push(moment);
    }
}
