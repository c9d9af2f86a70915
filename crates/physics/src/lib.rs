//! What a CNC program makes the axes do, in numbers.
//!
//! The records of a [session](frictcomp::Session) go in. A [`motion::TrajectoryPlanner`] turns them into
//! commanded traces, and a [`current::AdditiveCurrent`] traces into the currents that friction compensation
//! adds; [`currents`] does both. [`simulation`] has feed drives with friction, on which [`circle`] simulates
//! and judges circular tests and [`contour`] drives a program. [`compare`] lays two versions of a program side
//! by side, and [`stiction`] has the formulas of the compensation of another control.
//!
//! ```
//! use frictcomp_physics::circle;
//! ```

pub mod circle;
pub mod compare;
pub mod contour;
pub mod current;
mod currents;
pub mod motion;
pub mod simulation;
pub mod stiction;

pub use currents::currents;
