//! The shapes that are fitted to recorded paths at once, with their standard errors (R5.28).

use super::evidence_shape::{SHAPES, ShapeTerm, ShapeValues, Term};
use super::periodic::{Joint, Screw};
use super::series::AngleSeries;
use super::tails::{Decays, TailPlace, Tails, columns};
use crate::circle::geometry::CosineSine;
use crate::circle::geometry::Direction;
use crate::circle::geometry::PlaneAxis;
use crate::linear::Normal;

/// Shapes visible in both directions, with their places in a row, and the ratio of each to its unknown.
const OF_BOTH: [(usize, ShapeTerm, f64); 7] = [
    (6, ShapeTerm::Scale, 2.0),
    (7, ShapeTerm::Squareness, 2.0),
    (8, ShapeTerm::Gain, 2.0),
    (9, ShapeTerm::Backlash(PlaneAxis::X), 1.0),
    (10, ShapeTerm::Backlash(PlaneAxis::Y), 1.0),
    (11, ShapeTerm::Play(PlaneAxis::X), 1.0),
    (12, ShapeTerm::Play(PlaneAxis::Y), 1.0),
];

/// Shapes visible in one direction.
const OF_ONE: [(usize, ShapeTerm, f64); 2] = [
    (9, ShapeTerm::Backlash(PlaneAxis::X), 1.0),
    (10, ShapeTerm::Backlash(PlaneAxis::Y), 1.0),
];

/// Shapes that one direction cannot distinguish from others.
const UNTOLD: [usize; 3] = [8, 11, 12];

/// The places of the tails of X and of Y in a row.
const TAILS: [[usize; 2]; 2] = [[13, 14], [15, 16]];

/// The part of what a tail takes from a term that remains uncertain: no peak decays quite exponentially.
const TAKEN: f64 = 0.05;

/// The part of the height of a tail by which every term remains uncertain for the same reason.
const OF_TAIL: f64 = 0.01;

/// The places of the cosines and sines of two screws in a row.
const SCREWS: [[usize; 2]; 2] = [[17, 18], [19, 20]];

/// Shapes that paths may have in addition to those that each is fitted with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Additions {
    /// The decays of tails.
    pub(crate) decays: Decays,
    /// Errors that repeat along an axis.
    pub(crate) screws: [Option<Screw>; 2],
}

/// The basis of the rows.
#[derive(Debug, Clone, Copy)]
struct ShapeBasis {
    is_single: bool,
    added: Additions,
}

/// The path in which a row is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathMotion {
    pub(crate) direction: Direction,
    pub(crate) turn_s: Option<f64>,
    pub(crate) radius_mm: f64,
}

impl PathMotion {
    fn of(series: &AngleSeries) -> Self {
        Self {
            direction: series.direction,
            turn_s: series.turn_s,
            radius_mm: series.radius_mm,
        }
    }
}

/// Fitted shapes, and the paths less them.
pub(crate) struct Shapes {
    normal: Normal<SHAPES>,
    basis: ShapeBasis,
    found: ShapeValues,
    pub(crate) terms: Vec<Term>,
    pub(crate) left: Vec<AngleSeries>,
}

impl Shapes {
    /// Fits the shapes and some more.
    pub(crate) fn fit(series: &[AngleSeries], added: Additions) -> Option<Self> {
        let basis = ShapeBasis {
            is_single: series.len() == 1,
            added,
        };
        let mut normal = Normal::<SHAPES>::new();
        for one in series {
            for (angle, value) in one.steps() {
                normal.add(basis.row(angle, PathMotion::of(one)), value);
            }
        }
        normal.hold_unused();
        let shapes = Self {
            found: normal.clone().solve()?,
            normal,
            basis,
            terms: Vec::new(),
            left: Vec::new(),
        };
        let spreads = shapes.normal.spreads()?;
        Some(shapes.judged(series, &spreads))
    }

    /// Returns the tails of slow peaks.
    pub(crate) fn tails(&self) -> Tails {
        Tails::new(
            self.basis.added.decays,
            TAILS.map(|of_axis| of_axis.map(|at| self.found[at])),
        )
    }

    /// Returns the squares of what is left of the paths, added up.
    pub(crate) fn squares(&self) -> f64 {
        let left = self.left.iter().flat_map(AngleSeries::steps);
        left.map(|(_, value)| value * value).sum()
    }

    /// Returns the variance of a step of what is left.
    pub(crate) fn variance(&self) -> f64 {
        let of_blocks = self.left.iter().map(AngleSeries::block_variance);
        of_blocks.fold(0.0, f64::max)
    }

    /// Returns the fitted path at a place, in µm.
    pub(crate) fn at(&self, angle: CosineSine, course: PathMotion) -> f64 {
        let row = self.basis.row(angle, course);
        row.iter().zip(self.found).map(|(a, b)| a * b).sum()
    }

    /// Makes the terms less certain by what tails that are not quite exponential can add to them.
    pub(crate) fn doubted(mut self, without: &Self) -> Self {
        if self.basis.added.decays == Decays::default() {
            return self;
        }
        let tallest = self.tails().tallest_um();
        for (term, other) in self.terms.iter_mut().zip(&without.terms) {
            let taken = TAKEN * (term.size_um - other.size_um);
            term.error_um = term.error_um.hypot(taken).hypot(OF_TAIL * tallest);
        }
        self
    }

