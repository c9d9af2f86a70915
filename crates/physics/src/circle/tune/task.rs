//! The task of tuning.

use super::heights::Heights;
use super::ranges::Ranges;
use super::reversal::AxisAlone;
use crate::circle::geometry::Direction;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Circle, CircleError};
use crate::circle::simulated::CircularTest;
use crate::circle::simulated::Comparison;
use crate::circle::simulated::LapRun;
use crate::circle::simulated::Method;
use crate::current::{Reading, Switched};
use crate::simulation::{DriveParameters, FrictionModel, Plant};
use frictcomp::lists::Points;

/// Task of tuning.
#[derive(Debug, Clone)]
pub struct Task {
    /// The machine.
    pub plant: Plant,
    /// Friction model.
    pub model: FrictionModel,
    /// The circles, which differ in their feeds and radii.
    pub circles: Vec<Circle>,
    /// The ranges in which the parameters are searched.
    pub ranges: Ranges,
    /// Reading of the documents.
    pub reading: Reading,
    /// Form of the points of the lists.
    pub points: Points,
    /// Separate shape for the points below 1 mm/s.
    pub shaping: Shaping,
    /// The machines for which the list must be good.
    pub aim: TuningAim,
}

/// The machines for which a list must be good (R5.29).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum TuningAim {
    /// The plant as it is described.
    #[default]
    Plant,
    /// The plant, and machines whose contact is half or twice as stiff or whose friction differs by ±10 %
    /// between the directions; on the plant itself the list may leave a quarter more.
    Robust,
}

/// Shaping of a list below 1 mm/s.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Shaping {
    /// Separate shape if it is worthwhile.
    #[default]
    Allowed,
    /// No separate shape: the table is the friction curve.
    None,
}

/// The friction of a driven circle, and whether it has compensation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Variant {
    /// No compensation.
    Off,
    /// With compensation.
    On,
    /// With compensation, and 20 % less friction.
    Minus20,
    /// With compensation, and 20 % more friction.
    Plus20,
}

impl Variant {
    pub(super) const ALL: [Self; 4] = [Self::Off, Self::On, Self::Minus20, Self::Plus20];

    /// Returns the factor on the friction of the machine.
    fn friction(self) -> f64 {
        match self {
            Self::Off | Self::On => 1.0,
            Self::Minus20 => 0.8,
            Self::Plus20 => 1.2,
        }
    }
}

/// A change of the velocity in a CNC cycle at a reversal above which the place of the reversal in the
/// cycle matters, in mm/s.
const ABRUPT_MM_PER_S: f64 = 0.05;

/// Ratio of the fastest checked circle to the fastest of the range.
const BEYOND: f64 = 2.4;

impl Task {
    /// Checks that every circle can be simulated and has glitches.
    ///
    /// # Errors
    /// A value is out of range.
    pub fn check(&self) -> Result<(), CircleError> {
        self.circles.iter().try_for_each(|circle| {
            circle.check()?;
            circle.check_glitches()
        })
    }

    /// Returns the axes that are tuned one by one: both at once if their drives are equal.
    pub(super) fn groups(&self) -> Vec<Vec<PlaneAxis>> {
        if self.plant.x == self.plant.y {
            return vec![PlaneAxis::ALL.to_vec()];
        }
        PlaneAxis::ALL.map(|axis| vec![axis]).to_vec()
    }

    /// Returns the drive of an axis.
    pub(super) fn drive(&self, axis: PlaneAxis) -> &DriveParameters {
        match axis {
            PlaneAxis::X => &self.plant.x,
            PlaneAxis::Y => &self.plant.y,
        }
    }

    /// Returns the remaining glitches of a compensation at reversals of single axes, on each
    /// circle, simulated in this order. As soon as one reaches `bound_um` the candidate has lost.
    pub(super) fn heights(
        &self,
        axes: &[PlaneAxis],
        compensation: &Method,
        (circles, order, bound_um): (&[Circle], &[usize], f64),
    ) -> Result<Heights, CircleError> {
        let mut heights = vec![0.0; circles.len()];
        for &at in order {
            heights[at] = self.glitch_um(axes, circles[at], Some(compensation))?;
            if heights[at] >= bound_um {
                return Ok(Heights::lost());
            }
        }
        Ok(Heights(heights))
    }

    /// Returns the largest glitch at a reversal of single axes, with or without compensation.
    ///
    /// Equal axes differ only in the place of their reversal within a CNC cycle, which is considered if it
    /// matters.
    pub(super) fn glitch_um(
        &self,
        axes: &[PlaneAxis],
        circle: Circle,
        compensation: Option<&Method>,
    ) -> Result<f64, CircleError> {
        let change = circle.acceleration_mm_per_s2() * circle.cycle_time_s;
        let count = if change > ABRUPT_MM_PER_S {
            axes.len()
        } else {
            1
        };
        let glitches = axes.iter().take(count).map(|&axis| {
            let alone = AxisAlone {
                axis,
                drive: self.drive(axis),
                model: self.model,
                reading: self.reading,
                phase: 0.0,
            };
            alone.glitch_um(circle, compensation)
        });
        glitches
            .into_iter()
            .try_fold(0.0, |most: f64, glitch| Ok(most.max(glitch?)))
    }

    /// Returns a circle beyond the tuned range, if one can be driven: the one with the largest acceleration, 2.4 times
    /// as fast.
    pub(super) fn beyond(&self) -> Option<Circle> {
        let by = |circle: &&Circle| circle.acceleration_mm_per_s2();
        let fastest = self
            .circles
            .iter()
            .max_by(|one, other| by(one).total_cmp(&by(other)))?;
        let circle = Circle {
            feed_mm_per_min: BEYOND * fastest.feed_mm_per_min,
            ..*fastest
        };
        let is_possible = circle.check().is_ok() && circle.check_glitches().is_ok();
        is_possible.then_some(circle)
    }

    /// Returns the largest glitch of a whole circle with the compensation of X and Y. The direction of travel makes no
    /// difference: a clockwise circle is the mirror image of a counter-clockwise one.
    pub(super) fn whole_um(
        &self,
        circle: Circle,
        compensation: &[Option<Method>; 2],
        variant: Variant,
    ) -> Result<f64, CircleError> {
        let switched = match variant {
            Variant::Off => Switched::Off,
            Variant::On | Variant::Minus20 | Variant::Plus20 => Switched::On,
        };
        let test = CircularTest {
            circle,
            plant: self.plant.with_friction(variant.friction()),
            model: self.model,
            compensation: compensation.clone(),
            reading: self.reading,
        };
        let job = LapRun {
            compensation: switched,
            direction: Direction::Ccw,
        };
        let comparison = Comparison::of([test.run(job)?]);
        let figures = match switched {
            Switched::Off => comparison.off.figures,
            Switched::On => comparison.on.figures,
        };
        circle.check_glitches()?;
        Ok(figures.glitch_max_um().unwrap_or_default())
    }
}
