//! The shape of what is left of a recorded path beyond noise (R5.28).

use serde::Serialize;

use super::crossing::PlaneAxis;

/// A shape that no term has.
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
        /// Its frequency.
        hertz: f64,
        /// Its amplitude in µm.
        amplitude_um: f64,
    },
    /// Neither of them.
    Unknown,
}
