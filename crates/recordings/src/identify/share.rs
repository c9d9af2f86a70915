//! The share of the current of a list in a recorded torque (R6.22).
//!
//! The torque follows its command after a dead time and with the time constant of the current loop. The
//! command is linear in the following error, its derivative and its integral, in the feed-forward of the
//! motion, and in the current of the list. Time constant, delay of the error and shift of the current are
//! not known: each set of them is fitted, and weighted by its likelihood.

use super::around::{Instruments, SignalAround, SignalWindow, dot};
use super::statistics::{count, median, noise_of, samples_in};
use frictcomp_physics::linear::inverse;

/// The part of the current of a list that is in a torque, with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Share {
    pub(super) value: f64,
    /// Standard error, with that of the unknown delays.
    pub(super) error: f64,
}

/// A recording at its samples.
pub(super) struct Signals<'a> {
    pub(super) torques: &'a [f64],
    /// Commanded less actual position in mm.
    pub(super) errors: &'a [f64],
    /// The current of the list.
    pub(super) currents: &'a [f64],
    /// The motion: velocities, accelerations, positions.
    pub(super) motion: [&'a [f64]; 3],
    /// The direction of each sample.
    pub(super) signs: &'a [f64],
    /// Samples at which the axis reverses without standstill.
    pub(super) turns: &'a [usize],
    pub(super) step_s: f64,
    /// Samples in a CNC cycle.
    pub(super) cycle: f64,
}

/// Time constants of current loops that are tried, in s.
const TIME_CONSTANTS_S: [f64; 7] = [0.0001, 0.0003, 0.0006, 0.001, 0.0015, 0.002, 0.003];

/// Dead times that are tried: multiples of this, in s.
const DEAD_TIME_S: f64 = 0.00025;

/// The number of dead times.
const DEAD_TIMES: u32 = 7;

/// Shifts of the current that are tried, in CNC cycles (R6.22).
const SHIFTS: std::ops::RangeInclusive<i32> = -4..=8;

/// Parts of a sample between which signals are evaluated.
const PARTS: usize = 4;

/// Seconds before a reversal at which a window starts …
const BEFORE_S: f64 = 0.04;

/// … and maximum seconds after it.
const AFTER_S: f64 = 0.15;

/// Minimum seconds after a reversal.
const LEAST_AFTER_S: f64 = 0.03;

/// Maximum number of windows.
const MOST_WINDOWS: usize = 24;

/// Shifts of the current in CNC cycles that serve as instruments.
const KNOWN_SHIFTS: [f64; 6] = [-1.0, 0.0, 1.0, 2.0, 4.0, 8.0];

/// Least error of the equations of the loops, as a share of the current.
const LEAST_ERROR: f64 = 0.005;

/// Minimum noise of a torque, in drive units: it comes in whole ones.
const LEAST_NOISE: f64 = 0.28;

