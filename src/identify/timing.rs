//! Whether the additive current of a list acted while a recording was made, and whether it came early
//! or late (R6.22).
//!
//! The total of the torque is friction, whoever supplies it, and the build-up of the loops looks like a
//! lag: only the following error tells what the list did. The output of the loops is linear in the
//! following error, its derivative and its integral; what is left of the torque is what was added.

use serde::Serialize;

use super::curve::solve_linear;
use super::statistics::{count, moving_average, samples_in};
use super::track::Samples;

/// A list whose share is smaller did not act (R6.22).
const NOT_ACTING: f64 = 0.2;

/// A list whose share is larger, up to as much above 1, acted.
const ACTING: f64 = 0.8;

/// Shifts of the current that are tried, in CNC cycles.
const SHIFTS: std::ops::RangeInclusive<i32> = -4..=8;

/// The following error is looked at for so many s after a reversal …
const AFTER_S: f64 = 0.15;

/// … and for as long before it.
const BEFORE_S: f64 = 0.05;

/// Following errors at reversals that are smaller say nothing, in mm.
const NOTICEABLE: f64 = 0.0003;

/// So many standard errors are no accident.
const SIGNIFICANT: f64 = 3.0;

/// What a recording tells of the timing of a value list.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "state")]
#[non_exhaustive]
pub enum Timing {
    /// No following error was recorded, or no reversal.
    Open,
    /// The list did not act, or its current is not in the torque.
    Off {
        /// Part of the list's current that is in the torque.
        share: f64,
    },
    /// The part lies between: it is not clear whether this list acted.
    Other {
        /// Part of the list's current that is in the torque.
        share: f64,
    },
    /// The list acted.
    On {
        /// Part of the list's current that is in the torque.
        share: f64,
        /// First swing of the following error after a reversal in µm: positive where the axis stays
        /// behind, negative where it is ahead.
        swing_um: f64,
        /// Standard error of the swing over the reversals.
        error_um: f64,
        /// Reversals that were looked at.
        reversals: usize,
    },
}

impl Timing {
    /// The sentence about it.
    pub fn sentence(&self) -> String {
        match self {
            Self::Open => {
                "its timing is open: no following error at a reversal was recorded".to_owned()
            }
            Self::Off { share } => format!(
                "compensation was off or is not in this torque (about {share:.1} of the current of the list), so its \
                 timing is open"
            ),
            Self::Other { share } => format!(
                "it is not clear whether this list acted (about {share:.1} of its current), so its timing is open"
            ),
            Self::On {
                share,
                swing_um,
                error_um,
                reversals,
            } => {
                let state = self.early_or_late().unwrap_or("neither early nor late");
                format!(
                    "a list acted (about {share:.1} of the current of this one) and is {state}: following error of \
                     {swing_um:.2} µm, ± {error_um:.2}, at {reversals} reversals"
                )
            }
        }
    }

    /// `early` or `late`, where the following error tells.
    pub fn early_or_late(&self) -> Option<&'static str> {
        let Self::On {
            swing_um, error_um, ..
        } = self
        else {
            return None;
        };
        let least = (SIGNIFICANT * error_um).max(NOTICEABLE * UM);
        (swing_um.abs() > least).then_some(if *swing_um > 0.0 { "late" } else { "early" })
    }
}

/// µm in a mm.
const UM: f64 = 1000.0;

/// Averaging time in s of all signals alike: it keeps what is linear, and takes the steps of an
/// encoder away.
const AVERAGED_S: f64 = 0.005;

/// A recording with the current that a list adds.
pub(super) struct Followed<'a> {
    pub(super) samples: &'a Samples,
    /// Commanded less actual position in mm.
    pub(super) errors: &'a [f64],
    /// The current of the list at each sample.
    pub(super) predicted: &'a [f64],
    pub(super) accelerations: &'a [f64],
    /// Samples at which the axis turns without standing still.
    pub(super) turns: &'a [usize],
    /// The direction of each sample.
    pub(super) signs: &'a [f64],
    /// Samples in a CNC cycle.
    pub(super) cycle: f64,
}

