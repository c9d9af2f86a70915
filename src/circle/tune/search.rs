//! The search: a coarse grid, then neighbours of the best in steps that get smaller.

use std::collections::BTreeSet;

use super::candidate::{Candidate, Ranges};
use super::heights::Heights;

/// Steps of the neighbours, the largest first: `position_delay` as a part of its value, at
/// least one unit, and the scaling factor.
const STEPS: [Step; 5] = [
    Step {
        distance: 0.5,
        scaling: 80,
    },
    Step {
        distance: 0.3,
        scaling: 40,
    },
    Step {
        distance: 0.15,
        scaling: 20,
    },
    Step {
        distance: 0.08,
        scaling: 10,
    },
    Step {
        distance: 0.0,
        scaling: 5,
    },
];

/// Rounds at most; each makes the best better or the steps smaller.
const MAX_ROUNDS: usize = 40;

/// An improvement that is worth another round with the same steps, as a part.
const GAIN: f64 = 0.005;

struct Step {
    distance: f64,
    scaling: i16,
}

/// Sets whose largest glitch is at most this part above the smallest are as good: of them the one
/// with the smallest mean is taken (R5.25).
const AS_GOOD: f64 = 1.1;

/// A search for the candidate that leaves least. It hands out trials and takes their results;
/// with the same results it hands out the same trials.
#[derive(Debug, Clone)]
pub(super) struct Search {
    ranges: Ranges,
    tried: BTreeSet<Candidate>,
    best: Option<(f64, Candidate)>,
    /// All that may be as good as the best.
    good: Vec<(Heights, Candidate)>,
    stage: Stage,
    rounds: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Grid,
    Steps(usize),
    Done,
}

impl Search {
    /// A search within ranges.
    pub(super) fn new(ranges: &Ranges) -> Self {
        Self {
            ranges: ranges.clone(),
            tried: BTreeSet::new(),
            best: None,
            good: Vec::new(),
            stage: Stage::Grid,
            rounds: 0,
        }
    }

    /// The candidates to try next, none of them before; `None` when the search is over.
    pub(super) fn next_trials(&mut self) -> Option<Vec<Candidate>> {
        loop {
            let wanted = match self.stage {
                Stage::Done => return None,
                Stage::Grid => self.grid(),
                Stage::Steps(at) => self.neighbours(&STEPS[at]),
            };
            let fresh: BTreeSet<Candidate> = wanted
                .into_iter()
                .filter(|candidate| !self.tried.contains(candidate))
                .collect();
            self.tried.extend(&fresh);
            if !fresh.is_empty() {
                return Some(fresh.into_iter().collect());
            }
            self.advance();
        }
    }

    /// A trial that reaches this has lost.
    pub(super) fn bound(&self) -> f64 {
        AS_GOOD * self.least()
    }

    /// The smallest of the largest glitches so far.
    fn least(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |(value, _)| value)
    }

    /// Takes what trials leave, in their order.
    pub(super) fn take(&mut self, trials: &[Candidate], heights: &[Heights]) {
        let before = self.least();
        for (&candidate, heights) in trials.iter().zip(heights) {
            let worst = heights.worst_um();
            if worst < self.least() {
                self.best = Some((worst, candidate));
            }
            if worst < self.bound() {
                self.good.push((heights.clone(), candidate));
            }
        }
        self.rounds += 1;
        let is_better = self.least() < before * (1.0 - GAIN);
        if self.stage == Stage::Grid || !is_better || self.rounds > MAX_ROUNDS {
            self.advance();
        }
    }

    /// Of all sets that are as good as the best the one with the smallest mean.
    pub(super) fn result(&self) -> Candidate {
        let bound = self.bound();
        let good = self
            .good
            .iter()
            .filter(|(heights, _)| heights.worst_um() < bound);
        let chosen = good.min_by(|(one, _), (other, _)| one.mean_um().total_cmp(&other.mean_um()));
        chosen.map_or_else(|| self.start(), |&(_, candidate)| candidate)
    }

    /// The candidate with the smallest of the largest glitches so far.
    fn best(&self) -> Candidate {
        self.best
            .map_or_else(|| self.start(), |(_, candidate)| candidate)
    }

    /// How many candidates were tried.
    pub(super) fn trials(&self) -> usize {
        self.tried.len()
    }

    fn advance(&mut self) {
        self.stage = match self.stage {
            Stage::Grid => Stage::Steps(0),
            Stage::Steps(at) if at + 1 < STEPS.len() && self.rounds <= MAX_ROUNDS => {
                Stage::Steps(at + 1)
            }
            Stage::Steps(_) | Stage::Done => Stage::Done,
        };
    }

    fn start(&self) -> Candidate {
        let ranges = &self.ranges;
        Candidate {
            position_delay: *ranges.position_delay.start(),
            reversal_lookahead: *ranges.reversal_lookahead.start(),
            delay_cycles: *ranges.delay_cycles.start(),
            scaling_factor: 1000,
        }
    }

    fn grid(&self) -> Vec<Candidate> {
        let distances = [0, 4, 9, 20, 45, 90, 200, 500];
        let mut grid = Vec::new();
        for position_delay in distances {
            for reversal_lookahead in [0, 2, 4] {
                for delay_cycles in [0, 1, 2, 4] {
                    grid.push(Candidate {
                        position_delay,
                        reversal_lookahead,
                        delay_cycles,
                        scaling_factor: 1000,
                    });
                }
            }
        }
        grid.retain(|candidate| self.ranges.contain(candidate));
        grid
    }

    fn neighbours(&self, step: &Step) -> Vec<Candidate> {
        let centre = self.best();
        let distance = (f64::from(centre.position_delay) * step.distance).round();
        #[allow(clippy::cast_possible_truncation)] // at most half of a position_delay
        let distance = (distance as i32).max(1);
        let mut found = Vec::new();
        for p in [-1, 0, 1] {
            for l in [-1, 0, 1] {
                for d in [-1, 0, 1] {
                    for s in [-1, 0, 1] {
                        let candidate = Candidate {
                            position_delay: centre.position_delay.saturating_add(p * distance),
                            reversal_lookahead: centre.reversal_lookahead.saturating_add_signed(l),
                            delay_cycles: centre.delay_cycles.saturating_add(d),
                            scaling_factor: centre.scaling_factor.saturating_add(s * step.scaling),
                        };
                        found.push(candidate);
                    }
                }
            }
        }
        found.retain(|candidate| self.ranges.contain(candidate));
        found
    }
}

impl Ranges {
    fn contain(&self, candidate: &Candidate) -> bool {
        self.position_delay.contains(&candidate.position_delay)
            && self
                .reversal_lookahead
                .contains(&candidate.reversal_lookahead)
            && self.delay_cycles.contains(&candidate.delay_cycles)
            && self.scaling_factor.contains(&candidate.scaling_factor)
    }
}
