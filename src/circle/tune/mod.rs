//! Tuning: the parameters of a value list that leave the smallest glitch (R5.25).
//!
//! The friction curve of the plant is the table of the list; four parameters are searched. Nothing
//! here knows of threads: the [`Search`] asks for trials and its host makes them, in any order.

mod crossing;
mod search;

use std::ops::RangeInclusive;

use serde::Serialize;

use super::friction::FrictionModel;
use super::plant::Plant;
use super::reference::{Circle, CircleError, Direction};
use super::test::{CircularTest, Compensation, Job, Outcome};
use super::{default_list, drive::DriveParameters};
use crate::current::Reading;
use crate::lists::{Field, FrictionList};

pub use search::Search;

/// The four parameters that are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Candidate {
    /// P-COMP-00043, in 0.1 µm.
    pub position_delay: i32,
    /// P-COMP-00044, in CNC cycles.
    pub reversal_lookahead: u16,
    /// P-COMP-00058, in CNC cycles.
    pub delay_cycles: i16,
    /// P-COMP-00045, in 0.1 %.
    pub scaling_factor: i16,
}

/// Between which values the parameters are searched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ranges {
    /// P-COMP-00043.
    pub position_delay: RangeInclusive<i32>,
    /// P-COMP-00044.
    pub reversal_lookahead: RangeInclusive<u16>,
    /// P-COMP-00058.
    pub delay_cycles: RangeInclusive<i16>,
    /// P-COMP-00045; only compensation in the direction of the friction makes sense.
    pub scaling_factor: RangeInclusive<i16>,
}

impl Default for Ranges {
    /// The documented ranges (chapter 3.3 of the rules); of the scaling factor, half to double.
    fn default() -> Self {
        Self {
            position_delay: 0..=10,
            reversal_lookahead: 0..=4,
            delay_cycles: 0..=248,
            scaling_factor: 500..=2000,
        }
    }
}

impl Ranges {
    /// The same with a parameter beyond its documented range: `position_delay` up to 200 µm,
    /// `reversal_lookahead` up to 50 cycles. The others are wide enough.
    #[must_use]
    pub fn free(mut self, field: Field) -> Self {
        match field {
            Field::PositionDelay => self.position_delay = 0..=2000,
            Field::ReversalLookahead => self.reversal_lookahead = 0..=50,
            _ => {}
        }
        self
    }
}

/// What is tuned.
#[derive(Debug, Clone)]
pub struct Task {
    /// The machine.
    pub plant: Plant,
    /// How its friction is computed.
    pub model: FrictionModel,
    /// The circles, which differ in their feeds.
    pub circles: Vec<Circle>,
    /// Between which values the parameters are searched.
    pub ranges: Ranges,
    /// How the documents are read.
    pub reading: Reading,
}

/// With how much friction, and whether with compensation, a circle is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// Without compensation.
    Off,
    /// With it.
    On,
    /// With it, the friction 20 % less.
    Minus20,
    /// With it, the friction 20 % more.
    Plus20,
}

impl Variant {
    /// All four.
    pub const ALL: [Self; 4] = [Self::Off, Self::On, Self::Minus20, Self::Plus20];

    fn friction(self) -> f64 {
        match self {
            Self::Off | Self::On => 1.0,
            Self::Minus20 => 0.8,
            Self::Plus20 => 1.2,
        }
    }
}

/// The largest glitches at one feed, in µm, over the whole circle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FeedResult {
    /// The feed in mm/min.
    pub feed: f64,
    /// Without compensation.
    pub glitch_off: f64,
    /// With it.
    pub glitch_on: f64,
    /// With it, the friction of the machine being 20 % less than the list says.
    pub glitch_friction_minus20: f64,
    /// With it, the friction 20 % more.
    pub glitch_friction_plus20: f64,
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

