//! The result of a tuning.

use serde::Serialize;

use super::super::reference::CircleError;
use super::candidate::Candidate;
use super::search::Search;
use super::task::{Task, Variant};
use crate::lists::FrictionList;

/// The largest glitches at one feed, over the whole circle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FeedResult {
    /// The feed.
    #[serde(rename = "feed")]
    pub feed_mm_per_min: f64,
    /// Without compensation.
    #[serde(rename = "glitch_off")]
    pub glitch_off_um: f64,
    /// With it.
    #[serde(rename = "glitch_on")]
    pub glitch_on_um: f64,
    /// With it, the friction of the machine being 20 % less than the list says.
    #[serde(rename = "glitch_friction_minus20")]
    pub glitch_friction_minus20_um: f64,
    /// With it, the friction 20 % more.
    #[serde(rename = "glitch_friction_plus20")]
    pub glitch_friction_plus20_um: f64,
}

/// The result of a tuning.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// The best parameters.
    pub candidate: Candidate,
    /// The value list of X that has them.
    pub list: FrictionList,
    /// What they leave at each feed.
    pub feeds: Vec<FeedResult>,
    /// How many sets of parameters were tried.
    pub trials: usize,
}

impl Tuned {
    /// The result from the glitches of [`Task::wholes`], in their order.
    pub fn new(task: &Task, search: &Search, glitches_um: &[f64]) -> Self {
        let candidate = search.best();
        let feeds = task
            .circles
            .iter()
            .zip(glitches_um.chunks_exact(Variant::ALL.len()));
        Self {
            candidate,
            list: candidate.list(&task.plant.x),
            feeds: feeds
                .map(|(circle, glitches)| FeedResult {
                    feed_mm_per_min: circle.feed_mm_per_min,
                    glitch_off_um: glitches[0],
                    glitch_on_um: glitches[1],
                    glitch_friction_minus20_um: glitches[2],
                    glitch_friction_plus20_um: glitches[3],
                })
                .collect(),
            trials: search.trials(),
        }
    }
}

/// Tunes by itself, one trial after the other.
///
/// # Errors
/// A circle that cannot be simulated.
pub fn tune(task: &Task) -> Result<Tuned, CircleError> {
    let mut search = Search::new(&task.ranges);
    while let Some(trials) = search.next_trials() {
        let bound = search.bound();
        let heights = trials
            .iter()
            .map(|&candidate| task.worst_um(candidate, bound));
        search.take(&trials, &heights.collect::<Result<Vec<_>, _>>()?);
    }
    let best = search.best();
    let wholes = task.wholes();
    let glitches = wholes
        .iter()
        .map(|&(circle, variant)| task.whole_um(circle, best, variant));
    let glitches = glitches.collect::<Result<Vec<_>, _>>()?;
    Ok(Tuned::new(task, &search, &glitches))
}