    /// Returns the part of the residual that is explained by two more columns, which are given for an angle and a
    /// radius in mm.
    pub(crate) fn joint(&self, columns: impl Fn(CosineSine, f64) -> [f64; 2]) -> Option<Joint> {
        let mut sums = [[0.0; SHAPES]; 2];
        let (mut squares, mut products, mut count) = ([0.0; 3], [0.0; 2], 0.0);
        for one in &self.left {
            for (angle, value) in one.steps() {
                let columns = columns(angle, one.radius_mm);
                let row = self.basis.row(angle, PathMotion::of(one));
                for (sums, column) in sums.iter_mut().zip(columns) {
                    for (sum, part) in sums.iter_mut().zip(row) {
                        *sum += part * column;
                    }
                }
                let [c, s] = columns;
                for (sum, part) in squares.iter_mut().zip([c * c, c * s, s * s]) {
                    *sum += part;
                }
                products[0] += c * value;
                products[1] += s * value;
                count += 1.0;
            }
        }
        let shares = [
            self.normal.solve_for(sums[0])?,
            self.normal.solve_for(sums[1])?,
        ];
        let dot = |one: &ShapeValues, other: &ShapeValues| {
            one.iter().zip(other).map(|(a, b)| a * b).sum::<f64>()
        };
        let own = [
            squares[0] - dot(&sums[0], &shares[0]),
            squares[1] - dot(&sums[0], &shares[1]),
            squares[2] - dot(&sums[1], &shares[1]),
        ];
        let mut joint = Joint::new(own, squares, products)?;
        joint.explains /= f64::max(count, 1.0);
        Some(joint)
    }

    fn judged(mut self, series: &[AngleSeries], spreads: &ShapeValues) -> Self {
        self.left = self.less(series);
        let of_blocks = self.variance();
        let told: &[(usize, ShapeTerm, f64)] = if self.basis.is_single {
            &OF_ONE
        } else {
            &OF_BOTH
        };
        let term = |&(at, shape, factor): &(usize, ShapeTerm, f64)| Term {
            shape,
            size_um: factor * self.found[at],
            error_um: factor * (spreads[at] * of_blocks).sqrt(),
        };
        self.terms = told.iter().map(term).collect();
        self
    }

    /// Paths less the shapes.
    pub(crate) fn less(&self, series: &[AngleSeries]) -> Vec<AngleSeries> {
        let less = |one: &AngleSeries| one.less(|angle, _| self.at(angle, PathMotion::of(one)));
        series.iter().map(less).collect()
    }

    /// Returns the terms fitted in addition.
    pub(crate) fn added(&self) -> Additions {
        self.basis.added
    }

    /// Returns the amplitude in µm of a screw by its number.
    pub(crate) fn amplitude_um(&self, screw: usize) -> f64 {
        let [cos, sin] = SCREWS[screw].map(|at| self.found[at]);
        cos.hypot(sin)
    }
}

/// Steps where X and Y reverse: half of them against the direction of the axis.
fn steps(angle: CosineSine, turning: f64) -> [f64; 2] {
    [
        0.5 * turning * angle.sin.signum() * angle.cos,
        -0.5 * turning * angle.cos.signum() * angle.sin,
    ]
}

impl ShapeBasis {
    fn row(&self, angle: CosineSine, course: PathMotion) -> ShapeValues {
        let PathMotion {
            direction,
            turn_s,
            radius_mm,
        } = course;
        let CosineSine { cos, sin } = angle;
        let turning = direction.sign();
        let of = |which: f64| if turning * which > 0.0 { 1.0 } else { 0.0 };
        let [ccw, cw] = [of(1.0), of(-1.0)];
        let [x, y] = steps(angle, turning);
        let diagonal = 2.0 * cos * sin;
        let mut row = [
            ccw,
            cw,
            ccw * cos,
            ccw * sin,
            cw * cos,
            cw * sin,
            cos * cos - sin * sin,
            diagonal,
            turning * diagonal,
            x,
            y,
            0.5 * turning * cos.abs(),
            -0.5 * turning * sin.abs(),
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        for (axis, places) in PlaneAxis::ALL.into_iter().zip(TAILS) {
            let decay_s = self.added.decays[usize::from(axis == PlaneAxis::Y)];
            let Some((decay_s, turn_s)) = decay_s.zip(turn_s) else {
                continue;
            };
            let place = TailPlace {
                angle,
                direction,
                turn_s,
            };
            for (at, part) in places.into_iter().zip(columns(axis, decay_s, place)) {
                row[at] = part;
            }
        }
        for (screw, places) in self.added.screws.iter().zip(SCREWS) {
            let parts = screw.map(|it| it.columns(angle, radius_mm));
            for (at, part) in places.into_iter().zip(parts.unwrap_or_default()) {
                row[at] = part;
            }
        }
        if self.is_single {
            for at in UNTOLD {
                row[at] = 0.0;
            }
        }
        row
    }
}
