//! Circles that were recorded on a machine: actual positions of two axes (R5.20).

use std::f64::consts::TAU;

use thiserror::Error;

use super::compare::Side;
use super::direction::Direction;
use super::figures::{Nominal, Paths};
use super::profile::{Gap, Gatherer, RadialProfile};
use crate::diagnostic::Shown;

/// Points of a turn at least.
pub const MIN_POINTS: usize = 72;

/// A gap between two points that is bridged, in degrees.
pub(super) const WIDEST_GAP: f64 = 6.0;

/// Steps of the fit; it converges in a few.
const FIT_STEPS: usize = 12;

/// A circle that was recorded, in either direction.
#[derive(Debug, Clone)]
pub struct RecordedCircle {
    /// The direction of travel, found from the points.
    pub direction: Direction,
    /// The centre of the least-squares circle.
    pub centre_mm: [f64; 2],
    /// Its radius.
    pub radius_mm: f64,
    /// How many points the evaluated turn has.
    pub points: usize,
    profile: RadialProfile,
}

/// One or two recorded circles with their figures.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The circles.
    pub circles: Vec<RecordedCircle>,
    /// The commanded radius, where it is known.
    pub radius_mm: Option<f64>,
    /// The figures.
    pub side: Side,
}

/// A recording that is no circle.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordedError {
    /// A file of ten rows.
    #[error("{0} points are too few for a circle; at least {MIN_POINTS} are needed")]
    TooFew(usize),
    /// A straight line, or a point.
    #[error("the points are not on a circle")]
    NoCircle,
    /// A quarter of a circle.
    #[error("the points cover {0:.0}\u{b0} of the circle; a full turn is needed")]
    NotATurn(f64),
    /// A circle of which a part was not recorded.
    #[error(
        "points are missing: {0:.0}\u{b0} of the circle are in gaps of more than {WIDEST_GAP}\u{b0}"
    )]
    Gaps(f64),
    /// Three recordings.
    #[error("{0} recordings were given")]
    Count(usize),
    /// `--radius 0`
    #[error(
        "a radius of {} mm is not possible; it must be between 0.001 and 1000000 mm", Shown(*.0)
    )]
    CommandedRadius(f64),
    /// Two counter-clockwise circles.
    #[error("both recordings run {}", .0.as_str())]
    SameDirection(Direction),
    /// `--radius 50` for a circle of 100 mm.
    #[error("the recorded circle has a radius of {found_mm:.3} mm, not {commanded_mm} mm")]
    Radius {
        /// The radius that was given.
        commanded_mm: f64,
        /// The radius of the points.
        found_mm: f64,
    },
}

impl RecordedError {
    /// Advice for the user.
    pub fn help(&self) -> &'static str {
        match self {
            Self::TooFew(_) | Self::NotATurn(_) | Self::Gaps(_) => {
                "record one full turn with some overlap, without pauses of the recorder"
            }
            Self::NoCircle => "check that the columns hold the actual positions of two axes",
            Self::Count(_) => "give one of each direction, two at most",
            Self::CommandedRadius(_) => "write the commanded radius, `--radius 100`",
            Self::SameDirection(_) => "give one recording of each direction",
            Self::Radius { .. } => "check the commanded radius and the unit of the columns",
        }
    }
}

/// A circle through points: centre and radius in mm.
#[derive(Debug, Clone, Copy)]
struct Fit {
    centre: [f64; 2],
    radius: f64,
}

impl RecordedCircle {
    /// A circle from the actual positions of both axes, in the order of time. If there is more than a full
    /// turn, the turn in the middle counts, so that run-in and run-out fall away.
    ///
    /// F and D are against the commanded radius `commanded_mm`; G, H and the glitches do not
    /// depend on it.
    ///
    /// # Errors
    /// Points that make no full circle.
    pub fn new(points_mm: &[[f64; 2]], commanded_mm: Option<f64>) -> Result<Self, RecordedError> {
        if points_mm.len() < MIN_POINTS {
            return Err(RecordedError::TooFew(points_mm.len()));
        }
        let rough = Fit::of(points_mm)?;
        let (direction, turn) = rough.turn(points_mm)?;
        let fit = Fit::of(turn)?;
        if let Some(commanded_mm) = commanded_mm
            && !(0.9..1.1).contains(&(fit.radius / commanded_mm))
        {
            return Err(RecordedError::Radius {
                commanded_mm,
                found_mm: fit.radius,
            });
        }
        let mut gatherer = Gatherer::new(commanded_mm.unwrap_or(fit.radius) / 1000.0, WIDEST_GAP);
        let [cx, cy] = fit.centre;
        for [x, y] in turn {
            gatherer.take((x - cx) / 1000.0, (y - cy) / 1000.0);
        }
        let gaps = |gap: Gap| RecordedError::Gaps(gap.missing);
        Ok(Self {
            direction,
            centre_mm: fit.centre,
            radius_mm: fit.radius,
            points: turn.len(),
            profile: gatherer.finish().map_err(gaps)?,
        })
    }
}

impl Recording {
    /// Whether so many circles of such a radius can be evaluated together.
    ///
    /// # Errors
    /// More than two circles, or a radius that no circle has.
    pub fn check(circles: usize, commanded_mm: Option<f64>) -> Result<(), RecordedError> {
        if circles > 2 {
            return Err(RecordedError::Count(circles));
        }
        match commanded_mm {
            Some(radius) if !(0.001..=1e6).contains(&radius) => {
                Err(RecordedError::CommandedRadius(radius))
            }
            _ => Ok(()),
        }
    }

