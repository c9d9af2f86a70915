//! The conditions of a simulated circular test.

use super::method::Method;
use crate::circle::geometry::Circle;
use crate::circle::geometry::PlaneAxis;
use crate::current::Reading;
use crate::simulation::{FrictionModel, Plant};

/// One plant, one circle, and the compensation of friction on each axis.
#[derive(Debug, Clone)]
pub struct CircularTest {
    /// The commanded circle.
    pub circle: Circle,
    /// The machine.
    pub plant: Plant,
    /// Friction model.
    pub model: FrictionModel,
    /// Compensation of friction on X and Y, if it is on.
    pub compensation: [Option<Method>; 2],
    /// Reading of the documents.
    pub reading: Reading,
}

impl CircularTest {
    /// Returns the compensation of friction on an axis.
    pub(crate) fn of(&self, axis: PlaneAxis) -> Option<&Method> {
        let [x, y] = &self.compensation;
        match axis {
            PlaneAxis::X => x.as_ref(),
            PlaneAxis::Y => y.as_ref(),
        }
    }

    /// Returns whether stiction is compensated, and not friction by an additive current.
    pub fn is_stiction(&self) -> bool {
        let mut axes = self.compensation.iter().flatten();
        axes.any(|axis| axis.stiction().is_some())
    }
}
