//! The shape of a value list below 1 mm/s (R5.25).
//!
//! After a reversal a contact bends before it slides, and the force that the axis needs depends on the
//! distance. A value list depends on the velocity, but at these velocities one follows from the other. The
//! output of each slow point is free within bounds around the friction curve, and so are
//! `delay_cycles`, since a bent contact still pushes in the old direction, `position_delay` and
//! `reversal_lookahead`.

use super::candidate::Candidate;
use super::cma_es::{CmaEs, POINTS};
use super::heights::Heights;
use super::ranges::Ranges;
use crate::simulation::{DriveParameters, plant_list_at};
use frictcomp::lists::{FrictionList, Points, TablePoint};

/// The velocities of the points in µm/s, the first ones free.
pub(in crate::circle) const INPUTS: [f64; 20] = [
    0.0, 10.0, 20.0, 35.0, 60.0, 100.0, 150.0, 220.0, 330.0, 500.0, 700.0, 1000.0, 2000.0, 3500.0,
    6000.0, 10_000.0, 25_000.0, 80_000.0, 200_000.0, 500_000.0,
];

/// Points up to 1 mm/s.
pub(in crate::circle) const FREE: usize = 12;

/// Greatest distance of an output from the curve, as a share.
pub(in crate::circle) const BOUND: f64 = 0.6;

/// Greatest bend of the shares of three neighbours: second difference of outputs by their curve
/// (R5.29).
const BEND: f64 = 0.15;

/// The first step of the search, as a part of the curve.
const STEP: f64 = 0.15;

/// Cycles of `delay_cycles` for a step of 1.
const DELAY: f64 = 20.0;

/// Units of `position_delay` for a step of 1.
const DISTANCE: f64 = 20.0;

/// Cycles of `reversal_lookahead` for a step of 1.
const LOOKAHEAD: f64 = 10.0;

/// Delay at which each search begins, relative to the unshaped list, in cycles: it ends in another
/// valley.
const LATER: [f64; RUNS] = [0.0, 10.0, 20.0];

/// A scaling factor with which only the outputs scale the table.
const UNSCALED: i16 = 1000;

/// Number of searches that begin at different places.
const RUNS: usize = 3;

/// Generations of each search, before only the best of them continues.
const TRIAL: usize = 40;

/// Maximum number of generations, of all searches together.
const MOST: usize = 300;

/// Generations without a gain after which the search ends.
const IDLE: usize = 60;

/// Smallest gain that counts, as a share.
const GAIN: f64 = 0.001;

/// A search for outputs and times.
#[derive(Debug, Clone)]
pub(super) struct ShapeSearch {
    runs: [SearchRun; RUNS],
    /// Index of the current one.
    current: usize,
    start: Candidate,
    ranges: Ranges,
    curve: FrictionList,
    points: Points,
    asked: Vec<Vec<f64>>,
    best: Option<(f64, FrictionList)>,
    generations: usize,
    idle: usize,
    goal: f64,
}

/// One of the searches, and the least value that it found.
#[derive(Debug, Clone)]
struct SearchRun {
    cma_es: CmaEs,
    least: f64,
}

impl ShapeSearch {
    /// Maximum number of lists that a search tries.
    pub(super) const MOST_TRIALS: usize = MOST * POINTS;

    /// A search around the friction curve of a drive with the parameters that are best without a
    /// shape. Outputs are written as `points`.
    pub(super) fn new(
        drive: &DriveParameters,
        start: Candidate,
        ranges: &Ranges,
        points: Points,
    ) -> Self {
        let begin = |run: usize| {
            let mut mean = vec![0.0; FREE];
            mean.extend([LATER[run] / DELAY, 0.0, 0.0]);
            SearchRun {
                cma_es: CmaEs::new(mean, STEP, run as u64),
                least: f64::INFINITY,
            }
        };
        Self {
            runs: std::array::from_fn(begin),
            current: 0,
            start: Candidate {
                scaling_factor: UNSCALED,
                ..start
            },
            ranges: ranges.clone(),
            curve: plant_list_at(drive, &INPUTS),
            points,
            asked: Vec::new(),
            best: None,
            generations: 0,
            idle: 0,
            goal: f64::INFINITY,
        }
    }

    /// The lists to try next; `None` when the search is over.
    pub(super) fn next_trials(&mut self) -> Option<Vec<FrictionList>> {
        if self.generations >= MOST || self.idle >= IDLE {
            return None;
        }
        self.current = self.generations / TRIAL;
        if self.current >= RUNS {
            let best = (0..RUNS)
                .min_by(|&one, &other| self.runs[one].least.total_cmp(&self.runs[other].least));
            self.current = best.unwrap_or_default();
        }
        self.asked = self.runs[self.current].cma_es.ask();
        let lists = self.asked.iter().map(|point| self.shaped(point));
        Some(lists.collect())
    }

