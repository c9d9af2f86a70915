//! The crossings of a circle and the axes.

use std::fmt;

use serde::Serialize;

/// An axis of the plane in which the circle lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[non_exhaustive]
pub enum PlaneAxis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
}

impl PlaneAxis {
    /// Both axes, X first.
    pub const ALL: [Self; 2] = [Self::X, Self::Y];

    /// `X` or `Y`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Y => "Y",
        }
    }
}

impl fmt::Display for PlaneAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// A crossing from one quadrant into the next: there one axis reverses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[non_exhaustive]
pub enum Crossing {
    /// At the largest X: the X axis reverses.
    #[serde(rename = "X+")]
    XPlus,
    /// At the largest Y.
    #[serde(rename = "Y+")]
    YPlus,
    /// At the smallest X.
    #[serde(rename = "X-")]
    XMinus,
    /// At the smallest Y.
    #[serde(rename = "Y-")]
    YMinus,
}

impl Crossing {
    /// All four, counter-clockwise from X+.
    pub const ALL: [Self; 4] = [Self::XPlus, Self::YPlus, Self::XMinus, Self::YMinus];

    /// `X+`, `Y+`, `X-` or `Y-`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::XPlus => "X+",
            Self::YPlus => "Y+",
            Self::XMinus => "X-",
            Self::YMinus => "Y-",
        }
    }

    /// The angle from X+ counter-clockwise.
    pub fn angle_deg(self) -> u16 {
        match self {
            Self::XPlus => 0,
            Self::YPlus => 90,
            Self::XMinus => 180,
            Self::YMinus => 270,
        }
    }

    /// The axis that reverses.
    pub fn axis(self) -> PlaneAxis {
        match self {
            Self::XPlus | Self::XMinus => PlaneAxis::X,
            Self::YPlus | Self::YMinus => PlaneAxis::Y,
        }
    }
}

impl fmt::Display for Crossing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}
