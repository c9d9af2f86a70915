//! The circular test: one plant, one circle, one value list.

use std::f64::consts::{PI, TAU};

use super::figures::{Figures, Nominal, Paths};
use super::friction::FrictionModel;
use super::plant::Plant;
use super::profile::{Gatherer, Profile};
use super::reference::{Circle, CircleError, Direction, Stretch, TURNS};
use super::simulate::simulate;
use crate::current::Reading;
use crate::lists::FrictionList;

/// A gap between two points that is bridged, in degrees: less than a CNC cycle makes.
const WIDEST_GAP: f64 = 5.0;

/// Whether friction compensation is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Compensation {
    /// Nothing is added.
    Off,
    /// The additive current of the value list.
    On,
}

/// All that a simulated circular test depends on.
#[derive(Debug, Clone)]
pub struct CircularTest {
    /// The commanded circle.
    pub circle: Circle,
    /// The machine.
    pub plant: Plant,
    /// How its friction is computed.
    pub model: FrictionModel,
    /// The value lists of X and Y.
    pub lists: [FrictionList; 2],
    /// How the documents are read.
    pub reading: Reading,
}

/// One run of a test: half a turn of run-in, and a turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Job {
    /// Whether friction compensation is on.
    pub compensation: Compensation,
    /// The direction of travel.
    pub direction: Direction,
}

/// What a run gave.
#[derive(Debug, Clone)]
pub struct Lap {
    /// Which run it was.
    pub job: Job,
    /// The turn.
    pub profile: Profile,
    /// Cycles of the speed loop in which a force was cut.
    pub saturated: u64,
}

/// The paths in both directions with their figures.
#[derive(Debug, Clone)]
pub struct Side {
    /// The radial deviations over the angle.
    pub paths: Paths,
    /// The figures.
    pub figures: Figures,
}

/// The result of a test.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Without friction compensation.
    pub off: Side,
    /// With friction compensation.
    pub on: Side,
    /// Cycles of the speed loop in which a force was cut, over all runs.
    pub saturated: u64,
}

impl Job {
    /// The four runs of a test.
    pub const ALL: [Self; 4] = {
        const fn job(compensation: Compensation, direction: Direction) -> Job {
            Job {
                compensation,
                direction,
            }
        }
        [
            job(Compensation::Off, Direction::Ccw),
            job(Compensation::Off, Direction::Cw),
            job(Compensation::On, Direction::Ccw),
            job(Compensation::On, Direction::Cw),
        ]
    };
}

impl CircularTest {
    /// Makes one run (R5.20). It begins at X+ with half a turn of run-in, as machines do: the turn
    /// that is evaluated begins and ends at X-. Where a reversal falls within a CNC cycle follows
    /// from that, and at high feeds it shows in what the compensation leaves.
    ///
    /// # Errors
    /// A circle that cannot be simulated, or a drive that is unstable.
    pub fn run(&self, job: Job) -> Result<Lap, CircleError> {
        self.circle.check()?;
        let stretch = Stretch {
            start: 0.0,
            length: TURNS * TAU,
            lead: 0,
            direction: job.direction,
        };
        let run_in = self.circle.cycles(PI) - 1;
        let mut turn = Gatherer::new(self.circle.radius_m(), WIDEST_GAP);
        let remarks = simulate(self, job.compensation, stretch, |cycle, sample| {
            if cycle >= run_in {
                turn.take(sample.x, sample.y);
            }
        })?;
        let profile = turn.finish().map_err(|_| CircleError::Unstable {
            axis: "X or Y",
            angle: 360.0,
        })?;
        Ok(Lap {
            job,
            profile,
            saturated: remarks.saturated,
        })
    }

    /// All four runs, one after the other.
    ///
    /// # Errors
    /// Those of [`run`](Self::run).
    pub fn outcome(&self) -> Result<Outcome, CircleError> {
        let laps: Result<Vec<_>, _> = Job::ALL.into_iter().map(|job| self.run(job)).collect();
        Ok(Outcome::of(laps?))
    }
}

impl Outcome {
    /// The result of runs that were made one by one, in any order.
    pub fn of(laps: impl IntoIterator<Item = Lap>) -> Self {
        let (mut off, mut on) = (Paths::default(), Paths::default());
        let mut saturated = 0;
        for lap in laps {
            saturated += lap.saturated;
            match lap.job.compensation {
                Compensation::Off => off.set(lap.job.direction, lap.profile),
                Compensation::On => on.set(lap.job.direction, lap.profile),
            }
        }
        Self {
            off: Side::of(off, Nominal::Commanded),
            on: Side::of(on, Nominal::Commanded),
            saturated,
        }
    }
}

impl Side {
    pub(super) fn of(paths: Paths, nominal: Nominal) -> Self {
        Self {
            figures: Figures::of(&paths, nominal),
            paths,
        }
    }
}
