//! The shape of a value list below 1 mm/s (R5.25).
//!
//! After a reversal a contact bends before it slides, and the force that the axis needs depends on the
//! distance. A value list depends on the velocity, but at these velocities one follows from the other. The
//! output of each slow point is free within bounds around the friction curve, and so are
//! `delay_cycles`, since a bent contact still pushes in the old direction, `position_delay` and
//! `reversal_lookahead`.

use super::candidate::Candidate;
use crate::simulation::{DriveParameters, plant_list_at};
use frictcomp::lists::{FrictionList, Points, TablePoint};

/// The velocities of the free points in µm/s. They are close where contacts bend: a circle of 0.5 to 5 m/min
/// has moved by some µm there.
const INPUTS: [f64; FREE] = [
    0.0, 9.0, 18.0, 29.0, 42.0, 57.0, 74.0, 95.0, 122.0, 160.0, 210.0, 280.0, 380.0, 530.0, 740.0,
    1000.0,
];

/// Points up to 1 mm/s.
pub(super) const FREE: usize = 16;

/// The fastest point.
const FASTEST_UM_PER_S: f64 = 500_000.0;

/// Points between the free ones and the fastest.
const BETWEEN: usize = 3;

/// Places for them, evenly on a logarithmic scale.
const PLACES: i32 = 18;

/// Greatest distance of an output from the curve, as a share.
pub(super) const BOUND: f64 = 0.6;

/// Greatest bend of the shares of three neighbours: second difference of outputs by their curve
/// (R5.29).
pub(super) const BEND: f64 = 0.15;

/// Greatest bend before outputs are rounded, which bends them a little more.
pub(super) const ALLOWED: f64 = 0.97 * BEND;

/// A scaling factor with which only the outputs scale the table.
const UNSCALED: i16 = 1000;

/// A shape: the distance of each slow output from the curve as a share, and the times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ListShape {
    pub(super) factors: [f64; FREE],
    pub(super) times: Candidate,
}

/// The lists of shapes.
#[derive(Debug, Clone)]
pub(super) struct ShapedLists {
    curve: FrictionList,
    points: Points,
}

impl ShapedLists {
    /// Returns the shapes around the friction curve of a drive, outputs written as `points`.
    pub(super) fn new(drive: &DriveParameters, points: Points) -> Self {
        Self {
            curve: plant_list_at(drive, &inputs(drive)),
            points,
        }
    }

    /// Returns the curve itself with these times.
    pub(super) fn plain(times: Candidate) -> ListShape {
        ListShape {
            factors: [0.0; FREE],
            times: Candidate {
                scaling_factor: UNSCALED,
                ..times
            },
        }
    }

    /// Returns the list of a shape before its outputs are rounded.
    pub(super) fn exact(&self, shape: &ListShape) -> FrictionList {
        let factors = shape.factors.iter().chain(std::iter::repeat(&0.0));
        let bent = self.curve.table.iter().zip(factors);
        let bent = bent.map(|(point, factor)| TablePoint {
            input: point.input,
            output: point.output * (1.0 + factor),
        });
        FrictionList {
            table: bent.collect(),
            position_delay: shape.times.position_delay,
            reversal_lookahead: shape.times.reversal_lookahead,
            delay_cycles: shape.times.delay_cycles,
            scaling_factor: shape.times.scaling_factor,
            ..self.curve.clone()
        }
    }

    /// Returns the list of a shape as it is written.
    pub(super) fn written(&self, shape: &ListShape) -> FrictionList {
        shape.times.with_table(&self.exact(shape), self.points)
    }

    /// Returns the change of an output by one unit, as a share.
    pub(super) fn unit(&self, at: usize) -> f64 {
        1.0 / self.curve.table[at].output
    }

    /// Returns the shape with its outputs rounded as in a written list.
    pub(super) fn rounded(&self, shape: &ListShape) -> ListShape {
        let written = self.written(shape);
        ListShape {
            factors: std::array::from_fn(|at| {
                written.table[at].output / self.curve.table[at].output - 1.0
            }),
            ..*shape
        }
    }

    /// Returns the largest bend of the outputs of a shape, those above 1 mm/s rounded as in a written list.
    pub(super) fn bend(&self, factors: &[f64; FREE]) -> f64 {
        let rounded = self.points.rounded(&self.curve.table);
        let share = |at: usize| match factors.get(at) {
            Some(factor) => *factor,
            None => rounded[at].output / self.curve.table[at].output - 1.0,
        };
        let bend = |at: usize| (share(at - 1) - 2.0 * share(at) + share(at + 1)).abs();
        (1..=FREE).map(bend).fold(0.0, f64::max)
    }
}

/// Returns the velocities of all points: above 1 mm/s those between which the curve is closest to straight lines.
fn inputs(drive: &DriveParameters) -> Vec<f64> {
    let slowest = INPUTS[FREE - 1];
    let place = |at: i32| {
        let part = f64::from(at) / f64::from(PLACES + 1);
        (slowest * (FASTEST_UM_PER_S / slowest).powf(part)).round()
    };
    let places: Vec<f64> = (0..=PLACES + 1).map(place).collect();
    let curve: Vec<f64> = places
        .iter()
        .map(|it| drive.friction_n(it * 1e-6))
        .collect();
    // The largest distance of the curve from the line between two places.
    let missed = |from: usize, to: usize| {
        let slope = (curve[to] - curve[from]) / (places[to] - places[from]);
        let between = (from + 1..to).map(|at| {
            let line = curve[from] + slope * (places[at] - places[from]);
            (curve[at] - line).abs()
        });
        between.fold(0.0, f64::max)
    };
    // For each place the least distance with the points so far, and the points.
    let mut best: Vec<(f64, Vec<usize>)> = (0..places.len())
        .map(|to| (missed(0, to), Vec::new()))
        .collect();
    for _ in 0..BETWEEN {
        let longer = |to: usize| {
            let each = (1..to).map(|at| {
                let (before, points) = &best[at];
                let points = points.iter().copied().chain([at]).collect();
                (before.max(missed(at, to)), points)
            });
            let least = each.min_by(|one: &(f64, Vec<usize>), other| one.0.total_cmp(&other.0));
            least.unwrap_or_else(|| best[to].clone())
        };
        best = (0..places.len()).map(longer).collect();
    }
    let chosen = best.pop().map(|it| it.1).unwrap_or_default();
    let between = chosen.into_iter().map(|at| places[at]);
    INPUTS
        .into_iter()
        .chain(between)
        .chain([FASTEST_UM_PER_S])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Preset;

    #[test]
    fn the_fast_points_follow_the_curve() {
        // R5.25
        let drive = Preset::Mid.plant().x;
        let list = ShapedLists::new(&drive, Points::Whole).curve;
        assert_eq!(list.table.len(), 20);
        for pair in list.table.windows(2) {
            let middle = f64::midpoint(pair[0].input, pair[1].input);
            let line = f64::midpoint(pair[0].output, pair[1].output);
            let curve = drive.friction_n(middle * 1e-6) / drive.force_per_unit_n;
            assert!((line - curve).abs() < 0.006 * curve, "{pair:?}: {curve}");
        }
    }
}