    /// Takes the results of the lists, in their order.
    pub(super) fn take(&mut self, heights: &[Heights]) {
        self.generations += 1;
        self.idle += 1;
        let asked = std::mem::take(&mut self.asked);
        let mut values = Vec::new();
        let run = &mut self.runs[self.current];
        for heights in heights {
            run.least = run.least.min(heights.worst_um());
        }
        for (point, heights) in asked.iter().zip(heights) {
            let worst = heights.worst_um();
            if self.best.as_ref().is_none_or(|(least, _)| worst < *least) {
                self.best = Some((worst, self.shaped(point)));
            }
            values.push(heights.smooth_um() * (1.0 + self.excess(point)));
        }
        let least = self
            .best
            .as_ref()
            .map_or(f64::INFINITY, |(least, _)| *least);
        // While the searches compete, none of them is abandoned.
        if least < self.goal * (1.0 - GAIN) || self.generations <= RUNS * TRIAL {
            self.goal = least;
            self.idle = 0;
        }
        self.runs[self.current].cma_es.tell(&values);
    }

    /// The best list that was tried.
    pub(super) fn best(self) -> Option<FrictionList> {
        self.best.map(|(_, list)| list)
    }

    /// The list of a point of the search, within all bounds.
    fn shaped(&self, point: &[f64]) -> FrictionList {
        let candidate = self.candidate(point);
        let factors = smoothed(point);
        let factors = factors.iter().chain(std::iter::repeat(&0.0));
        let bent = self.curve.table.iter().zip(factors);
        let bent = bent.map(|(point, factor)| TablePoint {
            input: point.input,
            output: point.output * (1.0 + factor),
        });
        let list = FrictionList {
            table: bent.collect(),
            ..self.curve.clone()
        };
        candidate.with_table(&list, self.points)
    }

    /// The parameters of a point of the search, within their ranges.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the ranges
    fn candidate(&self, point: &[f64]) -> Candidate {
        let [delay, distance, lookahead] = self.free(point);
        let ranges = &self.ranges;
        Candidate {
            delay_cycles: (delay as i16)
                .clamp(*ranges.delay_cycles.start(), *ranges.delay_cycles.end()),
            position_delay: (distance as i32)
                .clamp(*ranges.position_delay.start(), *ranges.position_delay.end()),
            reversal_lookahead: (lookahead as u16).clamp(
                *ranges.reversal_lookahead.start(),
                *ranges.reversal_lookahead.end(),
            ),
            ..self.start
        }
    }

    /// `delay_cycles`, `position_delay` and `reversal_lookahead` of a point as whole numbers, without regard to
    /// their ranges.
    fn free(&self, point: &[f64]) -> [f64; 3] {
        let start = &self.start;
        let starts = [
            (f64::from(start.delay_cycles), DELAY),
            (f64::from(start.position_delay), DISTANCE),
            (f64::from(start.reversal_lookahead), LOOKAHEAD),
        ];
        let moved = point.get(FREE..).unwrap_or_default();
        std::array::from_fn(|at| {
            let (start, unit) = starts[at];
            (start + unit * moved.get(at).copied().unwrap_or_default()).round()
        })
    }

    /// Returns the distance of a point of the search from its bounds.
    fn excess(&self, point: &[f64]) -> f64 {
        let smoothed = smoothed(point);
        let factors = point.iter().zip(smoothed);
        let outside = factors.map(|(wanted, taken)| (wanted - taken).powi(2));
        let candidate = self.candidate(point);
        let taken = [
            f64::from(candidate.delay_cycles),
            f64::from(candidate.position_delay),
            f64::from(candidate.reversal_lookahead),
        ];
        let units = [DELAY, DISTANCE, LOOKAHEAD];
        let wanted = self.free(point).into_iter().zip(taken).zip(units);
        let beyond = wanted.map(|((wanted, taken), unit)| ((wanted - taken) / unit).powi(2));
        outside.sum::<f64>() + beyond.sum::<f64>()
    }
}

/// The factors of a point of the search, within their bounds and without kinks: repeatedly, three
/// neighbours that bend too much share the excess. The following points of the curve are not free.
pub(in crate::circle) fn smoothed(point: &[f64]) -> [f64; FREE] {
    const ROUNDS: usize = 200;
    // Rounded outputs bend a little more.
    const ALLOWED: f64 = 0.93 * BEND;
    let mut factors = [0.0; FREE + 2];
    for (factor, wanted) in factors.iter_mut().zip(&point[..FREE]) {
        *factor = wanted.clamp(-BOUND, BOUND);
    }
    for _ in 0..ROUNDS {
        let mut is_smooth = true;
        for at in 1..=FREE {
            let bend = factors[at - 1] - 2.0 * factors[at] + factors[at + 1];
            let excess = bend - bend.clamp(-ALLOWED, ALLOWED);
            if excess.abs() > 1e-3 {
                is_smooth = false;
            }
            // The normal of the bound is 1, -2, 1; points that are not free do not move.
            let moved = |at: usize| if at < FREE { 1.0 } else { 0.0 };
            let length = moved(at - 1) + 4.0 * moved(at) + moved(at + 1);
            for (place, weight) in [(at - 1, 1.0), (at, -2.0), (at + 1, 1.0)] {
                factors[place] -= moved(place) * weight * excess / length;
            }
        }
        if is_smooth {
            break;
        }
    }
    std::array::from_fn(|at| factors[at].clamp(-BOUND, BOUND))
}
