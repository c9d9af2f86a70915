//! Segments of constant speed (R6.10).

use std::borrow::Cow;
use std::collections::VecDeque;
use std::ops::Range;

use super::statistics::{count, median, moving_average, noise_of, samples_in};
use super::track::AxisSamples;

/// The moving average in s.
const AVERAGED_S: f64 = 0.05;

/// Minimum length of a segment, in s.
const SHORTEST_S: f64 = 0.3;

/// Speeds are the same within 30 µm/s, here in mm/s …
const STEADY: f64 = 0.03;

/// … or within this part of them …
const STEADY_PART: f64 = 0.01;

/// … or within this many standard deviations of the averaged noise.
const STEADY_SIGMA: f64 = 5.0;

/// Speed in mm/s below which segments are ignored.
const SLOWEST: f64 = 0.1;

/// Part cut off at the start, or duration if that is more; and part cut off at the end.
const CUT_FRONT: f64 = 0.15;
const CUT_FRONT_S: f64 = 0.15;
const CUT_END: f64 = 0.1;

/// Samples at one speed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Segment {
    /// Samples in use.
    pub samples: Range<usize>,
    /// Start, in s.
    pub from_s: f64,
    /// End, in s.
    pub to_s: f64,
    /// The speed with its sign, in mm/s or °/s.
    pub velocity: f64,
    /// The standard error of the speed.
    pub velocity_error: f64,
}

/// Part within which two speeds are the same.
const SAME: f64 = 0.05;

impl Segment {
    /// Returns the time in its middle, in s.
    pub(super) fn middle_s(&self) -> f64 {
        f64::midpoint(self.from_s, self.to_s)
    }

    /// Returns whether two segments have the same speed, in any direction, to the extent that noise permits.
    pub(super) fn is_as_fast_as(&self, other: &Self) -> bool {
        let [one, another] = [self.velocity.abs(), other.velocity.abs()];
        let unsure = 3.0 * self.velocity_error.hypot(other.velocity_error);
        (one - another).abs() <= SAME * one.min(another) + unsure
    }
}

/// Returns the segments of a recording in their order.
pub(super) fn segments(samples: &AxisSamples) -> Vec<Segment> {
    let speeds = SteadySpeeds::of(samples);
    let mut found = Vec::new();
    for stretch in unbroken(samples) {
        let within = &speeds.averaged[stretch.clone()];
        for range in steady(within, speeds.noise, samples_in(SHORTEST_S, samples.step_s)) {
            let range = stretch.start + range.start..stretch.start + range.end;
            let mut pieces = Vec::new();
            speeds.split(range, &mut pieces);
            for segment in pieces
                .into_iter()
                .filter_map(|piece| speeds.cut(samples, piece))
            {
                speeds.join(samples, &mut found, segment);
            }
        }
    }
    found
}

/// Speeds that are searched for steady ones, from the recorded signal with less noise.
struct SteadySpeeds<'a> {
    averaged: Vec<f64>,
    /// The standard deviation of the averaged noise.
    noise: f64,
    /// The standard deviation of the noise on the positions, if the speeds come from them.
    of_positions: Option<f64>,
    /// Speeds of single samples, and their noise.
    single: Cow<'a, [f64]>,
    single_noise: f64,
    shortest: usize,
}

impl<'a> SteadySpeeds<'a> {
    fn of(samples: &'a AxisSamples) -> Self {
        let width = samples_in(AVERAGED_S, samples.step_s);
        let recorded = noise_of(&samples.velocities);
        let averaged_noise = recorded / count(width).sqrt();
        let span = count(width) * samples.step_s;
        let of_positions = noise_of(&samples.positions) * 2.0_f64.sqrt() / span;
        let shortest = samples_in(SHORTEST_S, samples.step_s);
        if samples.has_positions && of_positions < averaged_noise / 2.0 {
            let single = slopes(samples, 2);
            return Self {
                averaged: slopes(samples, width),
                noise: of_positions,
                of_positions: Some(noise_of(&samples.positions)),
                single_noise: noise_of(&single),
                single: Cow::Owned(single),
                shortest,
            };
        }
        Self {
            averaged: moving_average(&samples.velocities, width),
            noise: averaged_noise,
            of_positions: None,
            single: Cow::Borrowed(&samples.velocities),
            single_noise: recorded,
            shortest,
        }
    }

    /// Returns a stretch without its ends, unless nothing is left of it or the axis hardly moves.
    fn cut(&self, samples: &AxisSamples, range: Range<usize>) -> Option<Segment> {
        let length = count(range.len());
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // parts of a length
        let front = (CUT_FRONT * length)
            .max(CUT_FRONT_S / samples.step_s)
            .ceil() as usize;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a part of a length
        let end = (CUT_END * length).ceil() as usize;
        let kept = range.start + front..range.end.checked_sub(end)?;
        (kept.len() > 1).then(|| self.segment(samples, kept))?
    }

