//! The residual of a path beyond its shapes: an error that repeats along an axis, an oscillation in
//! time, or neither (R5.28).

use std::f64::consts::TAU;

use super::crossing::PlaneAxis;
use super::direction::Direction;
use super::evidence_shape::OtherShape;
use super::profile::{RadialProfile, UM_PER_M};
use super::turning::Turning;

/// Angles of a turn.
const ANGLES: usize = 3600;

/// Fixed angles of a profile in one of them.
const FINER: usize = 10;

/// Masked part of a turn after every crossing: degrees, or seconds if that is more.
const MASKED_DEG: f64 = 14.0;
const MASKED_S: f64 = 0.3;

/// Beyond that nothing of a turn is left.
const MOST_MASKED_DEG: f64 = 75.0;

/// A block for the standard errors, in s; without times, in degrees.
const BLOCK_S: f64 = 0.05;
const BLOCK_DEG: f64 = 2.0;

/// Pitches of screws in mm.
const PITCHES: [f64; 2] = [1.0, 40.0];

/// The slowest oscillation that counts as one, in Hz.
const SLOWEST_HZ: f64 = 5.0;

/// A shape explains at least this part of what is left.
const EXPLAINS: f64 = 0.2;

/// Frequencies on either side of the best one among which the pitch is sharpened.
const FINE: i32 = 15;

/// A path in equal steps of the angle, in µm, without the reversals.
#[derive(Debug, Clone)]
pub(super) struct Series {
    pub(super) direction: Direction,
    /// Noise of a step as a part of that of a sample.
    pub(super) noise_share: f64,
    /// Samples outside the mask.
    places: Vec<(Turning, f64)>,
    values: Vec<Option<f64>>,
    radius_mm: f64,
    turn_s: Option<f64>,
}

#[allow(clippy::cast_precision_loss)] // 3600 and parts of it
fn real(count: usize) -> f64 {
    count as f64
}

fn angle_of(at: usize) -> Turning {
    Turning::of((real(at) + 0.5) / real(ANGLES) * TAU)
}

/// The values that are there, with their directions.
fn unmasked(values: &[Option<f64>]) -> Vec<(Turning, f64)> {
    let all = values.iter().enumerate();
    all.filter_map(|(at, value)| Some((angle_of(at), (*value)?)))
        .collect()
}

impl Series {
    /// The path of a profile that has so many samples; `None` where the reversals take all of it.
    pub(super) fn of(
        profile: &RadialProfile,
        direction: Direction,
        samples: usize,
    ) -> Option<Self> {
        let turn_s = profile.turn_s();
        let masked = turn_s.map_or(0.0, |turn_s| MASKED_S * 360.0 / turn_s);
        let masked = masked.max(MASKED_DEG);
        if masked > MOST_MASKED_DEG {
            return None;
        }
        let chunks = profile.deviations_m().chunks(FINER).enumerate();
        let values = chunks.map(|(at, chunk)| {
            let degrees = (real(at) + 0.5) / real(ANGLES) * 360.0;
            let after = (direction.sign() * degrees).rem_euclid(90.0);
            let mean = chunk.iter().sum::<f64>() / real(chunk.len()) * UM_PER_M;
            (after > masked && after < 89.0).then_some(mean)
        });
        let values: Vec<Option<f64>> = values.collect();
        let in_step = real(samples) / real(ANGLES);
        Some(Self {
            places: unmasked(&values),
            direction,
            noise_share: 1.0 / in_step.max(1.0).sqrt(),
            values,
            radius_mm: profile.radius_m() * 1000.0,
            turn_s,
        })
    }

    /// The samples that are not masked, with their directions.
    pub(super) fn samples(&self) -> impl Iterator<Item = (Turning, f64)> + '_ {
        self.places.iter().copied()
    }

    /// The same path with other values.
    pub(super) fn map(&self, value: impl Fn(Turning, f64) -> f64) -> Self {
        let values = self.values.iter().enumerate();
        let values = values.map(|(at, old)| old.map(|old| value(angle_of(at), old)));
        let values: Vec<Option<f64>> = values.collect();
        Self {
            places: unmasked(&values),
            values,
            ..*self
        }
    }

    /// The path less a periodic error.
    pub(super) fn less(&self, periodic: &Periodic) -> Self {
        self.map(|angle, value| value - periodic.at(angle, self.radius_mm))
    }

    /// The path with a periodic error.
    pub(super) fn plus(&self, periodic: &Periodic) -> Self {
        self.map(|angle, value| value + periodic.at(angle, self.radius_mm))
    }

    /// The variance of a sample as the means of blocks show it: neighbours may be alike.
    pub(super) fn block_variance(&self) -> f64 {
        let degrees = self
            .turn_s
            .map_or(BLOCK_DEG, |turn_s| BLOCK_S * 360.0 / turn_s);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 1 to 3600
        let length = (degrees / 360.0 * real(ANGLES)).round().max(1.0) as usize;
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

/// An error that repeats along an axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Periodic {
    axis: PlaneAxis,
    /// Periods in a mm.
    frequency: f64,
    parts: [f64; 2],
    /// Squares that it explains.
    explains: f64,
}

impl Periodic {
    fn row(axis: PlaneAxis, frequency: f64, angle: Turning, radius: f64) -> [f64; 2] {
        let along = match axis {
            PlaneAxis::X => angle.cos,
            PlaneAxis::Y => angle.sin,
        };
        let (sin, cos) = (TAU * frequency * radius * along).sin_cos();
        [along * cos, along * sin]
    }

