//! The least requirements on a recording, and the tolerance of a circle.

/// Minimum number of points of a turn.
pub const MIN_POINTS: usize = 72;

/// A gap between two points that is bridged, in degrees.
pub(super) const WIDEST_GAP_DEG: f64 = 6.0;

/// Greatest distance of a point from the circle, and greatest roundness deviation of a circle, in
/// mm: a machine is far better.
pub(super) const MOST_MM: f64 = 1.0;
