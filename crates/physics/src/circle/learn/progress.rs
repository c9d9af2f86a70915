//! The judgement of rounds by their recordings.

use serde::Serialize;

use super::round::LearnedRound;

/// Rounds without gain after which learning ends.
const IDLE: usize = 2;

/// Factor on the largest step after a round without gain.
const SMALLER: f64 = 0.5;

/// Judgement of a round.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RoundVerdict {
    /// The largest recorded glitch.
    #[serde(rename = "glitch")]
    pub worst_um: f64,
    /// The spread of both recordings.
    #[serde(rename = "spread")]
    pub spread_um: f64,
    /// Whether the round is better than the best before by more than the spread; the first one always is.
    pub is_accepted: bool,
}

/// The progress of an axis over its rounds (R16.4).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LearningProgress {
    /// The judgement of each round.
    pub verdicts: Vec<RoundVerdict>,
    /// Index of the best round, whose list is handed over.
    pub best: usize,
    /// The largest step as a share of the largest at the beginning.
    pub step: f64,
    /// Rounds without gain since the best.
    pub idle: usize,
}

impl LearningProgress {
    /// Judges rounds in their order: a round is accepted if it is better than the best by more than the
    /// larger spread of both, so that the list handed over is never worse than the first by more than that.
    pub fn of(rounds: &[LearnedRound]) -> Self {
        let mut progress = Self {
            verdicts: Vec::new(),
            best: 0,
            step: 1.0,
            idle: 0,
        };
        for (at, round) in rounds.iter().enumerate() {
            let [worst_um, spread_um] = [round.worst_um(), round.spread_um()];
            let best = progress.verdicts.get(progress.best);
            let is_accepted =
                best.is_none_or(|it| worst_um < it.worst_um - it.spread_um.max(spread_um));
            if is_accepted {
                progress.best = at;
                progress.idle = 0;
            } else {
                progress.idle += 1;
                progress.step *= SMALLER;
            }
            progress.verdicts.push(RoundVerdict {
                worst_um,
                spread_um,
                is_accepted,
            });
        }
        progress
    }

    /// Returns whether two rounds in succession brought no gain.
    pub fn is_over(&self) -> bool {
        self.idle >= IDLE
    }
}
