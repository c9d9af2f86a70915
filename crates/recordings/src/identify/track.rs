//! The recording of one axis, cycle by cycle.

use frictcomp::diagnostic::Rounded;
use thiserror::Error;

use super::statistics::count;

/// Samples of one axis at common, rising times.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Track {
    /// Times in s.
    pub times_s: Vec<f64>,
    /// Velocities in µm/s or 0.001°/s, if they were recorded.
    pub velocities: Option<Vec<f64>>,
    /// Positions in 0.1 µm or 0.0001°, if they were recorded.
    pub positions: Option<Vec<f64>>,
    /// Torque or current in drive units.
    pub torques: Vec<f64>,
    /// The usual time between two samples.
    pub step_s: f64,
}

impl Track {
    /// Replaces the torque by the mean torque of several motors that drive the axis, recorded at the same times.
    pub fn average_torque(&mut self, others: &[&Self]) {
        let motors = count(1 + others.len());
        for (at, torque) in self.torques.iter_mut().enumerate() {
            let more = others.iter().filter_map(|it| it.torques.get(at));
            *torque = (*torque + more.sum::<f64>()) / motors;
        }
    }

    /// Returns the samples from a time in s on.
    #[must_use]
    pub fn since(mut self, time_s: f64) -> Self {
        let before = self.times_s.partition_point(|it| *it < time_s);
        let cut = |column: &mut Vec<f64>| drop(column.drain(..before.min(column.len())));
        cut(&mut self.times_s);
        cut(&mut self.torques);
        [&mut self.velocities, &mut self.positions]
            .into_iter()
            .flatten()
            .for_each(cut);
        self
    }
}

/// Reason why a track cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum TrackError {
    /// Neither velocities nor positions.
    #[error("there is neither a velocity nor a position")]
    NoMotion,
    /// Values outside anything that can be measured.
    #[error("at {time_s} s the {what} is {value:e}, which nothing measures")]
    Absurd {
        /// The time.
        time_s: f64,
        /// The quantity, in words.
        what: &'static str,
        /// Value.
        value: f64,
    },
    /// Fewer samples than a segment has.
    #[error("{samples} samples are too few")]
    Short {
        /// Number of samples.
        samples: usize,
    },
    /// Samples that are too far apart to show motions.
    #[error("the samples are {} s apart, too far to show the motion", Rounded(*.step_s, 3))]
    Slow {
        /// The time between two samples.
        step_s: f64,
    },
    /// A velocity that does not match the position.
    #[error(
        "velocity and position do not belong together: the position moves {ratio} times as far as the velocity says"
    )]
    Apart {
        /// The ratio, as a text of few digits.
        ratio: String,
    },
}

impl TrackError {
    /// Returns the advice.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NoMotion => {
                "record the commanded velocity or the commanded position with the torque"
            }
            Self::Absurd { .. } => "name the channel that holds it, or give its unit",
            Self::Short { .. } => "record for a longer time",
            Self::Slow { .. } => {
                "record in the CNC cycle, or at least every 20 ms; if the times are not in s, give their unit, \
                 as in `t=ms`"
            }
            Self::Apart { .. } => "check the units of both, and that both are of one axis",
        }
    }
}

/// Motion and torque of one axis, complete and checked.
#[derive(Debug, Clone)]
pub(super) struct AxisSamples {
    pub(super) times_s: Vec<f64>,
    /// Velocities in mm/s or °/s.
    pub(super) velocities: Vec<f64>,
    /// Positions in mm or degrees.
    pub(super) positions: Vec<f64>,
    /// Whether the positions were recorded, not computed from the velocities.
    pub(super) has_positions: bool,
    pub(super) torques: Vec<f64>,
    pub(super) step_s: f64,
}

/// Limit beyond which squares and sums are not reliable.
const ABSURD: f64 = 1e12;

/// Minimum number of samples, below that of the shortest segment.
const FEWEST: usize = 20;

/// Samples that are further apart show no segments.
const SLOWEST_S: f64 = 0.02;