    fn at(&self, angle: Turning, radius: f64) -> f64 {
        let [cos, sin] = Self::row(self.axis, self.frequency, angle, radius);
        self.parts[0] * cos + self.parts[1] * sin
    }

    fn of(series: &[Series], axis: PlaneAxis, frequency: f64) -> Option<Self> {
        let (mut cc, mut cs, mut ss) = (0.0, 0.0, 0.0);
        let mut products = [0.0; 2];
        for one in series {
            for (angle, value) in one.samples() {
                let [c, s] = Self::row(axis, frequency, angle, one.radius_mm);
                cc += c * c;
                cs += c * s;
                ss += s * s;
                products[0] += c * value;
                products[1] += s * value;
            }
        }
        let determinant = cc * ss - cs * cs;
        let is_firm = determinant > 1e-9 * cc * ss;
        let parts = [
            (ss * products[0] - cs * products[1]) / determinant,
            (cc * products[1] - cs * products[0]) / determinant,
        ];
        is_firm.then_some(Self {
            axis,
            frequency,
            parts,
            explains: parts[0] * products[0] + parts[1] * products[1],
        })
    }

    /// The same error in another path.
    pub(super) fn again(&self, series: &[Series]) -> Option<Self> {
        Self::of(series, self.axis, self.frequency)
    }

    /// The error of any pitch of a screw that explains most.
    fn search(series: &[Series]) -> Option<Self> {
        let radius = series.first()?.radius_mm;
        let [from, to] = [1.0 / PITCHES[1], 1.0 / PITCHES[0]];
        let step = 1.0 / (6.0 * radius);
        let mut best: Option<Self> = None;
        for axis in PlaneAxis::ALL {
            let mut frequency = from.max(1.0 / radius);
            while frequency <= to {
                let found = Self::of(series, axis, frequency);
                if let Some(found) = found
                    && best.is_none_or(|best| found.explains > best.explains)
                {
                    best = Some(found);
                }
                frequency += step;
            }
        }
        let best = best?;
        // Between the frequencies that were tried.
        let near = (-FINE..=FINE).filter_map(|at| {
            let part = f64::from(at) / f64::from(FINE);
            Self::of(series, best.axis, best.frequency + part * step)
        });
        near.max_by(|one, other| one.explains.total_cmp(&other.explains))
    }
}

/// An oscillation in time.
#[derive(Debug, Clone, Copy, Default)]
struct Oscillation {
    hertz: f64,
    explains: f64,
    amplitude: f64,
}

impl Oscillation {
    /// The frequency that explains most.
    fn search(series: &[Series]) -> Option<Self> {
        let turn_s = series.iter().filter_map(|it| it.turn_s).reduce(f64::max)?;
        let highest = real(ANGLES) / turn_s / 2.5;
        let mut best = Self::default();
        let mut hertz = SLOWEST_HZ;
        while hertz < highest {
            let found = Self::of(series, hertz);
            if found.explains > best.explains {
                best = found;
            }
            hertz += 0.5 / turn_s;
        }
        Some(best)
    }

    fn of(series: &[Series], hertz: f64) -> Self {
        let (mut explains, mut amplitude) = (0.0, 0.0_f64);
        for one in series {
            let step = TAU * hertz * one.turn_s.unwrap_or_default() / real(ANGLES);
            let (sin, cos) = step.sin_cos();
            // The phase turns on from sample to sample.
            let [mut c, mut s] = [1.0_f64, 0.0_f64];
            let [mut real_part, mut imaginary, mut count] = [0.0; 3];
            for value in &one.values {
                if let Some(value) = value {
                    real_part += value * c;
                    imaginary += value * s;
                    count += 1.0;
                }
                [c, s] = [c * cos - s * sin, s * cos + c * sin];
            }
            let power = real_part * real_part + imaginary * imaginary;
            explains += 2.0 * power / f64::max(count, 1.0);
            amplitude = amplitude.max(2.0 * power.sqrt() / f64::max(count, 1.0));
        }
        Self {
            hertz,
            explains,
            amplitude,
        }
    }
}

/// The residual, as far as it is known.
pub(super) struct LeftOver {
    pub(super) periodic: Option<Periodic>,
    oscillation: Option<Oscillation>,
}

impl LeftOver {
    /// Its shape.
    pub(super) fn shape(&self) -> OtherShape {
        if let Some(periodic) = &self.periodic {
            return OtherShape::Periodic {
                axis: periodic.axis,
                pitch_mm: 1.0 / periodic.frequency,
                amplitude_um: periodic.parts[0].hypot(periodic.parts[1]),
            };
        }
        self.oscillation
            .map_or(OtherShape::Unknown, |it| OtherShape::Vibration {
                hertz: it.hertz,
                amplitude_um: it.amplitude,
            })
    }
}

/// Whether a screw or an oscillation explains what is left of paths with such a noise.
pub(super) fn other_shape(left: &[Series], noise_um: f64) -> LeftOver {
    let all = left.iter().flat_map(Series::samples);
    let (squares, count) = all.fold((0.0, 0.0), |(squares, count), (_, value)| {
        (squares + value * value, count + 1.0)
    });
    let least = EXPLAINS * (squares - count * noise_um * noise_um);
    let periodic = Periodic::search(left).filter(|it| it.explains > least);
    let oscillation = Oscillation::search(left).filter(|it| it.explains > least);
    let explained = oscillation.map_or(0.0, |it| it.explains);
    LeftOver {
        periodic: periodic.filter(|it| it.explains > explained),
        oscillation,
    }
}
