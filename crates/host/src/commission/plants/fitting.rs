//! The inputs for fitting plants.

use std::path::PathBuf;

use super::circles::Driven;
use crate::commission::Commissioning;
use crate::disk::sha256_of;
use crate::error::HostError;
use crate::watch::Watch;
use frictcomp::lists::FrictionList;
use frictcomp_physics::circle::{Circle, CircleError, PlaneAxis};
use frictcomp_physics::simulation::{DriveParameters, Plant};
use frictcomp_recordings::commission::{
    FrictionFound, PlantFound, RecordingResult, Stage, ValueListUsed, source_of, with_friction,
};

/// The inputs for fitting plants.
pub(crate) struct Fitting<'a> {
    /// The commissioning, with its plans and its reader.
    pub(crate) commissioning: &'a Commissioning<'a>,
    /// The previously known plant.
    pub(crate) base: &'a Plant,
    pub(crate) results: &'a [RecordingResult],
    /// Plants of an earlier run.
    pub(crate) known: &'a [PlantFound],
    pub(crate) watch: &'a Watch,
}

/// Why no plant was found.
pub(super) enum NoPlant {
    /// The recordings or the lists do not yield one; everything else continues.
    Lacking(String),
    /// The work cannot continue.
    Failed(HostError),
}

impl From<CircleError> for NoPlant {
    fn from(error: CircleError) -> Self {
        Self::Lacking(error.to_string())
    }
}

impl From<HostError> for NoPlant {
    fn from(error: HostError) -> Self {
        Self::Failed(error)
    }
}

/// An axis with its measured friction.
pub(super) struct FittedAxis<'a> {
    pub(super) name: &'a str,
    pub(super) plane: PlaneAxis,
    pub(super) friction: &'a FrictionFound,
    /// The drive with the measured friction.
    pub(super) drive: DriveParameters,
}

impl Fitting<'_> {
    /// Returns both axes of the circles with their measured friction, or the reason against a plant.
    pub(super) fn axes(&self) -> Result<Vec<FittedAxis<'_>>, String> {
        let first = self
            .commissioning
            .plans
            .iter()
            .find(|it| it.plan.stage == Stage::Off);
        let Some([x, y]) = first.map(|it| &it.plan.axes[..]) else {
            return Err("circles of two axes are planned in stage 1".to_owned());
        };
        let each = PlaneAxis::ALL.into_iter().zip([x, y]);
        each.map(|(plane, axis)| {
            if !axis.followers.is_empty() {
                return Err(format!(
                    "{} is a gantry, and a plant has one motor for each axis",
                    axis.name
                ));
            }
            let (source, _) = source_of(axis, self.commissioning.plans, self.results);
            let (_, friction) =
                source.ok_or_else(|| format!("the friction of {} is not known", axis.name))?;
            let fit = friction.fit.as_ref().ok_or_else(|| {
                format!(
                    "the friction of {} is not a curve of Coulomb, Stribeck and viscous friction",
                    axis.name
                )
            })?;
            let base = match plane {
                PlaneAxis::X => &self.base.x,
                _ => &self.base.y,
            };
            Ok(FittedAxis {
                name: &axis.name,
                plane,
                friction,
                drive: with_friction(base, fit),
            })
        })
        .collect()
    }

    /// Returns a circle as it was driven.
    pub(super) fn circle(&self, driven: &Driven<'_>) -> Circle {
        Circle {
            radius_mm: driven.radius,
            feed_mm_per_min: driven.circles.measured_feed.unwrap_or(driven.circles.feed),
            cycle_time_s: self.commissioning.reader.channels.cycle_time_s(),
        }
    }

    /// Returns a list as it was recorded.
    pub(super) fn list(&self, used: &ValueListUsed) -> Result<FrictionList, NoPlant> {
        Ok(self.commissioning.list(&recorded_list(used)?)?)
    }
}

/// Returns the file of a list, if it is still the recorded one.
pub(super) fn recorded_list(used: &ValueListUsed) -> Result<PathBuf, NoPlant> {
    let path = PathBuf::from(&used.file);
    if path.exists() && sha256_of(&path)? == used.sha256 {
        return Ok(path);
    }
    Err(NoPlant::Lacking(format!(
        "the list of {} that was recorded is no longer `{}`; put it back",
        used.axis, used.file
    )))
}
