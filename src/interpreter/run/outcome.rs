//! The actions of a block after its words.

use super::event::EndedBy;
use super::step::ControlStep;
use crate::interpreter::programs::wanted::WantedCall;
use crate::language::{AxisWords, BlockGroup, GFunction, Group};
use crate::syntax::ast::Block;
use crate::text::Span;

/// The F word of a block.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) enum Feed {
    /// There is none.
    #[default]
    Absent,
    /// Its value, where it is known.
    Given(Option<f64>),
}

/// A file that `#FILE EXIST` looks for.
pub(crate) enum LookedFor {
    /// The one of a name.
    Named(String),
    /// One whose name the program computes.
    Computed,
}

/// Actions of a block after its words.
#[derive(Default)]
pub(crate) struct BlockOutcome {
    /// M02, M30.
    pub(crate) end: Option<EndedBy>,
    /// M17, M29.
    pub(crate) returns: bool,
    /// A jump, or the step of a control block.
    pub(crate) step: Option<ControlStep>,
    /// Calls, in the order in which they are made.
    pub(crate) calls: Vec<WantedCall>,
    /// The file that `#FILE EXIST` looks for.
    pub(crate) looks_for: Option<LookedFor>,
    /// Letter of the last word that calls a program.
    pub(crate) implicit: Option<u8>,
    /// The groups of its G functions, a bit each: those of [`Group`], then those of [`BlockGroup`].
    groups: u32,
    /// The letters of which it has a word and may have one, D at bit 0.
    letters: u32,
    /// The numbers of its M functions, sorted.
    functions: Vec<i64>,
    /// Meaning of the axis words: with G04, G92 … they are not coordinates.
    pub(crate) axis_words: AxisWords,
    /// F, which may be unknown.
    pub(crate) feed: Feed,
    /// R of a circle.
    pub(crate) radius: Option<Span>,
    /// The condition of an `$IF` in a block with `$GOTO`.
    pub(crate) condition: Option<bool>,
    /// Whether a probe decides where the block leads (R2.91).
    pub(crate) probes: bool,
}

impl BlockOutcome {
    /// Takes a G function; returns whether the control refuses it, because the block has one of its group.
    pub(crate) fn is_second_of_group(&mut self, function: &GFunction) -> bool {
        let group = function.group.map(|group| group as usize);
        let place = group.or(function.one_of.map(BlockGroup::place));
        place.is_some_and(|place| !self.take_bit(place))
    }

    /// Takes a G function of a group; returns whether it is the first one.
    #[inline]
    pub(crate) fn take_group(&mut self, group: Group) -> bool {
        self.take_bit(group as usize)
    }

    #[inline]
    fn take_bit(&mut self, bit: usize) -> bool {
        let is_first = self.groups & 1 << bit == 0;
        self.groups |= 1 << bit;
        is_first
    }

    /// Takes a word of a letter; returns whether the control refuses it, because the block already has one (R2.45).
    pub(crate) fn is_repeated(
        &mut self,
        (letter, number): (u8, Option<i64>),
        block: &Block,
    ) -> bool {
        match letter {
            b'N' if self.groups & 1 << BlockGroup::LookAhead.place() != 0 => false,
            b'N' if block.number.is_some() => true,
            b'F' => matches!(self.feed, Feed::Given(_)),
            b'M' => number.is_some_and(|it| self.is_repeated_function(it)),
            b'D' | b'I' | b'J' | b'K' | b'N' | b'S' => {
                let bit = 1 << (letter - b'D');
                let is_repeated = self.letters & bit != 0;
                self.letters |= bit;
                is_repeated
            }
            _ => false,
        }
    }

    fn is_repeated_function(&mut self, number: i64) -> bool {
        let found = self.functions.binary_search(&number);
        if let Err(place) = found {
            self.functions.insert(place, number);
        }
        found.is_ok()
    }

    /// Whether the block itself leads only to the next one.
    pub(crate) fn goes_on(&self) -> bool {
        self.end.is_none() && !self.returns && self.step.is_none()
    }
}
