//! One run of a circular test.

use std::f64::consts::{PI, TAU};

use super::simulate::{AxesSimulation, AxisRun};
use super::test::CircularTest;
use crate::circle::geometry::Direction;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{CircleArc, CircleError, TURNS};
use crate::circle::geometry::{Gatherer, RadialProfile};
use crate::current::Switched;

/// A gap that is bridged if the ends of the turn do not meet, in degrees: on a circle of a tenth
/// of a second the loops are still settling.
const WIDEST_GAP: f64 = 60.0;

/// Additional length in turns for a path that has not closed.
const LATER: f64 = 0.5;

/// One run of a test: half a turn of run-in, and a turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LapRun {
    /// State of friction compensation.
    pub compensation: Switched,
    /// The direction of travel.
    pub direction: Direction,
}

/// Result of a run.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Lap {
    /// Job of the run.
    pub job: LapRun,
    /// The turn.
    pub profile: RadialProfile,
    /// Cycles of the speed loop in which a force was limited.
    pub saturated_cycles: u64,
}

impl LapRun {
    /// The four runs of a test.
    pub const ALL: [Self; 4] = {
        const fn job(compensation: Switched, direction: Direction) -> LapRun {
            LapRun {
                compensation,
                direction,
            }
        }
        [
            job(Switched::Off, Direction::Ccw),
            job(Switched::Off, Direction::Cw),
            job(Switched::On, Direction::Ccw),
            job(Switched::On, Direction::Cw),
        ]
    };
}

impl CircularTest {
    /// Makes one run (R5.20). It begins at X+ with half a turn of run-in, as machines do: the turn
    /// that is evaluated begins and ends at X-. This determines where a reversal falls within a CNC cycle,
    /// which at high feeds affects what the compensation leaves.
    ///
    /// # Errors
    /// A circle that cannot be simulated or that the drives do not follow, or a drive that is
    /// unstable.
    pub fn run(&self, job: LapRun) -> Result<Lap, CircleError> {
        self.circle.check()?;
        match self.drive(job, TURNS) {
            // On a circle that ends before the drives have settled, their lag was still growing by much of
            // a turn: their path closes later than the commanded one.
            Err(CircleError::NotFollowed { .. }) => self.drive(job, TURNS + LATER),
            lap => lap,
        }
    }

    /// Makes the run over a number of commanded turns.
    fn drive(&self, job: LapRun, turns: f64) -> Result<Lap, CircleError> {
        let stretch = CircleArc {
            start: 0.0,
            length: turns * TAU,
            lead: 0,
            direction: job.direction,
        };
        let run_in = self.circle.cycles(PI) - 1;
        let mut turn = Gatherer::new(self.circle.radius_m(), WIDEST_GAP);
        let axis = |axis, drive| AxisRun {
            axis,
            drive,
            compensation: match job.compensation {
                Switched::On => self.of(axis),
                Switched::Off => None,
            },
        };
        let run = AxesSimulation {
            circle: self.circle,
            model: self.model,
            reading: self.reading,
            axes: [
                axis(PlaneAxis::X, &self.plant.x),
                axis(PlaneAxis::Y, &self.plant.y),
            ],
        };
        let remarks = run.simulate(stretch, |cycle, [x, y]| {
            if cycle >= run_in {
                turn.take(x, y);
            }
        })?;
        let lap_s = TAU / self.circle.angular_velocity();
        let profile = turn
            .finish(Some(lap_s))
            .map_err(|_| CircleError::NotFollowed {
                radius_mm: self.circle.radius_mm,
                feed_mm_per_min: self.circle.feed_mm_per_min,
                saturated_cycles: remarks.saturated_cycles,
            })?;
        Ok(Lap {
            job,
            profile,
            saturated_cycles: remarks.saturated_cycles,
        })
    }
}
