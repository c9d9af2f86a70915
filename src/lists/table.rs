//! A friction value list that the control accepts.

use serde::{Deserialize, Serialize};

/// The table size without P-COMP-00062, or with the value 0.
pub const DEFAULT_MAX_POINTS: u32 = 20;

/// One point of the friction table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TablePoint {
    /// Velocity in µm/s, or 0.001°/s, P-COMP-00046.
    pub input: f64,
    /// Motor current in drive units, P-COMP-00047.
    pub output: f64,
}

/// A friction value list that passed the control's checks (chapter 3.3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrictionList {
    /// Distance of the build-up after a reversal in 0.1 µm or 0.0001°, P-COMP-00043.
    pub position_delay: i32,
    /// CNC cycles of the decay before a reversal, P-COMP-00044.
    pub reversal_lookahead: u16,
    /// Scaling of all outputs in 0.1 %, P-COMP-00045.
    pub scaling_factor: i16,
    /// Dead time of the output in CNC cycles, P-COMP-00058.
    pub delay_cycles: i16,
    /// Reserved table size, P-COMP-00062.
    pub max_points: u32,
    /// The points that are used, velocities ascending.
    pub table: Vec<TablePoint>,
}
