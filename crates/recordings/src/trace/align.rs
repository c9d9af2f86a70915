//! Channels of several rates brought to one clock.

use std::borrow::Cow;

use thiserror::Error;

use super::channel::ChannelIndex;
use super::clock::Clock;
use super::recording::TraceRecording;
use super::select::{Pick, guess};
use super::unit::ChannelQuantity;
use frictcomp::diagnostic::ReadableNumber;

/// Samples of several channels at the same times.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Aligned {
    /// The times in seconds, rising.
    pub times_s: Vec<f64>,
    /// Samples of each channel in the units of lists and traces.
    pub columns: Vec<Vec<f64>>,
    /// The usual time between two samples.
    pub step_s: f64,
    /// Steps that brought the channels together, each a sentence in lower case.
    pub remarks: Vec<String>,
}

/// Reason why channels cannot be brought together.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NotAligned {
    /// A table without a column of times, and without a known distance between its rows.
    #[error("it has no times")]
    NoTimes {
        /// A channel that may be that of the times.
        guess: Option<String>,
    },
    /// A clock that jumps back or stops.
    #[error("the times do not rise: after {before_s} s comes {after_s} s")]
    Backwards {
        /// A time.
        before_s: f64,
        /// The one below it.
        after_s: f64,
    },
    /// Channels that were recorded one after the other.
    #[error("the groups of {one} and of {other} have no time in common")]
    Apart {
        /// A channel with the times of its group.
        one: String,
        /// Name of the other channel.
        other: String,
    },
    /// Too few samples for any statement.
    #[error("the channel `{channel}` has too few samples: {samples}")]
    Short {
        /// Name of the channel.
        channel: String,
        /// Number of samples.
        samples: usize,
    },
}

impl NotAligned {
    /// Returns the advice.
    pub fn help(&self) -> Cow<'static, str> {
        match self {
            Self::NoTimes { guess: Some(guess) } => {
                format!("name the column of the times; perhaps it is `{guess}`").into()
            }
            Self::NoTimes { guess: None } => {
                "name the column of the times, or give the cycle in which the rows were recorded"
                    .into()
            }
            Self::Backwards { .. } => {
                "a recording is one measurement; separate what was recorded later".into()
            }
            Self::Apart { .. } => "record the channels together".into(),
            Self::Short { .. } => "record for a longer time".into(),
        }
    }
}

/// Steps of a gap from which it is not bridged.
const BRIDGED: f64 = 5.0;

impl TraceRecording {
    /// Returns the samples of some channels on the clock of the fastest one, the others interpolated. Rows without
    /// times are `cycle_s` apart.
    ///
    /// # Errors
    /// The channels have no times in common, or none that rise.
    pub fn align(&self, picks: &[Pick], cycle_s: Option<f64>) -> Result<Aligned, NotAligned> {
        let mut aligned = Aligned::default();
        let tracks: Vec<TimedChannel> = picks
            .iter()
            .map(|pick| self.track(pick, cycle_s, &mut aligned.remarks))
            .collect::<Result<_, _>>()?;
        let fastest = tracks
            .iter()
            .min_by(|one, other| one.step_s.total_cmp(&other.step_s));
        let Some(base) = fastest else {
            return Ok(aligned);
        };
        let begin = tracks
            .iter()
            .max_by(|one, other| one.first().total_cmp(&other.first()));
        let end = tracks
            .iter()
            .min_by(|one, other| one.last().total_cmp(&other.last()));
        if let (Some(begin), Some(end)) = (begin, end)
            && begin.first() > end.last()
        {
            return Err(NotAligned::Apart {
                one: self.span(begin),
                other: self.span(end),
            });
        }
        aligned.remarks.extend(self.unequal_spans(&tracks));
        let from = begin.map_or(f64::NEG_INFINITY, TimedChannel::first);
        let to = end.map_or(f64::INFINITY, TimedChannel::last);
        let slower = |track: &&TimedChannel| {
            track.clock != base.clock || track.clock.is_none() && track.has_holes
        };
        for track in tracks
            .iter()
            .filter(slower)
            .filter(|it| it.channel != base.channel)
        {
            aligned.remarks.push(format!(
                "`{}`, sampled every {} ms, is brought to the {} ms of `{}` by interpolation",
                self.name(track.channel),
                milliseconds(track.step_s),
                milliseconds(base.step_s),
                self.name(base.channel)
            ));
        }
        let is_inside = |time: f64| {
            (from..=to).contains(&time) && tracks.iter().all(|track| track.covers(time))
        };
        aligned.step_s = base.step_s;
        aligned.times_s = base
            .times_s
            .iter()
            .copied()
            .filter(|&time| is_inside(time))
            .collect();
        aligned.columns = tracks
            .iter()
            .map(|track| track.at(&aligned.times_s))
            .collect();
        Ok(aligned)
    }

    /// Returns a channel with the times of its group.
    fn span(&self, track: &TimedChannel<'_>) -> String {
        format!(
            "`{}` ({} to {} s)",
            self.name(track.channel),
            readable(track.first()),
            readable(track.last())
        )
    }

