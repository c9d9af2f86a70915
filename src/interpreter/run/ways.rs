//! Ways that the control may take and the dry run does not (R2.51, R2.52): a jump, a return or a
//! program end that depends on a value that is not known offline.
//!
//! Such a way is kept with the state in which it leaves. At the block where it joins the way of the
//! dry run again, everything in which the two may differ becomes unknown. A way that would end the
//! program joins at program end.

use std::collections::{BTreeMap, VecDeque};

use serde::{Deserialize, Serialize};

use super::channel_axes::ChannelAxes;
use super::cycles::ModalCycles;
use super::event::EndedBy;
use crate::comp::KindSet;
use crate::interpreter::coordinates::modal::Modal;
use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::rows;
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::history::History;
use crate::text::Span;

/// The target of a way that returns to the caller.
pub(crate) const RETURN: EntryIndex = EntryIndex::MAX;

/// Different targets beyond which everything counts as written.
const MAX_WRITTEN: usize = 4096;

/// All the ways that the control may have taken.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Ways {
    /// Sorted by depth and target, one for each.
    pub(crate) open: VecDeque<OpenPath>,
    /// The ways that ended the program, as one.
    pub(crate) end: Option<Box<OpenPath>>,
    /// Ends of the program on these ways.
    #[serde(default)]
    pub(crate) ends: Vec<WayEnd>,
    /// The state at the end of the dry run, before the other ways made it unknown.
    #[serde(default)]
    pub(crate) own: Option<Vec<AxisKinds>>,
    /// Writes since the first of them left, and the block of the last write.
    pub(crate) written: WrittenTargets,
    /// The block that may have written anything.
    pub(crate) everything: u64,
}

/// Limit of the program ends kept that the dry run does not reach.
const MAX_ENDS: usize = 64;

/// A program end that the dry run does not reach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct WayEnd {
    /// The block, and the unit that holds it.
    pub(crate) place: (usize, EntryIndex),
    pub(crate) by: EndedBy,
    /// Value that decides whether the program ends there.
    pub(crate) cause: Unknown,
    /// Selections that are possible there.
    pub(crate) kinds: Vec<AxisKinds>,
}

/// Targets with the executed block that wrote them last.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct WrittenTargets(#[serde(with = "rows")] pub(crate) BTreeMap<Location, u64>);

/// A way that left the one of the dry run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct OpenPath {
    /// Number of nested calls at its target.
    pub(crate) depth: usize,
    /// The block where it continues.
    pub(crate) target: EntryIndex,
    /// The executed block at which it left.
    pub(crate) since: u64,
    /// The executed block at which it left last, where it left several times.
    pub(crate) latest: u64,
    pub(crate) cause: Unknown,
    pub(crate) state: PathState,
    /// Blocks that it executes before it reaches the target.
    pub(crate) tails: Vec<Remainder>,
}

/// The part of a state that is kept for a way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PathState {
    /// Selected and unknown kinds, by axis.
    pub(crate) kinds: Vec<AxisKinds>,
    /// The blocks that switched them.
    pub(crate) history: History,
    pub(crate) modal: Modal,
    pub(crate) cycles: ModalCycles,
    /// The couplings, by the number of their changes.
    pub(crate) couplings: u64,
    pub(crate) named: BTreeMap<String, Value>,
    pub(crate) channel_axes: ChannelAxes,
    /// The macros, by the number of their changes.
    pub(crate) macros: u64,
}

/// Selected and unknown kinds of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct AxisKinds {
    pub(crate) selected: KindSet,
    pub(crate) unknown: KindSet,
}

impl AxisKinds {
    /// The kinds in which two states may differ.
    pub(crate) fn differing(self, other: Self) -> KindSet {
        let (mine, theirs) = (self.selected, other.selected);
        let differ = mine.without(theirs).union(theirs.without(mine));
        differ.union(self.unknown).union(other.unknown)
    }
}

/// A section from a block on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(crate) struct Remainder {
    pub(crate) unit: usize,
    pub(crate) section: usize,
    pub(crate) from: EntryIndex,
}

/// A way that leaves at the block being executed.
#[derive(Debug, Clone)]
pub(crate) struct Branch {
    pub(crate) to: JumpTarget,
    pub(crate) cause: Unknown,
    /// The block after what is passed over.
    pub(crate) here: EntryIndex,
    /// Span for the message on it, until it is reported.
    pub(crate) say: Option<Span>,
}

/// Target of a way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum JumpTarget {
    Block(EntryIndex),
    Return,
    /// A return over programs.
    Far,
    End,
}

/// Exit of a way from a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Leaving {
    /// To a block of the same program.
    To(EntryIndex),
    /// To the caller.
    Return,
    /// The program ends.
    End,
}

/// A way out of a loop, and the value that decides whether it is taken.
#[derive(Debug, Clone)]
pub(crate) struct WayOut {
    pub(crate) to: Leaving,
    pub(crate) cause: Unknown,
}

impl Ways {
    /// Whether any way is open.
    #[inline]
    pub(crate) fn is_open(&self) -> bool {
        !self.open.is_empty() || self.end.is_some()
    }

    /// Whether a way continues somewhere.
    #[inline]
    pub(crate) fn has_targets(&self) -> bool {
        !self.open.is_empty()
    }

    /// Adds those of another way that reaches the same block.
    pub(crate) fn join(&mut self, other: &Self) {
        let Self {
            open,
            end,
            ends,
            own: _,
            written,
            everything,
        } = other;
        for way in open {
            if !self.open.contains(way) {
                self.add(way.clone());
            }
        }
        if let Some(way) = end
            && self.end != *end
        {
            self.add_end(OpenPath::clone(way));
        }
        for end in ends {
            self.note_end(end.clone());
        }
        for (target, seq) in &written.0 {
            let last = self.written.0.entry(target.clone()).or_default();
            *last = (*last).max(*seq);
        }
        self.everything = self.everything.max(*everything);
    }

