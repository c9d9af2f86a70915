//! The parameters of a value list that are searched.

use serde::Serialize;

use crate::simulation::{DriveParameters, plant_list};
use frictcomp::lists::{FrictionList, Points};

/// The four parameters that are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[non_exhaustive]
pub struct Candidate {
    /// P-COMP-00043, in 0.1 µm.
    pub position_delay: i32,
    /// P-COMP-00044, in CNC cycles.
    pub reversal_lookahead: u16,
    /// P-COMP-00058, in CNC cycles.
    pub delay_cycles: i16,
    /// P-COMP-00045, in 0.1 %.
    pub scaling_factor: i16,
}

impl Candidate {
    /// Returns the parameters of a list.
    pub fn of(list: &FrictionList) -> Self {
        Self {
            position_delay: list.position_delay,
            reversal_lookahead: list.reversal_lookahead,
            delay_cycles: list.delay_cycles,
            scaling_factor: list.scaling_factor,
        }
    }

    /// Returns the value list with the friction curve of a drive and these parameters, its points in their written
    /// form.
    pub fn list(self, drive: &DriveParameters, points: Points) -> FrictionList {
        self.with_table(&plant_list(drive), points)
    }

    /// Returns a list with these parameters, its points in their written form.
    pub(crate) fn with_table(self, list: &FrictionList, points: Points) -> FrictionList {
        FrictionList {
            position_delay: self.position_delay,
            reversal_lookahead: self.reversal_lookahead,
            delay_cycles: self.delay_cycles,
            scaling_factor: self.scaling_factor,
            table: points.rounded(&list.table),
            max_points: list.max_points,
        }
    }
}
