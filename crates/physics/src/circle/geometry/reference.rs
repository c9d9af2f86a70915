//! The circle as commanded by the control, CNC cycle by CNC cycle.

use std::f64::consts::TAU;

use frictcomp::diagnostic::ReadableNumber;
use serde::Serialize;
use thiserror::Error;

use super::direction::Direction;
use super::window::fastest_feed;
use crate::simulation::{POSITION_LOOP_S, STEP_S};

/// Maximum number of simulation steps of one run.
pub const MAX_STEPS: f64 = 24e6;

/// Minimum number of CNC cycles in a turn: with fewer, the chords alone are larger than what is measured.
pub const MIN_CYCLES: f64 = 90.0;

/// Turns of a whole run: half a turn of run-in and the one that is evaluated (R5.20).
pub const TURNS: f64 = 1.5;

/// A circle around the origin at a constant feed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Circle {
    /// Radius.
    pub radius_mm: f64,
    /// Feed.
    pub feed_mm_per_min: f64,
    /// The CNC cycle.
    pub cycle_time_s: f64,
}

impl Default for Circle {
    fn default() -> Self {
        Self {
            radius_mm: 100.0,
            feed_mm_per_min: 1000.0,
            cycle_time_s: 0.001,
        }
    }
}

/// A circle that cannot be simulated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CircleError {
    /// A radius of 0 mm.
    #[error("a radius of {} mm is not possible; it must be between 0.1 and 100000 mm", ReadableNumber(*.0))]
    Radius(f64),
    /// A feed of 0 mm/min.
    #[error("a feed of {} mm/min is not possible; it must be between 0.1 and 1000000 mm/min", ReadableNumber(*.0))]
    Feed(f64),
    /// A CNC cycle of 0.1 ms.
    #[error(
        "a CNC cycle of {} ms is not possible; it must be a whole multiple of 0.25 ms, the cycle of \
         the position loop, up to 100 ms",
        ReadableNumber(.0 * 1000.0)
    )]
    CycleTime(f64),
    /// A feed of 1 mm/min: the circle takes hours.
    #[error(
        "a circle of {radius_mm} mm at {feed_mm_per_min} mm/min takes {duration_s:.0} s with its run-in, at most \
         {} s are simulated", MAX_STEPS * STEP_S
    )]
    TooLong {
        /// Radius.
        radius_mm: f64,
        /// Feed.
        feed_mm_per_min: f64,
        /// Duration.
        duration_s: f64,
    },
    /// 1 mm at 10000 mm/min: the circle has hardly a cycle.
    #[error(
        "a circle of {radius_mm} mm at {feed_mm_per_min} mm/min has only {cycles:.0} CNC cycles of \
         {} ms, {MIN_CYCLES} are needed",
        ReadableNumber(.cycle_time_s * 1000.0)
    )]
    TooFast {
        /// Radius.
        radius_mm: f64,
        /// Feed.
        feed_mm_per_min: f64,
        /// The CNC cycle.
        cycle_time_s: f64,
        /// Cycles in a turn.
        cycles: f64,
    },
    /// 5 mm at 1000 mm/min: the windows reach the next crossings.
    #[error(
        "a circle of {radius_mm} mm at {feed_mm_per_min} mm/min has no glitch: 0.3 s after a \
         crossing the path is half-way to the next one"
    )]
    NoGlitch {
        /// Radius.
        radius_mm: f64,
        /// Feed.
        feed_mm_per_min: f64,
    },
    /// A plant whose loops do not settle.
    #[error(
        "the drive of {axis} is unstable: it left the circle {angle_deg:.0}\u{b0} after the start"
    )]
    Unstable {
        /// `X` or `Y`.
        axis: &'static str,
        /// The commanded angle since the start.
        angle_deg: f64,
    },
    /// A circle of 5 mm at 14 m/min on axes that are too heavy for their force: their path is
    /// not closed around the centre.
    #[error(
        "the axes do not follow a circle of {radius_mm} mm at {feed_mm_per_min} mm/min: their path \
         does not close around the centre, and a force was limited in {saturated_cycles} cycles of \
         the speed loop"
    )]
    NotFollowed {
        /// Radius.
        radius_mm: f64,
        /// Feed.
        feed_mm_per_min: f64,
        /// Cycles of the speed loop in which a force was limited, of both axes together.
        saturated_cycles: u64,
    },
    /// The watcher has stopped the simulation.
    #[error("the simulation was stopped")]
    Stopped,
}

impl CircleError {
    /// Returns advice for the user.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Radius(_) => "give the radius in mm, such as 100",
            Self::Feed(_) => "write feeds in mm/min, such as 1000",
            Self::CycleTime(_) => "give the time of a cycle in ms, such as 1",
            Self::TooLong { .. } => "choose a smaller radius or a higher feed",
            Self::NoGlitch { .. } => "choose a larger radius or a lower feed",
            Self::NotFollowed { .. } => {
                "choose a larger radius or a lower feed, or check `m` and `rated_force` of the plant"
            }
            Self::TooFast { .. } => "choose a larger radius, a lower feed or a shorter cycle",
            Self::Unstable { .. } => {
                "lower `Kv` or `Kp` of the plant, or check the units of its values: they are SI"
            }
            Self::Stopped => "start it again",
        }
    }
}

