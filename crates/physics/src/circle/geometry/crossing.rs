//! The crossings of a circle and the axes.

use serde::Serialize;

frictcomp::words! {
    /// An axis of the plane of the circle.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[non_exhaustive]
    pub enum PlaneAxis {
        /// The first axis.
        X = "X",
        /// The second axis.
        Y = "Y",
    }
}

frictcomp::words! {
    /// A crossing from one quadrant into the next: there one axis reverses.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[non_exhaustive]
    pub enum Crossing {
        /// Largest X: the X axis reverses.
        #[serde(rename = "X+")]
        XPlus = "X+",
        /// Largest Y: the Y axis reverses.
        #[serde(rename = "Y+")]
        YPlus = "Y+",
        /// Smallest X: the X axis reverses.
        #[serde(rename = "X-")]
        XMinus = "X-",
        /// Smallest Y: the Y axis reverses.
        #[serde(rename = "Y-")]
        YMinus = "Y-",
    }
}

impl PlaneAxis {
    /// Returns the other axis of the plane.
    pub(crate) fn other(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::X,
        }
    }
}

impl Crossing {
    /// Returns the angle from X+ counter-clockwise.
    pub fn angle_deg(self) -> u16 {
        match self {
            Self::XPlus => 0,
            Self::YPlus => 90,
            Self::XMinus => 180,
            Self::YMinus => 270,
        }
    }

    /// Returns the axis that reverses.
    pub fn axis(self) -> PlaneAxis {
        match self {
            Self::XPlus | Self::XMinus => PlaneAxis::X,
            Self::YPlus | Self::YMinus => PlaneAxis::Y,
        }
    }
}
