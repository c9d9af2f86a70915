//! Computation of commanded traces from executed programs: the commanded position and velocity of each axis in every
//! CNC cycle (R5.1 to R5.4).
//!
//! The rows of a session contain the motion of each block. A [`TrajectoryPlanner`] makes segments of a
//! path from them, plans the path velocity with full look-ahead within the limits of all axes, and
//! passes a [`Sample`] per cycle to a [`TraceSink`], with the [`Cause`] of each: memory does not depend on
//! the length of the program. Motions that cannot be followed are left out and reported, see [`SkippedMotion`].
//! What is modelled, and how a control differs, is in `docs/motion.md`.
//!
//! Positions are in mm or degrees, as the axis is linear or rotary; velocities, accelerations and
//! jerks in the same per s, s² and s³.

mod curve;
mod cycle;
mod junction;
mod limits;
mod look_ahead;
mod plan;
mod planner;
mod profile;
mod program;
mod remarks;
mod rounding;
mod sampler;
mod segment;
mod share;
mod smoothing;
mod tool_path;
mod trace;
mod turns;

pub use cycle::{CycleError, check_cycle};
pub use frictcomp::interpreter::{Contouring, PositionFrame, Simplification, Simplifications};
pub(crate) use limits::without_assumed_limits;
pub use limits::{Assumed, AssumedLimits, AxisLimits};
pub use planner::{PlannerOptions, ToolRadii, TrajectoryPlanner};
pub use program::ProgramTrace;
pub use rounding::{Departure, Transitions};
pub use trace::{Cause, Movement, Sample, SkippedMotion, TraceSink};
