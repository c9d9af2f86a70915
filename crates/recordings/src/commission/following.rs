//! The following error of an axis: what its loops leave of the commanded motion, and the rest after reversals
//! (R16.1, R16.9).
//!
//! A loop without friction answers a commanded motion with a following error that is linear in the velocity and in
//! the accelerations of the last tenths of a second. This answer is fitted to the samples before reversals; the
//! difference from it after a reversal is due to friction, or to a list.

use std::cmp::Ordering;

use thiserror::Error;

use crate::identify::{Track, count, moving_average, noise_of, samples_in};
use frictcomp_physics::linear::solve_linear;

/// Samples that are further apart do not show a glitch: twice the requested time.
pub(super) const COARSEST_S: f64 = 0.002_05;

/// Seconds over which signals are averaged.
const AVERAGED_S: f64 = 0.008;

/// Seconds after a start or a reversal in which friction shows.
const AFTER_S: f64 = 0.15;

/// Speed in mm/s or °/s below which motion is standstill.
pub(super) const STANDSTILL: f64 = 0.05;

/// A reversal with a longer standstill in s is a stop and a start.
const AT_ONCE_S: f64 = 0.1;

/// The times in s after which an acceleration shows in the following error; the answer is linear between them.
const KNOTS_S: [f64; 11] = [
    0.0, 0.004, 0.008, 0.014, 0.02, 0.03, 0.045, 0.065, 0.09, 0.13, 0.18,
];

/// The part of the travel by which a following error may exceed what its loops explain.
const UNEXPLAINED: f64 = 0.01;

/// Reason why a following error cannot be evaluated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NotFollowed {
    /// Neither the following error nor both positions.
    #[error("it has neither the following error nor the actual position with the commanded one")]
    Absent,
    /// Samples that are too far apart.
    #[error("a sample every {step_ms} ms does not show what a reversal does; record every ms")]
    Coarse {
        /// The time between two samples, as a text of few digits.
        step_ms: String,
    },
    /// Samples that are missing.
    #[error("after {after_s:.3} s samples are missing")]
    Gap {
        /// The last time before.
        after_s: f64,
    },
    /// An axis that does not move.
    #[error("the axis does not move")]
    Still,
    /// A motion in which too little accelerates.
    #[error("its motion does not show how the loops answer to accelerations")]
    Undetermined,
    /// An actual position that goes elsewhere.
    #[error(
        "the actual position does not follow the commanded one: up to {most:.3} remain of {way:.3} that were \
         commanded; the channels of two axes are swapped, or a unit is wrong"
    )]
    Elsewhere {
        /// The largest difference in mm or degrees beyond the answer of the loops.
        most: f64,
        /// The commanded way in mm or degrees.
        way: f64,
    },
}

/// A recorded axis, and its following error beyond the answer of its loops.
#[derive(Debug, Clone)]
pub(super) struct Following {
    /// The time between two samples in s.
    step_s: f64,
    /// Commanded velocities in mm/s or °/s.
    velocities: Vec<f64>,
    /// The rest of the following errors in mm or degrees.
    left: Vec<f64>,
}

/// A reversal without a stop.
#[derive(Debug, Clone)]
pub(super) struct PassedReversal {
    /// The direction after it.
    pub(super) sign: f64,
    /// The fastest velocity of the stroke before it in mm/s or °/s.
    pub(super) speed: f64,
    /// The rest of the following error after it in mm or degrees, positive if the axis lags.
    pub(super) left: Vec<f64>,
}

impl Following {
    /// Returns the rest of following errors, commanded less actual position in 0.1 µm or 0.0001°.
    ///
    /// # Errors
    /// They are missing, too coarse, or those of another motion.
    pub(super) fn of(track: &Track, errors: &[f64]) -> Result<Self, NotFollowed> {
        let step_s = track.step_s;
        let (velocities, errors) = averaged(track, errors)?;
        let motion = CommandedMotion::of(&velocities, step_s, AFTER_S);
        let answer = motion.answer(&errors);
        let left: Vec<f64> = (0..errors.len())
            .map(|at| errors[at] - answer.as_ref().map_or(0.0, |it| motion.expected(it, at)))
            .collect();
        let most_of = |chosen: &dyn Fn(usize) -> bool| {
            let chosen = (0..left.len()).filter(|at| chosen(*at));
            chosen.fold(0.0_f64, |most, at| most.max(left[at].abs()))
        };
        let way = motion.way();
        let most = most_of(&|at| motion.is_settled[at]);
        if answer.is_none() || most > UNEXPLAINED * way {
            return Err(NotFollowed::Elsewhere { most, way });
        }
        if most_of(&|_| true) > UNEXPLAINED * way {
            return Err(NotFollowed::Undetermined);
        }
        Ok(Self {
            step_s,
            velocities,
            left,
        })
    }

