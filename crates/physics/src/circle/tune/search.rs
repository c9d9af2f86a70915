//! The search: a coarse grid, then neighbours of the best in decreasing steps.

use std::collections::BTreeSet;

use super::heights::Heights;
use super::space::Space;

/// Maximum number of rounds; each improves the best or makes the steps smaller.
const MAX_ROUNDS: usize = 40;

/// Minimum improvement for another round with the same steps, as a part.
const GAIN: f64 = 0.005;

/// Sets whose largest glitch is at most this part above the smallest are as good: of them the one
/// with the smallest mean is taken (R5.25).
const AS_GOOD: f64 = 1.1;

/// A search for the candidate of a space that leaves least. It gives out trials and takes their
/// results; with the same results it gives out the same trials.
#[derive(Debug, Clone)]
pub(super) struct Search<S: Space> {
    space: S,
    tried: BTreeSet<S::Candidate>,
    best: Option<(f64, S::Candidate)>,
    /// Candidates that may be as good as the best.
    good: Vec<(Heights, S::Candidate)>,
    stage: SearchStage,
    rounds: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SearchStage {
    Grid,
    Steps(usize),
    Done,
}

impl<S: Space> Search<S> {
    /// Returns a search in a space.
    pub(super) fn new(space: S) -> Self {
        Self {
            space,
            tried: BTreeSet::new(),
            best: None,
            good: Vec::new(),
            stage: SearchStage::Grid,
            rounds: 0,
        }
    }

    /// Returns the candidates to try next, all of them new; `None` when the search is over.
    pub(super) fn next_trials(&mut self) -> Option<Vec<S::Candidate>> {
        loop {
            let wanted = match self.stage {
                SearchStage::Done => return None,
                SearchStage::Grid => self.space.grid(),
                SearchStage::Steps(at) => self.space.neighbours(self.best(), at),
            };
            let fresh: BTreeSet<S::Candidate> = wanted
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

    /// Returns a trial that reaches this has lost.
    pub(super) fn bound(&self) -> f64 {
        AS_GOOD * self.least()
    }

    /// Returns the glitches that the best candidate leaves.
    pub(super) fn best_heights(&self) -> Option<&Heights> {
        let (_, best) = self.best?;
        let found = self.good.iter().find(|(_, candidate)| *candidate == best);
        found.map(|(heights, _)| heights)
    }

    /// Returns the smallest of the largest glitches so far.
    fn least(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |(value, _)| value)
    }

    /// Takes the results of trials, in their order.
    pub(super) fn take(&mut self, trials: &[S::Candidate], heights: &[Heights]) {
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
        if self.stage == SearchStage::Grid || !is_better || self.rounds > MAX_ROUNDS {
            self.advance();
        }
    }

    /// Returns, of all sets that are as good as the best, the one with the smallest mean, and of equal ones the one
    /// with the smallest values.
    pub(super) fn result(&self) -> S::Candidate {
        let bound = self.bound();
        let good = self
            .good
            .iter()
            .filter(|(heights, _)| heights.worst_um() < bound);
        let chosen = good.min_by(|(one, first), (other, second)| {
            let by_mean = one.mean_um().total_cmp(&other.mean_um());
            by_mean.then_with(|| first.cmp(second))
        });
        chosen.map_or_else(|| self.space.start(), |&(_, candidate)| candidate)
    }

    /// Returns the candidate with the smallest of the largest glitches so far.
    fn best(&self) -> S::Candidate {
        self.best
            .map_or_else(|| self.space.start(), |(_, candidate)| candidate)
    }

    /// Returns the number of candidates tried.
    pub(super) fn trials(&self) -> usize {
        self.tried.len()
    }

    fn advance(&mut self) {
        self.stage = match self.stage {
            SearchStage::Grid => SearchStage::Steps(0),
            SearchStage::Steps(at) if at + 1 < S::STEPS && self.rounds <= MAX_ROUNDS => {
                SearchStage::Steps(at + 1)
            }
            SearchStage::Steps(_) | SearchStage::Done => SearchStage::Done,
        };
    }
}
