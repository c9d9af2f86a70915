//! What a simulated circular test depends on.

use super::reference::Circle;
use crate::current::Reading;
use crate::lists::FrictionList;
use crate::simulation::{FrictionModel, Plant};

/// One plant, one circle, one value list an axis.
#[derive(Debug, Clone)]
pub struct CircularTest {
    /// The commanded circle.
    pub circle: Circle,
    /// The machine.
    pub plant: Plant,
    /// How its friction is computed.
    pub model: FrictionModel,
    /// The value lists of X and Y.
    pub lists: [FrictionList; 2],
    /// How the documents are read.
    pub reading: Reading,
}
