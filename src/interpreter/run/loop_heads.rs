//! The states in which loops that only the machine ends begin their passes (R14.3).

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::path::Path;
use super::stack::{CallFrame, CallStack};
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::rows;

/// A block in its context: the blocks to which the calls return, then the block itself.
pub(crate) type HeadPlace = Vec<PlaceInCall>;

/// A block of a program that runs: its file, the block, the passes of the executed part that are left, and the calls
/// that come before the block.
pub(crate) type PlaceInCall = (usize, EntryIndex, u64, usize);

/// The state in which a loop begins its passes: the join of all of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LoopHead {
    /// The block that opens the loop, and the last one from which it goes back.
    pub(crate) blocks: RangeInclusive<EntryIndex>,
    pub(crate) state: Path,
}

/// The loops that are joined at their heads. The state of one is kept while a loop around it is repeated: a way that
/// adds nothing to it ends there, so that loops in one another do not multiply their passes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct LoopHeads(#[serde(with = "rows")] BTreeMap<HeadPlace, LoopHead>);

/// What a way adds to the head that it reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arrival {
    /// Nothing: earlier passes have done all that it may do.
    Covered,
    /// Something, with which the next pass begins.
    Grown,
}

impl LoopHeads {
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    pub(crate) fn states(&self) -> impl Iterator<Item = &Path> {
        self.0.values().map(|head| &head.state)
    }

    pub(crate) fn states_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.0.values_mut().map(|head| &mut head.state)
    }

    pub(crate) fn has(&self, place: &HeadPlace) -> bool {
        self.0.contains_key(place)
    }

    pub(crate) fn get(&self, place: &HeadPlace) -> Option<&LoopHead> {
        self.0.get(place)
    }

    pub(crate) fn insert(&mut self, place: HeadPlace, head: LoopHead) {
        self.0.insert(place, head);
    }

    /// A way reaches a head. Returns the state with what it adds.
    pub(crate) fn arrive(&mut self, place: &HeadPlace, way: Path) -> Option<(Arrival, &Path)> {
        let head = self.0.get_mut(place)?;
        let arrival = head.state.take_in(way, &Unknown::Passes);
        Some((arrival, &head.state))
    }

    /// Drops the heads among blocks of the running program, and in the programs that these blocks call.
    pub(crate) fn drop_within(&mut self, calls: &CallStack, blocks: &RangeInclusive<EntryIndex>) {
        let range = places(calls, blocks);
        self.0.retain(|place, _| !range.contains(place));
    }

    /// Drops the others.
    pub(crate) fn drop_without(&mut self, calls: &CallStack, blocks: &RangeInclusive<EntryIndex>) {
        let range = places(calls, blocks);
        self.0.retain(|place, _| range.contains(place));
    }
}

/// The place of a block of the running program.
pub(crate) fn head_place(calls: &CallStack, block: EntryIndex) -> HeadPlace {
    place_at(calls, calls.depth(), block)
}

/// The place of a block of the program at a depth of calls.
pub(crate) fn place_at(calls: &CallStack, depth: usize, block: EntryIndex) -> HeadPlace {
    let mut place: HeadPlace = calls.iter().take(depth).map(CallFrame::place).collect();
    if let Some(last) = place.last_mut() {
        last.1 = block;
    }
    place
}

impl CallFrame {
    /// The next block, which calls return to.
    pub(crate) fn place(&self) -> PlaceInCall {
        let left = self.passage.map_or(0, |passage| passage.left);
        (self.unit, self.next, left, self.waiting.len())
    }
}

/// The places of blocks of the running program, and of those that they call: a call returns to the block after it.
fn places(calls: &CallStack, blocks: &RangeInclusive<EntryIndex>) -> std::ops::Range<HeadPlace> {
    head_place(calls, *blocks.start())..head_place(calls, blocks.end().saturating_add(2))
}
