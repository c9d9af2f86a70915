//! The options of a contour.

use crate::current::Reading;
use crate::motion::PlannerOptions;
use crate::simulation::{DriveParameters, FrictionModel};
use frictcomp::comp::AxisIndex;
use frictcomp::lists::FrictionList;

/// Maximum number of axes that are driven at once.
pub const MOST_AXES: usize = 8;

/// Source of the value list of an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum ListSource {
    /// The lists of the machine.
    Machine,
    /// A list that was given for this run, by its name.
    Given(String),
    /// The friction curve of the simulated drive: the machine has no values.
    Plant,
}

/// An axis that is driven.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ContourAxis {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// Name.
    pub name: String,
    /// Simulated drive.
    pub drive: DriveParameters,
    /// The compensation value list.
    pub list: FrictionList,
    /// Source of the list.
    pub source: ListSource,
    /// Size of a drive unit of the list in units of the drive.
    pub torque_scale: f64,
}

impl ContourAxis {
    /// Returns the force of a drive unit of the list, in N.
    pub fn newtons_per_unit(&self) -> f64 {
        self.drive.force_per_unit_n * self.torque_scale
    }
}

/// Options of a contour.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ContourOptions {
    /// The axes: those of the plane first, then further linear axes, at most [`MOST_AXES`].
    pub axes: Vec<ContourAxis>,
    /// Options of the commanded trace.
    pub planner: PlannerOptions,
    /// The friction model.
    pub model: FrictionModel,
    /// Reading of the points that the documents leave open.
    pub reading: Reading,
}

impl ContourOptions {
    /// Creates the options for some axes, with the usual planner, model and reading.
    pub fn new(axes: Vec<ContourAxis>) -> Self {
        Self {
            axes,
            planner: PlannerOptions::default(),
            model: FrictionModel::default(),
            reading: Reading::default(),
        }
    }

    /// Sets the planner.
    pub fn with_planner(self, planner: PlannerOptions) -> Self {
        Self { planner, ..self }
    }

    /// Sets the friction model.
    pub fn with_model(self, model: FrictionModel) -> Self {
        Self { model, ..self }
    }

    /// Sets the reading.
    pub fn with_reading(self, reading: Reading) -> Self {
        Self { reading, ..self }
    }
}