impl Signals<'_> {
    /// Returns the share, if two reversals or more were recorded that do not follow each other too soon.
    pub(super) fn share(&self) -> Option<Share> {
        let windows = self.windows();
        if windows.len() < 2 {
            return None;
        }
        let instruments =
            Instruments::new(&windows, (self.step_s, self.signs), |at| self.known(at))?;
        let column = |signal: &dyn Fn(usize) -> f64| instruments.column(&windows, signal);
        let torque = column(&|at| self.torques[at]);
        let [velocity, acceleration, position] = self.motion;
        let motion = [
            column(&|_| 1.0),
            column(&|at| velocity[at]),
            column(&|at| acceleration[at]),
            column(&|at| position[at]),
        ];
        let errors = between(self.errors);
        let integral = between(&integrated(self.errors, self.step_s));
        let currents: Vec<f64> = self.currents.iter().flat_map(|it| [*it; PARTS]).collect();
        let part_s = self.step_s / count(PARTS);
        let mut fits = Vec::new();
        for constant_s in TIME_CONSTANTS_S {
            let filter = Lag::new(part_s, constant_s);
            let lagging = filter.of(&errors, Hold::Line);
            let summed = filter.of(&integral, Hold::Line);
            let added = filter.of(&currents, Hold::Step);
            let rate = |at: usize| (errors[at] - lagging[at]) / constant_s;
            let shifted: Vec<SignalAround> = SHIFTS
                .map(|cycles| {
                    let shift = rounded(f64::from(cycles) * self.cycle);
                    column(&|at| {
                        at.checked_add_signed(-shift)
                            .map_or(0.0, |it| added[it * PARTS])
                    })
                })
                .collect();
            for number in 0..DEAD_TIMES {
                let late = rounded(f64::from(number) * DEAD_TIME_S / part_s);
                let at_part = |at: usize| (at * PARTS).saturating_add_signed(-late);
                let error = [
                    column(&|at| lagging[at_part(at)]),
                    column(&|at| rate(at_part(at))),
                    column(&|at| summed[at_part(at)]),
                ];
                let rest: Vec<&SignalAround> = motion.iter().chain(&error).collect();
                fits.extend(shifted.iter().filter_map(|current| {
                    let columns: Vec<&SignalAround> =
                        rest.iter().copied().chain([current]).collect();
                    TorqueFit::of(&instruments, &torque, &columns)
                }));
            }
        }
        TorqueFit::together(&fits)
    }

    /// Windows around reversals, evenly chosen if there are many.
    fn windows(&self) -> Vec<SignalWindow> {
        let samples = |time_s: f64| samples_in(time_s, self.step_s);
        // The shifts of the current need samples, too.
        let margin = samples(f64::from(*SHIFTS.end() + 1) * self.cycle * self.step_s);
        let gaps: Vec<f64> = self
            .turns
            .windows(2)
            .map(|it| count(it[1] - it[0]))
            .collect();
        let shortest_s = median(&gaps).map_or(AFTER_S, |it| 0.7 * it * self.step_s);
        if shortest_s < LEAST_AFTER_S {
            return Vec::new();
        }
        let (before, after) = (
            samples(BEFORE_S.min(shortest_s / 2.0)),
            samples(AFTER_S.min(shortest_s)),
        );
        let of = |(number, &turn): (usize, &usize)| {
            let window = SignalWindow {
                from: turn.checked_sub(before)?,
                turn,
                to: turn + after,
            };
            let end = self.torques.len().checked_sub(margin)?;
            let is_alone = number
                .checked_sub(1)
                .is_none_or(|it| self.turns[it] < window.from)
                && self.turns.get(number + 1).is_none_or(|&it| it >= window.to);
            (window.from >= margin && window.to <= end && is_alone).then_some(window)
        };
        let all: Vec<SignalWindow> = self.turns.iter().enumerate().filter_map(of).collect();
        let wanted = all.len().min(MOST_WINDOWS);
        (0..wanted).map(|it| all[it * all.len() / wanted]).collect()
    }

    /// Returns the known signals of a sample, without noise.
    fn known(&self, at: usize) -> Vec<f64> {
        let shifted = KNOWN_SHIFTS.map(|cycles| {
            let place = at.checked_add_signed(-rounded(cycles * self.cycle));
            place
                .and_then(|it| self.currents.get(it))
                .map_or(0.0, |it| it * 0.01)
        });
        [1.0]
            .into_iter()
            .chain(self.motion.map(|it| it[at]))
            .chain(shifted)
            .collect()
    }
}

/// One fit of the torque.
struct TorqueFit {
    share: f64,
    error: f64,
    /// Signal of the instruments in the residual, as a multiple of the noise.
    misfit: f64,
    /// Number of free parameters.
    free: f64,
}

