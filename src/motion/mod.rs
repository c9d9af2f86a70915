//! From executed programs to commanded traces: where each axis is commanded to be, and how fast,
//! in every CNC cycle (R5.1 to R5.4).
//!
//! The rows of a session say what each block moves. A [`Tracer`] makes legs of a path from them,
//! plans the path velocity with full look-ahead within the limits of all axes, and hands the
//! cycles on as they come: memory is the same for a program of any length. What is modelled, and
//! how a control differs, is in `docs/motion.md`.

mod course;
mod junction;
mod leg;
mod limits;
mod plan;
mod profile;
mod sampler;
mod tracer;

use std::ops::ControlFlow;
use std::sync::Arc;

pub use limits::{Assumed, AxisLimits};
pub use profile::{Bounds, PathState, Profile};
pub use tracer::{Tracer, TracerOptions};

use crate::compensation::State;

/// The block that a piece of the path comes from, and the friction compensation that is in force
/// while it is followed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cause {
    /// The executed block of its program, from 1.
    pub seq: u64,
    /// The file.
    pub file: Arc<str>,
    /// The line on which the block starts, from 1.
    pub line: u32,
    /// The friction compensation of each followed axis.
    pub friction: Arc<[State]>,
}

/// One CNC cycle of the commanded trace.
#[derive(Debug, Clone, Copy)]
pub struct Cycle<'a> {
    /// Seconds since the first cycle.
    pub time: f64,
    /// Where each followed axis is commanded to be, in mm or degrees.
    pub positions: &'a [f64],
    /// How fast each followed axis is commanded to move, per second.
    pub velocities: &'a [f64],
    /// The block that is followed.
    pub cause: &'a Arc<Cause>,
}

/// Takes a commanded trace.
pub trait Cycles {
    /// The trace begins, or begins anew behind something that is not known. The axes stand.
    fn begin(&mut self, time: f64, cause: &Arc<Cause>) -> ControlFlow<()>;

    /// Takes the next cycle; `Break` ends the trace.
    fn cycle(&mut self, cycle: &Cycle<'_>) -> ControlFlow<()>;
}
