//! A file of a run: which of its blocks were executed, and those that are kept parsed.

use std::sync::Arc;

use super::index::{EntryIndex, Index};
use super::weight::weight;
use crate::syntax::ast::Block;
use crate::syntax::{Comments, Remark, Stretch};

/// A file of the run.
#[derive(Clone)]
pub(crate) struct SourceUnit {
    pub(crate) index: Arc<Index>,
    /// Blocks that were executed more than once, parsed.
    pub(crate) kept: Vec<Option<Arc<Parsed>>>,
    /// Blocks below this one were executed before.
    pub(crate) high: EntryIndex,
    /// Executed blocks, where they are requested.
    pub(crate) executed: Vec<bool>,
    /// Whether a call of the file came back from its end (R17.2).
    pub(crate) returned: bool,
}

impl SourceUnit {
    pub(crate) fn new(index: Index) -> Self {
        Self {
            kept: Vec::new(),
            high: 0,
            executed: vec![false; index.entries.len()],
            returned: false,
            index: Arc::new(index),
        }
    }

    pub(super) fn parse(&self, entry: EntryIndex) -> Parsed {
        let mut block = Block::default();
        let mut text = String::new();
        let mut comments = Comments::Possible;
        let mut remark = None;
        if let Some(mut reader) = self.index.reader(entry)
            && let Some(raw) = reader.next(&mut block)
        {
            debug_assert_eq!(raw.stretch, Stretch::Block);
            raw.text.clone_into(&mut text);
            comments = raw.comments;
            remark = raw.remark.cloned();
        }
        Parsed {
            weight: weight(&block, &text),
            block,
            file: Arc::clone(self.index.source.name()),
            line: self.index.entries[entry as usize].line,
            text,
            comments,
            remark: remark.or_else(|| self.index.remark(entry)),
        }
    }
}

/// A parsed block with its text and its place.
pub(crate) struct Parsed {
    pub(crate) block: Block,
    /// Work of executing it again.
    pub(crate) weight: u64,
    pub(crate) file: Arc<str>,
    pub(crate) line: u32,
    pub(crate) text: String,
    pub(crate) comments: Comments,
    pub(crate) remark: Option<Remark>,
}
