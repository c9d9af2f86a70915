//! Where a run stops: at lines, where a state changes, where a value is not known.

use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;

use super::paths::RealPaths;
use crate::interpreter::Executed;
use crate::syntax::ast::Block;
use crate::syntax::{BlockReader, FastPath};
use crate::text::TextLines;

/// Where the client wants a run to stop.
#[derive(Debug, Default)]
pub(super) struct Breakpoints {
    lines: HashMap<PathBuf, BTreeSet<u32>>,
    /// The axes whose changes of state stop it; all of them where the set is empty.
    changes: Option<BTreeSet<String>>,
    unknown: bool,
    paths: RealPaths,
}

/// The identifiers of the filters that a client can switch on.
pub(super) const STATE_CHANGES: &str = "state";
pub(super) const UNKNOWN_VALUES: &str = "unknown";

impl Breakpoints {
    /// Sets the lines of a file, and gives for each wanted line the one that a block stands on.
    pub(super) fn set_lines(
        &mut self,
        file: PathBuf,
        text: &str,
        wanted: &[u32],
    ) -> Vec<Option<u32>> {
        let starts = block_lines(text);
        let found: Vec<Option<u32>> = wanted
            .iter()
            .map(|line| starts.range(*line..).next().copied())
            .collect();
        self.lines
            .insert(file, found.iter().flatten().copied().collect());
        found
    }

    /// Takes the filters that the client switched on.
    pub(super) fn set_filters(&mut self, changes: Option<BTreeSet<String>>, unknown: bool) {
        self.changes = changes;
        self.unknown = unknown;
    }

    /// Whether a breakpoint stands on the line of a block.
    pub(super) fn is_on(&mut self, block: &Executed<'_>) -> bool {
        if self.lines.is_empty() {
            return false;
        }
        let lines = self.lines.get(self.paths.of(block.file));
        lines.is_some_and(|lines| lines.contains(&block.line))
    }

    /// Whether values that only the machine knows stop the run where they are read.
    pub(super) fn stops_at_unknown(&self) -> bool {
        self.unknown
    }

    /// Whether a change of state of this axis stops the run.
    pub(super) fn watches(&self, axis: &str) -> bool {
        self.changes
            .as_ref()
            .is_some_and(|axes| axes.is_empty() || axes.contains(axis))
    }
}

/// The lines on which blocks start, from 1.
fn block_lines(text: &str) -> BTreeSet<u32> {
    let mut reader = BlockReader::new(TextLines::new(text), 1, FastPath::On);
    let mut block = Block::default();
    let mut lines = BTreeSet::new();
    while let Some(found) = reader.next(&mut block) {
        lines.insert(found.line);
    }
    lines
}
