//! The deviation of one axis over the time since its reversal.

use super::glitch::straightened;
use crate::circle::geometry::Direction;
use crate::circle::geometry::{PER_DEGREE, RadialProfile};

/// Interval of the samples in s.
const STEP_S: f64 = 0.002;

/// Half the time in s over which a sample is the mean: noise of recordings averages out (R5.28).
const HALF_MEAN_S: f64 = 0.004;

/// Samples at both ends through which the undisturbed path runs: 20 ms.
const ENDS: usize = 10;

/// Micrometres in a metre.
const UM_PER_M: f64 = 1e6;

/// The deviation of an axis outwards in µm, every 2 ms from a time before its reversal to one after it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Waveform {
    /// Number of the first sample; number 0 is at the reversal.
    first: i32,
    um: Vec<f64>,
}

impl Waveform {
    /// Returns the reversals at the four crossings of a recorded turn; `None` if it has no glitches or no times.
    pub(crate) fn at_crossings(profile: &RadialProfile, direction: Direction) -> Option<[Self; 4]> {
        let angles_per_s = 360.0 / profile.turn_s()? * f64::from(PER_DEGREE);
        let paths = straightened(profile, direction)?;
        Some(paths.map(|path| {
            let in_time = path.iter().map(|&(way, it)| (way / angles_per_s, it));
            Self::sampled(&in_time.collect::<Vec<_>>())
        }))
    }

    /// Samples points, ascending times since the reversal in s with deviations in m: each sample is the mean over
    /// 8 ms, or is on the straight line if points are farther apart.
    pub(crate) fn sampled(points: &[(f64, f64)]) -> Self {
        let [Some(begin), Some(end)] = [points.first(), points.last()] else {
            return Self::default();
        };
        let [first, last] = [(begin.0 / STEP_S).ceil(), (end.0 / STEP_S).floor()];
        #[allow(clippy::cast_possible_truncation)] // a circle lasts 1500 s at most
        let numbers = first as i32..=last as i32;
        let mut sums = vec![0.0];
        for (_, deviation) in points {
            sums.push(sums[sums.len() - 1] + deviation);
        }
        let sample = |number: i32| {
            let time = f64::from(number) * STEP_S;
            let from = points.partition_point(|it| it.0 < time - HALF_MEAN_S);
            let to = points.partition_point(|it| it.0 <= time + HALF_MEAN_S);
            let metres = if to > from {
                (sums[to] - sums[from]) / real(to - from)
            } else {
                between(points, time)
            };
            metres * UM_PER_M
        };
        Self {
            um: numbers.clone().map(sample).collect(),
            first: *numbers.start(),
        }
    }

    /// Returns the mean of waveforms over the samples that all of them have.
    pub(crate) fn mean(waveforms: &[&Self]) -> Self {
        let first = waveforms.iter().map(|it| it.first).max().unwrap_or(0);
        let end = waveforms.iter().map(|it| it.end()).min().unwrap_or(0);
        let mean = |number: i32| {
            let sum: f64 = waveforms.iter().map(|it| it.at(number)).sum();
            sum / real(waveforms.len())
        };
        Self {
            first,
            um: (first..end).map(mean).collect(),
        }
    }

    /// Returns the number of independent samples in a mean over 8 ms, for samples a number of seconds apart and a turn
    /// of a number of seconds: a profile has one at each fixed angle at most.
    pub(crate) fn samples_of_a_mean(step_s: f64, turn_s: f64) -> f64 {
        let angle_s = turn_s / 360.0 / f64::from(PER_DEGREE);
        (2.0 * HALF_MEAN_S / step_s.max(angle_s)).max(1.0)
    }

    /// Returns the height in µm without the noise of its samples, and its standard error. Each sample becomes the mean
    /// over as many neighbours as show nothing but noise (Lepski), so that the noise of the flat part does not count as
    /// height. `None` without samples.
    pub(crate) fn without_noise(&self, noise_um: f64) -> Option<(f64, f64)> {
        let mut sums = vec![0.0];
        for it in &self.um {
            sums.push(sums[sums.len() - 1] + it);
        }
        let smooth = (0..self.um.len()).map(|at| quiet_mean(&sums, at, noise_um));
        let smooth: Vec<(f64, f64)> = smooth.collect();
        let of = |one: &&(f64, f64), other: &&(f64, f64)| one.0.total_cmp(&other.0);
        let low = smooth.iter().min_by(of)?;
        let high = smooth.iter().max_by(of)?;
        Some((high.0 - low.0, low.1.hypot(high.1)))
    }

