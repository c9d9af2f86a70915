//! Timings of repeated work, for benchmarks.

use std::time::{Duration, Instant};

/// A measurement that repeats each piece of work.
#[derive(Debug, Clone, Copy)]
pub struct Bench {
    /// Number of repetitions.
    pub runs: u32,
}

impl Bench {
    /// Repeats as often as `FRICTCOMP_BENCH_RUNS` says, or else `runs` times.
    pub fn new(runs: u32) -> Self {
        let given = std::env::var("FRICTCOMP_BENCH_RUNS");
        let given = given.ok().and_then(|runs| runs.parse().ok());
        Self {
            runs: given.unwrap_or(runs).max(1),
        }
    }

    /// Returns the times of a piece of work, the shortest first.
    pub fn times(self, mut work: impl FnMut()) -> Vec<Duration> {
        let once = |_| {
            let start = Instant::now();
            work();
            start.elapsed()
        };
        let mut times: Vec<Duration> = (0..self.runs).map(once).collect();
        times.sort();
        times
    }

    /// Returns the shortest time of a piece of work; other work on the machine only adds.
    pub fn fastest(self, work: impl FnMut()) -> Duration {
        self.times(work)[0]
    }
}

/// Returns the middle one of several times.
pub fn median(times: impl IntoIterator<Item = Duration>) -> Duration {
    let mut times: Vec<Duration> = times.into_iter().collect();
    times.sort();
    times[times.len() / 2]
}
