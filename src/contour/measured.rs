//! What is measured in a cycle.

use std::sync::Arc;

use super::path::Distance;
use crate::motion::Cause;

/// What is measured in a cycle.
pub(super) struct Measured<'a> {
    pub(super) time_s: f64,
    pub(super) cause: &'a Arc<Cause>,
    /// Where the driven axes are commanded to be, in mm.
    pub(super) positions: &'a [f64],
    /// How fast, in mm/s.
    pub(super) velocities: &'a [f64],
    pub(super) path_velocity: f64,
    pub(super) programmed_velocity: f64,
    /// The additive currents of the programmed run.
    pub(super) added: &'a [f64],
    pub(super) distances: &'a [Distance; 3],
}
