//! The control's ASCII lists: their lines, what they say, and the control's checks.

mod axis;
mod check;
mod friction;
mod line;
mod parameter;
mod program;
mod startup;
mod value;
mod write;

use serde::{Deserialize, Serialize};

pub use axis::AxisValues;
pub use check::{Conditions, FrictionReading, Verdict};
pub use friction::{Field, FrictionDraft, WrittenPoint};
pub use line::{Entries, Entry};
pub use parameter::{AxisType, Origin, Parameter};
pub use program::{ChannelPrograms, Role};
pub use startup::{ChannelAxis, ChannelList, ListKind, NamedList, StartupList};
pub use value::{Given, Number, Written};
pub use write::{Points, write_value_list};

/// The table size that P-COMP-00062 has when no list, or the value 0, is given.
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