impl AxisSamples {
    pub(super) fn new(track: &Track) -> Result<Self, TrackError> {
        let samples = track.times_s.len();
        let step_s = track.step_s;
        if samples < FEWEST {
            return Err(TrackError::Short { samples });
        }
        if !(step_s > 0.0 && step_s <= SLOWEST_S) {
            return Err(TrackError::Slow { step_s });
        }
        let columns = [
            ("velocity", track.velocities.as_deref()),
            ("position", track.positions.as_deref()),
            ("torque", Some(&track.torques[..])),
        ];
        for (what, column) in columns {
            let pairs = track.times_s.iter().zip(column.unwrap_or_default());
            for (&time_s, &value) in pairs {
                if !value.is_finite() || value.abs() > ABSURD {
                    return Err(TrackError::Absurd {
                        time_s,
                        what,
                        value,
                    });
                }
            }
        }
        let (velocities, positions) = match (&track.velocities, &track.positions) {
            (None, None) => return Err(TrackError::NoMotion),
            (Some(velocities), None) => {
                let velocities = scaled(velocities, 1e-3);
                let positions = integrated(&velocities, &track.times_s);
                (velocities, positions)
            }
            (None, Some(positions)) => {
                let positions = scaled(positions, 1e-4);
                (differentiated(&positions, &track.times_s), positions)
            }
            (Some(velocities), Some(positions)) => {
                (scaled(velocities, 1e-3), scaled(positions, 1e-4))
            }
        };
        let samples = Self {
            times_s: track.times_s.clone(),
            velocities,
            positions,
            has_positions: track.positions.is_some(),
            torques: track.torques.clone(),
            step_s,
        };
        let motion = samples.velocities.iter().zip(&samples.positions);
        let motion = samples.times_s.iter().zip(motion);
        let motion = motion.map(|(&time, (&velocity, &position))| [time, velocity, position]);
        check_motion(step_s, motion)?;
        Ok(samples)
    }

    /// Removes a part of the torque that depends on the position.
    pub(super) fn take_away(&mut self, part: impl Fn(f64) -> f64) {
        for (torque, &position) in self.torques.iter_mut().zip(&self.positions) {
            *torque -= part(position);
        }
    }
}

/// Checks that positions in mm or degrees follow from velocities in mm/s or °/s: each sample is its time in s, its velocity
/// and its position, and comes `step_s` after the one before.
///
/// # Errors
/// They move another distance than the velocities say.
pub fn check_motion(
    step_s: f64,
    samples: impl IntoIterator<Item = [f64; 3]>,
) -> Result<(), TrackError> {
    /// Distances in mm below which nothing is reported.
    const LEAST: f64 = 0.5;
    // Every tenth of a second, so that noise of single samples does not add travel.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 5 to some hundreds
    let every = (0.1 / step_s).ceil().max(1.0) as usize;
    let mut reached = 0.0;
    let mut earlier = None;
    let mut coarse: Option<[f64; 2]> = None;
    let [mut one, mut other] = [0.0_f64; 2];
    for (at, [time, velocity, position]) in samples.into_iter().enumerate() {
        reached += velocity * (time - earlier.unwrap_or(time));
        earlier = Some(time);
        if at % every == 0 {
            let before = coarse.replace([position, reached]);
            let [from, from_reached] = before.unwrap_or([position, reached]);
            one += (position - from).abs();
            other += (reached - from_reached).abs();
        }
    }
    if one.max(other) < LEAST {
        return Ok(());
    }
    let ratio = one / other.max(1e-12);
    if (0.5..=2.0).contains(&ratio) {
        return Ok(());
    }
    Err(TrackError::Apart {
        ratio: if ratio >= 1.0 {
            format!("{ratio:.0}")
        } else {
            format!("{ratio:.4}")
        },
    })
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// Integrates velocities, from 0.
fn integrated(velocities: &[f64], times_s: &[f64]) -> Vec<f64> {
    let mut position = 0.0;
    let mut before = times_s.first().copied().unwrap_or_default();
    let pairs = velocities.iter().zip(times_s);
    pairs
        .map(|(velocity, &time)| {
            position += velocity * (time - before);
            before = time;
            position
        })
        .collect()
}

/// Velocities of positions, each over the samples before and after.
fn differentiated(positions: &[f64], times_s: &[f64]) -> Vec<f64> {
    let last = positions.len() - 1;
    (0..=last)
        .map(|at| {
            let (from, to) = (at.saturating_sub(1), (at + 1).min(last));
            (positions[to] - positions[from]) / (times_s[to] - times_s[from])
        })
        .collect()
}
