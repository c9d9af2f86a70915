//! The measured values of a cycle.

use std::sync::Arc;

use super::path::Distance;
use crate::motion::Cause;

/// Measured values of a cycle.
pub(super) struct MeasuredCycle<'a> {
    pub(super) time_s: f64,
    pub(super) cause: &'a Arc<Cause>,
    /// Commanded positions of the driven axes, in mm.
    pub(super) positions: &'a [f64],
    /// Velocities in mm/s.
    pub(super) velocities: &'a [f64],
    pub(super) path_velocity: f64,
    pub(super) programmed_velocity: f64,
    /// The additive currents of the programmed run.
    pub(super) added: &'a [f64],
    pub(super) distances: &'a [Distance; 3],
}