    /// Returns the reversals without a stop, in their order.
    pub(super) fn turns(&self) -> Vec<PassedReversal> {
        let after = samples_in(AFTER_S, self.step_s);
        let at_once = samples_in(AT_ONCE_S, self.step_s);
        let mut turns = Vec::new();
        let mut last: Option<(usize, f64)> = None;
        let mut speed = 0.0_f64;
        for (at, &velocity) in self.velocities.iter().enumerate() {
            if velocity.abs() < STANDSTILL {
                continue;
            }
            let sign = velocity.signum();
            if let Some((before, _)) = last.filter(|it| it.1 * sign < 0.0) {
                if at - before <= at_once && at + after <= self.left.len() {
                    let left = self.left[at..at + after].iter().map(|it| it * sign);
                    turns.push(PassedReversal {
                        sign,
                        speed,
                        left: left.collect(),
                    });
                }
                speed = 0.0;
            }
            speed = speed.max(velocity.abs());
            last = Some((at, sign));
        }
        turns
    }
}

/// Returns the additional lag of an actual position in the positive direction compared with the negative one, long
/// after reversals, in mm or degrees: backlash between motor and scale, for one. `None` where the motion does not show
/// it.
pub(super) fn step_at_reversals(track: &Track, errors: &[f64]) -> Option<f64> {
    /// Time in s after which slow loops have settled.
    const SETTLED_S: f64 = 0.3;
    let (velocities, errors) = averaged(track, errors).ok()?;
    let motion = CommandedMotion::of(&velocities, track.step_s, SETTLED_S);
    motion.answer(&errors).map(|it| 2.0 * it[DIRECTION])
}

/// Returns the commanded velocities in mm/s or °/s and the following errors in mm or degrees, averaged.
fn averaged(track: &Track, errors: &[f64]) -> Result<(Vec<f64>, Vec<f64>), NotFollowed> {
    if errors.is_empty() || errors.len() != track.times_s.len() {
        return Err(NotFollowed::Absent);
    }
    let step_s = track.step_s;
    if !(step_s > 0.0 && step_s <= COARSEST_S) {
        return Err(NotFollowed::Coarse {
            step_ms: format!("{:.1}", step_s * 1000.0),
        });
    }
    let gap = track
        .times_s
        .windows(2)
        .find(|pair| pair[1] - pair[0] > 5.0 * step_s);
    if let Some(&[after_s, _]) = gap {
        return Err(NotFollowed::Gap { after_s });
    }
    let width = samples_in(AVERAGED_S, step_s);
    let velocities = moving_average(&commanded(track), width);
    let scaled: Vec<f64> = errors.iter().map(|it| it * 1e-4).collect();
    let errors = moving_average(&scaled, width);
    if velocities.iter().all(|it| it.abs() < STANDSTILL) {
        return Err(NotFollowed::Still);
    }
    Ok((velocities, errors))
}

/// Returns the commanded velocities in mm/s or °/s: as recorded, or from the positions if those are less noisy.
pub(super) fn commanded(track: &Track) -> Vec<f64> {
    let recorded = track.velocities.as_ref();
    let recorded: Option<Vec<f64>> = recorded.map(|it| it.iter().map(|it| it * 1e-3).collect());
    let derived = track.positions.as_ref().map(|positions| {
        let last = positions.len().saturating_sub(1);
        let slope = |at: usize| {
            let (from, to) = (at.saturating_sub(1), (at + 1).min(last));
            let seconds = track.times_s[to] - track.times_s[from];
            (positions[to] - positions[from]) * 1e-4 / seconds.max(1e-6)
        };
        (0..positions.len()).map(slope).collect::<Vec<f64>>()
    });
    match (recorded, derived) {
        (Some(recorded), Some(derived)) if noise_of(&derived) < noise_of(&recorded) => derived,
        (Some(recorded), _) => recorded,
        (None, derived) => derived.unwrap_or_default(),
    }
}

/// The place of the direction among the causes of a following error.
const DIRECTION: usize = 1;

/// The commanded motion, with the accelerations that still show at each sample.
struct CommandedMotion<'a> {
    velocities: &'a [f64],
    accelerations: Vec<f64>,
    /// The weights of earlier accelerations for each knot, and the sample before which they begin.
    shares: Vec<Vec<(usize, f64)>>,
    /// Whether a sample is long enough after a start or a reversal.
    is_settled: Vec<bool>,
    step_s: f64,
}

