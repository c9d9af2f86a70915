//! The part of the torque that repeats along the travel: the pitch of a screw, the poles of a motor
//! (R6.16).

use std::f64::consts::TAU;
use std::ops::Range;

use super::segment::Segment;
use super::statistics::{count, trimmed_mean};
use super::track::AxisSamples;
use frictcomp_physics::linear::solve_linear;

/// A torque that repeats with the position.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Ripple {
    /// The period in mm or degrees.
    pub period: f64,
    /// Half of its peak-to-peak value, in drive units.
    pub amplitude: f64,
}

/// Maximum number of averages of the residuals.
const MOST: usize = 20_000;

/// Maximum number of frequencies that are tried.
const FREQUENCIES: usize = 1500;

/// The shortest period in mm.
const SHORTEST: f64 = 0.4;

/// A ripple with its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wave {
    /// Periods per mm or degree.
    frequency: f64,
    /// Parts of its cosine and its sine, in drive units.
    parts: [f64; 2],
}

impl Wave {
    /// Returns the period and the amplitude.
    pub(super) fn ripple(&self) -> Ripple {
        let [cosine, sine] = self.parts;
        Ripple {
            period: 1.0 / self.frequency,
            amplitude: cosine.hypot(sine),
        }
    }

    /// Returns the torque at a position in mm or degrees.
    pub(super) fn at(&self, position: f64) -> f64 {
        let (sine, cosine) = (TAU * self.frequency * position).sin_cos();
        self.parts[0] * cosine + self.parts[1] * sine
    }

    /// Returns the wave of a frequency that fits best if every segment has a separate mean: a segment shorter than a
    /// period says little about it.
    fn fitted(samples: &AxisSamples, segments: &[Segment], frequency: f64) -> Option<Self> {
        let mut sums = [[0.0; 3]; 2];
        for segment in segments {
            let range = segment.samples.clone();
            let length = count(range.len());
            let rows = || {
                range.clone().map(|at| {
                    let turns = frequency * samples.positions[at];
                    let (sine, cosine) = (TAU * turns).sin_cos();
                    [cosine, sine, samples.torques[at]]
                })
            };
            let means = rows().fold([0.0; 3], |means, row| {
                std::array::from_fn(|at| means[at] + row[at] / length)
            });
            for row in rows() {
                let row: [f64; 3] = std::array::from_fn(|at| row[at] - means[at]);
                for (sums, factor) in sums.iter_mut().zip(row) {
                    for (sum, value) in sums.iter_mut().zip(row) {
                        *sum += factor * value;
                    }
                }
            }
        }
        let found = solve_linear(sums.map(|row| row.to_vec()).to_vec())?;
        Some(Self {
            frequency,
            parts: [*found.first()?, *found.get(1)?],
        })
    }
}

/// Returns the largest ripple of the segments, if it stands out from the noise.
pub(super) fn wave(samples: &AxisSamples, segments: &[Segment]) -> Option<Wave> {
    let residuals = residuals(samples, segments);
    let positions = residuals.iter().map(|it| it[0]);
    let (low, high) = positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| {
        (low.min(it), high.max(it))
    });
    let way = high - low;
    if residuals.len() < 200 || way < 4.0 * SHORTEST {
        return None;
    }
    let squares: f64 = residuals.iter().map(|it| it[1] * it[1]).sum();
    let spread = (squares / count(residuals.len())).sqrt();
    let step = (0.5 / way).max((1.0 / SHORTEST - 2.0 / way) / count(FREQUENCIES));
    let (frequency, amplitude) = (0..FREQUENCIES)
        .map(|at| 2.0 / way + count(at) * step)
        .take_while(|&frequency| frequency <= 1.0 / SHORTEST)
        .map(|frequency| (frequency, amplitude(&residuals, frequency)))
        .max_by(|one, other| one.1.total_cmp(&other.1))?;
    let frequency = sharpened(&residuals, frequency, step);
    // The greatest of many amplitudes of noise.
    let by_chance = spread * (4.0 * count(FREQUENCIES).ln() / count(residuals.len())).sqrt();
    (amplitude > 2.0 * by_chance).then(|| Wave::fitted(samples, segments, frequency))?
}

/// Returns the frequency between its neighbours at which the amplitude is greatest.
fn sharpened(residuals: &[[f64; 2]], frequency: f64, step: f64) -> f64 {
    let near = (-10..=10).map(|at| frequency + f64::from(at) * step / 10.0);
    let greatest = near
        .filter(|&it| it > 0.0)
        .map(|it| (it, amplitude(residuals, it)))
        .max_by(|one, other| one.1.total_cmp(&other.1));
    greatest.map_or(frequency, |(frequency, _)| frequency)
}

fn amplitude(residuals: &[[f64; 2]], frequency: f64) -> f64 {
    let (mut cosine, mut sine) = (0.0, 0.0);
    for [position, residual] in residuals {
        let (s, c) = (TAU * frequency * position).sin_cos();
        cosine += residual * c;
        sine += residual * s;
    }
    2.0 * cosine.hypot(sine) / count(residuals.len())
}

/// Pairs of position and the difference of the torque from the mean of its segment.
pub(super) fn residuals(samples: &AxisSamples, segments: &[Segment]) -> Vec<[f64; 2]> {
    let all: usize = segments.iter().map(|segment| segment.samples.len()).sum();
    let block = (all / MOST).max(1);
    let of_segment = |range: &Range<usize>| -> Vec<[f64; 2]> {
        let torques = &samples.torques[range.clone()];
        let mean = trimmed_mean(torques);
        let places = samples.positions[range.clone()].chunks_exact(block);
        let blocks = places.zip(torques.chunks_exact(block));
        let middle = |values: &[f64]| values.iter().sum::<f64>() / count(values.len());
        blocks
            .map(|(x, torque)| [middle(x), middle(torque) - mean])
            .collect()
    };
    segments
        .iter()
        .flat_map(|segment| of_segment(&segment.samples))
        .collect()
}
