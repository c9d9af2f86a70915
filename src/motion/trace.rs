//! The commanded trace, and who takes it.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::comp::State;

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

/// The commanded trace in one CNC cycle (R5.1).
#[derive(Debug, Clone, Copy)]
pub struct Sample<'a> {
    /// Time since the first cycle.
    pub time_s: f64,
    /// Where each followed axis is commanded to be, in mm or degrees.
    pub positions: &'a [f64],
    /// How fast each followed axis is commanded to move, in mm or degrees per second.
    pub velocities: &'a [f64],
    /// The block that is followed.
    pub cause: &'a Arc<Cause>,
}

/// A stay where the path ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dwell<'a> {
    pub(super) seconds: f64,
    pub(super) cause: &'a Arc<Cause>,
}

/// Takes a commanded trace.
pub trait TraceSink {
    /// The trace begins, or begins anew after something that is not known. The axes stand still.
    fn begin(&mut self, time_s: f64, cause: &Arc<Cause>) -> ControlFlow<()>;

    /// Takes the next cycle; `Break` ends the trace.
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()>;
}