    fn segment(&self, samples: &AxisSamples, kept: Range<usize>) -> Option<Segment> {
        let velocities = &self.single[kept.clone()];
        let middle = median(velocities)?;
        let velocity = velocities.iter().sum::<f64>() / count(kept.len());
        let is_moving = middle.abs().min(velocity.abs()) >= SLOWEST;
        let [from_s, to_s] = [samples.times_s[kept.start], samples.times_s[kept.end - 1]];
        // Of positions only those at both ends count.
        let velocity_error = match self.of_positions {
            Some(noise) => noise * 2.0_f64.sqrt() / (to_s - from_s).max(samples.step_s),
            None => self.single_noise / count(kept.len()).sqrt(),
        };
        is_moving.then_some(Segment {
            from_s,
            to_s,
            velocity,
            velocity_error,
            samples: kept,
        })
    }

    /// Appends a segment, or extends the last one if noise alone had ended it.
    fn join(&self, samples: &AxisSamples, found: &mut Vec<Segment>, next: Segment) {
        /// Longest cut between two pieces of one segment, in s.
        const APART_S: f64 = 1.0;
        if let Some(last) = found.last_mut()
            && last.velocity * next.velocity > 0.0
            && next.from_s - last.to_s < APART_S
            && last.is_as_fast_as(&next)
            && STEADY_SIGMA * self.noise > STEADY.max(STEADY_PART * last.velocity.abs())
            && let Some(joined) = self.segment(samples, last.samples.start..next.samples.end)
        {
            *last = joined;
            return;
        }
        found.push(next);
    }

    /// Divides a stretch in which noise hides two speeds: where the means of both sides differ by far
    /// more than their errors.
    fn split(&self, range: Range<usize>, pieces: &mut Vec<Range<usize>>) {
        /// Standard errors from which a step counts as real, wherever it is searched for.
        const SIGNIFICANT: f64 = 7.0;
        let values = &self.single[range.clone()];
        let total: f64 = values.iter().sum();
        let length = count(values.len());
        let mut sum = 0.0;
        let mut best = (0.0, 0);
        for (at, value) in values.iter().enumerate() {
            let before = count(at);
            if at >= self.shortest && at + self.shortest <= values.len() {
                let apart = (sum / before - (total - sum) / (length - before)).abs();
                let weighed = apart * (before * (length - before) / length).sqrt();
                if weighed > best.0 && apart > STEADY {
                    best = (weighed, at);
                }
            }
            sum += value;
        }
        let mean = (total / length).abs();
        let is_hidden = STEADY_SIGMA * self.noise > STEADY.max(STEADY_PART * mean);
        if is_hidden && best.0 > SIGNIFICANT * self.single_noise {
            let middle = range.start + best.1;
            self.split(range.start..middle, pieces);
            self.split(middle..range.end, pieces);
            return;
        }
        pieces.push(range);
    }
}

/// Speeds from positions that are a number of samples apart.
fn slopes(samples: &AxisSamples, width: usize) -> Vec<f64> {
    let last = samples.positions.len() - 1;
    (0..=last)
        .map(|at| {
            let from = at.saturating_sub(width / 2);
            let to = (from + width).min(last);
            let from = to.saturating_sub(width);
            let way = samples.positions[to] - samples.positions[from];
            way / (samples.times_s[to] - samples.times_s[from])
        })
        .collect()
}

/// Stretches without gaps.
fn unbroken(samples: &AxisSamples) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut stretches = Vec::new();
    for at in 1..samples.times_s.len() {
        if samples.times_s[at] - samples.times_s[at - 1] > 1.5 * samples.step_s {
            stretches.push(start..at);
            start = at;
        }
    }
    stretches.push(start..samples.times_s.len());
    stretches
}

/// Returns the longest successive stretches within which no two speeds differ by more than twice the permitted
/// difference.
fn steady(averaged: &[f64], noise: f64, shortest: usize) -> Vec<Range<usize>> {
    let admitted = |speed: f64| {
        let steady = STEADY.max(STEADY_PART * speed.abs());
        2.0 * steady.max(STEADY_SIGMA * noise)
    };
    let mut found = Vec::new();
    let mut least: VecDeque<usize> = VecDeque::new();
    let mut greatest: VecDeque<usize> = VecDeque::new();
    let mut start = 0;
    for (at, &speed) in averaged.iter().enumerate() {
        while least.back().is_some_and(|&it| averaged[it] >= speed) {
            least.pop_back();
        }
        least.push_back(at);
        while greatest.back().is_some_and(|&it| averaged[it] <= speed) {
            greatest.pop_back();
        }
        greatest.push_back(at);
        while let (Some(&low), Some(&high)) = (least.front(), greatest.front()) {
            let [low, high] = [averaged[low], averaged[high]];
            if high - low <= admitted(f64::midpoint(low, high)) {
                break;
            }
            if at - start >= shortest {
                found.push(start..at);
                start = at;
            } else {
                start += 1;
            }
            for ends in [&mut least, &mut greatest] {
                while ends.front().is_some_and(|&it| it < start) {
                    ends.pop_front();
                }
            }
        }
    }
    if averaged.len() - start >= shortest {
        found.push(start..averaged.len());
    }
    found
}
