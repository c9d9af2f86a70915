//! The words of a block that shape its motion: I, J, K, R and the like (R2.46).

use super::motion::BlockEnd;
use crate::language::Simplifications;
use crate::text::Span;

/// Value of a word: absent, or a value that may be unknown.
pub(in crate::interpreter) type WordValue = Option<Option<f64>>;

/// The words of a block that only shape its motion.
#[derive(Clone, Debug, Default)]
pub(in crate::interpreter) struct Geometry {
    /// I, J, K.
    pub(in crate::interpreter) centre: [WordValue; 3],
    /// R.
    pub(in crate::interpreter) radius: WordValue,
    /// The seconds of `G04 2.5` and `#TIME 2.5`.
    pub(in crate::interpreter) dwell: WordValue,
    pub(in crate::interpreter) end: BlockEnd,
    /// E: the feed at the end of the block.
    pub(in crate::interpreter) end_feed: WordValue,
    /// G166: overrides do not count.
    pub(in crate::interpreter) at_full_speed: bool,
    /// Simplifications of the commanded trace in this block.
    pub(in crate::interpreter) simplified: Simplifications,
    /// Span of the first of I, J, K and R.
    pub(in crate::interpreter) span: Option<Span>,
    /// Number of axes that move along the circle without a word of their own.
    pub(in crate::interpreter) around: usize,
    /// A G function that makes the block's motion something else.
    pub(in crate::interpreter) foreign: Option<&'static str>,
}
