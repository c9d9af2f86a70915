//! `frictcomp.contour`: where on the part compensation is missing.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::interpreter::{Motions, Options};
use frictcomp_host::{
    ContourSetup, Disk, FileRegistry, LoadedMachine, MachineOptions, Naming, drive_contour,
    find_plant, read_value_list,
};
use frictcomp_physics::contour::{ContourLimits, ContourOptions};
use frictcomp_physics::motion::PlannerOptions;
use frictcomp_physics::simulation::FrictionModel;
use frictcomp_report::Detail;
use frictcomp_report::pictures::ContourPicture;
use frictcomp_report::results::contour::{
    ContourRecorder, ContourSubject, contour_remarks, render_json,
};
use frictcomp_report::svg::Frame;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::exceptions::refused;
use crate::failure::Failure;
use crate::json;
use crate::limits::{self, PyLimits};
use crate::machine::{machine_options, watched_machine_of};
use crate::messages::{GivenMessages, PyMessages};
use crate::notebook;
use crate::pickled::{self, Reduced};
use crate::planner::planner;
use crate::program::GivenPrograms;
use crate::several::Several;
use crate::start::{Places, positions};
use crate::words::meant;
use crate::work::{Stop, interruptible};

/// The path of a program driven by simulated axes: as programmed, with all compensation, with none.
#[pyclass(frozen, name = "Contour", module = "frictcomp")]
pub(crate) struct PyContour {
    record: String,
    svg: String,
    remarks: Vec<String>,
    messages: Py<PyMessages>,
}

/// Input of a contour, independent of Python.
struct ContourJob {
    programs: GivenPrograms,
    machine: MachineOptions,
    plane: [String; 2],
    plant: String,
    model: FrictionModel,
    value_lists: BTreeMap<String, PathBuf>,
    cycle_s: Option<f64>,
    start: Vec<(String, f64)>,
    max_cycles: Option<u64>,
    run: Options,
}

/// Its result.
struct Driven {
    record: String,
    svg: String,
    remarks: Vec<String>,
    said: GivenMessages,
}

/// Drives the path of a program with simulated axes: the document of ``frictcomp contour --format json``.
///
/// The path is driven three times: with friction compensation as the program switches it, with all of
/// it on, and with all of it off. ``plane`` is the view of the picture, ``"XY"`` or two names.
/// ``value_list`` gives axes other lists than those of the machine, ``{"X": "comp_x.lis"}``. ``start``
/// gives the axis positions at the start, ``{"X": 0.0}``, in mm or degrees.
#[pyfunction]
#[pyo3(signature = (program, *, machine=None, plane=None, plant="stiff", model=None, value_list=None, cycle_time_ms=None, start=None, max_cycles=None, limits=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments, clippy::similar_names)]
pub(crate) fn contour(
    program: &Bound<'_, PyAny>,
    machine: Option<&Bound<'_, PyAny>>,
    plane: Option<&Bound<'_, PyAny>>,
    plant: &str,
    model: Option<&str>,
    value_list: Option<BTreeMap<String, PathBuf>>,
    cycle_time_ms: Option<f64>,
    start: Option<Places>,
    max_cycles: Option<u64>,
    limits: Option<&Bound<'_, PyLimits>>,
) -> PyResult<PyContour> {
    let py = program.py();
    let job = ContourJob {
        programs: GivenPrograms::one(program)?,
        machine: machine_options(machine)?,
        plane: axes_of(plane)?,
        plant: plant.to_owned(),
        model: meant("model", model)?,
        value_lists: value_list.unwrap_or_default(),
        cycle_s: cycle_time_ms.map(|ms| ms / 1000.0),
        start: start.map_or_else(Vec::new, |Places(places)| places),
        max_cycles: max_cycles.map(|cycles| cycles.max(1)),
        run: limits::options(limits),
    };
    let Driven {
        record,
        svg,
        remarks,
        said,
    } = interruptible(py, move |stop| job.done(stop))?;
    Ok(PyContour {
        record,
        svg,
        remarks,
        messages: Py::new(py, PyMessages::new(said))?,
    })
}

