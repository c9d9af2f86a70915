//! The commanded trace, and its sinks.

use std::ops::ControlFlow;
use std::sync::Arc;

use frictcomp::comp::State;
use frictcomp::interpreter::{PositionFrame, Simplifications};

/// The block that a piece of the path comes from, and the conditions while it is followed.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Cause {
    /// The program of the session, from 1.
    pub program: u32,
    /// The executed block of its program, from 1.
    pub seq: u64,
    /// Path of the file, as it is shown.
    pub file: Arc<str>,
    /// The line on which the block starts, from 1.
    pub line: u32,
    /// The block number, if it is known.
    pub number: Option<i64>,
    /// Motion of the axes.
    pub movement: Movement,
    /// Frame of the positions (R5.4).
    pub frame: PositionFrame,
    /// Functions on the path or its velocity that the trace does not follow.
    pub simplified: Simplifications,
    /// The friction compensation of each followed axis.
    pub friction: Arc<[State]>,
}

frictcomp::words! {
    /// Motion of the axes along a piece of the path.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum Movement {
        /// Motion at the highest velocity of the axes, G00.
        Rapid = "rapid",
        /// Motion at a feed, G01, G02, G03.
        Feed = "feed",
        /// Rest of the axes for a time, G04.
        Dwell = "dwell",
    }
}

/// The commanded trace in one CNC cycle (R5.1).
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Sample<'a> {
    /// Time since the first cycle.
    pub time_s: f64,
    /// Commanded position of each followed axis, in mm or degrees.
    pub positions: &'a [f64],
    /// Commanded velocity of each followed axis, in mm or degrees per second.
    pub velocities: &'a [f64],
    /// Velocity of the path, in mm/s, or °/s if the feed is that of rotary axes.
    pub path_velocity: f64,
    /// The programmed path velocity in the same units, infinite in a rapid motion.
    pub programmed_velocity: f64,
    /// The block that is followed.
    pub cause: &'a Arc<Cause>,
}

/// A motion that the trace leaves out, because its target or its velocity is not known.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct SkippedMotion<'a> {
    /// The time of the trace at which it would begin.
    pub time_s: f64,
    /// Path of the file, as it is shown.
    pub file: &'a str,
    /// The line of the block, from 1.
    pub line: u32,
    /// The block number, if it is known.
    pub number: Option<i64>,
    /// The reason, in lower case.
    pub reason: &'static str,
}

/// A dwell at the end of the path.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dwell<'a> {
    pub(super) seconds: f64,
    pub(super) cause: &'a Arc<Cause>,
}

/// Takes a commanded trace.
pub trait TraceSink {
    /// Starts the trace, or restarts it after something that is not known. The axes are at standstill.
    fn begin(&mut self, time_s: f64, cause: &Arc<Cause>) -> ControlFlow<()>;

    /// Takes the next cycle; `Break` ends the trace.
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()>;

    /// Leaves a motion out of the trace. The motions before it have been followed.
    fn left_out(&mut self, motion: &SkippedMotion<'_>) {
        let _ = motion;
    }
}
