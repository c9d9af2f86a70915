//! A recording: channels with their samples, each on the clock with which it was sampled.

use super::channel::{Channel, ChannelIndex};

/// Layout of a file; each is described in the file that reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Layout {
    name: &'static str,
    pub(super) rows: RowForm,
}

/// Form of the rows of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum RowForm {
    /// Rows with all numbers.
    Whole,
    /// Rows of Scope: shorter where channels have ended, repeated for slow ones, and followed by other lines after a
    /// blank one.
    Ragged,
}

impl Layout {
    pub(super) const fn new(name: &'static str, rows: RowForm) -> Self {
        Self { name, rows }
    }

    /// Returns its name in a sentence.
    pub fn as_str(self) -> &'static str {
        self.name
    }
}

/// Cells of a channel that do not hold a number.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Missing {
    /// Number of them.
    pub count: u64,
    /// The line of the first one.
    pub line: u64,
    /// Text of the first one.
    pub text: String,
}

/// The samples of a channel.
#[derive(Debug, Clone, Default)]
pub(super) struct ChannelSamples {
    pub(super) values: Vec<f64>,
    pub(super) missing: Missing,
    /// Index of its clock, if the file has times.
    pub(super) clock: Option<usize>,
}

/// Channels with their samples.
#[derive(Debug, Clone)]
pub struct TraceRecording {
    pub(super) layout: Layout,
    pub(super) channels: Vec<Channel>,
    /// Samples in the order of the channels; `None` for channels that were not requested.
    pub(super) samples: Vec<Option<ChannelSamples>>,
    /// The times of the clocks in seconds.
    pub(super) clocks: Vec<Vec<f64>>,
    pub(super) remarks: Vec<String>,
}

impl TraceRecording {
    /// Returns the layout of the file.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Returns every channel of the file, including those whose samples were not requested.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Returns the steps in which the file was read, each a sentence in lower case.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// Returns the channels whose samples were requested.
    pub fn kept(&self) -> impl Iterator<Item = ChannelIndex> {
        let kept = self.samples.iter().enumerate();
        kept.filter_map(|(index, samples)| samples.is_some().then_some(ChannelIndex(index)))
    }

    /// Returns the samples of a channel as the file has them; NaN where one is missing in the middle.
    pub fn values(&self, channel: ChannelIndex) -> &[f64] {
        self.of(channel).map_or(&[], |samples| &samples.values)
    }

    /// Takes the samples of a channel out.
    pub fn take_values(&mut self, channel: ChannelIndex) -> Vec<f64> {
        let samples = self.samples.get_mut(channel.0).and_then(Option::as_mut);
        samples.map_or_else(Vec::new, |samples| std::mem::take(&mut samples.values))
    }

    /// Returns the times of the samples of a channel in seconds, if the file has times. There are as many as samples.
    pub fn times_s(&self, channel: ChannelIndex) -> Option<&[f64]> {
        let samples = self.of(channel)?;
        let times = self.clocks.get(samples.clock?)?;
        Some(&times[..times.len().min(samples.values.len())])
    }

    /// Returns the cells of a channel that do not hold a number.
    pub fn missing(&self, channel: ChannelIndex) -> Missing {
        let missing = self.of(channel).map(|samples| samples.missing.clone());
        missing.unwrap_or_default()
    }

    fn of(&self, channel: ChannelIndex) -> Option<&ChannelSamples> {
        self.samples.get(channel.0)?.as_ref()
    }

    /// Returns the number of the clock of a channel: channels with the same one were sampled together.
    pub fn clock(&self, channel: ChannelIndex) -> Option<usize> {
        self.of(channel)?.clock
    }
}