impl Followed<'_> {
    /// What is to be said of the timing.
    pub(super) fn timing(&self) -> Timing {
        if self.turns.is_empty() {
            return Timing::Open;
        }
        let width = samples_in(AVERAGED_S, self.samples.step_s);
        let [errors, torques, currents, velocities, accelerations] = [
            self.errors,
            &self.samples.torques,
            self.predicted,
            // An error that is measured some cycles apart has a part of the velocity.
            &self.samples.velocities,
            self.accelerations,
        ]
        .map(|signal| moving_average(signal, width));
        let smooth = Smooth {
            times_s: &self.samples.times_s,
            errors,
            torques,
            currents,
            velocities,
            accelerations,
        };
        let fits = SHIFTS.filter_map(|cycles| {
            #[allow(clippy::cast_possible_truncation)] // some hundred samples
            let shift = (f64::from(cycles) * self.cycle).round() as isize;
            smooth.share(shift)
        });
        let best = fits.min_by(|one, other| one.1.total_cmp(&other.1));
        match best.map(|it| it.0) {
            None => Timing::Open,
            Some(share) if share.abs() < NOT_ACTING => Timing::Off { share },
            Some(share) if (share - 1.0).abs() > 1.0 - ACTING => Timing::Other { share },
            Some(share) => self.swing(share),
        }
    }

    /// The first swing of the following error at the reversals.
    fn swing(&self, share: f64) -> Timing {
        let [before, after] = [BEFORE_S, AFTER_S].map(|it| samples_in(it, self.samples.step_s));
        let swing = |&turn: &usize| {
            let level = self.errors.get(turn.checked_sub(before)?..turn)?;
            let level = level.iter().sum::<f64>() / count(before);
            let path = self.errors.get(turn..turn + after)?;
            let signed = path.iter().map(|it| (it - level) * self.signs[turn]);
            let most = signed.clone().map(f64::abs).fold(0.0, f64::max);
            // The first way out that is no small one.
            signed.into_iter().find(|it| it.abs() > 0.5 * most)
        };
        let swings: Vec<f64> = self.turns.iter().filter_map(swing).collect();
        let all = count(swings.len());
        if swings.len() < 2 {
            return Timing::Open;
        }
        let mean = swings.iter().sum::<f64>() / all;
        let squares: f64 = swings.iter().map(|it| (it - mean) * (it - mean)).sum();
        Timing::On {
            share,
            swing_um: mean * UM,
            error_um: (squares / (all - 1.0) / all).sqrt() * UM,
            reversals: swings.len(),
        }
    }
}

/// The averaged signals.
struct Smooth<'a> {
    times_s: &'a [f64],
    errors: Vec<f64>,
    torques: Vec<f64>,
    currents: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
}

impl Smooth<'_> {
    /// The part of the shifted current that is in the torque, and the squares that are left.
    fn share(&self, shift: isize) -> Option<(f64, f64)> {
        const SIZE: usize = 9;
        let mut sums = vec![vec![0.0; SIZE + 1]; SIZE];
        let (mut integral, mut squares) = (0.0, 0.0);
        let times = self.times_s;
        for at in 1..times.len() - 1 {
            let step = times[at] - times[at - 1];
            integral += self.errors[at] * step;
            let Some(then) = at.checked_add_signed(-shift) else {
                continue;
            };
            let Some(&current) = self.currents.get(then) else {
                continue;
            };
            let span = (times[at + 1] - times[at - 1]) / 2.0;
            let [before, here, after] = [at - 1, at, at + 1].map(|it| self.errors[it]);
            let row = [
                1.0,
                times[at] - times[0],
                here,
                (after - before) / (2.0 * span),
                // The current loop and the dead time of the drive: a Taylor term of a delay.
                (after - 2.0 * here + before) / (span * span),
                integral,
                self.velocities[at],
                self.accelerations[at],
                current,
            ];
            let torque = self.torques[at];
            squares += torque * torque;
            for (sums, one) in sums.iter_mut().zip(row) {
                for (sum, other) in sums.iter_mut().zip(row.into_iter().chain([torque])) {
                    *sum += one * other;
                }
            }
        }
        let right: Vec<f64> = sums.iter().map(|row| row[SIZE]).collect();
        // Columns of one size: a torque has hundreds of units, an integral of an error none.
        let sizes: Vec<f64> = (0..SIZE).map(|at| sums[at][at].sqrt().max(1e-12)).collect();
        for (at, row) in sums.iter_mut().enumerate() {
            for (value, size) in row.iter_mut().zip(sizes.iter().chain([&1.0])) {
                *value /= size * sizes[at];
            }
        }
        let found = solve_linear(sums)?;
        let mut parts = found.iter().zip(&sizes).map(|(part, size)| part / size);
        let explained: f64 = parts
            .clone()
            .zip(&right)
            .map(|(part, sum)| part * sum)
            .sum();
        Some((parts.next_back()?, squares - explained))
    }
}