    /// A value was written.
    pub(crate) fn write(&mut self, location: &Location, seq: u64) {
        if self.written.0.len() >= MAX_WRITTEN {
            return self.write_anything(seq);
        }
        self.written.0.insert(location.clone(), seq);
    }

    /// Something was declared or deleted.
    pub(crate) fn write_anything(&mut self, seq: u64) {
        self.everything = seq;
        self.written.0.clear();
    }

    pub(crate) fn place(&self, depth: usize, target: EntryIndex) -> Result<usize, usize> {
        let key = |way: &OpenPath| (way.depth, way.target);
        self.open.binary_search_by_key(&(depth, target), key)
    }

    pub(crate) fn add(&mut self, way: OpenPath) {
        match self.place(way.depth, way.target) {
            Ok(place) => self.open[place].take_in(way),
            Err(place) => self.open.insert(place, way),
        }
    }

    /// A way may end the program in a block; two ways to one end are one.
    pub(crate) fn note_end(&mut self, end: WayEnd) {
        if let Some(known) = self.ends.iter_mut().find(|it| it.place == end.place) {
            for (mine, theirs) in known.kinds.iter_mut().zip(&end.kinds) {
                mine.unknown = mine.differing(*theirs);
            }
        } else if self.ends.len() < MAX_ENDS {
            self.ends.push(end);
        }
    }

    pub(crate) fn add_end(&mut self, way: OpenPath) {
        match &mut self.end {
            Some(end) => end.take_in(way),
            None => self.end = Some(Box::new(way)),
        }
    }

    /// The nearest way that left since a block was executed and continues beyond another block of the
    /// same program, or else returns from it or ends it.
    pub(crate) fn out_of(&self, depth: usize, from: EntryIndex, since: u64) -> Option<WayOut> {
        let place = self
            .place(depth, from.saturating_add(1))
            .unwrap_or_else(|place| place);
        let beyond = self.open.range(place..);
        let beyond = beyond.take_while(|way| way.depth == depth);
        let way = beyond
            .chain(self.end.as_deref())
            .find(|way| way.latest >= since)?;
        let to = match way.target {
            _ if way.depth == 0 => Leaving::End,
            RETURN => Leaving::Return,
            target => Leaving::To(target),
        };
        Some(WayOut {
            to,
            cause: way.cause.clone(),
        })
    }

    /// Takes the first way of a program that continues before a block or at it.
    pub(crate) fn arrived(&mut self, depth: usize, here: EntryIndex) -> Option<OpenPath> {
        let place = self.place(depth, 0).unwrap_or_else(|place| place);
        let first = self.open.get(place)?;
        let is_it = first.depth == depth && first.target <= here;
        is_it.then(|| self.open.remove(place))?
    }

    /// Takes the ways of a program that is left.
    pub(crate) fn left(&mut self, depth: usize) -> VecDeque<OpenPath> {
        let place = self.place(depth, 0).unwrap_or_else(|place| place);
        self.open.split_off(place)
    }

    pub(crate) fn all(&self) -> impl Iterator<Item = &OpenPath> {
        self.open.iter().chain(self.end.as_deref())
    }

    /// Whether the state kept for each way describes a number of axes, and names conditions below a number.
    pub(crate) fn fit(&self, axes: usize, conditions: usize) -> bool {
        self.all().map(|way| &way.state).all(|state| {
            state.kinds.len() == axes
                && state.history.fits(axes, conditions)
                && state.modal.fits(axes)
        })
    }

    /// The sections that ways execute, each from a block on.
    pub(crate) fn tails(&self) -> impl Iterator<Item = (ProgramId, EntryIndex)> {
        self.all().flat_map(|way| &way.tails).map(|tail| {
            let Remainder {
                unit,
                section,
                from,
            } = *tail;
            (ProgramId { unit, section }, from)
        })
    }

    /// The modal cycles of each way.
    pub(crate) fn cycles(&self) -> impl Iterator<Item = &ModalCycles> {
        self.all().map(|way| &way.state.cycles)
    }

    /// Drops data that no way needs any more.
    pub(crate) fn tidy(&mut self) {
        if !self.is_open() {
            self.written.0.clear();
            self.everything = 0;
        }
    }
}

impl OpenPath {
    /// Two ways to one place are one.
    pub(crate) fn take_in(&mut self, other: Self) {
        self.since = self.since.min(other.since);
        self.latest = self.latest.max(other.latest);
        self.state.macros = self.state.macros.min(other.state.macros);
        self.state.couplings = self.state.couplings.min(other.state.couplings);
        for (mine, theirs) in self.state.kinds.iter_mut().zip(&other.state.kinds) {
            mine.unknown = mine.differing(*theirs);
        }
        self.state.history.join_sites(&other.state.history);
        self.state.modal.join(&other.state.modal);
        self.state.cycles.join(&other.state.cycles);
        join_names(&mut self.state.named, &other.state.named, &other.cause);
        self.state.channel_axes.join(&other.state.channel_axes);
        for tail in other.tails {
            if !self.tails.contains(&tail) {
                self.tails.push(tail);
            }
        }
    }
}

/// Makes unknown the words that may call another program on one way.
pub(crate) fn join_names(
    names: &mut BTreeMap<String, Value>,
    other: &BTreeMap<String, Value>,
    cause: &Unknown,
) {
    if names == other {
        return;
    }
    let words: Vec<String> = names.keys().chain(other.keys()).cloned().collect();
    for word in words {
        if names.get(&word) != other.get(&word) {
            names.insert(word, Value::Unknown(cause.clone()));
        }
    }
}
