//! The direction of travel on a circle.

use serde::Serialize;

frictcomp::words! {
    /// The direction of travel.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum Direction {
        /// Counter-clockwise, G03.
        Ccw = "ccw",
        /// Clockwise, G02.
        Cw = "cw",
    }
}

impl Direction {
    /// Returns 1 for counter-clockwise, -1 for clockwise.
    pub fn sign(self) -> f64 {
        match self {
            Self::Ccw => 1.0,
            Self::Cw => -1.0,
        }
    }
}
