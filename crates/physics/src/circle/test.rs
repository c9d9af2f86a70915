//! What a simulated circular test depends on.

use super::crossing::PlaneAxis;
use super::method::Method;
use super::reference::Circle;
use crate::current::Reading;
use crate::simulation::{FrictionModel, Plant};

/// One plant, one circle, and what compensates the friction of each axis.
#[derive(Debug, Clone)]
pub struct CircularTest {
    /// The commanded circle.
    pub circle: Circle,
    /// The machine.
    pub plant: Plant,
    /// How its friction is computed.
    pub model: FrictionModel,
    /// What compensates friction on X and Y, where that is on.
    pub compensation: [Option<Method>; 2],
    /// How the documents are read.
    pub reading: Reading,
}

impl CircularTest {
    /// What compensates friction on an axis.
    pub(super) fn of(&self, axis: PlaneAxis) -> Option<&Method> {
        let [x, y] = &self.compensation;
        match axis {
            PlaneAxis::X => x.as_ref(),
            PlaneAxis::Y => y.as_ref(),
        }
    }

    /// Whether it is stiction that is compensated, and not friction by an additive current.
    pub fn is_stiction(&self) -> bool {
        let mut axes = self.compensation.iter().flatten();
        axes.any(|axis| axis.stiction().is_some())
    }
}
