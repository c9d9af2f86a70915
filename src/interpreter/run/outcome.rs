//! The actions of a block after its words.

use super::event::EndedBy;
use super::step::ControlStep;
use crate::interpreter::coordinates::axis_words::AxisWords;
use crate::interpreter::coordinates::group::Group;
use crate::interpreter::programs::wanted::WantedCall;
use crate::text::Span;

/// The F word of a block.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::interpreter) enum Feed {
    /// There is none.
    #[default]
    Absent,
    /// Its value, where it is known.
    Given(Option<f64>),
}

/// Actions of a block after its words.
#[derive(Default)]
pub(in crate::interpreter) struct BlockOutcome {
    /// M02, M30.
    pub(in crate::interpreter) end: Option<EndedBy>,
    /// M17, M29.
    pub(in crate::interpreter) returns: bool,
    /// A jump, or the step of a control block.
    pub(in crate::interpreter) step: Option<ControlStep>,
    /// Calls, in the order in which they are made.
    pub(in crate::interpreter) calls: Vec<WantedCall>,
    /// The G functions of the block, to find two of one group.
    pub(in crate::interpreter) groups: [Option<u32>; Group::COUNT],
    /// Meaning of the axis words: with G04, G92 … they are not coordinates.
    pub(in crate::interpreter) axis_words: AxisWords,
    /// F, which may be unknown.
    pub(in crate::interpreter) feed: Feed,
    /// R of a circle.
    pub(in crate::interpreter) radius: Option<Span>,
    /// The condition of an `$IF` in a block with `$GOTO`.
    pub(in crate::interpreter) condition: Option<bool>,
    /// Whether a probe decides where the block leads (R2.91).
    pub(in crate::interpreter) probes: bool,
}

impl BlockOutcome {
    /// Whether the block itself leads only to the next one.
    pub(in crate::interpreter) fn goes_on(&self) -> bool {
        self.end.is_none() && !self.returns && self.step.is_none()
    }
}
