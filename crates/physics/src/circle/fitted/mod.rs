//! The plant from recorded circles (R16.3).
//!
//! A [`DriveFit`] holds the motion of an axis at its reversals with compensation off and on. The unknowns of its
//! drive are found by least squares over all reversals, each with a separate offset and slope. Their accuracy is
//! determined by other selections of the reversals, another friction model and another damping, never by the
//! residual noise.

mod extent;
mod fitted_drive;
mod height;
mod observed;
mod squares;
mod unknowns;

pub use extent::Extent;
pub use fitted_drive::{FittedDrive, SharesOn};
pub use height::{predicted_height_um, recorded_height_um};
pub use observed::{DriveFit, ObservedCircle};
