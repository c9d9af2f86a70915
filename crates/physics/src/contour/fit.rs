//! Match between a value list and the simulated drive that it compensates (R11.25).

use super::options::{ContourAxis, ContourOptions, ListSource};
use crate::current::{AdditiveCurrent, VELOCITY_UNITS_PER_MM_PER_S};

/// The velocities in mm/s at which list and friction are compared. Below them the points of a list
/// shape the reversal.
const COMPARED: [f64; 7] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];

/// The least and the largest share of the friction that a list of the drive adds.
const BELONGS: std::ops::RangeInclusive<f64> = 0.5..=2.0;

const MM_PER_M: f64 = 1000.0;

/// The force that a value list adds, and the friction of the drive at the same velocities: means over
/// 1 to 100 mm/s.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ListFit {
    /// The mean of the added force in N.
    pub added_n: f64,
    /// The mean of the friction in N.
    pub friction_n: f64,
}

impl ListFit {
    /// Returns the added force as a share of the friction; `None` without friction.
    pub fn share(&self) -> Option<f64> {
        (self.friction_n > 0.0).then(|| self.added_n / self.friction_n)
    }

    /// Returns whether the list adds between half and twice the friction.
    pub fn belongs(&self) -> bool {
        self.share().is_some_and(|share| BELONGS.contains(&share))
    }
}

impl ContourOptions {
    /// Compares the value list of an axis with its drive. `None` if the list is made from the
    /// drive.
    pub fn list_fit(&self, axis: &ContourAxis) -> Option<ListFit> {
        if axis.source == ListSource::Plant {
            return None;
        }
        let mut current = AdditiveCurrent::new(&axis.list, self.reading);
        let added = COMPARED.map(|velocity| {
            current.steady(velocity * VELOCITY_UNITS_PER_MM_PER_S) * axis.newtons_per_unit()
        });
        let friction = COMPARED.map(|velocity| axis.drive.friction_n(velocity / MM_PER_M));
        let mean = |forces: [f64; 7]| forces.iter().sum::<f64>() / 7.0;
        Some(ListFit {
            added_n: mean(added),
            friction_n: mean(friction),
        })
    }
}
