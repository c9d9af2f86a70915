//! The channels whose lists name an axis (R3.13). A program runs in one channel and knows only its axes.

/// Channels whose lists name an axis, by their numbers from 1.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum ChannelsOfAxis {
    /// Nothing says which channels have the axis.
    #[default]
    Unsaid,
    /// All channel lists were read, and these name the axis.
    Listed(Vec<u32>),
    /// These have the axis, as far as the items of a project say (R3.42).
    Assumed(Vec<u32>),
}

impl ChannelsOfAxis {
    /// Returns the channels that have the axis; `None` where nothing says it.
    pub fn numbers(&self) -> Option<&[u32]> {
        match self {
            Self::Unsaid => None,
            Self::Listed(numbers) | Self::Assumed(numbers) => Some(numbers),
        }
    }

    /// Returns the channels that have the axis, among those that may have it.
    pub(crate) fn among(&self, numbers: Option<Vec<u32>>) -> Option<Vec<u32>> {
        match (self.numbers(), numbers) {
            (Some(own), Some(mut numbers)) => {
                numbers.retain(|number| own.contains(number));
                Some(numbers)
            }
            (Some(own), None) => Some(own.to_vec()),
            (None, numbers) => numbers,
        }
    }
}
