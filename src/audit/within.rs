//! The blocks that a run executed in one file.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::interpreter::Executed;

/// Number of blocks remembered before the end.
const LAST_BLOCKS: usize = 8;

/// The blocks that a run executed in one file and that a cure needs: those of the main program, or of a program that it
/// calls.
#[derive(Debug, Clone, Default)]
pub(super) struct Within {
    /// The called file; `None` for the main program.
    called: Option<Arc<str>>,
    /// The depth of the call while the file runs.
    depth: Option<u32>,
    /// The line of the first block.
    pub(super) first_line: Option<u32>,
    /// The lines of the last blocks before each return to the caller.
    pub(super) returns: BTreeSet<u32>,
    ring: [u32; LAST_BLOCKS],
    blocks: usize,
}

impl Within {
    /// Starts empty, for a file that the main program calls.
    pub(super) fn called(file: &Arc<str>) -> Self {
        Self {
            called: Some(Arc::clone(file)),
            ..Self::default()
        }
    }

    /// Whether the main program is observed.
    pub(super) fn is_of_main(&self) -> bool {
        self.called.is_none()
    }

    #[inline]
    pub(super) fn executed(&mut self, executed: &Executed<'_>) {
        match &self.called {
            None if executed.level.is_some() => {}
            None => self.block(executed.line),
            Some(_) => self.of_called(executed),
        }
    }

    #[inline]
    fn block(&mut self, line: u32) {
        self.first_line.get_or_insert(line);
        self.ring[self.blocks % LAST_BLOCKS] = line;
        self.blocks += 1;
    }

    fn of_called(&mut self, executed: &Executed<'_>) {
        let level = executed.level.unwrap_or_default();
        if self.depth.is_some_and(|depth| level > depth) {
            return;
        }
        let is_here = self.called.as_ref() == Some(executed.file);
        if !is_here {
            self.leave();
            return;
        }
        if self.depth != Some(level) {
            self.leave();
            self.depth = Some(level);
        }
        self.block(executed.line);
    }

    fn leave(&mut self) {
        if self.depth.take().is_some() {
            self.returns.extend(self.last_line());
        }
    }

    /// Ends the run, wherever it is.
    pub(super) fn ended(&mut self) {
        self.leave();
    }

    fn last_line(&self) -> Option<u32> {
        self.last_lines().next()
    }

    /// Returns the line of the file that is being executed or contains the call.
    pub(super) fn line(&self) -> Option<u32> {
        let runs = self.called.is_none() || self.depth.is_some();
        self.last_line().filter(|_| runs)
    }

    /// Returns the lines of the last executed blocks, the latest first.
    pub(super) fn last_lines(&self) -> impl Iterator<Item = u32> {
        let count = self.blocks.min(LAST_BLOCKS);
        (1..=count).map(|back| self.ring[(self.blocks - back) % LAST_BLOCKS])
    }
}
