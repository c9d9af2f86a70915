//! What a recording must have, and what is still a circle.

/// Points of a turn at least.
pub const MIN_POINTS: usize = 72;

/// A gap between two points that is bridged, in degrees.
pub(super) const WIDEST_GAP_DEG: f64 = 6.0;

/// What lies farther from the circle is not on it, and a circle that is less round is refused, in
/// mm: a machine is better by far.
pub(super) const MOST_MM: f64 = 1.0;
