//! The plants that are fitted to the circles of rounds.

use serde::Serialize;

use frictcomp_physics::simulation::Plant;

use super::plant_found::{ComparedGlitch, PlantFound, TunedList};

/// The plants of all rounds.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Plants {
    /// Whether plants are fitted, because the one known beforehand is given.
    pub is_wanted: bool,
    /// A plant for each round whose circles are recorded.
    pub verdicts: Vec<PlantVerdict>,
    /// Reasons why none is fitted to all recordings.
    pub lacking: Vec<String>,
}

/// A plant, and what the recordings say about it.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PlantVerdict {
    /// The plant.
    #[serde(flatten)]
    pub found: PlantFound,
    /// Recorded glitches with their predictions.
    pub compared: Vec<ComparedGlitch>,
    /// Recorded glitches that are worse than predicted: it is rejected, and so are the lists that were tuned on it.
    pub rejected: Vec<String>,
    /// Recorded glitches that are better than predicted: nothing is predicted with it any more (R16.16).
    pub retired: Vec<String>,
    /// The plant as known beforehand.
    #[serde(skip)]
    pub base: Plant,
}

impl Plants {
    /// Returns the plants themselves.
    pub fn found(&self) -> impl Iterator<Item = &PlantFound> {
        self.verdicts.iter().map(|it| &it.found)
    }

    /// Returns whether the recordings reject the last plant.
    pub fn is_rejected(&self) -> bool {
        let last = self.verdicts.last();
        last.is_some_and(|it| !it.rejected.is_empty())
    }

    /// Reasons against lists that were tuned on the plant with a key.
    pub fn against(&self, key: &str) -> Vec<String> {
        let Some(plant) = self.verdicts.iter().find(|it| it.found.key == key) else {
            let reason = "the plant on which they were tuned is not fitted now, so that its predictions are not compared";
            return vec![reason.to_owned()];
        };
        let missed = plant.rejected.iter();
        missed
            .map(|it| format!("the plant on which they were tuned is rejected: {it}"))
            .collect()
    }
}

impl PlantVerdict {
    /// Returns whether recordings miss none of its predictions.
    pub fn holds(&self) -> bool {
        self.rejected.is_empty() && self.retired.is_empty()
    }

    /// Returns the tuned lists, unless the plant is rejected or retired.
    pub fn lists(&self) -> &[TunedList] {
        if self.holds() { &self.found.lists } else { &[] }
    }
}
