//! The parameters that are searched, and between which values.

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::lists::{Field, FrictionList, Points};
use crate::simulation::{DriveParameters, plant_list};

/// The four parameters that are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
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

/// Between which values the parameters are searched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ranges {
    /// P-COMP-00043.
    pub position_delay: RangeInclusive<i32>,
    /// P-COMP-00044.
    pub reversal_lookahead: RangeInclusive<u16>,
    /// P-COMP-00058.
    pub delay_cycles: RangeInclusive<i16>,
    /// P-COMP-00045; only compensation in the direction of the friction makes sense.
    pub scaling_factor: RangeInclusive<i16>,
}

impl Default for Ranges {
    /// The documented ranges (chapter 3.3 of the rules); of the scaling factor, half to double.
    fn default() -> Self {
        Self {
            position_delay: 0..=10,
            reversal_lookahead: 0..=4,
            delay_cycles: 0..=248,
            scaling_factor: 500..=2000,
        }
    }
}

impl Ranges {
    /// The same with a parameter beyond its documented range: `position_delay` up to 200 µm,
    /// `reversal_lookahead` up to 50 cycles. The others are wide enough.
    #[must_use]
    pub fn free(mut self, field: Field) -> Self {
        match field {
            Field::PositionDelay => self.position_delay = 0..=2000,
            Field::ReversalLookahead => self.reversal_lookahead = 0..=50,
            _ => {}
        }
        self
    }
}

impl Candidate {
    /// The value list with the friction curve of a drive and these parameters, its points as they
    /// are written.
    pub fn list(self, drive: &DriveParameters, points: Points) -> FrictionList {
        self.with_table(&plant_list(drive), points)
    }

    /// A list with these parameters, its points as they are written.
    pub(super) fn with_table(self, list: &FrictionList, points: Points) -> FrictionList {
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
