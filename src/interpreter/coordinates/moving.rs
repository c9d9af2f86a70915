//! The motion of an axis in a block (R10.7).

use super::axis_words::AxisWord;
use crate::comp::AxisIndex;
use crate::language::{Certainty, MotionKind};
use crate::text::Span;

/// The motion of one axis in a block.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MovedAxis {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// The words that move it.
    pub span: Span,
    /// How it moves.
    pub kind: MotionKind,
    /// Whether it certainly moves.
    pub certainty: Certainty,
}

impl MovedAxis {
    /// The motion of an axis word.
    #[inline]
    pub(crate) fn of_word(word: &AxisWord, kind: MotionKind) -> Self {
        Self {
            axis: word.axis,
            span: word.span,
            kind,
            certainty: Certainty::Certain,
        }
    }
}
