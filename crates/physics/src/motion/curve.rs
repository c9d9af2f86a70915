//! A cubic piece of a path that rounds corners or joins short lines (R11.21, R11.22).
//!
//! A span of a uniform cubic B-spline: neighbouring spans meet with equal direction and curvature.

use super::limits::AxisLimits;
use super::profile::Bounds;
use super::share::Share;

/// Share of the acceleration for the curve itself: the rest speeds up and slows down.
const CURVE_ACCELERATION: f64 = 0.9;
/// Share of the jerk for the curve itself.
const CURVE_JERK: f64 = 0.7;
/// Share of the rest for the change of path velocity across the path.
const CROSS_JERK: f64 = 0.5;

/// The places at which a span is searched for its extremes.
const LOOKED_AT: [f64; 9] = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];

/// Nodes and weights of Gauss and Legendre on 0 to 1.
const NODES: [(f64, f64); 5] = [
    (0.046_910_077_030_668_07, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// Number of steps to find the parameter of a distance; two are enough for short spans.
const STEPS: usize = 8;

/// A span of a B-spline.
#[derive(Debug, Clone)]
pub(super) struct SplineSpan {
    axes: Box<[MovingAxis]>,
    length: f64,
}

/// One axis that moves along a span.
#[derive(Debug, Clone, Copy)]
struct MovingAxis {
    /// Place among the axes of the machine.
    place: usize,
    /// Whether the feed refers to the axis.
    is_main: bool,
    /// The coefficients of the powers of the parameter.
    cubic: [f64; 4],
    /// The steps from control point to control point.
    steps: [f64; 3],
    /// The largest change of the position, the slope and the bend with the distance.
    largest: [f64; 3],
}

/// State along a curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Along {
    u: f64,
    /// The change of the distance with the parameter, the change of that, and the next one.
    speed: f64,
    gain: f64,
    growth: f64,
}

impl MovingAxis {
    fn position(&self, u: f64) -> f64 {
        let horner = |sum: f64, coefficient: &f64| sum * u + coefficient;
        self.cubic.iter().rev().fold(0.0, horner)
    }

    /// Returns the first, second and third derivatives by the parameter.
    fn derivatives(&self, u: f64) -> [f64; 3] {
        let [_, _, c, d] = self.cubic;
        let [before, within, after] = self.steps;
        let rest = 1.0 - u;
        [
            // No weight is negative: steps in one direction never give a motion in the other.
            0.5 * (rest * rest * before + (1.0 + 2.0 * u * rest) * within + u * u * after),
            2.0 * c + 6.0 * d * u,
            6.0 * d,
        ]
    }

    /// Returns the first, second and third derivatives by the distance.
    fn by_distance(&self, along: Along) -> [f64; 3] {
        let Along {
            u,
            speed,
            gain,
            growth,
        } = along;
        let [first, second, third] = self.derivatives(u);
        let slope = first / speed;
        let bend = (second - slope * gain) / (speed * speed);
        let twist = (third - 3.0 * bend * speed * gain - slope * growth) / speed.powi(3);
        [slope, bend, twist]
    }
}

impl SplineSpan {
    /// Returns the span with these control points, by axis; `None` if it is not a curve with a length.
    pub(super) fn new(points: [&[f64]; 4], main: &[bool]) -> Option<Self> {
        let [p, q, r, s] = points;
        let axis = |place: usize| {
            let (p, q, r, s) = (p[place], q[place], r[place], s[place]);
            MovingAxis {
                place,
                is_main: main[place],
                cubic: [
                    (p + 4.0 * q + r) / 6.0,
                    (r - p) / 2.0,
                    f64::midpoint(p, r) - q,
                    (s - p + 3.0 * (q - r)) / 6.0,
                ],
                steps: [q - p, r - q, s - r],
                largest: [0.0; 3],
            }
        };
        let moves = |place: &usize| {
            let to_p = |other: &[f64]| other[*place].total_cmp(&p[*place]);
            [q, r, s].into_iter().any(|other| to_p(other).is_ne())
        };
        let moving = (0..p.len()).filter(moves).map(axis);
        let mut curve = Self {
            axes: moving.collect(),
            length: 0.0,
        };
        curve.length = curve.way(1.0);
        if !(curve.length > 0.0 && curve.length.is_finite()) {
            return None;
        }
        for u in LOOKED_AT {
            let along = curve.along(u);
            if along.speed <= 1e-6 * curve.length {
                return None;
            }
            for axis in &mut curve.axes {
                let found = axis.by_distance(along);
                for (largest, found) in axis.largest.iter_mut().zip(found) {
                    *largest = largest.max(found.abs());
                }
            }
        }
        Some(curve)
    }

    pub(super) fn length(&self) -> f64 {
        self.length
    }

    fn speed(&self, u: f64) -> f64 {
        let main = self.axes.iter().filter(|axis| axis.is_main);
        let square: f64 = main.map(|axis| axis.derivatives(u)[0].powi(2)).sum();
        square.sqrt()
    }

    fn along(&self, u: f64) -> Along {
        let (mut square, mut product, mut next) = (0.0, 0.0, 0.0);
        for axis in self.axes.iter().filter(|axis| axis.is_main) {
            let [first, second, third] = axis.derivatives(u);
            square += first * first;
            product += first * second;
            next += second * second + first * third;
        }
        let speed = square.sqrt();
        let gain = product / speed;
        Along {
            u,
            speed,
            gain,
            growth: (next - gain * gain) / speed,
        }
    }

    /// Returns the distance up to a parameter.
    fn way(&self, u: f64) -> f64 {
        let parts = NODES.iter();
        u * parts
            .map(|(node, weight)| weight * self.speed(u * node))
            .sum::<f64>()
    }

    /// Returns the state after a distance.
    pub(super) fn after(&self, distance: f64) -> Along {
        if distance <= 0.0 {
            return self.along(0.0);
        }
        if distance >= self.length {
            return self.along(1.0);
        }
        let mut u = distance / self.length;
        for _ in 0..STEPS {
            let left = distance - self.way(u);
            u = (u + left / self.speed(u)).clamp(0.0, 1.0);
            if left.abs() <= 1e-13 * self.length {
                break;
            }
        }
        self.along(u)
    }

    fn axis(&self, axis: usize) -> Option<&MovingAxis> {
        self.axes.iter().find(|it| it.place == axis)
    }

    /// Returns the position of an axis there; `None` if it does not move.
    pub(super) fn position(&self, axis: usize, along: Along) -> Option<f64> {
        Some(self.axis(axis)?.position(along.u))
    }

    /// Returns the slope and the bend of an axis there.
    pub(super) fn shape(&self, axis: usize, along: Along) -> [f64; 2] {
        self.axis(axis).map_or([0.0; 2], |axis| {
            let [slope, bend, _] = axis.by_distance(along);
            [slope, bend]
        })
    }

    /// Lowers bounds to what the limits of the axes leave along the curve: `v²·x''` of the
    /// acceleration and `v³·x'''` of the jerk of each axis are its own, the rest is for the change of
    /// the path velocity.
    pub(super) fn restrict(&self, bounds: &mut Bounds, (limits, share): (&[AxisLimits], Share)) {
        for axis in &self.axes {
            let limits = share.of(&limits[axis.place]);
            let [slope, bend, twist] = axis.largest;
            let velocity = [
                limits.velocity / slope,
                (CURVE_ACCELERATION * limits.acceleration / bend).sqrt(),
                (CURVE_JERK * limits.curve_jerk / twist).cbrt(),
            ];
            bounds.velocity = velocity.into_iter().fold(bounds.velocity, f64::min);
        }
        let velocity = bounds.velocity;
        for axis in &self.axes {
            let limits = share.of(&limits[axis.place]);
            let [slope, bend, twist] = axis.largest;
            let across = velocity * velocity * bend;
            let jerk =
                (limits.jerk - velocity.powi(3) * twist).max(limits.jerk * (1.0 - CURVE_JERK));
            let acceleration = ((limits.acceleration - across) / slope)
                .min(CROSS_JERK * jerk / (3.0 * velocity * bend));
            bounds.acceleration = bounds.acceleration.min(acceleration);
            let crossing = 3.0 * velocity * bounds.acceleration * bend;
            bounds.jerk = bounds.jerk.min((jerk - crossing).max(jerk / 2.0) / slope);
        }
    }
}