impl<'a> CommandedMotion<'a> {
    /// Returns a motion whose samples are settled this many seconds after a start or a reversal.
    fn of(velocities: &'a [f64], step_s: f64, after_s: f64) -> Self {
        let last = velocities.len() - 1;
        let slope = |at: usize| {
            let (from, to) = (at.saturating_sub(1), (at + 1).min(last));
            (velocities[to] - velocities[from]) / (count(to - from).max(1.0) * step_s)
        };
        let after = samples_in(after_s, step_s);
        let mut direction = Ordering::Equal;
        let mut since = 0;
        let mut is_settled = vec![false; velocities.len()];
        for (at, &velocity) in velocities.iter().enumerate() {
            let now = if velocity.abs() < STANDSTILL {
                Ordering::Equal
            } else {
                velocity.total_cmp(&0.0)
            };
            if now == direction {
                since += 1;
            } else {
                // The averages shortly before contain later samples.
                let before = at.saturating_sub(2 * samples_in(AVERAGED_S, step_s));
                is_settled[before..at].fill(false);
                since = 0;
            }
            direction = now;
            // At standstill friction holds, whatever the loops command.
            is_settled[at] = now.is_ne() && since >= after;
        }
        Self {
            is_settled,
            accelerations: (0..=last).map(slope).collect(),
            shares: (0..KNOTS_S.len())
                .map(|knot| shares(knot, step_s))
                .collect(),
            velocities,
            step_s,
        }
    }

    /// Returns the travel from one end to the other in mm or degrees.
    fn way(&self) -> f64 {
        let mut place = 0.0_f64;
        let [mut low, mut high] = [0.0_f64; 2];
        for velocity in self.velocities {
            place += velocity * self.step_s;
            low = low.min(place);
            high = high.max(place);
        }
        high - low
    }

    /// Returns the inputs to which the loops may respond: a constant, the direction at [`DIRECTION`], the velocity,
    /// past accelerations.
    fn causes(&self, at: usize) -> Vec<f64> {
        let velocity = self.velocities[at];
        let direction = if velocity.abs() < STANDSTILL {
            0.0
        } else {
            velocity.signum()
        };
        let past = self.shares.iter().map(|shares| {
            let weighed = shares.iter().filter_map(|&(ago, share)| {
                Some(share * self.accelerations.get(at.checked_sub(ago)?)?)
            });
            weighed.sum::<f64>()
        });
        [1.0, direction, velocity].into_iter().chain(past).collect()
    }

    fn expected(&self, answer: &[f64], at: usize) -> f64 {
        let causes = self.causes(at);
        causes
            .iter()
            .zip(answer)
            .map(|(one, other)| one * other)
            .sum()
    }

    /// Returns the answer that fits the settled samples best; `None` if nothing determines it.
    fn answer(&self, errors: &[f64]) -> Option<Vec<f64>> {
        /// Keeps what no motion determines at 0.
        const NEARLY: f64 = 1e-9;
        let size = 3 + KNOTS_S.len();
        let mut rows = vec![vec![0.0; size + 1]; size];
        for at in (0..errors.len()).filter(|at| self.is_settled[*at]) {
            let causes = self.causes(at);
            for (row, cause) in rows.iter_mut().zip(&causes).filter(|it| *it.1 != 0.0) {
                let products = causes.iter().chain([&errors[at]]);
                for (sum, other) in row.iter_mut().zip(products) {
                    *sum += cause * other;
                }
            }
        }
        for (at, row) in rows.iter_mut().enumerate() {
            row[at] = row[at] * (1.0 + NEARLY) + f64::MIN_POSITIVE.sqrt();
        }
        solve_linear(rows)
    }
}

/// Returns the earlier samples and the weights of a knot, which is linear between its neighbours.
fn shares(knot: usize, step_s: f64) -> Vec<(usize, f64)> {
    let at = KNOTS_S[knot];
    let before = knot.checked_sub(1).map_or(at, |it| KNOTS_S[it]);
    let after = KNOTS_S.get(knot + 1).copied().unwrap_or(at);
    let last = samples_in(after, step_s);
    let share = |ago: usize| {
        let time = count(ago) * step_s;
        if time <= at && at > before {
            (time - before) / (at - before)
        } else if time > at && after > at {
            (after - time) / (after - at)
        } else {
            f64::from(u8::from((time - at).abs() < 0.5 * step_s))
        }
    };
    let weighed = (0..=last).map(|ago| (ago, share(ago)));
    weighed.filter(|(_, share)| *share > 0.0).collect()
}

/// Returns where an actual position does not follow the commanded one; nothing if it was not recorded, or too
/// coarsely for that.
pub fn actual_elsewhere(track: &Track, following_errors: &[f64]) -> Option<NotFollowed> {
    let error = Following::of(track, following_errors).err();
    error.filter(|it| matches!(it, NotFollowed::Elsewhere { .. }))
}
