//! The result of a circular test: the same circle without and with friction compensation.

use super::lap::{Lap, LapRun};
use super::test::CircularTest;
use crate::circle::figures::{Figures, Nominal, Paths};
use crate::circle::geometry::CircleError;
use crate::circle::geometry::PathCentre;
use crate::current::Switched;

/// The paths in both directions with their figures.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Side {
    /// The radial deviations over the angle.
    pub paths: Paths,
    /// The figures.
    pub figures: Figures,
}

/// The result of a test.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Comparison {
    /// Result without friction compensation.
    pub off: Side,
    /// Result with friction compensation.
    pub on: Side,
    /// Cycles of the speed loop in which a force was limited, over all runs.
    pub saturated_cycles: u64,
}

impl CircularTest {
    /// Makes all four runs, one after the other.
    ///
    /// # Errors
    /// The errors of [`run`](Self::run).
    pub fn compare(&self) -> Result<Comparison, CircleError> {
        let laps: Result<Vec<_>, _> = LapRun::ALL.into_iter().map(|job| self.run(job)).collect();
        Ok(Comparison::of(laps?))
    }
}

impl Comparison {
    /// Returns the result of runs that were made one by one, in any order.
    pub fn of(laps: impl IntoIterator<Item = Lap>) -> Self {
        let (mut off, mut on) = (Paths::default(), Paths::default());
        let mut saturated_cycles = 0;
        for lap in laps {
            saturated_cycles += lap.saturated_cycles;
            match lap.job.compensation {
                Switched::Off => off.set(lap.job.direction, lap.profile),
                Switched::On => on.set(lap.job.direction, lap.profile),
            }
        }
        Self {
            off: Side::of(off, Nominal::Commanded, PathCentre::default()),
            on: Side::of(on, Nominal::Commanded, PathCentre::default()),
            saturated_cycles,
        }
    }

    /// Returns the comparison with G(b) and H about another centre.
    #[must_use]
    pub fn about(self, centre: PathCentre) -> Self {
        let about = |side: Side| Side::of(side.paths, Nominal::Commanded, centre);
        Self {
            off: about(self.off),
            on: about(self.on),
            ..self
        }
    }
}

impl Side {
    pub(crate) fn of(paths: Paths, nominal: Nominal, centre: PathCentre) -> Self {
        Self {
            figures: Figures::of(&paths, nominal, centre),
            paths,
        }
    }
}