impl Task {
    /// The circular test of a circle with parameters and friction.
    fn test(&self, circle: Circle, candidate: Candidate, factor: f64) -> CircularTest {
        CircularTest {
            circle,
            plant: self.plant.with_friction(factor),
            model: self.model,
            lists: [&self.plant.x, &self.plant.y].map(|drive| candidate.list(drive)),
            reading: self.reading,
        }
    }

    /// The largest glitch in µm over the crossings and feeds, as the search sees it: of both axes
    /// one reversal, simulated by itself. A value that reaches `bound` ends the trial, since the
    /// candidate has lost.
    ///
    /// # Errors
    /// A circle that cannot be simulated.
    pub fn worst(&self, candidate: Candidate, bound: f64) -> Result<f64, CircleError> {
        let mut worst: f64 = 0.0;
        let mut circles = self.circles.clone();
        // The fastest circle is the shortest simulation.
        circles.sort_by(|a, b| b.feed.total_cmp(&a.feed));
        for circle in circles {
            let test = self.test(circle, candidate, 1.0);
            for axis in crossing::Axis::ALL {
                worst = worst.max(crossing::height(&test, axis)?);
                if worst >= bound {
                    return Ok(worst);
                }
            }
        }
        Ok(worst)
    }

    /// The largest glitch in µm of a whole circle. The way round makes no difference: a clockwise
    /// circle is the mirror image of a counter-clockwise one.
    ///
    /// # Errors
    /// A circle that cannot be simulated.
    pub fn whole(
        &self,
        circle: Circle,
        candidate: Candidate,
        variant: Variant,
    ) -> Result<f64, CircleError> {
        let compensation = match variant {
            Variant::Off => Compensation::Off,
            Variant::On | Variant::Minus20 | Variant::Plus20 => Compensation::On,
        };
        let job = Job {
            compensation,
            direction: Direction::Ccw,
        };
        let lap = self.test(circle, candidate, variant.friction()).run(job)?;
        let outcome = Outcome::of([lap]);
        Ok(outcome
            .off
            .figures
            .glitch_max()
            .max(outcome.on.figures.glitch_max()))
    }

    /// Every circle with every variant, the circles in their order.
    pub fn wholes(&self) -> Vec<(Circle, Variant)> {
        let pairs = self
            .circles
            .iter()
            .flat_map(|&circle| Variant::ALL.map(|variant| (circle, variant)));
        pairs.collect()
    }
}

impl Candidate {
    /// The value list with the friction curve of a drive and these parameters.
    pub fn list(self, drive: &DriveParameters) -> FrictionList {
        FrictionList {
            position_delay: self.position_delay,
            reversal_lookahead: self.reversal_lookahead,
            delay_cycles: self.delay_cycles,
            scaling_factor: self.scaling_factor,
            ..default_list::plant_list(drive)
        }
    }
}

impl Tuned {
    /// The result from the glitches of [`Task::wholes`], in their order.
    pub fn new(task: &Task, search: &Search, glitches: &[f64]) -> Self {
        let candidate = search.best();
        let feeds = task
            .circles
            .iter()
            .zip(glitches.chunks_exact(Variant::ALL.len()));
        Self {
            candidate,
            list: candidate.list(&task.plant.x),
            feeds: feeds
                .map(|(circle, glitches)| FeedResult {
                    feed: circle.feed,
                    glitch_off: glitches[0],
                    glitch_on: glitches[1],
                    glitch_friction_minus20: glitches[2],
                    glitch_friction_plus20: glitches[3],
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
        let heights = trials.iter().map(|&candidate| task.worst(candidate, bound));
        search.take(&trials, &heights.collect::<Result<Vec<_>, _>>()?);
    }
    let best = search.best();
    let wholes = task.wholes();
    let glitches = wholes
        .iter()
        .map(|&(circle, variant)| task.whole(circle, best, variant));
    let glitches = glitches.collect::<Result<Vec<_>, _>>()?;
    Ok(Tuned::new(task, &search, &glitches))
}
