//! The axes that a program moves, which have to be driven.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use thiserror::Error;

use super::options::{ContourAxis, ListSource, MOST_AXES};
use crate::simulation::{Plant, plant_list};
use frictcomp::comp::AxisIndex;
use frictcomp::diagnostic::UnknownName;
use frictcomp::interpreter::Motion;
use frictcomp::lists::{AxisType, FrictionList};
use frictcomp::machine::{Machine, Parameterisation};
use frictcomp::timeline::{Record, Sink};

/// Takes the records of a session, which must include the motions of blocks, and keeps the axes that move.
#[derive(Debug, Clone, Default)]
pub struct MovingAxes(BTreeSet<usize>);

impl Sink for MovingAxes {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record
            && let Some(Motion::Travel(travel)) = row.motion
        {
            self.0.extend(travel.axes.iter().map(|axis| axis.get()));
        }
        ControlFlow::Continue(())
    }
}

/// Reason why a contour cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NoContour {
    /// A plane of X and Q on a machine without Q.
    #[error("the machine has no axis `{}`", .0.name)]
    NoAxis(UnknownName),
    /// A rotary axis in the plane.
    #[error("axis `{0}` is not a linear axis, and a plane has two of them")]
    NotLinear(String),
    /// The same axis twice.
    #[error("a plane has two axes, and `{0}` is named twice")]
    Twice(String),
    /// More axes than can be driven at once.
    #[error("the program moves {0} linear axes; at most {MOST_AXES} are driven at once")]
    TooMany(usize),
    /// A value list for an axis that does not move.
    #[error("the contour drives no axis `{0}`, for which a value list is given")]
    NotDriven(String),
}

impl MovingAxes {
    /// Returns whether a program moves an axis.
    pub fn contains(&self, axis: AxisIndex) -> bool {
        self.0.contains(&axis.get())
    }

    /// Returns the axes to drive: those of a plane, and each further linear axis that moves. The first axis of the
    /// plane that is `named` has the drive X of the plant, the second Y, and the others X (R11.1). `given` are value
    /// lists by axis, which take the place of the machine's.
    ///
    /// # Errors
    /// The two names do not make a plane, or the program moves too many axes.
    pub fn driven(
        &self,
        machine: &Machine,
        named: [&str; 2],
        plant: &Plant,
        given: &[(String, String, FrictionList)],
    ) -> Result<Vec<ContourAxis>, NoContour> {
        let is_linear = |axis: AxisIndex| machine.axis(axis).axis_type == AxisType::Linear;
        let mut indices: Vec<AxisIndex> = Vec::new();
        for name in named {
            let Some(axis) = machine.find(name) else {
                let known = machine.axes.iter().map(|axis| axis.name.as_str());
                return Err(NoContour::NoAxis(UnknownName::new(name, known)));
            };
            if !is_linear(axis) {
                return Err(NoContour::NotLinear(name.to_owned()));
            }
            if indices.contains(&axis) {
                return Err(NoContour::Twice(name.to_owned()));
            }
            indices.push(axis);
        }
        let moving = self.0.iter().map(|&position| AxisIndex::new(position));
        let further: Vec<AxisIndex> = moving
            .filter(|axis| is_linear(*axis) && !indices.contains(axis))
            .collect();
        indices.extend(further);
        if indices.len() > MOST_AXES {
            return Err(NoContour::TooMany(indices.len()));
        }
        let is_driven = |name: &str| indices.iter().any(|axis| machine.axis(*axis).name == name);
        if let Some((name, ..)) = given.iter().find(|(name, ..)| !is_driven(name)) {
            return Err(NoContour::NotDriven(name.clone()));
        }
        let driven = indices.into_iter().enumerate();
        Ok(driven
            .map(|(at, index)| {
                let axis = machine.axis(index);
                let drive = if at == 1 { &plant.y } else { &plant.x };
                let own = given.iter().find(|(name, ..)| *name == axis.name);
                let (list, source) = match (own, &axis.friction) {
                    (Some((_, file, list)), _) => (list.clone(), ListSource::Given(file.clone())),
                    (None, Parameterisation::Accepted(list)) => (list.clone(), ListSource::Machine),
                    (None, _) => (plant_list(drive), ListSource::Plant),
                };
                ContourAxis {
                    axis: index,
                    name: axis.name.clone(),
                    drive: drive.clone(),
                    list,
                    torque_scale: match source {
                        ListSource::Plant => 1.0,
                        _ => axis.torque_scale.factor(),
                    },
                    source,
                }
            })
            .collect())
    }
}

/// Gives a machine the value lists of the axes, as if the control had accepted them. A list of the
/// machine that the control switches off or rejects is kept, unless another one was given.
pub fn parameterise(machine: &mut Machine, axes: &[ContourAxis]) {
    for axis in axes {
        let own = &mut machine.axes[axis.axis.get()].friction;
        let is_open = matches!(own, Parameterisation::Missing | Parameterisation::Assumed);
        let replaces = match axis.source {
            ListSource::Machine => false,
            ListSource::Given(_) => true,
            ListSource::Plant => is_open,
        };
        if replaces {
            *own = Parameterisation::Accepted(axis.list.clone());
        }
    }
}
