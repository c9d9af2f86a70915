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
pub(in crate::interpreter) struct SourceUnit {
    pub(in crate::interpreter) index: Arc<Index>,
    /// Blocks that were executed more than once, parsed.
    pub(in crate::interpreter) kept: Vec<Option<Arc<Parsed>>>,
    /// Blocks below this one were executed before.
    pub(in crate::interpreter) high: EntryIndex,
    /// Executed blocks, where they are requested.
    pub(in crate::interpreter) executed: Vec<bool>,
    /// Control blocks whose branch is not known offline.
    pub(in crate::interpreter) undecided: BTreeSet<EntryIndex>,
    /// Regions that were passed over and tried (R2.51), apart from each other: first block and end.
    tried: BTreeMap<EntryIndex, EntryIndex>,
    /// Kinds of calls that may call any program of their kind: local subprograms `L`, those of G functions `G`.
    pub(in crate::interpreter) open_calls: BTreeSet<u8>,
    /// Whether a call of the file came back from its end (R17.2).
    pub(in crate::interpreter) returned: bool,
}

impl SourceUnit {
    pub(in crate::interpreter) fn new(index: Index) -> Self {
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
    pub(in crate::interpreter) fn take_untried(
        &mut self,
        region: Range<EntryIndex>,
    ) -> Vec<Range<EntryIndex>> {
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
