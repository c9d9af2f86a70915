//! The contents of the channels of a recording, at a glance.

use super::channel::{Channel, ChannelIndex};
use super::clock::Clock;
use super::recording::TraceRecording;

/// A channel at a glance.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ChannelSummary<'a> {
    /// Description of the channel.
    pub channel: &'a Channel,
    /// Number of samples, including missing ones.
    pub samples: usize,
    /// Number of missing samples.
    pub missing: u64,
    /// The least and the greatest sample, in the unit of the file; `None` without any.
    pub range: Option<[f64; 2]>,
    /// The times at which it was sampled, if the file has times.
    pub clock: Option<Clock>,
}

impl TraceRecording {
    /// Returns the requested channels, at a glance.
    pub fn summaries(&self) -> impl Iterator<Item = ChannelSummary<'_>> {
        self.kept().map(|index| self.summary(index))
    }

    fn summary(&self, index: ChannelIndex) -> ChannelSummary<'_> {
        let values = self.values(index);
        let numbers = values.iter().copied().filter(|value| value.is_finite());
        let range = numbers.fold(None, |range: Option<[f64; 2]>, value| {
            let [least, greatest] = range.unwrap_or([value, value]);
            Some([least.min(value), greatest.max(value)])
        });
        ChannelSummary {
            channel: &self.channels()[index.get()],
            samples: values.len(),
            missing: self.missing(index).count,
            range,
            clock: self.times_s(index).and_then(Clock::of),
        }
    }
}
