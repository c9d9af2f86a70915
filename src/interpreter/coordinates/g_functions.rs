//! The G functions in force and the feeds (R2.45, R2.46).

use serde::{Deserialize, Serialize};

use super::lacking_feed::LackingFeeds;
use super::motion::BlockEnd;
use super::pace::ProgrammedFeed;
use crate::language::{GFunction, Group, GroupSet};

/// Places of the feeds of G94 and G95.
pub(super) const PER_MINUTE: usize = 1;
pub(super) const PER_REVOLUTION: usize = 2;

/// The G functions in force and the feeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GFunctions {
    /// G00 to G03.
    pub motion: u32,
    /// G17 to G19.
    pub plane: u32,
    /// Whether G90 is in force.
    pub absolute: bool,
    /// Whether G70 is in force.
    pub inch: bool,
    /// G93 to G95, G194.
    pub feed_mode: u32,
    /// The feed of each mode, G93, G94, G95, G194, where one was programmed.
    pub feeds: [Option<ProgrammedFeed>; 4],
    /// G53 to G59, G159.
    pub offset: u32,
    /// Whether the circle centre is absolute, G161.
    pub centre_absolute: bool,
    /// G40 to G42.
    #[serde(default = "without_compensation")]
    pub(super) tool_side: u32,
    /// The number of the tool data in force, D, where it is known.
    pub tool_data: Option<u32>,
    /// Condition for the end of blocks, G359 and G360.
    pub block_end: BlockEnd,
    /// Groups whose active function is not known offline (R2.51).
    pub(super) unknown: GroupSet,
    /// Modes of F without a feed.
    #[serde(default)]
    pub(super) lacking: LackingFeeds,
}

fn without_compensation() -> u32 {
    40
}

impl Default for GFunctions {
    /// Those at program start.
    fn default() -> Self {
        Self {
            motion: 0,
            plane: 17,
            absolute: true,
            inch: false,
            feed_mode: 94,
            feeds: [None; 4],
            offset: 53,
            centre_absolute: false,
            tool_side: without_compensation(),
            tool_data: Some(0),
            block_end: BlockEnd::Through,
            unknown: GroupSet::default(),
            lacking: LackingFeeds::all(),
        }
    }
}

impl GFunctions {
    /// The place of the feed of the mode in force.
    #[inline]
    pub(super) fn feed_place(&self) -> usize {
        match self.feed_mode {
            93 => 0,
            95 => PER_REVOLUTION,
            194 => 3,
            _ => PER_MINUTE,
        }
    }

    /// Whether G01, G02 or G03 is in force and may have no feed, or the feed 0 (R2.110).
    #[inline]
    pub(crate) fn may_lack_feed(&self) -> bool {
        self.is_feed_move() && self.has_no_feed()
    }

    /// Whether the mode in force may have no feed, or the feed 0.
    #[inline]
    pub(crate) fn has_no_feed(&self) -> bool {
        self.lacking.contains(self.feed_place())
    }

    /// Whether G01, G02 or G03 is in force.
    #[inline]
    pub(crate) fn is_feed_move(&self) -> bool {
        GFunction::is_feed_move(self.motion) && !self.unknown.contains(Group::Motion)
    }

    /// Whether G02 or G03 was programmed last.
    #[inline]
    pub(crate) fn is_arc(&self) -> bool {
        GFunction::is_arc(self.motion)
    }

    /// Whether the program has certainly given no feed so far, and G94 is in force.
    pub(crate) fn is_first_without_feed(&self) -> bool {
        self.feed_mode == 94 && !self.unknown.contains(Group::Feed) && self.lacking.is_certain()
    }

    /// The feed of the mode in force, as the program gives it.
    pub(crate) fn programmed_feed(&self) -> Option<f64> {
        self.feeds[self.feed_place()].map(|feed| feed.value)
    }

    /// The mode in force has a feed that the program does not say.
    pub(crate) fn give_feed(&mut self) {
        self.lacking.give(self.feed_place());
    }

    /// Any mode may have a feed that the program does not say.
    pub(crate) fn perhaps_give_feeds(&mut self) {
        self.lacking = LackingFeeds::default();
    }
}
