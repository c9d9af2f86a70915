//! `frictcomp.plan`: the programs that measure friction.

use std::path::PathBuf;

use frictcomp_host::commission::{AxisToMeasure, Planning};
use frictcomp_host::{FileRegistry, MachineOptions, OutputFiles};
use frictcomp_recordings::commission::FreeTravel;
use frictcomp_report::results::commission::{plan_texts, render_json};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::json::JsonText;
use crate::machine::{machine_here, machine_options};
use crate::outputs::place;
use crate::per_axis::PerAxis;
use crate::several::{OneOrSeveral, Several};
use crate::work::{Stop, interruptible};

/// Plans the NC programs that measure friction: the document of ``frictcomp commission plan --format json``.
///
/// ``axis`` is one axis, or two linear ones. ``travel`` is what is free of each, in mm or degrees, ``{"X": (0, 300)}``;
/// nothing leaves its inner 90 %. ``feeds`` are those of circles or strokes in mm/min or °/min, at least four over a decade.
/// ``pitch`` is the distance over which the torque repeats, ``slowest`` the slowest speed, by default 0.2 mm/s, ``approach``
/// the feed of all motions that are not measured, by default 1000 mm/min. With ``value_list`` it is stage 2, with these lists
/// on. Only ``into`` writes the programs, a page for the operator and the plan, to this folder.
#[pyfunction]
#[pyo3(signature = (axis, *, travel, feeds, radius_mm=None, pitch=None, slowest=None, approach=None, value_list=None, into=None, machine=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn plan(
    py: Python<'_>,
    axis: OneOrSeveral<String>,
    travel: PerAxis<[f64; 2]>,
    feeds: Several<f64>,
    radius_mm: Option<f64>,
    pitch: Option<PerAxis<f64>>,
    slowest: Option<f64>,
    approach: Option<f64>,
    value_list: Option<PerAxis<PathBuf>>,
    into: Option<PathBuf>,
    machine: Option<&Bound<'_, PyAny>>,
) -> PyResult<JsonText> {
    let Several(feeds) = feeds;
    let job = PlanJob {
        axes: axis.0,
        travel,
        feeds,
        radius_mm,
        pitch,
        slowest: slowest.unwrap_or(Planning::SLOWEST),
        approach: approach.unwrap_or(Planning::APPROACH),
        value_list,
        into,
        machine: machine_options(machine)?,
    };
    interruptible(py, move |stop| job.done(stop))
}

/// What is planned, independent of Python.
struct PlanJob {
    axes: Vec<String>,
    travel: PerAxis<[f64; 2]>,
    feeds: Vec<f64>,
    radius_mm: Option<f64>,
    pitch: Option<PerAxis<f64>>,
    slowest: f64,
    approach: f64,
    value_list: Option<PerAxis<PathBuf>>,
    into: Option<PathBuf>,
    machine: MachineOptions,
}

impl PlanJob {
    fn done(self, stop: &Stop) -> Result<JsonText, Failure> {
        let registry = FileRegistry::default();
        let names: Vec<&str> = self.axes.iter().map(String::as_str).collect();
        let axes = names.iter().map(|name| self.axis(name, &names));
        let lists = names.iter().filter_map(|name| self.list(name, &names));
        let planning = Planning {
            axes: axes.collect::<Result<_, _>>()?,
            lists: lists.collect::<Result<_, _>>()?,
            feeds: self.feeds.clone(),
            radius: self.radius_mm,
            slowest: self.slowest,
            approach: self.approach,
            folder: self.into.as_deref(),
            registry: &registry,
        };
        let report = planning.plan(&*machine_here(self.machine.clone(), &registry)?)?;
        let mut outputs = OutputFiles::new(&registry);
        planning.write(&report, plan_texts(&report), &mut outputs)?;
        place(outputs, stop)?;
        Ok(JsonText(render_json(&report)))
    }

    /// An axis with what is said about it.
    fn axis(&self, name: &str, all: &[&str]) -> Result<AxisToMeasure, Failure> {
        let [low, high] = *self.travel.required(name, ("travel", all))?;
        let pitch = self.pitch.as_ref();
        let pitch = pitch.map(|it| it.of(name, ("pitch", all))).transpose()?;
        Ok(AxisToMeasure {
            name: name.to_owned(),
            travel: FreeTravel { low, high },
            pitch: pitch.flatten().copied(),
        })
    }

    /// The list of an axis, if it is stage 2.
    fn list(&self, name: &str, all: &[&str]) -> Option<Result<PathBuf, Failure>> {
        let lists = self.value_list.as_ref()?;
        Some(lists.required(name, ("value_list", all)).cloned())
    }
}
