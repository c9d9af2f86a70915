//! The axis words of a block.

use crate::comp::AxisIndex;
use crate::text::Span;

/// An axis word of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisWord {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// The word.
    pub span: Span,
    /// The coordinate as it is programmed, where it is known.
    pub value: Option<f64>,
    /// Position before, where it is known.
    pub from: Option<f64>,
}

/// A coordinate that counts from a place; unknown if any part is, or if the sum leaves the range of
/// numbers.
#[inline]
pub(super) fn shifted(from: Option<f64>, value: Option<f64>, scale: Option<f64>) -> Option<f64> {
    Some(from? + value? * scale?).filter(|sum| sum.is_finite())
}
