//! A measuring program as motions.

use serde::{Deserialize, Serialize};

/// A measuring program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct MeasuringProgram {
    /// The number of its signature, from 1 to 1023.
    pub number: u16,
    /// File without a folder.
    pub file: String,
    /// The measurement.
    pub role: Measurement,
    /// Time in s at 100 % override, from the first measured motion on.
    pub time_s: f64,
    /// The motions after the approach.
    #[serde(skip)]
    pub steps: Vec<PlanStep>,
    /// Start: the position of each axis of the plan in mm or degrees.
    pub start: Vec<f64>,
}

/// The measurement of a program; axes are places in the plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Measurement {
    /// Constant speeds of an axis in mm/s or °/s, slowest first, up and then down.
    Friction {
        /// The axis.
        axis: usize,
        /// The speeds.
        speeds: Vec<f64>,
    },
    /// Circles counter-clockwise and then clockwise, two turns each.
    Circles {
        /// The feed in mm/min.
        feed: f64,
        /// The radius in mm.
        radius: f64,
    },
    /// Strokes of an axis alone at the feeds, four at each.
    Strokes {
        /// The axis.
        axis: usize,
        /// The feeds in mm/min or °/min.
        feeds: Vec<f64>,
    },
}

/// A motion or a pause of a program.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum PlanStep {
    /// A comment before the next motion.
    Note(String),
    /// Standstill in s.
    Dwell(f64),
    /// A straight motion of one axis of the plan.
    Line {
        /// The axis.
        axis: usize,
        /// The place in mm or degrees.
        to: f64,
        /// The feed in mm/min or °/min.
        feed: f64,
    },
    /// An arc of the two axes of the plan.
    Arc {
        /// The direction.
        turning: Turning,
        /// The end in mm.
        to: [f64; 2],
        /// The centre from the start in mm.
        centre: [f64; 2],
        /// The feed in mm/min.
        feed: f64,
    },
}

/// The direction of an arc, from the first axis towards the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Turning {
    /// Counter-clockwise.
    Ccw,
    /// Clockwise.
    Cw,
}