/// A stretch of the circle: from an angle over a number of radians in a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CircleArc {
    /// The commanded angle at the start in radians.
    pub(crate) start: f64,
    /// The length in radians.
    pub(crate) length: f64,
    /// CNC cycles at the start in which only the additive current takes part.
    pub(crate) lead: usize,
    /// The direction of travel.
    pub(crate) direction: Direction,
}

impl Circle {
    /// Checks that the circle can be simulated in bounded time.
    ///
    /// # Errors
    /// A value is out of range.
    pub fn check(&self) -> Result<(), CircleError> {
        if !(0.1..=100_000.0).contains(&self.radius_mm) {
            return Err(CircleError::Radius(self.radius_mm));
        }
        if !(0.1..=1e6).contains(&self.feed_mm_per_min) {
            return Err(CircleError::Feed(self.feed_mm_per_min));
        }
        let ticks = self.cycle_time_s / POSITION_LOOP_S;
        let is_whole = (ticks - ticks.round()).abs() < 1e-6;
        if !is_whole || !(0.5..=400.5).contains(&ticks) {
            return Err(CircleError::CycleTime(self.cycle_time_s));
        }
        let (radius_mm, feed_mm_per_min) = (self.radius_mm, self.feed_mm_per_min);
        let turn = TAU / self.angular_velocity();
        let duration_s = TURNS * turn;
        if duration_s > MAX_STEPS * STEP_S {
            return Err(CircleError::TooLong {
                radius_mm,
                feed_mm_per_min,
                duration_s,
            });
        }
        let cycles = turn / self.cycle_time_s;
        if cycles < MIN_CYCLES {
            return Err(CircleError::TooFast {
                radius_mm,
                feed_mm_per_min,
                cycle_time_s: self.cycle_time_s,
                cycles,
            });
        }
        Ok(())
    }

    /// Returns the feed in mm/min up to which a circle of this radius has glitches: above it the windows reach the next
    /// crossings (R5.22).
    pub fn fastest_feed_for_glitches(radius_mm: f64) -> f64 {
        fastest_feed(radius_mm)
    }

    /// Checks that the circle is slow enough for glitches.
    pub(crate) fn check_glitches(&self) -> Result<(), CircleError> {
        let (radius_mm, feed_mm_per_min) = (self.radius_mm, self.feed_mm_per_min);
        if feed_mm_per_min <= Self::fastest_feed_for_glitches(radius_mm) {
            return Ok(());
        }
        Err(CircleError::NoGlitch {
            radius_mm,
            feed_mm_per_min,
        })
    }

    /// Radius in m.
    pub(crate) fn radius_m(&self) -> f64 {
        self.radius_mm / 1000.0
    }

    /// Returns the angular velocity in rad/s.
    pub(crate) fn angular_velocity(&self) -> f64 {
        self.feed_mm_per_min / 60.0 / self.radius_mm
    }

    /// Returns the number of CNC cycles of a stretch, one more than its duration.
    pub(crate) fn cycles(&self, length: f64) -> usize {
        let cycles = (length / (self.angular_velocity() * self.cycle_time_s)).ceil();
        let most = MAX_STEPS / 4.0;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded just here
        let cycles = cycles.clamp(0.0, most) as usize;
        cycles + 1
    }

    /// Returns a simulation step as a part of a CNC cycle.
    pub(crate) fn step_in_cycle(&self) -> f64 {
        STEP_S / self.cycle_time_s
    }

    /// Returns the centripetal acceleration v²/R in mm/s²: at a crossing that of the axis that reverses.
    pub fn acceleration_mm_per_s2(&self) -> f64 {
        (self.feed_mm_per_min / 60.0).powi(2) / self.radius_mm
    }

    /// Returns the circle at the feed with this acceleration v²/R, in mm/s².
    #[must_use]
    pub fn with_acceleration(self, mm_per_s2: f64) -> Self {
        Self {
            feed_mm_per_min: 60.0 * (mm_per_s2 * self.radius_mm).sqrt(),
            ..self
        }
    }

    /// Returns the position in m and the velocity in m/s of both axes at CNC cycle `k` of a stretch.
    pub(crate) fn at(&self, stretch: CircleArc, k: usize) -> [(f64, f64); 2] {
        #[allow(clippy::cast_precision_loss)] // far below 2^52 cycles
        let time = k as f64 * self.cycle_time_s;
        let turning = stretch.direction.sign() * self.angular_velocity();
        let (sin, cos) = (stretch.start + turning * time).sin_cos();
        let radius = self.radius_m();
        let speed = radius * turning;
        [(radius * cos, -speed * sin), (radius * sin, speed * cos)]
    }

    /// Returns the number of simulation steps of a whole run.
    pub fn steps(&self) -> f64 {
        TURNS * TAU / self.angular_velocity() / STEP_S
    }
}