/// `"XY"`, or two names.
fn axes_of(plane: Option<&Bound<'_, PyAny>>) -> PyResult<[String; 2]> {
    let names = match plane {
        None => vec!["X".to_owned(), "Y".to_owned()],
        Some(text) if text.is_instance_of::<PyString>() => {
            let letters: String = text.extract()?;
            letters.chars().map(String::from).collect()
        }
        Some(several) => several.extract::<Several<String>>()?.0,
    };
    names.try_into().map_err(|_| {
        refused(
            "a plane has two axes: give \"XY\", or names of several letters as (\"X1\", \"Y1\")",
        )
    })
}

impl ContourJob {
    fn done(self, stop: &Stop) -> Result<Driven, Failure> {
        self.programs.probe()?;
        let watcher = Arc::new(stop.clone());
        let loaded = watched_machine_of(self.machine.clone(), &self.programs, watcher)?;
        let setup = self.setup(&loaded)?;
        let input = &self.programs.inputs[0];
        let (contour, mut recorder) = drive_contour(input, &loaded, &setup, recorder)?;
        let subject = ContourSubject {
            program: input.name(Naming::AsGiven),
            plant: self.plant,
        };
        let picture = recorder.take_picture();
        let picture = picture.expect("the recorder draws");
        let chart = picture.chart(&subject.heading(&contour));
        Ok(Driven {
            record: render_json(&contour, &recorder, &ContourLimits::default()),
            svg: chart.render(Frame::Alone),
            remarks: contour_remarks(&contour, Detail::Full),
            said: GivenMessages::of_trace((&contour.errors, &contour.remarks), &loaded),
        })
    }

    fn setup(&self, loaded: &LoadedMachine) -> Result<ContourSetup, Failure> {
        let registry = FileRegistry::default();
        let lists = self.value_lists.iter().map(|(axis, path)| {
            let list = read_value_list(path, &registry, &Disk::default())?.list;
            Ok((axis.clone(), frictcomp::text::shown_path(path), list))
        });
        let usual = PlannerOptions::default();
        Ok(ContourSetup {
            plane: self.plane.clone(),
            plant: find_plant(&self.plant, &registry)?,
            value_lists: lists.collect::<Result<_, Failure>>()?,
            model: self.model,
            planner: planner(
                self.cycle_s,
                self.max_cycles.unwrap_or(usual.max_cycles),
                loaded,
            )?,
            session: loaded
                .session(self.run.with_motions(Motions::Taken))
                .with_start(positions(&self.start, loaded)?),
            naming: Naming::AsGiven,
        })
    }
}

/// Keeps everything, and draws.
fn recorder(options: &ContourOptions) -> ContourRecorder<'static> {
    let names: Vec<String> = options.axes.iter().map(|axis| axis.name.clone()).collect();
    let plane = [names[0].clone(), names[1].clone()];
    let recorder = ContourRecorder::new(names).keeping_all();
    recorder.drawing(ContourPicture::new(plane))
}

/// The data that a contour is restored from.
type PickledContour = (String, String, Vec<String>, Py<PyMessages>);

#[pymethods]
impl PyContour {
    #[staticmethod]
    fn _unpickled(
        record: String,
        svg: String,
        remarks: Vec<String>,
        messages: Py<PyMessages>,
    ) -> Self {
        Self {
            record,
            svg,
            remarks,
            messages,
        }
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<PickledContour>> {
        let this = slf.get();
        let arguments = (
            this.record.clone(),
            this.svg.clone(),
            this.remarks.clone(),
            this.messages.clone_ref(slf.py()),
        );
        pickled::reduced(slf, arguments)
    }

    /// The document of ``frictcomp contour --format json``: figures, reversals, blocks.
    #[getter]
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::parsed(py, &self.record)
    }

    /// The feed that is reached, and what the figures rest on: a sentence each.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }

    /// Causes that stopped the program or the trace, and simplifications of the trace.
    #[getter]
    fn messages(&self, py: Python<'_>) -> Py<PyMessages> {
        self.messages.clone_ref(py)
    }

    /// The picture of the path with its magnified deviation, as ``frictcomp contour --svg`` draws it.
    fn svg(&self) -> &str {
        &self.svg
    }

    /// Its picture, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        notebook::pictured(py, &notebook::verdict(&self.record), &[&self.svg])
    }

    fn __repr__(&self) -> String {
        format!(
            "<frictcomp.Contour: {}>",
            self.remarks
                .first()
                .map_or("nothing was driven", String::as_str)
        )
    }
}
