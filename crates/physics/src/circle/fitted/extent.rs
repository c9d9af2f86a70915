//! A value with the range in which it lies.

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
    /// Whether the value is where its search ends, so that it is no value of the machine.
    pub at_bound: bool,
}

/// The ends of a range are within this factor where a value is determined.
const DETERMINED: f64 = 1.4;

impl Extent {
    /// The range of a value and of others that are as good.
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

    /// The same, at least so wide to both sides.
    pub(super) fn widened(self, least: f64) -> Self {
        Self {
            low: self.low.min(self.value - least),
            high: self.high.max(self.value + least),
            ..self
        }
    }

    /// Whether the range is within a factor of 1.4; else only its lower end is known.
    pub fn is_determined(&self) -> bool {
        self.high <= DETERMINED * self.low
    }
}
