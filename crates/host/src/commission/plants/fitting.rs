//! The inputs for fitting plants: the drives, and the usable recorded circles of a plan.

use std::path::PathBuf;

use crate::commission::Commissioning;
use crate::disk::sha256_of;
use crate::error::HostError;
use crate::watch::Watch;
use frictcomp::lists::FrictionList;
use frictcomp_physics::circle::{Circle, CircleError, PlaneAxis};
use frictcomp_physics::simulation::{DriveParameters, Plant};
use frictcomp_recordings::commission::{
    CirclesFound, FrictionFound, Measurement, Plan, PlanFile, PlantFound, RecordingOutcome,
    RecordingResult, Stage, ValueListUsed, source_of, with_friction,
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

/// Reason why no plant was found.
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

/// A recorded circle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Driven<'a> {
    pub(super) result: &'a RecordingResult,
    pub(super) circles: &'a CirclesFound,
    pub(super) plan: &'a Plan,
    /// The planned radius in mm.
    pub(super) radius: f64,
}

/// The recorded circles of a round.
#[derive(Debug, Clone)]
pub(super) struct RoundCircles<'a> {
    /// The number of the round and of its plan.
    pub(super) number: usize,
    pub(super) plan: &'a PlanFile,
    pub(super) circles: Vec<Driven<'a>>,
}

impl<'a> RoundCircles<'a> {
    /// Returns the list of each axis, in the order of the plan.
    pub(super) fn lists(&self) -> [Option<&'a ValueListUsed>; 2] {
        [0, 1].map(|at| {
            let name = &self.plan.plan.axes.get(at)?.name;
            self.plan.lists.iter().find(|it| it.axis == *name)
        })
    }

    /// Returns the SHA-256 of the list of each axis.
    pub(super) fn shas(&self) -> [Option<&'a str>; 2] {
        self.lists().map(|it| it.map(|it| it.sha256.as_str()))
    }
}

/// Returns the usable circles of a plan; of several recordings of a program the one closest to its feed counts, of
/// those within 2 % the last one.
pub(super) fn driven_in<'a>(plan: &'a PlanFile, results: &'a [RecordingResult]) -> Vec<Driven<'a>> {
    let programs = plan.plan.programs.iter();
    let each = programs.filter_map(|program| {
        let Measurement::Circles { radius, .. } = program.role else {
            return None;
        };
        let recorded = results.iter().rev();
        let used = recorded.filter(|it| it.program == Some(program.number) && it.found.is_used());
        let circles = used.filter_map(|result| match &result.found {
            RecordingOutcome::Circles(circles) if circles.heights_um.is_some() => {
                Some((result, circles))
            }
            _ => None,
        });
        let (result, circles) =
            circles.min_by(|one, other| one.1.beside().total_cmp(&other.1.beside()))?;
        Some(Driven {
            result,
            circles,
            plan: &plan.plan,
            radius,
        })
    });
    each.collect()
}

/// Returns whether a feed equals one of others.
pub(super) fn has(feeds: &[f64], feed: f64) -> bool {
    feeds.iter().any(|it| it.total_cmp(&feed).is_eq())
}

/// Returns the feeds that were driven alike off and in a round, slowest first.
pub(super) fn common_feeds(off: &[Driven<'_>], round: &RoundCircles<'_>) -> Vec<f64> {
    let is_on = |off: &CirclesFound| {
        let mut on = round.circles.iter();
        on.any(|it| it.circles.is_driven_as(off))
    };
    let off = off.iter().map(|it| it.circles);
    let mut feeds: Vec<f64> = off.filter(|it| is_on(it)).map(|it| it.feed).collect();
    feeds.sort_by(f64::total_cmp);
    feeds
}