    /// The figures of one circle, or of one in each direction; each about its own least-squares
    /// centre. `commanded_mm` is the radius that the circles were commanded with.
    ///
    /// # Errors
    /// Two circles in the same direction.
    pub fn new(
        circles: Vec<RecordedCircle>,
        commanded_mm: Option<f64>,
    ) -> Result<Self, RecordedError> {
        if let [first, second] = &circles[..]
            && first.direction == second.direction
        {
            return Err(RecordedError::SameDirection(first.direction));
        }
        let mut paths = Paths::default();
        for circle in &circles {
            paths.set(circle.direction, circle.profile.clone());
        }
        let nominal = match commanded_mm {
            Some(_) => Nominal::Commanded,
            None => Nominal::Fitted,
        };
        Ok(Self {
            side: Side::of(paths, nominal),
            radius_mm: commanded_mm,
            circles,
        })
    }
}

impl Fit {
    /// The least-squares circle: Kåsa's linear fit of x² + y² as the start, then Gauss-Newton
    /// steps on the distances from the circle.
    fn of(points: &[[f64; 2]]) -> Result<Self, RecordedError> {
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let count = points.len() as f64;
        let mut mean = [0.0; 2];
        for point in points {
            mean[0] += point[0] / count;
            mean[1] += point[1] / count;
        }
        let shifted = || points.iter().map(|[x, y]| (x - mean[0], y - mean[1]));
        let (mut xx, mut xy, mut yy, mut xz, mut yz) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (x, y) in shifted() {
            let z = x * x + y * y;
            xx += x * x;
            xy += x * y;
            yy += y * y;
            xz += x * z;
            yz += y * z;
        }
        let determinant = xx * yy - xy * xy;
        let is_flat = determinant <= 1e-9 * (xx + yy) * (xx + yy);
        if is_flat || !determinant.is_finite() {
            return Err(RecordedError::NoCircle);
        }
        let mut a = (xz * yy - yz * xy) / determinant / 2.0;
        let mut b = (yz * xx - xz * xy) / determinant / 2.0;
        let mut radius = ((xx + yy) / count + a * a + b * b).sqrt();
        for _ in 0..FIT_STEPS {
            let mut normal = Normal::default();
            for (x, y) in shifted() {
                let distance = (x - a).hypot(y - b).max(f64::MIN_POSITIVE);
                normal.add(
                    [(x - a) / distance, (y - b) / distance, 1.0],
                    distance - radius,
                );
            }
            let Some([da, db, dr]) = normal.solve() else {
                return Err(RecordedError::NoCircle);
            };
            (a, b, radius) = (a + da, b + db, radius + dr);
            if da.abs() + db.abs() + dr.abs() < 1e-12 * radius.abs() {
                break;
            }
        }
        if !(radius.is_finite() && radius > 0.0 && a.is_finite() && b.is_finite()) {
            return Err(RecordedError::NoCircle);
        }
        Ok(Self {
            centre: [a + mean[0], b + mean[1]],
            radius,
        })
    }

    /// The direction of travel, and the full turn in the middle of the points.
    fn turn<'a>(
        &self,
        points: &'a [[f64; 2]],
    ) -> Result<(Direction, &'a [[f64; 2]]), RecordedError> {
        let angles = self.angles(points);
        let last = angles.last().copied().unwrap_or_default();
        let direction = if last < 0.0 {
            Direction::Cw
        } else {
            Direction::Ccw
        };
        let covered = last.abs();
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let step = covered / (points.len() - 1) as f64;
        if covered + 2.0 * step < TAU {
            return Err(RecordedError::NotATurn(covered.to_degrees()));
        }
        let begin = ((covered - TAU) / 2.0).max(0.0);
        let sign = direction.sign();
        let first = angles.iter().position(|angle| sign * angle >= begin - 1e-9);
        let first = first.unwrap_or_default();
        // One point more than a turn closes the gap between its ends.
        let length = angles[first..]
            .iter()
            .position(|angle| sign * angle >= begin + TAU);
        let end = length.map_or(points.len(), |length| first + length + 1);
        Ok((direction, &points[first..end]))
    }

    /// The angle of each point since the first, turns counted, in radians.
    fn angles(&self, points: &[[f64; 2]]) -> Vec<f64> {
        let [cx, cy] = self.centre;
        let mut turned = 0.0;
        let mut last = None;
        let angle = |point: &[f64; 2]| {
            let angle = (point[1] - cy).atan2(point[0] - cx);
            if let Some(last) = last.replace(angle) {
                let way: f64 = angle - last;
                turned += way - TAU * (way / TAU).round();
            }
            turned
        };
        points.iter().map(angle).collect()
    }
}

/// The normal equations of a fit with three unknowns.
#[derive(Debug, Default)]
struct Normal {
    matrix: [[f64; 3]; 3],
    right: [f64; 3],
}

impl Normal {
    fn add(&mut self, row: [f64; 3], value: f64) {
        for i in 0..3 {
            for j in 0..3 {
                self.matrix[i][j] += row[i] * row[j];
            }
            self.right[i] += row[i] * value;
        }
    }

    /// Cramer's rule; `None` where the points determine no circle.
    fn solve(&self) -> Option<[f64; 3]> {
        let whole = determinant(self.matrix);
        let scale = self.matrix[2][2].powi(3);
        if whole.is_nan() || whole.abs() <= 1e-12 * scale {
            return None;
        }
        let mut solution = [0.0; 3];
        for (column, place) in solution.iter_mut().enumerate() {
            let mut matrix = self.matrix;
            for (row, right) in matrix.iter_mut().zip(self.right) {
                row[column] = right;
            }
            *place = determinant(matrix) / whole;
        }
        Some(solution)
    }
}

fn determinant(m: [[f64; 3]; 3]) -> f64 {
    let minor = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
    m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1)
}