    /// Returns the remark on groups of channels that were not recorded over the same time (R6.27).
    fn unequal_spans(&self, tracks: &[TimedChannel<'_>]) -> Option<String> {
        /// The greatest difference of the ends of channels that were recorded together, in steps.
        const TOGETHER: f64 = 3.0;
        let step_s = tracks.iter().map(|it| it.step_s).fold(0.0, f64::max);
        let mut groups: Vec<&TimedChannel<'_>> = Vec::new();
        for track in tracks {
            let is_same = |it: &&TimedChannel<'_>| {
                let ends = [it.first() - track.first(), it.last() - track.last()];
                ends.iter().all(|apart| apart.abs() <= TOGETHER * step_s)
            };
            if !groups.iter().any(is_same) {
                groups.push(track);
            }
        }
        if groups.len() < 2 {
            return None;
        }
        let from = groups.iter().map(|it| it.first()).fold(f64::MIN, f64::max);
        let to = groups.iter().map(|it| it.last()).fold(f64::MAX, f64::min);
        let spans: Vec<String> = groups.iter().map(|it| self.span(it)).collect();
        Some(format!(
            "the groups were recorded over different times: {}; the {} s that all of them have are used",
            spans.join(", "),
            readable(to - from)
        ))
    }

    fn name(&self, channel: ChannelIndex) -> String {
        self.channels()[channel.get()].name.clone()
    }

    fn track(
        &self,
        pick: &Pick,
        cycle_s: Option<f64>,
        remarks: &mut Vec<String>,
    ) -> Result<TimedChannel<'_>, NotAligned> {
        let channel = pick.channel;
        let values = self.values(channel);
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let counted = |cycle: f64| (0..values.len()).map(|row| row as f64 * cycle).collect();
        let all: Cow<'_, [f64]> = match (self.times_s(channel), cycle_s) {
            (Some(times), _) => Cow::Borrowed(times),
            (None, Some(cycle)) => Cow::Owned(counted(cycle)),
            (None, None) => {
                return Err(NotAligned::NoTimes {
                    guess: guess(ChannelQuantity::Time, self.channels()),
                });
            }
        };
        let rows = all.len();
        let scaled = |value: &f64| value * pick.unit.factor;
        let is_whole = rows == values.len() && values.iter().all(|value| value.is_finite());
        let (times_s, values): (Cow<'_, [f64]>, Vec<f64>) = if is_whole {
            (all, values.iter().map(scaled).collect())
        } else {
            let pairs = all.iter().zip(values);
            let pairs = pairs.filter(|(_, value)| value.is_finite());
            let (times, values): (Vec<f64>, Vec<f64>) =
                pairs.map(|(time, value)| (*time, scaled(value))).unzip();
            (Cow::Owned(times), values)
        };
        let missing = rows - times_s.len();
        if missing > 0 {
            remarks.push(format!(
                "{missing} samples of `{}` are not numbers and left out",
                self.name(channel)
            ));
        }
        if let Some(pair) = times_s.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(NotAligned::Backwards {
                before_s: pair[0],
                after_s: pair[1],
            });
        }
        let step_s = Clock::of(&times_s).and_then(|clock| clock.step_s);
        let Some(step_s) = step_s else {
            return Err(NotAligned::Short {
                channel: self.name(channel),
                samples: times_s.len(),
            });
        };
        Ok(TimedChannel {
            channel,
            clock: self.clock(channel),
            has_holes: missing > 0,
            times_s,
            values,
            step_s,
        })
    }
}

/// Returns a time without the rounding error of a difference.
fn readable(seconds: f64) -> ReadableNumber {
    ReadableNumber((seconds * 1e6).round() / 1e6)
}

fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e3
}

/// A channel with its own times.
struct TimedChannel<'a> {
    channel: ChannelIndex,
    clock: Option<usize>,
    has_holes: bool,
    /// Times of the samples; those of the recording if none is left out.
    times_s: Cow<'a, [f64]>,
    values: Vec<f64>,
    step_s: f64,
}

impl TimedChannel<'_> {
    fn first(&self) -> f64 {
        self.times_s.first().copied().unwrap_or(f64::INFINITY)
    }

    fn last(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(f64::NEG_INFINITY)
    }

    /// Returns whether there are samples around a time, not too far from each other.
    fn covers(&self, time: f64) -> bool {
        let after = self.times_s.partition_point(|&it| it < time);
        match (
            after.checked_sub(1).map(|at| self.times_s[at]),
            self.times_s.get(after),
        ) {
            (_, Some(&exact)) if exact <= time => true,
            (Some(before), Some(after)) => after - before <= self.step_s * BRIDGED,
            _ => false,
        }
    }

    /// Returns the values at some rising times.
    fn at(&self, times_s: &[f64]) -> Vec<f64> {
        let mut after = 0;
        let value = |&time: &f64| {
            while self.times_s.get(after).is_some_and(|&it| it < time) {
                after += 1;
            }
            let here = after.min(self.values.len().saturating_sub(1));
            let before = here.saturating_sub(1);
            let span = self.times_s[here] - self.times_s[before];
            if self.times_s[here] <= time || span <= 0.0 {
                return self.values[here];
            }
            let share = (time - self.times_s[before]) / span;
            self.values[before] + share * (self.values[here] - self.values[before])
        };
        times_s.iter().map(value).collect()
    }
}
