//! A path in equal steps of the angle without its reversals: the input of the fit of shapes, and its
//! residual (R5.28).

use std::f64::consts::TAU;

use crate::circle::geometry::CosineSine;
use crate::circle::geometry::Direction;
use crate::circle::geometry::{ANGLES, RadialProfile, UM_PER_M};

/// Fixed angles of a profile in a step of the shapes.
const COARSE: usize = 10;

/// Fixed angles of a profile in a step in which the decay of tails is sought.
const ROUGH: usize = 40;

/// Masked part of a turn after every crossing: degrees, or seconds if that is more.
const MASKED_DEG: f64 = 14.0;
const MASKED_S: f64 = 0.3;

/// Masked degrees before every crossing …
const BEFORE_DEG: f64 = 1.0;

/// … or seconds, if that is more, where friction rises as the axis slows down.
const SLOWING_S: f64 = 0.1;

/// Limit beyond which nothing of a turn is left.
const MOST_MASKED_DEG: f64 = 75.0;

/// A block for the standard errors, in s; without times, in degrees.
const BLOCK_S: f64 = 0.05;
const BLOCK_DEG: f64 = 2.0;

/// Parts left out of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mask {
    Reversals,
    /// The reversals, and the parts before them in which axes slow down.
    ReversalsAndSlowing,
}

/// A path in equal steps of the angle, in µm, without the reversals.
#[derive(Debug, Clone)]
pub(crate) struct AngleSeries {
    pub(crate) direction: Direction,
    /// Noise of a step as a part of that of a sample.
    pub(crate) noise_share: f64,
    /// Steps outside the mask.
    places: Vec<(CosineSine, f64)>,
    pub(crate) values: Vec<Option<f64>>,
    pub(crate) radius_mm: f64,
    pub(crate) turn_s: Option<f64>,
}

#[allow(clippy::cast_precision_loss)] // 36000 and parts of it
pub(crate) fn real(count: usize) -> f64 {
    count as f64
}

impl AngleSeries {
    /// Returns the path of a profile with a number of samples, in the steps of the shapes; `None` if the reversals take
    /// all of it.
    pub(crate) fn coarse(
        profile: &RadialProfile,
        direction: Direction,
        samples: usize,
        mask: Mask,
    ) -> Option<Self> {
        Self::in_steps(profile, direction, (samples, COARSE), mask)
    }

    /// Returns the path in longer steps, in which slow shapes are the same.
    pub(crate) fn rough(
        profile: &RadialProfile,
        direction: Direction,
        samples: usize,
        mask: Mask,
    ) -> Option<Self> {
        Self::in_steps(profile, direction, (samples, ROUGH), mask)
    }

    /// Returns the path in steps of a sample, or of a fixed angle if that is more.
    pub(crate) fn fine(
        profile: &RadialProfile,
        direction: Direction,
        samples: usize,
        mask: Mask,
    ) -> Option<Self> {
        let step = (ANGLES / samples.max(1)).clamp(1, COARSE);
        Self::in_steps(profile, direction, (samples, step), mask)
    }

    fn in_steps(
        profile: &RadialProfile,
        direction: Direction,
        (samples, step): (usize, usize),
        mask: Mask,
    ) -> Option<Self> {
        let turn_s = profile.turn_s();
        let in_degrees = |seconds: f64| turn_s.map_or(0.0, |turn_s| seconds * 360.0 / turn_s);
        let masked = in_degrees(MASKED_S).max(MASKED_DEG);
        let slowing = match mask {
            Mask::Reversals => BEFORE_DEG,
            Mask::ReversalsAndSlowing => in_degrees(SLOWING_S).max(BEFORE_DEG),
        };
        if masked + slowing > MOST_MASKED_DEG {
            return None;
        }
        let chunks = profile.deviations_m().chunks(step).enumerate();
        let values = chunks.map(|(at, chunk)| {
            let degrees = (real(at) + 0.5) * real(step) / real(ANGLES) * 360.0;
            let after = (direction.sign() * degrees).rem_euclid(90.0);
            let mean = chunk.iter().sum::<f64>() / real(chunk.len()) * UM_PER_M;
            (after > masked && after < 90.0 - slowing).then_some(mean)
        });
        let values: Vec<Option<f64>> = values.collect();
        let in_step = real(samples * step) / real(ANGLES);
        // A step between two fixed angles has the noise of a sample, however many there are.
        let in_step = if step == 1 { 1.0 } else { in_step };
        let mut series = Self {
            places: Vec::new(),
            direction,
            noise_share: 1.0 / in_step.max(1.0).sqrt(),
            values,
            radius_mm: profile.radius_m() * 1000.0,
            turn_s,
        };
        series.places = series.unmasked();
        Some(series)
    }

    fn angle_of(&self, at: usize) -> CosineSine {
        CosineSine::of((real(at) + 0.5) / real(self.values.len()) * TAU)
    }

    fn unmasked(&self) -> Vec<(CosineSine, f64)> {
        let all = self.values.iter().enumerate();
        all.filter_map(|(at, value)| Some((self.angle_of(at), (*value)?)))
            .collect()
    }

    /// Returns the steps that are not masked, with their directions.
    pub(crate) fn steps(&self) -> impl Iterator<Item = (CosineSine, f64)> + '_ {
        self.places.iter().copied()
    }

    /// Seconds of a step.
    pub(crate) fn step_s(&self) -> Option<f64> {
        Some(self.turn_s? / real(self.values.len()))
    }

    /// Returns the path less a model of it.
    pub(crate) fn less(&self, model: impl Fn(CosineSine, Direction) -> f64) -> Self {
        let mut left = self.clone();
        for (at, value) in left.values.iter_mut().enumerate() {
            if let Some(value) = value {
                *value -= model(self.angle_of(at), self.direction);
            }
        }
        left.places = left.unmasked();
        left
    }

    /// Returns the variance of a step, from the means of blocks: neighbours may be alike.
    pub(crate) fn block_variance(&self) -> f64 {
        let degrees = self
            .turn_s
            .map_or(BLOCK_DEG, |turn_s| BLOCK_S * 360.0 / turn_s);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 1 to 36000
        let length = (degrees / 360.0 * real(self.values.len())).round().max(1.0) as usize;
        let blocks: Vec<f64> = self
            .values
            .chunks(length)
            .filter_map(|block| {
                let sum: Option<f64> = block.iter().copied().sum();
                Some(sum? / real(block.len()))
            })
            .collect();
        let squares: f64 = blocks.iter().map(|it| it * it).sum();
        squares / real(blocks.len().max(1)) * real(length)
    }
}

/// Returns the root mean square of paths beyond this noise.
pub(crate) fn beyond_noise(left: &[AngleSeries], noise_um: f64) -> f64 {
    let squares = left.iter().map(|one| {
        let noise = noise_um * one.noise_share;
        let of_steps = one.steps().map(|(_, value)| value * value).sum::<f64>();
        (
            of_steps - real(one.places.len()) * noise * noise,
            one.places.len(),
        )
    });
    let (squares, count) = squares.fold((0.0, 0), |sum, it| (sum.0 + it.0, sum.1 + it.1));
    (squares / real(count.max(1))).max(0.0).sqrt()
}
