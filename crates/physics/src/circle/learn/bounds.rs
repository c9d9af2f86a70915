//! The lists around the best one that a step may reach.

use super::round::output_at;
use crate::circle::tune::{Candidate, Ranges};
use frictcomp::lists::{FrictionList, Points, TablePoint};

/// The velocities of the points in µm/s, the first ones free.
const INPUTS: [f64; 20] = [
    0.0, 10.0, 20.0, 35.0, 60.0, 100.0, 150.0, 220.0, 330.0, 500.0, 700.0, 1000.0, 2000.0, 3500.0,
    6000.0, 10_000.0, 25_000.0, 80_000.0, 200_000.0, 500_000.0,
];

/// Points up to 1 mm/s.
const FREE: usize = 12;

/// Greatest distance of an output from the friction, as a share.
const BOUND: f64 = 0.6;

/// Greatest bend of the shares of three neighbours: second difference of outputs by their friction
/// (R5.29).
const BEND: f64 = 0.15;

/// Greatest change of an output as a part of the friction (R16.4).
const OUTPUT: f64 = 0.35;

/// Greatest change of `delay_cycles`.
const DELAY: f64 = 8.0;

/// Greatest change of `position_delay` in its units.
const DISTANCE: f64 = 5.0;

/// Greatest change of `reversal_lookahead` in cycles.
const LOOKAHEAD: f64 = 2.0;

/// A scaling factor with which only the outputs scale the table.
const UNSCALED: i16 = 1000;

/// Variables of the search: the outputs up to 1 mm/s, `delay_cycles`, `position_delay`,
/// `reversal_lookahead`. Each goes from −1 to 1, the largest step.
pub(super) const VARIABLES: usize = FREE + 3;

/// Lists within a step of the best one.
#[derive(Debug, Clone)]
pub(super) struct Steps {
    best: Candidate,
    max_points: u32,
    /// Outputs of the best list at the velocities of the search, scaled.
    outputs: Vec<f64>,
    /// The measured friction there.
    friction: Vec<f64>,
    /// Greatest current as a part of the friction.
    most: f64,
    ranges: Ranges,
    points: Points,
    /// The largest step as a share of the largest at the beginning.
    share: f64,
}

impl Steps {
    pub(super) fn new(
        best: &FrictionList,
        (friction, most): (&FrictionList, f64),
        (ranges, points): (&Ranges, Points),
        share: f64,
    ) -> Self {
        let of = |list: &FrictionList| INPUTS.map(|input| output_at(list, input)).to_vec();
        Self {
            best: Candidate {
                scaling_factor: UNSCALED,
                ..Candidate::of(best)
            },
            max_points: best.max_points,
            outputs: of(best),
            friction: of(friction),
            most,
            ranges: ranges.clone(),
            points,
            share,
        }
    }

    /// Returns the list of a point of the search, within all bounds.
    pub(super) fn list(&self, point: &[f64]) -> FrictionList {
        let parts = self.parts(point);
        let output = |at: usize| {
            let part = parts.get(at).map(|it| 1.0 + it);
            let wanted = part.map_or(self.outputs[at], |it| it * self.friction[at]);
            // Rounding adds at most half a unit.
            wanted.min(self.most * self.friction[at] - 0.5).max(0.0)
        };
        let table = INPUTS.iter().enumerate().map(|(at, &input)| TablePoint {
            input,
            output: output(at),
        });
        let size = u32::try_from(INPUTS.len()).unwrap_or(u32::MAX);
        let list = FrictionList {
            position_delay: self.best.position_delay,
            reversal_lookahead: self.best.reversal_lookahead,
            delay_cycles: self.best.delay_cycles,
            scaling_factor: self.best.scaling_factor,
            max_points: self.max_points.max(size),
            table: table.collect(),
        };
        self.candidate(point).with_table(&list, self.points)
    }

    /// Returns the outputs up to 1 mm/s as parts of the friction above it, each at most a step from the best and
    /// together without kinks (R5.29).
    fn parts(&self, point: &[f64]) -> [f64; FREE] {
        let most = OUTPUT * self.share;
        let wanted: Vec<f64> = (0..FREE)
            .map(|at| {
                let from = self.outputs[at] / self.friction[at] - 1.0;
                let change = (most * point[at]).clamp(-most, most);
                (from + change).clamp(-BOUND, self.most - 1.0)
            })
            .collect();
        smoothed(&wanted)
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the ranges
    fn candidate(&self, point: &[f64]) -> Candidate {
        let moved = |from: f64, most: f64, by: f64| {
            let most = (most * self.share).max(1.0);
            (from + (most * by).clamp(-most, most)).round()
        };
        let (best, ranges) = (&self.best, &self.ranges);
        let delay = moved(f64::from(best.delay_cycles), DELAY, point[FREE]);
        let distance = moved(f64::from(best.position_delay), DISTANCE, point[FREE + 1]);
        let lookahead = moved(
            f64::from(best.reversal_lookahead),
            LOOKAHEAD,
            point[FREE + 2],
        );
        Candidate {
            delay_cycles: (delay as i16)
                .clamp(*ranges.delay_cycles.start(), *ranges.delay_cycles.end()),
            position_delay: (distance as i32)
                .clamp(*ranges.position_delay.start(), *ranges.position_delay.end()),
            reversal_lookahead: (lookahead.max(0.0) as u16).clamp(
                *ranges.reversal_lookahead.start(),
                *ranges.reversal_lookahead.end(),
            ),
            scaling_factor: best.scaling_factor,
        }
    }

    /// Returns the distance of a point from the bounds of a step, squared.
    pub(super) fn excess(point: &[f64]) -> f64 {
        point
            .iter()
            .map(|it| (it.abs() - 1.0).max(0.0).powi(2))
            .sum()
    }

    /// Returns the mean square of a step, as a part of the largest.
    pub(super) fn length(point: &[f64]) -> f64 {
        let squares: f64 = point.iter().map(|it| it.clamp(-1.0, 1.0).powi(2)).sum();
        #[allow(clippy::cast_precision_loss)] // 15
        let count = VARIABLES as f64;
        squares / count
    }
}

/// Returns the factors of a point of the search, within their bounds and without kinks: repeatedly, three neighbours
/// that bend too much share the excess. The following points of the curve are not free.
fn smoothed(point: &[f64]) -> [f64; FREE] {
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
