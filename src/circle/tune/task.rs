//! What is tuned, and the trials that a search asks for.

use super::super::compare::Comparison;
use super::super::direction::Direction;
use super::super::lap::Job;
use super::super::reference::{Circle, CircleError};
use super::super::test::CircularTest;
use super::candidate::{Candidate, Ranges};
use super::crossing;
use crate::current::{Reading, Switched};
use crate::simulation::{FrictionModel, Plant};

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
#[non_exhaustive]
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
    /// Every variant, in the order of [`Tuned::new`](super::tuned::Tuned::new).
    pub const ALL: [Self; 4] = [Self::Off, Self::On, Self::Minus20, Self::Plus20];

    /// The factor on the friction of the machine.
    fn friction(self) -> f64 {
        match self {
            Self::Off | Self::On => 1.0,
            Self::Minus20 => 0.8,
            Self::Plus20 => 1.2,
        }
    }
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

    /// The largest glitch over the crossings and feeds, as the search sees it: of both axes
    /// one reversal, simulated by itself. A value that reaches `bound_um` ends the trial, since the
    /// candidate has lost.
    ///
    /// # Errors
    /// A circle that cannot be simulated.
    pub fn worst_um(&self, candidate: Candidate, bound_um: f64) -> Result<f64, CircleError> {
        let mut worst: f64 = 0.0;
        let mut circles = self.circles.clone();
        // The fastest circle is the shortest simulation.
        circles.sort_by(|a, b| b.feed_mm_per_min.total_cmp(&a.feed_mm_per_min));
        for circle in circles {
            let test = self.test(circle, candidate, 1.0);
            for axis in crossing::Axis::ALL {
                worst = worst.max(crossing::height(&test, axis)?);
                if worst >= bound_um {
                    return Ok(worst);
                }
            }
        }
        Ok(worst)
    }

    /// The largest glitch of a whole circle. The way round makes no difference: a clockwise
    /// circle is the mirror image of a counter-clockwise one.
    ///
    /// # Errors
    /// A circle that cannot be simulated.
    pub fn whole_um(
        &self,
        circle: Circle,
        candidate: Candidate,
        variant: Variant,
    ) -> Result<f64, CircleError> {
        let compensation = match variant {
            Variant::Off => Switched::Off,
            Variant::On | Variant::Minus20 | Variant::Plus20 => Switched::On,
        };
        let job = Job {
            compensation,
            direction: Direction::Ccw,
        };
        let lap = self.test(circle, candidate, variant.friction()).run(job)?;
        let comparison = Comparison::of([lap]);
        let figures = match compensation {
            Switched::Off => comparison.off.figures,
            Switched::On => comparison.on.figures,
        };
        Ok(figures.glitch_max_um().unwrap_or(f64::NAN))
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
