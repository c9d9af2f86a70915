//! A value with its range.

use serde::{Deserialize, Serialize};

/// A parameter with its 95 % range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Extent {
    /// The value that fits best.
    pub value: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// Whether the value is at the end of its search range, so that it is not a value of the machine.
    pub at_bound: bool,
}

/// Factor within which the ends of a range are if a value is determined.
const DETERMINED: f64 = 1.4;

impl Extent {
    /// Returns the range of a value and of others that fit as well.
    pub(super) fn over(value: f64, others: impl IntoIterator<Item = f64>) -> Self {
        let mut extent = Self {
            value,
            low: value,
            high: value,
            at_bound: false,
        };
        for other in others {
            extent.low = extent.low.min(other);
            extent.high = extent.high.max(other);
        }
        extent
    }

    /// Returns the range extended to at least this distance on both sides.
    pub(super) fn widened(self, least: f64) -> Self {
        Self {
            low: self.low.min(self.value - least),
            high: self.high.max(self.value + least),
            ..self
        }
    }

    /// Returns whether the range is within a factor of 1.4; otherwise only its lower end is known.
    pub fn is_determined(&self) -> bool {
        self.high <= DETERMINED * self.low
    }
}
