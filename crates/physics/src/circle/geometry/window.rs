//! The windows of disturbances around a crossing (R5.22).

use std::ops::RangeInclusive;

use super::profile::PER_DEGREE;

/// Degrees before a crossing at which the window begins.
const BEFORE_DEG: i32 = 8;

/// Least width of the window after a crossing, in degrees.
const LEAST_DEG: f64 = 8.0;

/// Least duration of the window after a crossing: by then the loops of a drive have settled.
const SETTLING_S: f64 = 0.3;

/// The sides of a window reach at least this far from the crossing, in degrees.
const SIDE_DEG: i32 = 20;

/// Angle from one crossing to the next, in degrees.
const QUARTER_DEG: i32 = 90;

/// The fastest angular velocity in degrees per second at which twice the window ends before the next
/// crossing.
const FASTEST_DEG_PER_S: f64 = 45.0 / SETTLING_S;

/// The window at every crossing of a path, in fixed angles in the direction of travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CrossingWindow {
    after: i32,
}

impl CrossingWindow {
    /// Returns the window of a path with a number of seconds per turn; ±8° if that is not known. `None` if it would
    /// reach the next crossing.
    pub(crate) fn of(turn_s: Option<f64>) -> Option<Self> {
        let turning = turn_s.map_or(0.0, |turn_s| 360.0 / turn_s);
        if turning > FASTEST_DEG_PER_S * (1.0 + 1e-9) {
            return None;
        }
        let degrees = LEAST_DEG.max(turning * SETTLING_S);
        #[allow(clippy::cast_possible_truncation)] // at most 4500
        let after = (degrees * f64::from(PER_DEGREE)).round() as i32;
        Some(Self { after })
    }

    /// Returns the window of the disturbance.
    pub(crate) fn inside(self) -> RangeInclusive<i32> {
        -BEFORE_DEG * PER_DEGREE..=self.after
    }

    /// Returns the side before the window.
    pub(crate) fn before() -> RangeInclusive<i32> {
        -SIDE_DEG * PER_DEGREE..=-BEFORE_DEG * PER_DEGREE
    }

    /// Returns the side after the window.
    pub(crate) fn after(self) -> RangeInclusive<i32> {
        self.after..=(2 * self.after).max(SIDE_DEG * PER_DEGREE)
    }

    /// Returns the window in which no peak is left: the second half of the distance to the next
    /// crossing.
    pub(crate) fn quiet(self) -> RangeInclusive<i32> {
        let half = QUARTER_DEG * PER_DEGREE / 2;
        self.after.max(half)..=(QUARTER_DEG - BEFORE_DEG) * PER_DEGREE
    }

    /// Returns the range half-way from a crossing to where nothing is left of a peak: a peak that has not decayed
    /// leaves something there.
    pub(crate) fn decaying(self) -> RangeInclusive<i32> {
        let half = self.quiet().start() / 2;
        half - PER_DEGREE..=half + PER_DEGREE
    }

    /// Returns the width of the window after a crossing, in degrees.
    pub(crate) fn degrees(self) -> f64 {
        f64::from(self.after) / f64::from(PER_DEGREE)
    }
}

/// Returns the highest feed in mm/min at which a circle of this radius in mm has figures at its crossings.
pub(crate) fn fastest_feed(radius_mm: f64) -> f64 {
    FASTEST_DEG_PER_S.to_radians() * radius_mm * 60.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_lasts_at_least_as_long_as_loops_settle() {
        // R5.22
        assert_eq!(CrossingWindow::of(None).unwrap().inside(), -800..=800);
        assert_eq!(CrossingWindow::of(Some(60.0)).unwrap().inside(), -800..=800);
        // Radius 10 mm at 1200 mm/min: 2 rad/s, 34.4° in 0.3 s.
        let window = CrossingWindow::of(Some(std::f64::consts::PI)).unwrap();
        assert_eq!(window.inside(), -800..=3438);
        assert_eq!(window.after(), 3438..=6876);
        // Radius 5 mm at 1000 mm/min: 191°/s.
        assert_eq!(CrossingWindow::of(Some(1.885)), None);
        assert!((fastest_feed(5.0) - 785.4).abs() < 0.1);
    }
}
