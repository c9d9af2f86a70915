//! The words of a block that shape its motion: I, J, K, R and the like (R2.46).

use super::motion::BlockEnd;
use crate::language::Simplifications;
use crate::text::Span;

/// Value of a word: absent, or a value that may be unknown.
pub(crate) type WordValue = Option<Option<f64>>;

/// The words of a block that only shape its motion.
#[derive(Clone, Debug, Default)]
pub(crate) struct Geometry {
    /// I, J, K.
    pub(crate) centre: [WordValue; 3],
    /// R.
    pub(crate) radius: WordValue,
    /// The seconds of `G04 2.5` and `#TIME 2.5`.
    pub(crate) dwell: WordValue,
    pub(crate) end: BlockEnd,
    /// E: the feed at the end of the block.
    pub(crate) end_feed: WordValue,
    /// G166: overrides do not count.
    pub(crate) at_full_speed: bool,
    /// Simplifications of the commanded trace in this block.
    pub(crate) simplified: Simplifications,
    /// Span of the first of I, J, K and R.
    pub(crate) span: Option<Span>,
    /// Number of axes that move along the circle without a word of their own.
    pub(crate) around: usize,
    /// A G function that makes the block's motion something else.
    pub(crate) foreign: Option<&'static str>,
}
