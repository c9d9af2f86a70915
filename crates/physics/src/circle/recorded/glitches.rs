//! The glitches of a recorded circle over all of its turns, with their errors (R16.10, R16.15).

use serde::{Deserialize, Serialize};

use super::circle::RecordedCircle;
use super::limits::WIDEST_GAP_DEG;
use crate::circle::figures::Waveform;
use crate::circle::geometry::{Crossing, PlaneAxis};
use crate::circle::geometry::{Gatherer, RadialProfile};

/// Number of standard errors by which the glitches of turns scatter if the turns differ.
const APART: f64 = 3.0;

/// A glitch is the same in two recordings of one machine within this part …
const REPEATS: f64 = 0.01;

/// … or within this, in µm.
const LEAST_UM: f64 = 0.05;

/// A recorded glitch in µm with its error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MeasuredGlitch {
    /// The glitch without its noise: of the mean of all turns, or the largest where the turns differ.
    pub um: f64,
    /// Standard error, which contains the scatter of turns that differ.
    pub error_um: f64,
    /// The median of the turns.
    pub median_um: f64,
    /// The standard deviation of the turns where they differ by more than their errors, otherwise 0.
    pub spread_um: f64,
    /// The part of the plain figure that is noise.
    pub noise_um: f64,
    /// Number of turns.
    pub turns: usize,
}

/// A comparison of two recorded glitches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum GlitchOrder {
    /// The first is larger, by more than three errors.
    Larger,
    /// The first is larger by more than three errors of the noise, but by less than turns of one circle differ; or only
    /// than the median of turns that differ.
    TurnsDiffer,
    /// Both are alike within three errors.
    Alike,
    /// The first is smaller, by more than three errors.
    Smaller,
}

impl MeasuredGlitch {
    /// Compares it with another one by the difference over its error (R16.15).
    pub fn compared_with(&self, other: &Self) -> GlitchOrder {
        let apart = self.um - other.um;
        let repeated = (REPEATS * self.um.max(other.um)).hypot(LEAST_UM);
        let all = self.error_um.hypot(other.error_um).hypot(repeated);
        let alone = |it: &Self| (it.error_um.powi(2) - it.spread_um.powi(2)).max(0.0).sqrt();
        let noise = alone(self).hypot(alone(other)).hypot(repeated);
        if apart > APART * all {
            GlitchOrder::Larger
        } else if self.um - other.um.min(other.median_um) > APART * noise {
            GlitchOrder::TurnsDiffer
        } else if apart < -APART * all {
            GlitchOrder::Smaller
        } else {
            GlitchOrder::Alike
        }
    }

    /// Returns a figure without anything known about its turns.
    pub fn of(um: f64, error_um: f64) -> Self {
        Self {
            um,
            error_um,
            median_um: um,
            spread_um: 0.0,
            noise_um: 0.0,
            turns: 1,
        }
    }

    /// Returns the larger of two figures.
    #[must_use]
    pub fn larger(self, other: Self) -> Self {
        if other.um > self.um { other } else { self }
    }

    /// Returns the figure of a waveform in each turn, less the noise of a sample in µm that is the mean over 8 ms.
    fn of_turns(turns: &[Waveform], noise_um: f64) -> Option<Self> {
        let each: Vec<&Waveform> = turns.iter().collect();
        #[allow(clippy::cast_precision_loss)] // a few turns
        let count = turns.len() as f64;
        let mean = Waveform::mean(&each);
        let whole = mean.without_noise(noise_um / count.sqrt())?;
        let heights = turns.iter().filter_map(|it| it.without_noise(noise_um));
        let mut heights: Vec<(f64, f64)> = heights.collect();
        heights.sort_by(|one, other| one.0.total_cmp(&other.0));
        let (largest, error) = *heights.last()?;
        let average = heights.iter().map(|it| it.0).sum::<f64>() / count;
        let squares: f64 = heights.iter().map(|it| (it.0 - average).powi(2)).sum();
        let scatter = (squares / (count - 1.0).max(1.0)).sqrt();
        let differ = heights.len() > 1 && scatter > APART * error;
        let (um, error_um) = if differ {
            (largest, error.hypot(scatter))
        } else {
            whole
        };
        Some(Self {
            um,
            error_um,
            median_um: heights[heights.len() / 2].0,
            spread_um: if differ { scatter } else { 0.0 },
            noise_um: (mean.height_um() - whole.0).max(0.0),
            turns: turns.len(),
        })
    }
}

impl RecordedCircle {
    /// Returns the glitches at X+, Y+, X- and Y-, over all whole turns between the ends at which the machine is not
    /// yet, or no longer, at its feed; `None` if the path has no glitches or no times.
    pub fn glitches(&self) -> Option<[MeasuredGlitch; 4]> {
        let turns = self.reversals()?;
        let noise_um = self.mean_noise_um();
        let of = |at: usize| {
            let waveforms: Vec<Waveform> = turns.iter().map(|it| it[at].clone()).collect();
            MeasuredGlitch::of_turns(&waveforms, noise_um)
        };
        Some([of(0)?, of(1)?, of(2)?, of(3)?])
    }

    /// Returns the waveforms at the four crossings in each whole turn, or in the evaluated turn if it is the only one.
    pub(crate) fn reversals(&self) -> Option<Vec<[Waveform; 4]>> {
        let profiles = self.turns_m.iter().filter_map(|it| self.profile_of(it));
        let all: Vec<[Waveform; 4]> = profiles
            .filter_map(|it| Waveform::at_crossings(&it, self.direction))
            .collect();
        if all.is_empty() {
            return Some(vec![Waveform::at_crossings(&self.profile, self.direction)?]);
        }
        Some(all)
    }

    /// Returns the reversals of an axis in each whole turn, at its largest and at its smallest position.
    pub(crate) fn reversals_of(&self, axis: PlaneAxis) -> Option<Vec<[Waveform; 2]>> {
        let turns = self.reversals()?.into_iter();
        let of_axis = turns.map(|[x_plus, y_plus, x_minus, y_minus]| match axis {
            PlaneAxis::X => [x_plus, x_minus],
            PlaneAxis::Y => [y_plus, y_minus],
        });
        Some(of_axis.collect())
    }

    /// Returns the standard deviation in µm of the noise of a mean over 8 ms.
    pub(crate) fn mean_noise_um(&self) -> f64 {
        let noise_um = self.profile.quality().map_or(0.0, |it| it.noise_um);
        let turn_s = self.turn_s.unwrap_or(f64::INFINITY);
        #[allow(clippy::cast_precision_loss)] // points of a turn
        let step_s = turn_s / self.points.max(1) as f64;
        noise_um / Waveform::samples_of_a_mean(step_s, turn_s).sqrt()
    }

    /// Returns the profile of a turn, points in m about their own centre; `None` if it has gaps.
    pub(super) fn profile_of(&self, points: &[[f64; 2]]) -> Option<RadialProfile> {
        let mut gatherer = Gatherer::new(self.radius_mm / 1000.0, WIDEST_GAP_DEG);
        for [x, y] in points {
            gatherer.take(*x, *y);
        }
        gatherer.finish(self.turn_s).ok()
    }

    /// Returns the largest figure of this direction, with its crossing.
    pub fn largest_glitch(&self) -> Option<(Crossing, MeasuredGlitch)> {
        let each = Crossing::ALL.into_iter().zip(self.glitches()?);
        each.max_by(|one, other| one.1.um.total_cmp(&other.1.um))
    }
}
