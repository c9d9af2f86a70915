//! Simulations that run on all processors.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::watch::{Done, Watch};
use super::workers;
use frictcomp_physics::circle::{
    CircleError, CircularTest, Comparison, LapRun, LearnedRound, Learner, Proposal, Simulations,
    Task, Tuned, tune_with,
};

/// Drives the circle of a test with friction compensation off and on, in both directions.
///
/// # Errors
/// A circle that cannot be simulated, or a plant that is unstable on it.
pub fn compare(test: &CircularTest, watch: &Watch) -> Result<Comparison, CircleError> {
    let runs = SimulationRuns {
        of: "circle",
        watch,
    };
    let laps = runs.of_each(&LapRun::ALL, |&job| {
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
    tune_with(
        task,
        &Tuning {
            runs: SimulationRuns { of: "tune", watch },
            done: AtomicUsize::new(0),
            all: task.expected_trials(),
        },
    )
}

/// Returns the list for the next round of an axis that learns; `None` where it has no round yet.
///
/// # Errors
/// A circle that cannot be simulated, or a plant that is unstable on it.
pub fn learn(
    learner: &Learner,
    rounds: &[LearnedRound],
    watch: &Watch,
) -> Result<Option<Proposal>, CircleError> {
    let simulations = Tuning {
        runs: SimulationRuns { of: "list", watch },
        done: AtomicUsize::new(0),
        all: Learner::expected_trials(rounds.len()),
    };
    learner.propose(rounds, &simulations)
}

/// The simulations of a tuning, which continues until nothing improves.
struct Tuning<'a> {
    runs: SimulationRuns<'a>,
    /// Simulations made in earlier steps.
    done: AtomicUsize,
    /// The approximate total.
    all: usize,
}

/// Runs of a simulation, and their watcher.
struct SimulationRuns<'a> {
    of: &'static str,
    watch: &'a Watch,
}

impl SimulationRuns<'_> {
    /// Refuses a run that was cancelled.
    fn wanted(&self) -> Result<(), CircleError> {
        if self.watch.is_stopped() {
            return Err(CircleError::Stopped);
        }
        Ok(())
    }

    fn of_each<T: Sync, R: Send>(&self, pieces: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
        self.after(pieces, (0, pieces.len()), work)
    }

    /// Executes pieces of work after `before` others, of `all`, and returns their results.
    fn after<T: Sync, R: Send>(
        &self,
        pieces: &[T],
        (before, all): (usize, usize),
        work: impl Fn(&T) -> R + Sync,
    ) -> Vec<R> {
        workers::map(pieces, work, |done| {
            self.watch.show(|| Done::Runs {
                of: self.of,
                done: before + done,
                all: all.max(before + pieces.len()),
            });
        })
    }
}

impl Simulations for Tuning<'_> {
    fn make(
        &self,
        count: usize,
        simulation: &(dyn Fn(usize) -> Result<Vec<f64>, CircleError> + Sync),
    ) -> Result<Vec<Vec<f64>>, CircleError> {
        let pieces: Vec<usize> = (0..count).collect();
        let before = self.done.fetch_add(count, Ordering::Relaxed);
        let made = self.runs.after(&pieces, (before, self.all), |&at| {
            self.runs.wanted()?;
            simulation(at)
        });
        made.into_iter().collect()
    }
}
