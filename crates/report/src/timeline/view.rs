//! The blocks and kinds that a timeline shows.

use frictcomp::comp::{Kind, KindSet};
use frictcomp::timeline::Row;

/// The blocks that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Blocks {
    /// Every block.
    #[default]
    All,
    /// Only blocks that changed a state or have a message.
    Changed,
}

/// The content of a timeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct View {
    /// The blocks that are written.
    pub blocks: Blocks,
    /// The kinds of compensation whose changes are written.
    pub kinds: KindSet,
}

impl View {
    /// Sets [`blocks`](Self::blocks).
    pub fn with_blocks(mut self, blocks: Blocks) -> Self {
        self.blocks = blocks;
        self
    }

    /// Sets [`kinds`](Self::kinds).
    pub fn with_kinds(mut self, kinds: KindSet) -> Self {
        self.kinds = kinds;
        self
    }
}

impl Default for View {
    fn default() -> Self {
        Self {
            blocks: Blocks::All,
            kinds: KindSet::of(Kind::Frict),
        }
    }
}

impl View {
    /// Returns whether a block changed a selected kind, or there is a message about it.
    pub(crate) fn is_eventful(self, row: &Row<'_>) -> bool {
        !row.diagnostics.is_empty()
            || row
                .changes
                .iter()
                .any(|change| self.kinds.contains(change.kind))
    }

    /// Returns whether a block is written.
    pub(crate) fn shows(self, row: &Row<'_>) -> bool {
        self.blocks == Blocks::All || self.is_eventful(row)
    }
}
