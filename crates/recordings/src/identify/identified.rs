//! Computation of a friction curve and of the points of a value list from a recording.

use thiserror::Error;

use super::branches::DirectionBranches;
use super::curve::{Fit, FrictionCurve};
use super::finding::TraceFinding;
use super::measured::Measured;
use super::pair::{Drift, Pair};
use super::ripple::Ripple;
use super::segment::Segment;
use super::support::RequestedPoints;
use super::track::TrackError;
use frictcomp::lists::{DEFAULT_MAX_POINTS, FrictionList, TablePoint};

/// Options of an identification.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct IdentifyOptions {
    /// Number of support points.
    pub wanted: RequestedPoints,
    /// The desired accuracy of the friction, as a part of it.
    pub accuracy: f64,
    /// The speed in mm/s or °/s at which the machine works.
    pub working_speed: f64,
    /// Known properties of the torque.
    pub measured: Measured,
}

impl Default for IdentifyOptions {
    /// Returns the default options: eight points, 2 %, 1 m/min, the actual torque of the drive.
    fn default() -> Self {
        Self {
            wanted: RequestedPoints::Points(8),
            accuracy: 0.02,
            working_speed: 1000.0 / 60.0,
            measured: Measured::default(),
        }
    }
}

/// Reason why nothing was identified.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum IdentifyError {
    /// The recording cannot be used.
    #[error(transparent)]
    Track(#[from] TrackError),
    /// No part of the recording has a constant speed.
    #[error("no part of the recording has a constant speed of at least 0.1 mm/s for 0.3 s")]
    NoSegments,
    /// A recording of constant speeds in place of circles.
    #[error(
        "the axis moves at constant speeds for most of the recording, which no axis of a circle does"
    )]
    NoCircles,
    /// A value list without any output.
    #[error("the value list adds nothing: its outputs or its `scaling_factor` are 0")]
    NothingAdded,
    /// The recording is not what it seems.
    #[error("{}: {}", .0.code, .0.message)]
    Refused(TraceFinding),
    /// Only one direction was recorded.
    #[error("only one direction was recorded, so friction cannot be told from weight")]
    OneDirection,
    /// A torque that does not depend on the direction.
    #[error("the torque hardly depends on the direction: {friction:.3} of {spread:.3} drive units")]
    NoFriction {
        /// Half of the difference between the directions.
        friction: f64,
        /// Standard error.
        spread: f64,
    },
}

impl IdentifyError {
    /// Returns the advice.
    pub fn help(&self) -> &str {
        match self {
            Self::Refused(finding) => &finding.help,
            Self::Track(error) => error.help(),
            Self::NoSegments => {
                "move the axis at constant speeds, each for a second or more; of circles the \
                                 friction is found another way"
            }
            Self::NoCircles => "identify the friction at its constant speeds, not on circles",
            Self::NothingAdded => "give the list that is to act",
            Self::OneDirection => "move at every speed back and forth",
            Self::NoFriction { .. } => {
                "check which channel is the torque of this axis, and its resolution"
            }
        }
    }
}

/// Values found in a recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Identified {
    /// The segments of constant speed.
    pub segments: Vec<Segment>,
    /// Friction and offset at each speed, slowest first.
    pub pairs: Vec<Pair>,
    /// Part that is the same in both directions, in drive units: weight, asymmetry.
    pub offset: f64,
    /// The fit, whether it is used or not; `None` with fewer than four speeds.
    pub fit: Option<Fit>,
    /// The curve that is used.
    pub curve: FrictionCurve,
    /// The points of the value list.
    pub points: Vec<TablePoint>,
    /// The largest error of the straight lines between the points, in drive units.
    pub point_error: f64,
    /// The error that was asked for, in drive units, if the points that are allowed do not keep it.
    pub missed_error: Option<f64>,
    /// Part that repeats along the travel.
    pub ripple: Option<Ripple>,
    /// Change of friction over the recording, if speeds were visited more than once.
    pub drift: Option<Drift>,
    /// Positions in mm or degrees, and the difference of the torque there from the mean of its segment.
    pub residuals: Vec<[f64; 2]>,
    /// Remarks; those on a wrong recording come first.
    pub findings: Vec<TraceFinding>,
}

impl Identified {
    /// Returns the value list: the points, and everything else as the control assumes it.
    pub fn list(&self) -> FrictionList {
        let points = u32::try_from(self.points.len()).unwrap_or(DEFAULT_MAX_POINTS);
        FrictionList {
            position_delay: 0,
            reversal_lookahead: 0,
            scaling_factor: 1000,
            delay_cycles: 0,
            max_points: points.max(DEFAULT_MAX_POINTS),
            table: self.points.clone(),
        }
    }

    /// Returns both directions where they differ by more than an offset (R6.25): neither a value list nor an offset
    /// holds that.
    pub fn branches(&self) -> Option<DirectionBranches> {
        DirectionBranches::of(&self.pairs)
    }

    /// Returns whether the offset is less than a hundredth of the friction.
    pub fn is_offset_small(&self) -> bool {
        self.offset.abs() < 0.01 * self.level()
    }

    /// Returns the fit if the curve is one.
    pub fn used_fit(&self) -> Option<&Fit> {
        match &self.curve {
            FrictionCurve::Fit(fit) => Some(fit),
            FrictionCurve::Lines(_) => None,
        }
    }

    /// Returns the smallest friction of the pairs, without its sign.
    pub(super) fn level(&self) -> f64 {
        let levels = self.pairs.iter().map(|pair| pair.friction.abs());
        levels.fold(f64::INFINITY, f64::min)
    }
}
