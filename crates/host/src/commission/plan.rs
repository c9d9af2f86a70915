//! The plan of a commissioning, made for a machine and written to its folder (R16.1, R16.8).

use std::path::{Path, PathBuf};

use super::error::CommissionError;
use super::evaluated::plan_name;
use crate::disk::{Disk, FileRegistry, Replaces, read_text, sha256_of};
use crate::error::HostError;
use crate::machines::{LoadedMachine, read_value_list};
use crate::outputs::{OutputFiles, json_text};
use frictcomp::comp::Kind;
use frictcomp::machine::{Axis, Machine};
use frictcomp::text::shown_path;
use frictcomp_physics::motion::AxisLimits;
use frictcomp_recordings::commission::{
    Dynamics, FreeTravel, Installed, MeasuredAxis, Plan, PlanFile, PlanReport, PlanRequest, Stage,
    ValueListUsed,
};

/// Name of the files of a plan in the message that one cannot be written.
const NAME: &str = "a file of the plan";

/// Requirements on the plan of a round.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Planning<'a> {
    /// The axes that are measured: one alone, or two linear ones.
    pub axes: Vec<AxisToMeasure>,
    /// The feeds of circles or strokes in mm/min or °/min.
    pub feeds: Vec<f64>,
    /// The feed of all other motions in mm/min or °/min.
    pub approach: f64,
    /// The radius of the circles in mm; `None` for the largest that fits, up to 100 mm.
    pub radius: Option<f64>,
    /// The slowest speed in mm/s or °/s.
    pub slowest: f64,
    /// The lists of stage 2, that of each axis in their order; none for stage 1.
    pub lists: Vec<PathBuf>,
    /// The folder to which the plan is written, if there is one.
    pub folder: Option<&'a Path>,
    /// The files that are read.
    pub registry: &'a FileRegistry,
}

/// An axis that is measured, beyond what its machine says.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisToMeasure {
    /// Name in programs.
    pub name: String,
    /// The travel that may be used.
    pub travel: FreeTravel,
    /// The period of the torque along the travel, if it is known, in mm or degrees.
    pub pitch: Option<f64>,
}

