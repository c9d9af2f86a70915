//! The selection of the channels of a file.

use super::channel::{Channel, ChannelIndex};
use super::error::SelectError;
use super::select::Pick;

/// Selection of channels.
#[derive(Debug, Clone, Default)]
pub struct Choice {
    /// Channels of numbers.
    pub values: Vec<ChannelIndex>,
    /// Channels of `on` and `off`, kept as 1 and 0.
    pub switches: Vec<ChannelIndex>,
    /// Source of their times.
    pub time: TimeSource,
}

/// Source of the times of samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum TimeSource {
    /// The columns of times that the layout has; a table with a header has none.
    #[default]
    Layout,
    /// A channel.
    Channel(Pick),
}

impl Choice {
    /// Chooses all channels that are there, with the times of one of them where the layout has none.
    pub fn all(channels: &[Channel], time: Option<Pick>) -> Self {
        Self {
            values: (0..channels.len()).map(ChannelIndex).collect(),
            switches: Vec::new(),
            time: time.map_or(TimeSource::Layout, TimeSource::Channel),
        }
    }
}

impl Choice {
    /// Adds the channel of a name, if there is one, as a switch.
    pub fn with_switch(mut self, name: &str, channels: &[Channel]) -> (Self, Option<ChannelIndex>) {
        let found = channels.iter().position(|channel| channel.name == name);
        let found = found.map(ChannelIndex);
        self.switches.extend(found);
        (self, found)
    }
}

/// Selects the channels that are kept.
type Choose<'a> = Box<dyn FnMut(&[Channel]) -> Result<Choice, SelectError> + Send + 'a>;

/// Requirements on a trace.
pub(super) struct Demand<'a> {
    pub(super) choose: Choose<'a>,
    pub(super) most_rows: usize,
}
