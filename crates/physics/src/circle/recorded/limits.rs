//! The least requirements on a recording, and the tolerance of a circle.

use std::ops::Range;

/// Minimum number of points of a turn.
pub const MIN_POINTS: usize = 72;

/// A gap between two points that is bridged, in degrees.
pub(super) const WIDEST_GAP_DEG: f64 = 6.0;

/// Greatest distance of a point from the circle, and greatest roundness deviation of a circle, in
/// mm: a machine is far better.
pub(super) const MOST_MM: f64 = 1.0;

/// The ratio of two radii or feeds that are the same.
pub(super) const LIKE: Range<f64> = 0.9..1.1;
