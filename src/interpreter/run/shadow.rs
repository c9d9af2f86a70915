//! Shadows: ways that are executed beside the one that a motion or a debugger follows (R14.8).
//!
//! A shadow raises no event. Where it joins the followed way, the axes that it moved stand at an unknown position: that
//! stretch is not judged.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::path::RunTrack;
use super::stack::CallStack;
use crate::comp::AxisIndex;
use crate::interpreter::programs::index::EntryIndex;

/// The block at which the sides of a question meet: a side is a shadow up to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Meeting {
    /// Number of nested calls down to its program.
    pub(crate) depth: usize,
    pub(crate) unit: usize,
    pub(crate) entry: EntryIndex,
}

/// What a way is to the one that is followed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Shadow {
    /// Where it is followed again; `None` for the way that is followed.
    pub(crate) until: Option<Meeting>,
    /// The axes that shadows may have moved since the last event.
    pub(crate) moved: BTreeSet<AxisIndex>,
    /// Whether the followed way has moved where another one did not go.
    pub(crate) moves_alone: bool,
}

impl Shadow {
    /// Another way reaches the same block: they are followed if one of them is.
    pub(super) fn join(&mut self, other: &Self) {
        if other.until.is_none() {
            self.until = None;
        }
        self.moved.extend(&other.moved);
        self.moves_alone |= other.moves_alone;
    }
}

impl RunTrack {
    /// Whether the way raises no events.
    #[inline]
    pub(crate) fn is_shadow(&self) -> bool {
        self.shadow.until.is_some()
    }

    /// Whether motions on the ways that lead here are not those of all ways.
    pub(crate) fn has_undecided_motion(&self) -> bool {
        self.shadow.moves_alone || !self.shadow.moved.is_empty()
    }

    /// A shadow that has come to the block at which the sides of its question meet is followed again, and so is the last
    /// way that is left.
    #[inline]
    pub(crate) fn follow_again(&mut self, frames: &CallStack, is_last: bool) {
        let Some(meeting) = self.shadow.until else {
            return;
        };
        let is_there = frames.running().is_some_and(|frame| {
            (frames.depth(), frame.unit, frame.next) == (meeting.depth, meeting.unit, meeting.entry)
        });
        if is_last || is_there {
            self.shadow.until = None;
        }
    }
}
