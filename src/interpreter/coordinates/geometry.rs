//! The words of a block that shape its motion: I, J, K, R and the like (R2.46).

use super::motion::BlockEnd;
use super::simplified::Simplifications;
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

/// Reason why the motion of axis words with a G function is not modelled.
pub(in crate::interpreter) fn foreign(number: u32) -> Option<&'static str> {
    Some(match number {
        33 => "G33 follows a spindle",
        63 => "G63 follows a spindle",
        100..=102 | 106 | 108 | 310 => "a measuring motion ends where the probe triggers",
        301 | 302 => "G301 and G302 insert a contour",
        303 => "G303 is an arc in space",
        _ => return None,
    })
}

/// Reason why a motion with a `#` command among its words is not modelled (PM/206123787, 206609163).
pub(in crate::interpreter) fn foreign_command(name: &str) -> Option<&'static str> {
    Some(match name {
        "#ANG" => "`#ANG` computes a coordinate from an angle",
        "#CHF" | "#CHR" | "#RND" => "`#CHF`, `#CHR` and `#RND` insert a contour",
        _ => return None,
    })
}