impl TorqueFit {
    /// Returns the fit of a torque by signals, the last of which is the current.
    fn of(
        instruments: &Instruments,
        torque: &SignalAround,
        columns: &[&SignalAround],
    ) -> Option<Self> {
        let size = columns.len();
        let with = |one: &SignalAround| {
            columns
                .iter()
                .map(|it| one.expected_with(it))
                .collect::<Vec<_>>()
        };
        let mut matrix: Vec<Vec<f64>> = columns.iter().map(|it| with(it)).collect();
        for (at, row) in matrix.iter_mut().enumerate() {
            row[at] *= 1.0 + 1e-9;
        }
        let inverse = inverse(&matrix)?;
        let right: Vec<f64> = columns.iter().map(|it| it.expected_with(torque)).collect();
        let parts: Vec<f64> = inverse.iter().map(|row| dot(row, &right)).collect();
        let last = &inverse[size - 1];
        let variance: f64 = (0..size)
            .flat_map(|i| (0..size).map(move |j| (i, j)))
            .map(|(i, j)| last[i] * last[j] * columns[i].both_expected(columns[j]))
            .sum();
        let left = |of: &dyn Fn(&SignalAround) -> &[f64]| {
            let mut left = of(torque).to_vec();
            for (column, part) in columns.iter().zip(&parts) {
                for (value, one) in left.iter_mut().zip(of(column)) {
                    *value -= part * one;
                }
            }
            left
        };
        // The noise is determined from the first windows.
        let noises: Vec<f64> = (0..torque.values.len().min(4))
            .map(|window| noise_of(&left(&|it| &it.values[window])))
            .collect();
        let noise = median(&noises)?.max(LEAST_NOISE / torque.size);
        let total = left(&|it| &it.total);
        let unit = torque.size / columns[size - 1].size;
        Some(Self {
            share: parts[size - 1] * unit,
            error: (variance.max(0.0).sqrt() * noise * unit).hypot(LEAST_ERROR),
            misfit: instruments.found_in(&total) / (noise * noise),
            free: count(total.len() - size),
        })
    }

    /// Returns the combined share of the fits, each weighted by its likelihood.
    fn together(fits: &[Self]) -> Option<Share> {
        let valid = || {
            fits.iter()
                .filter(|it| it.misfit.is_finite() && it.error.is_finite())
        };
        let best = valid().min_by(|one, other| one.misfit.total_cmp(&other.misfit))?;
        let (mut weights, mut sum, mut squares) = (0.0, 0.0, 0.0);
        // A misfit of even the best one beyond the noise makes all of them less certain.
        let excess = (best.misfit / best.free).max(1.0);
        for fit in valid() {
            let error = fit.error * excess.sqrt();
            let weight = ((best.misfit - fit.misfit) / 2.0 / excess).exp() / (error * error);
            weights += weight;
            sum += weight * fit.share;
            squares += weight * (fit.share * fit.share + error * error);
        }
        let value = sum / weights;
        let error = (squares / weights - value * value).max(0.0).sqrt();
        (value.is_finite() && error.is_finite()).then_some(Share { value, error })
    }
}

/// Course of a signal between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hold {
    /// The value of the first.
    Step,
    /// A line.
    Line,
}

/// A lag of first order.
struct Lag {
    kept: f64,
}

impl Lag {
    fn new(step_s: f64, constant_s: f64) -> Self {
        Self {
            kept: (-step_s / constant_s).exp(),
        }
    }

    fn of(&self, signal: &[f64], hold: Hold) -> Vec<f64> {
        let mut before = signal[0];
        let mut value = before;
        signal
            .iter()
            .map(|&here| {
                let target = match hold {
                    Hold::Step => before,
                    Hold::Line => f64::midpoint(before, here),
                };
                value = self.kept * value + (1.0 - self.kept) * target;
                before = here;
                value
            })
            .collect()
    }
}

fn integrated(signal: &[f64], step_s: f64) -> Vec<f64> {
    let (mut sum, mut before) = (0.0, signal[0]);
    let mut add = |&here: &f64| {
        sum += f64::midpoint(before, here) * step_s;
        before = here;
        sum
    };
    signal.iter().map(&mut add).collect()
}

/// Returns the signal at parts of each sample, on cubic curves through four neighbours.
fn between(signal: &[f64]) -> Vec<f64> {
    let last = signal.len() - 1;
    let curve = |at: usize| {
        let [before, here, next, after] = [
            at.saturating_sub(1),
            at,
            (at + 1).min(last),
            (at + 2).min(last),
        ]
        .map(|it| signal[it]);
        (0..PARTS).map(move |part| {
            let t = count(part) / count(PARTS);
            let cubic = 3.0 * (here - next) + after - before;
            let square = 2.0 * before - 5.0 * here + 4.0 * next - after;
            here + 0.5 * t * (next - before + t * (square + t * cubic))
        })
    };
    (0..=last).flat_map(curve).collect()
}

#[allow(clippy::cast_possible_truncation)] // some hundred samples
fn rounded(samples: f64) -> isize {
    samples.round() as isize
}
