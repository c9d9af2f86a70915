//! Simulations with their runs on all processors.

use super::watch::{Done, Watch};
use super::workers;
use frictcomp_physics::circle::{
    CircleError, CircularTest, Comparison, Heights, Job, Simulations, Task, Tuned, tune_with,
};

/// Drives the circle of a test with friction compensation off and on, in both directions.
///
/// # Errors
/// A circle that cannot be simulated, or a plant that is unstable on it.
pub fn compare(test: &CircularTest, watch: &Watch) -> Result<Comparison, CircleError> {
    let runs = Runs {
        of: "circle",
        watch,
    };
    let laps = runs.of_each(&Job::ALL, |&job| {
        runs.wanted()?;
        test.run(job)
    });
    Ok(Comparison::of(
        laps.into_iter().collect::<Result<Vec<_>, _>>()?,
    ))
}

/// Searches the value lists that leave the smallest glitch.
///
/// # Errors
/// A circle that cannot be simulated or has no glitch, or a plant that is unstable on it.
pub fn tune(task: &Task, watch: &Watch) -> Result<Tuned, CircleError> {
    tune_with(task, &Runs { of: "tune", watch })
}

/// Runs of a simulation, and their watcher.
struct Runs<'a> {
    of: &'static str,
    watch: &'a Watch,
}

impl Runs<'_> {
    /// Refuses a run that nobody wants any more.
    fn wanted(&self) -> Result<(), CircleError> {
        if self.watch.is_stopped() {
            return Err(CircleError::Stopped);
        }
        Ok(())
    }

    fn of_each<T: Sync, R: Send>(&self, pieces: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
        workers::map(pieces, work, |done| {
            self.watch.show(|| Done::Runs {
                of: self.of,
                done,
                all: pieces.len(),
            });
        })
    }
}

impl Simulations for Runs<'_> {
    fn make(
        &self,
        count: usize,
        simulation: &(dyn Fn(usize) -> Result<Heights, CircleError> + Sync),
    ) -> Result<Vec<Heights>, CircleError> {
        let pieces: Vec<usize> = (0..count).collect();
        let made = self.of_each(&pieces, |&at| {
            self.wanted()?;
            simulation(at)
        });
        made.into_iter().collect()
    }
}
