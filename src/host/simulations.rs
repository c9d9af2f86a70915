//! Simulations with their runs on all processors.

use super::watch::{Done, Watch};
use super::workers;
use crate::circle::{CircleError, CircularTest, Comparison, Job, Search, Task, Tuned};

/// Drives the circle of a test with friction compensation off and on, in both directions.
///
/// # Errors
/// A circle that cannot be simulated, or a plant that is unstable on it.
pub fn compare(test: &CircularTest, watch: &Watch) -> Result<Comparison, CircleError> {
    let runs = Runs {
        of: "circle",
        watch,
    };
    let laps = runs.of_each(&Job::ALL, |&job| test.run(job));
    Ok(Comparison::of(
        laps.into_iter().collect::<Result<Vec<_>, _>>()?,
    ))
}

/// Searches the parameters of a value list that leave the smallest glitch.
///
/// # Errors
/// A circle that cannot be simulated, or a plant that is unstable on it.
pub fn tune(task: &Task, watch: &Watch) -> Result<Tuned, CircleError> {
    let runs = Runs { of: "tune", watch };
    let mut search = Search::new(&task.ranges);
    while let Some(trials) = search.next_trials() {
        let bound = search.bound();
        let heights = runs.of_each(&trials, |&candidate| task.worst_um(candidate, bound));
        search.take(
            &trials,
            &heights.into_iter().collect::<Result<Vec<_>, _>>()?,
        );
    }
    let best = search.best();
    let glitches = runs.of_each(&task.wholes(), |&(circle, variant)| {
        task.whole_um(circle, best, variant)
    });
    let glitches = glitches.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(Tuned::new(task, &search, &glitches))
}

/// Runs of a simulation, and who watches them.
struct Runs<'a> {
    of: &'static str,
    watch: &'a Watch,
}

impl Runs<'_> {
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