impl Planning<'_> {
    /// The usual slowest speed in mm/s or °/s.
    pub const SLOWEST: f64 = 0.2;

    /// The usual feed of motions that are not measured, in mm/min or °/min.
    pub const APPROACH: f64 = 1000.0;

    /// Makes the plan for a machine.
    ///
    /// # Errors
    /// The machine lacks an axis or what has to be known of it, the programs do not fit its travel, or a list cannot be
    /// used.
    pub fn plan(&self, loaded: &LoadedMachine) -> Result<PlanReport, HostError> {
        let machine = &loaded.machine;
        if machine.channel.inch {
            return Err(CommissionError::Inch.into());
        }
        let lists = self.lists_used()?;
        let axes = self.axes.iter().map(|it| it.on(machine));
        let request = PlanRequest {
            axes: axes.collect::<Result<_, CommissionError>>()?,
            feeds: self.feeds.clone(),
            approach: self.approach,
            radius: self.radius,
            slowest: self.slowest,
            round: self.round(&lists),
        };
        let stage = if lists.is_empty() {
            Stage::Off
        } else {
            Stage::On
        };
        let is_measured = |it: &&Axis| self.axes.iter().any(|axis| axis.name == it.name);
        let measured = machine.axes.iter().filter(is_measured);
        let assumed = measured.filter(|it| AxisLimits::of(it).assumed.jerk);
        let origin = loaded.origin.as_ref();
        Ok(PlanReport {
            plan: Plan::new(&request, stage).map_err(CommissionError::from)?,
            lists,
            machine: origin.map_or("the command line".to_owned(), |it| shown_path(it)),
            assumed_jerk: assumed.map(|it| it.name.clone()).collect(),
        })
    }

    /// Writes the plan, its programs and its pages, each with its name, to the folder.
    ///
    /// # Errors
    /// The folder holds another plan of the round, or a file cannot be written.
    pub fn write(
        &self,
        report: &PlanReport,
        texts: impl Iterator<Item = (String, String)>,
        outputs: &mut OutputFiles,
    ) -> Result<(), HostError> {
        let Some(folder) = self.folder else {
            return Ok(());
        };
        let path = folder.join(plan_name(self.round(&report.lists)));
        let plan = json_text(&report.file())?;
        let is_other = read_text(&path).is_ok_and(|there| there.trim_end() != plan.trim_end());
        if is_other && outputs.replaces(Replaces::Results) == Replaces::Results {
            return Err(CommissionError::OtherPlan(path).into());
        }
        for (name, text) in texts {
            let path = folder.join(name);
            let mut file = outputs.create_in_folder(NAME, &path, Replaces::Results)?;
            file.bytes(text.as_bytes())?;
        }
        let mut file = outputs.create_in_folder(NAME, &path, Replaces::Results)?;
        file.bytes(plan.as_bytes())
    }

    /// Returns the lists of stage 2, each read as the control reads it.
    fn lists_used(&self) -> Result<Vec<ValueListUsed>, HostError> {
        let used = |(axis, path): (&AxisToMeasure, &PathBuf)| {
            read_value_list(path, self.registry, &Disk::default())?;
            Ok(ValueListUsed {
                axis: axis.name.clone(),
                file: shown_path(path),
                sha256: sha256_of(path)?,
            })
        };
        self.axes.iter().zip(&self.lists).map(used).collect()
    }

    /// Returns the round of a plan with these lists: 1 without lists; with lists the one that already has them, or the next that is
    /// not in the folder.
    fn round(&self, lists: &[ValueListUsed]) -> u16 {
        if lists.is_empty() {
            return 1;
        }
        let sums = |lists: &[ValueListUsed]| {
            let pairs = lists.iter().map(|it| (it.axis.clone(), it.sha256.clone()));
            pairs.collect::<Vec<_>>()
        };
        let is_free = |round: &u16| {
            let path = self.folder.map(|it| it.join(plan_name(*round)));
            let Some(path) = path.filter(|it| it.exists()) else {
                return true;
            };
            plan_in(&path).is_some_and(|it| sums(&it.lists) == sums(lists))
        };
        (2..u16::MAX).find(is_free).unwrap_or(u16::MAX)
    }
}

impl AxisToMeasure {
    /// Returns the axis as a machine describes it.
    fn on(&self, machine: &Machine) -> Result<MeasuredAxis, CommissionError> {
        let name = &self.name;
        let found = machine.axes.iter().find(|it| it.name == *name);
        let Some(axis) = found.filter(|it| !it.is_spindle()) else {
            let axes = machine.axes.iter().filter(|it| !it.is_spindle());
            return Err(CommissionError::NoAxis {
                name: name.clone(),
                axes: axes.map(|it| it.name.clone()).collect(),
            });
        };
        let limits = AxisLimits::of(axis);
        let lacking = [
            ("max_velocity", limits.assumed.velocity),
            ("max_acceleration", limits.assumed.acceleration),
        ];
        if let Some((key, _)) = lacking.into_iter().find(|(_, is_assumed)| *is_assumed) {
            let axis = name.clone();
            return Err(CommissionError::NoLimit { axis, key });
        }
        let followers = machine.gantry_slaves.iter();
        let followers = followers.filter(|it| it.master.as_deref() == Some(name));
        Ok(MeasuredAxis {
            name: name.clone(),
            axis_type: axis.axis_type,
            travel: self.travel,
            dynamics: Dynamics {
                velocity_per_s: limits.velocity_per_s,
                acceleration_per_s2: limits.acceleration_per_s2,
                jerk_per_s3: limits.jerk_per_s3,
            },
            installed: installed(axis),
            pitch: self.pitch,
            followers: followers.map(|it| it.name.clone()).collect(),
        })
    }
}

/// Returns the state of friction compensation at the start of the control.
fn installed(axis: &Axis) -> Installed {
    if !axis.configured.contains(Kind::Frict) {
        Installed::Unconfigured
    } else if axis.manual.contains(Kind::Frict) {
        Installed::Off
    } else {
        Installed::On
    }
}

/// Reads the plan in a file; `None` if there is none that this version understands.
fn plan_in(path: &Path) -> Option<PlanFile> {
    serde_json::from_str(&read_text(path).ok()?).ok()
}
