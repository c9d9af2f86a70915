//! The direction of travel on a circle.

use std::fmt;

use serde::Serialize;

/// The direction of travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Direction {
    /// Counter-clockwise, G03.
    Ccw,
    /// Clockwise, G02.
    Cw,
}

impl Direction {
    /// Both directions, counter-clockwise first.
    pub const ALL: [Self; 2] = [Self::Ccw, Self::Cw];

    /// `ccw` or `cw`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Ccw => "ccw",
            Self::Cw => "cw",
        }
    }

    /// 1 for counter-clockwise, -1 for clockwise.
    pub fn sign(self) -> f64 {
        match self {
            Self::Ccw => 1.0,
            Self::Cw => -1.0,
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}
