//! A file of a run: which of its blocks were executed, and those that are kept parsed.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::index::{EntryIndex, Index};
use crate::syntax::ast::Block;
use crate::syntax::{Comments, Remark};

/// A file of the run.
#[derive(Clone)]
pub(in crate::interpreter) struct Unit {
    pub(in crate::interpreter) index: Arc<Index>,
    /// Blocks that were executed more than once, parsed.
    pub(in crate::interpreter) kept: Vec<Option<Arc<Parsed>>>,
    /// Blocks below this one were executed before.
    pub(in crate::interpreter) high: EntryIndex,
    /// Executed blocks, where they are requested.
    pub(in crate::interpreter) executed: Vec<bool>,
    /// Control blocks whose branch is not known offline.
    pub(in crate::interpreter) undecided: BTreeSet<EntryIndex>,
    /// First blocks of the regions that were passed over and tried (R2.51).
    pub(in crate::interpreter) tried: BTreeSet<EntryIndex>,
    /// Whether a call of the file came back from its end (R17.2).
    pub(in crate::interpreter) returned: bool,
}

impl Unit {
    pub(in crate::interpreter) fn new(index: Index) -> Self {
        Self {
            kept: Vec::new(),
            high: 0,
            executed: vec![false; index.entries.len()],
            undecided: BTreeSet::new(),
            tried: BTreeSet::new(),
            returned: false,
            index: Arc::new(index),
        }
    }
}

/// A parsed block with its text and its place.
pub(in crate::interpreter) struct Parsed {
    pub(in crate::interpreter) block: Block,
    /// Work of executing it again.
    pub(in crate::interpreter) weight: u64,
    pub(in crate::interpreter) file: Arc<str>,
    pub(in crate::interpreter) line: u32,
    pub(in crate::interpreter) text: String,
    pub(in crate::interpreter) comments: Comments,
    pub(in crate::interpreter) remark: Option<Remark>,
}
