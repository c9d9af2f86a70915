//! The columns of a recorded trace.

use super::additive::Switched;

/// The columns of a recorded trace, one CNC cycle per row. Positions or velocities must exist.
#[derive(Debug, Clone, Default)]
pub struct TraceColumns {
    /// The time of each cycle.
    pub times_s: Option<Vec<f64>>,
    /// Positions in 0.1 µm or 0.0001°.
    pub positions: Option<Vec<f64>>,
    /// Velocities in µm/s or 0.001°/s.
    pub velocities: Option<Vec<f64>>,
    /// State of the compensation in each cycle.
    pub switched: Vec<Switched>,
}
