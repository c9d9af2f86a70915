//! The least-squares circle through points.

use std::f64::consts::TAU;

use super::error::RecordedError;
use super::limits::MOST_MM;
use crate::linear::Normal;

/// Number of steps of the fit; it converges in a few.
const STEPS: usize = 12;

/// A circle in mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct FittedCircle {
    pub(super) centre: [f64; 2],
    pub(super) radius: f64,
}

impl FittedCircle {
    /// Returns the circle through three points; `None` if they are on a line.
    pub(super) fn through([first, second, third]: [[f64; 2]; 3]) -> Option<Self> {
        let from_first = |point: [f64; 2]| [point[0] - first[0], point[1] - first[1]];
        let square = |way: [f64; 2]| way[0] * way[0] + way[1] * way[1];
        let [second, third] = [from_first(second), from_first(third)];
        let twice = 2.0 * (second[0] * third[1] - second[1] * third[0]);
        let x = (third[1] * square(second) - second[1] * square(third)) / twice;
        let y = (second[0] * square(third) - third[0] * square(second)) / twice;
        let radius = x.hypot(y);
        let is_circle = radius.is_finite() && radius > 0.0;
        is_circle.then_some(Self {
            centre: [first[0] + x, first[1] + y],
            radius,
        })
    }

    /// Returns the least-squares circle: Kåsa's linear fit of x² + y² as the start, then Gauss-Newton steps on the
    /// distances from the circle.
    pub(super) fn of(points: &[[f64; 2]]) -> Result<Self, RecordedError> {
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let count = points.len() as f64;
        let mut mean = [0.0; 2];
        for point in points {
            mean[0] += point[0] / count;
            mean[1] += point[1] / count;
        }
        let shifted = || points.iter().map(|[x, y]| (x - mean[0], y - mean[1]));
        let mut start = Normal::<3>::new();
        for (x, y) in shifted() {
            start.add([2.0 * x, 2.0 * y, 1.0], x * x + y * y);
        }
        let [mut a, mut b, square] = start.solve().ok_or(RecordedError::NoCircle)?;
        let mut radius = (square + a * a + b * b).sqrt();
        for _ in 0..STEPS {
            let mut normal = Normal::<3>::new();
            for (x, y) in shifted() {
                let distance = (x - a).hypot(y - b).max(f64::MIN_POSITIVE);
                normal.add(
                    [(x - a) / distance, (y - b) / distance, 1.0],
                    distance - radius,
                );
            }
            let [da, db, dr] = normal.solve().ok_or(RecordedError::NoCircle)?;
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

    /// Returns the distance of a point outside the circle.
    pub(super) fn outside(&self, point: [f64; 2]) -> f64 {
        (point[0] - self.centre[0]).hypot(point[1] - self.centre[1]) - self.radius
    }

    /// Returns the angle of a point as seen from the centre, in radians.
    pub(super) fn angle(&self, point: [f64; 2]) -> f64 {
        (point[1] - self.centre[1]).atan2(point[0] - self.centre[0])
    }

    /// Returns the permitted distance from this circle, in mm.
    pub(super) fn tolerance(&self) -> f64 {
        /// Largest tolerance as a part of the radius, which keeps an oval from passing as a small circle.
        const PART: f64 = 0.05;
        MOST_MM.min(PART * self.radius)
    }

    /// Returns whether points lie in every eighth of the turn.
    pub(super) fn goes_round(&self, points: &[[f64; 2]]) -> bool {
        const EIGHTHS: f64 = 8.0;
        let mut seen: u8 = 0;
        for &point in points {
            let eighth = self.angle(point).rem_euclid(TAU) / TAU * EIGHTHS;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 8
            let eighth = (eighth as u32).min(7);
            seen |= 1 << eighth;
        }
        seen == u8::MAX
    }
}
