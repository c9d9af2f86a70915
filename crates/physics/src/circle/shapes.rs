//! The shapes that are fitted to recorded paths at once, with their standard errors (R5.28).

use super::crossing::PlaneAxis;
use super::direction::Direction;
use super::evidence_shape::{SHAPES, ShapeTerm, ShapeValues, Term};
use super::linear::Normal;
use super::periodic::{Joint, Periodic, Screw};
use super::series::AngleSeries;
use super::turning::CosineSine;

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

/// Fitted shapes, and the paths less them.
pub(super) struct Shapes {
    normal: Normal<SHAPES>,
    is_single: bool,
    found: ShapeValues,
    pub(super) terms: Vec<Term>,
    pub(super) left: Vec<AngleSeries>,
}

impl Shapes {
    pub(super) fn fit(series: &[AngleSeries]) -> Option<Self> {
        let is_single = series.len() == 1;
        let mut normal = Normal::<SHAPES>::new();
        for one in series {
            for (angle, value) in one.steps() {
                normal.add(row(angle, one.direction, is_single), value);
            }
        }
        normal.hold_unused();
        let shapes = Self {
            found: normal.clone().solve()?,
            normal,
            is_single,
            terms: Vec::new(),
            left: Vec::new(),
        };
        let spreads = shapes.normal.spreads()?;
        Some(shapes.judged(series, &spreads, None))
    }

    /// The shapes together with a periodic error, which takes from each the part that may belong to either.
    pub(super) fn with(&self, periodic: &Periodic, series: &[AngleSeries]) -> Option<Self> {
        let joint = &periodic.joint;
        let mut found = self.found;
        let mut spreads = self.normal.spreads()?;
        for (at, (unknown, spread)) in found.iter_mut().zip(&mut spreads).enumerate() {
            let shares = joint.shares.map(|it| it[at]);
            *unknown -= shares[0] * joint.parts[0] + shares[1] * joint.parts[1];
            *spread += joint.spread(shares);
        }
        let shapes = Self {
            normal: self.normal.clone(),
            is_single: self.is_single,
            found,
            terms: Vec::new(),
            left: Vec::new(),
        };
        Some(shapes.judged(series, &spreads, Some(periodic)))
    }

    /// The screw's own part of the residual of the shapes.
    pub(super) fn joint(&self, screw: &Screw) -> Option<Joint> {
        let mut sums = [[0.0; SHAPES]; 2];
        let (mut squares, mut products, mut count) = ([0.0; 3], [0.0; 2], 0.0);
        for one in &self.left {
            for (angle, value) in one.steps() {
                let columns = screw.columns(angle, one.radius_mm);
                let row = row(angle, one.direction, self.is_single);
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
        joint.shares = shares;
        joint.explains /= f64::max(count, 1.0);
        Some(joint)
    }

    fn judged(
        mut self,
        series: &[AngleSeries],
        spreads: &ShapeValues,
        periodic: Option<&Periodic>,
    ) -> Self {
        self.left = self.less(series, periodic);
        let of_blocks = self.left.iter().map(AngleSeries::block_variance);
        let of_blocks = of_blocks.fold(0.0, f64::max);
        let told: &[(usize, ShapeTerm, f64)] = if self.is_single { &OF_ONE } else { &OF_BOTH };
        let term = |&(at, shape, factor): &(usize, ShapeTerm, f64)| Term {
            shape,
            size_um: factor * self.found[at],
            error_um: factor * (spreads[at] * of_blocks).sqrt(),
        };
        self.terms = told.iter().map(term).collect();
        self
    }

    /// Paths less the shapes, and less a periodic error.
    pub(super) fn less(
        &self,
        series: &[AngleSeries],
        periodic: Option<&Periodic>,
    ) -> Vec<AngleSeries> {
        let less = |one: &AngleSeries| {
            one.less(|angle, direction| {
                let row = row(angle, direction, self.is_single);
                let of_shapes: f64 = row.iter().zip(self.found).map(|(a, b)| a * b).sum();
                of_shapes + periodic.map_or(0.0, |it| it.at(angle, one.radius_mm))
            })
        };
        series.iter().map(less).collect()
    }
}

/// Steps where X and Y reverse: half of them against the direction of the axis.
fn steps(angle: CosineSine, turning: f64) -> [f64; 2] {
    [
        0.5 * turning * angle.sin.signum() * angle.cos,
        -0.5 * turning * angle.cos.signum() * angle.sin,
    ]
}

fn row(angle: CosineSine, direction: Direction, is_single: bool) -> ShapeValues {
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
    ];
    if is_single {
        for at in UNTOLD {
            row[at] = 0.0;
        }
    }
    row
}
