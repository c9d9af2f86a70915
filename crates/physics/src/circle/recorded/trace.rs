//! The rows of a recording.

use std::ops::Range;

/// Actual positions of two axes in the order of time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordedTrace {
    /// X and Y.
    pub points_mm: Vec<[f64; 2]>,
    /// The time of each point; empty if it is not known.
    pub times_s: Vec<f64>,
}

impl RecordedTrace {
    /// Creates a trace of positions without times.
    pub fn of_points(points_mm: Vec<[f64; 2]>) -> Self {
        Self {
            points_mm,
            times_s: Vec::new(),
        }
    }

    /// Returns the rows without those that repeat the one before: from a recorder that is faster than the control, or
    /// from standstill.
    pub(super) fn without_repeats(&self) -> Self {
        let mut kept = Self::default();
        for (at, &point) in self.points_mm.iter().enumerate() {
            if kept.points_mm.last() != Some(&point) {
                kept.points_mm.push(point);
                kept.times_s.extend(self.times_s.get(at));
            }
        }
        kept
    }

    /// Returns the time from one point to another, if it is known and positive.
    pub(super) fn duration_s(&self, from: usize, to: usize) -> Option<f64> {
        let duration = self.times_s.get(to)? - self.times_s.get(from)?;
        (duration.is_finite() && duration > 0.0).then_some(duration)
    }

    /// Returns the longest time between two of some points, if it is known.
    pub(super) fn widest_step_s(&self, points: &Range<usize>) -> Option<f64> {
        let times = self.times_s.get(points.clone())?;
        let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
        steps.max_by(f64::total_cmp)
    }
}
