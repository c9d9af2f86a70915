//! The ranges in which parameters are searched.

use std::ops::RangeInclusive;

/// The ranges in which parameters are searched.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Ranges {
    /// P-COMP-00043.
    pub position_delay: RangeInclusive<i32>,
    /// P-COMP-00044.
    pub reversal_lookahead: RangeInclusive<u16>,
    /// P-COMP-00058.
    pub delay_cycles: RangeInclusive<i16>,
    /// P-COMP-00045; only compensation in the direction of the friction makes sense.
    pub scaling_factor: RangeInclusive<i16>,
    /// MP1511 in µs.
    pub mp1511: RangeInclusive<u32>,
    /// MP1512 in counting steps.
    pub mp1512: RangeInclusive<u32>,
}

/// A parameter that may be searched beyond its documented range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FreeParameter {
    /// Range up to 200 µm.
    PositionDelay,
    /// Range up to 50 cycles.
    ReversalLookahead,
    /// Range from 0 to 100 000 µs.
    Mp1511,
    /// Range up to 1000 counting steps.
    Mp1512,
}

impl Default for Ranges {
    /// Returns the documented ranges (chapter 3.3 of the rules) and guidelines (R8.3); of the scaling factor, half to
    /// double.
    fn default() -> Self {
        Self {
            position_delay: 0..=10,
            reversal_lookahead: 0..=4,
            delay_cycles: 0..=248,
            scaling_factor: 500..=2000,
            mp1511: 5000..=10_000,
            mp1512: 1..=49,
        }
    }
}

impl Ranges {
    /// Extends a parameter beyond its documented range.
    #[must_use]
    pub fn free(mut self, parameter: FreeParameter) -> Self {
        match parameter {
            FreeParameter::PositionDelay => self.position_delay = 0..=2000,
            FreeParameter::ReversalLookahead => self.reversal_lookahead = 0..=50,
            FreeParameter::Mp1511 => self.mp1511 = 0..=100_000,
            FreeParameter::Mp1512 => self.mp1512 = 1..=1000,
        }
        self
    }
}