    /// Returns the range from the least to the largest deviation in µm.
    pub fn height_um(&self) -> f64 {
        let ends = self
            .um
            .iter()
            .fold([f64::MAX, f64::MIN], |[low, high], it| {
                [low.min(*it), high.max(*it)]
            });
        (ends[1] - ends[0]).max(0.0)
    }

    /// Returns the waveform with a change added to the samples that the change has.
    pub(crate) fn changed(&self, change: &Self) -> Self {
        let numbers = self.first..self.end();
        Self {
            first: self.first,
            um: numbers.map(|it| self.at(it) + change.at(it)).collect(),
        }
    }

    /// Returns the difference from another one on the samples of this one.
    pub(crate) fn less(&self, other: &Self) -> Self {
        let numbers = self.first..self.end();
        Self {
            first: self.first,
            um: numbers.map(|it| self.at(it) - other.at(it)).collect(),
        }
    }

    /// Returns the samples that another one also has.
    pub(crate) fn within(&self, other: &Self) -> Self {
        Self::mean(&[
            self,
            &Self {
                um: vec![0.0; other.um.len()],
                ..*other
            },
        ])
        .scaled(2.0)
    }

    fn scaled(mut self, factor: f64) -> Self {
        self.um.iter_mut().for_each(|it| *it *= factor);
        self
    }

    /// Returns the waveform less the straight line through both ends.
    pub(crate) fn levelled(mut self) -> Self {
        let ends = ENDS.min(self.um.len() / 2).max(1);
        if self.um.len() <= ends {
            return self;
        }
        let mean = |part: &[f64]| part.iter().sum::<f64>() / real(part.len());
        let from = mean(&self.um[..ends]);
        let to = mean(&self.um[self.um.len() - ends..]);
        let slope = (to - from) / real(self.um.len() - ends);
        let middle = (real(ends) - 1.0) / 2.0;
        for (at, value) in self.um.iter_mut().enumerate() {
            *value -= from + slope * (real(at) - middle);
        }
        self
    }

    /// Returns the samples: the time since the reversal in s, and the deviation in µm.
    pub(crate) fn samples(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let times = (self.first..).map(|it| f64::from(it) * STEP_S);
        times.zip(self.um.iter().copied())
    }

    /// Returns the mean square in µm².
    pub(crate) fn power(&self) -> f64 {
        let squares: f64 = self.um.iter().map(|it| it * it).sum();
        squares / real(self.um.len().max(1))
    }

    /// Returns a sample, and 0 beyond both ends.
    fn at(&self, number: i32) -> f64 {
        let at = usize::try_from(number - self.first).ok();
        at.and_then(|at| self.um.get(at)).copied().unwrap_or(0.0)
    }

    /// Returns the number after the last sample.
    fn end(&self) -> i32 {
        self.first + i32::try_from(self.um.len()).unwrap_or(i32::MAX)
    }
}

/// Returns the mean around a sample over the widest part in which it differs from narrower ones by no more than their
/// noise, and its standard error; from sums up to each sample and the noise of a sample, a mean over 8 ms.
fn quiet_mean(sums: &[f64], at: usize, noise_um: f64) -> (f64, f64) {
    /// Number of standard errors from which means differ by more than noise.
    const APART: f64 = 2.0;
    /// Samples that have the same noise: 8 ms.
    const OF_A_MEAN: f64 = 4.0;
    const WIDEST: usize = 64;
    let mean = |half: usize| {
        let (from, to) = (at.saturating_sub(half), (at + half + 1).min(sums.len() - 1));
        let error = noise_um * (OF_A_MEAN / real(to - from)).min(1.0).sqrt();
        ((sums[to] - sums[from]) / real(to - from), error)
    };
    let mut best = mean(0);
    let [mut low, mut high] = [-1.0, 1.0].map(|it| best.0 + it * APART * best.1);
    let mut half = 2;
    while half <= WIDEST {
        let wider = mean(half);
        if !(low..=high).contains(&wider.0) {
            break;
        }
        best = wider;
        low = low.max(wider.0 - APART * wider.1);
        high = high.min(wider.0 + APART * wider.1);
        half *= 2;
    }
    best
}

/// Returns the value at a time on straight lines between points.
fn between(points: &[(f64, f64)], time: f64) -> f64 {
    let after = points.partition_point(|it| it.0 < time);
    match (after.checked_sub(1).map(|at| points[at]), points.get(after)) {
        (Some((t0, a)), Some((t1, b))) => a + (b - a) * (time - t0) / (t1 - t0),
        (Some((_, value)), None) | (None, Some(&(_, value))) => value,
        (None, None) => 0.0,
    }
}

fn real(count: usize) -> f64 {
    #[allow(clippy::cast_precision_loss)] // far below 2^52 samples
    let real = count as f64;
    real
}
