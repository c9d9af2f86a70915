//! The shapes of a recorded path: the fitted ones, and the residual beyond noise (R5.28).

use serde::Serialize;

use crate::circle::geometry::PlaneAxis;

/// Number of standard errors from which a term is noticeable …
const SIGNIFICANT: f64 = 3.0;

/// … if it also has this size, in µm.
const LEAST_TERM_UM: f64 = 0.5;

/// Number of shapes that are fitted at once, including centres, radii, the tails of slow peaks and screws.
pub(crate) const SHAPES: usize = 21;

/// One value for each fitted shape.
pub(crate) type ShapeValues = [f64; SHAPES];

/// A shape without a term.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum OtherShape {
    /// An error that repeats along an axis.
    Periodic {
        /// The axis.
        axis: PlaneAxis,
        /// The period in mm.
        pitch_mm: f64,
        /// The amplitude in µm.
        amplitude_um: f64,
    },
    /// An oscillation in time.
    Vibration {
        /// Frequency.
        hertz: f64,
        /// Amplitude in µm.
        amplitude_um: f64,
    },
    /// Any other shape.
    Unknown,
}

/// A fitted shape with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Term {
    /// The shape.
    pub shape: ShapeTerm,
    /// Size.
    pub size_um: f64,
    /// Standard error.
    pub error_um: f64,
}

/// A shape that is fitted away from the reversals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ShapeTerm {
    /// A step outwards where an axis reverses.
    Backlash(PlaneAxis),
    /// A step sideways of an axis where the other one reverses.
    Play(PlaneAxis),
    /// An ellipse at 45° that turns with the direction.
    Gain,
    /// An ellipse at 45° that does not.
    Squareness,
    /// An ellipse along the axes.
    Scale,
    /// A shift of an axis from turn to turn.
    Drift(PlaneAxis),
}

impl Term {
    /// Returns whether the recording supports it.
    pub fn is_carried(&self) -> bool {
        self.size_um.abs() > (SIGNIFICANT * self.error_um).max(LEAST_TERM_UM)
    }
}
