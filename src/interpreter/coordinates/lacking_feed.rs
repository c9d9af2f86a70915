//! The modes of F for which no feed is in force (R2.110).

use serde::{Deserialize, Serialize};

/// The modes of F that lack a feed or have the feed 0, a bit each in the order of
/// [`super::g_functions::GFunctions::feeds`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct LackingFeeds {
    /// Those that certainly do.
    certain: u8,
    /// Those that may.
    possible: u8,
}

impl LackingFeeds {
    const ALL: u8 = 0b1111;

    /// No feed was programmed.
    pub(super) fn all() -> Self {
        Self {
            certain: Self::ALL,
            possible: Self::ALL,
        }
    }

    /// The mode at a place has a feed from here on.
    pub(super) fn give(&mut self, place: usize) {
        self.certain &= !(1 << place);
        self.possible &= !(1 << place);
    }

    /// The mode at a place has the feed 0 from here on.
    pub(super) fn take(&mut self, place: usize) {
        self.certain |= 1 << place;
        self.possible |= 1 << place;
    }

    /// Another way reaches the same block.
    pub(super) fn join(&mut self, other: Self) {
        self.certain &= other.certain;
        self.possible |= other.possible;
    }

    /// Whether the mode at a place may lack a feed.
    #[inline]
    pub(super) fn contains(self, place: usize) -> bool {
        self.possible & 1 << place != 0
    }

    /// Whether the program has certainly given no feed in any mode.
    pub(super) fn is_certain(self) -> bool {
        self.certain == Self::ALL
    }
}
