//! What `#SAVE CONFIG` saved (R2.107; PM/207535499, PM/207542155). It outlives programs.

use serde::{Deserialize, Serialize};

use super::channel_axes::ChannelAxes;
use crate::comp::AxisIndex;

/// A configuration that `#LOAD CONFIG` restores.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) enum SavedItem<T> {
    /// An earlier program may have saved one.
    #[default]
    Perhaps,
    /// None is there.
    Nothing,
    /// This one.
    Known(T),
}

/// The saved configurations of the channel.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct SavedConfig {
    /// The axes of the channel.
    pub(crate) axes: SavedItem<ChannelAxes>,
    /// The pairs of coupled axes.
    pub(crate) links: SavedItem<Vec<AxisIndex>>,
}

impl<T: PartialEq> SavedItem<T> {
    fn join(&mut self, other: &Self) {
        if self != other {
            *self = Self::Perhaps;
        }
    }
}

impl SavedConfig {
    /// Another way may have saved another one.
    pub(crate) fn join(&mut self, other: &Self) {
        self.axes.join(&other.axes);
        self.links.join(&other.links);
    }
}
