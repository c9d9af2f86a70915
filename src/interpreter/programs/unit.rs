//! A file of a run: which of its blocks were executed, and those that are kept parsed.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
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
    /// Control blocks whose branch is not known offline.
    pub(crate) undecided: BTreeSet<EntryIndex>,
    /// Regions that were passed over and tried (R2.51), apart from each other: first block and end.
    tried: BTreeMap<EntryIndex, EntryIndex>,
    /// Kinds of calls that may call any program of their kind: local subprograms `L`, those of G functions `G`.
    pub(crate) open_calls: BTreeSet<u8>,
    /// Whether a call of the file came back from its end (R17.2).
    pub(crate) returned: bool,
}

impl SourceUnit {
    pub(crate) fn new(index: Index) -> Self {
        Self {
            kept: Vec::new(),
            high: 0,
            executed: vec![false; index.entries.len()],
            undecided: BTreeSet::new(),
            tried: BTreeMap::new(),
            open_calls: BTreeSet::new(),
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

    /// Takes the parts of a region that were not tried before, and marks them as tried.
    pub(crate) fn take_untried(&mut self, region: Range<EntryIndex>) -> Vec<Range<EntryIndex>> {
        if region.is_empty() {
            return Vec::new();
        }
        let (mut from, mut whole) = (region.start, region.clone());
        let mut untried = Vec::new();
        let before = self.tried.range(..=from).next_back();
        let first = before.map_or(from, |(start, _)| *start);
        let known = self.tried.range(first..region.end);
        let known = known.filter(|(_, end)| **end >= from);
        let known: Vec<_> = known.map(|(start, end)| (*start, *end)).collect();
        for (start, end) in known {
            self.tried.remove(&start);
            if from < start {
                untried.push(from..start);
            }
            from = from.max(end);
            whole = whole.start.min(start)..whole.end.max(end);
        }
        if from < region.end {
            untried.push(from..region.end);
        }
        self.tried.insert(whole.start, whole.end);
        untried
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
