//! `frictcomp.ask_write`, `ask_read` and `ask_list`: what the documents of a control leave open, put to it.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::comp::CncBuild;
use frictcomp::text::shown_path;
use frictcomp_host::ask::{AskedControl, RecordedAnswers, TRAVEL};
use frictcomp_host::{FileRegistry, LoadedMachine, MachineOptions, OutputFiles};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::results::ask::{AnswersReport, WrittenPrograms, render_json};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::identify::given_units;
use crate::json::JsonText;
use crate::machine::{machine_here, machine_options};
use crate::outputs::place;
use crate::several::OneOrSeveral;
use crate::words::{meant_if_given, seconds};
use crate::work::{Stop, interruptible};

/// Writes the NC programs that test on the control what its documents leave open, and a page for the operator.
///
/// Only the folder ``into`` gets files, and no program there is replaced. ``axis`` is the axis to test, by default the first
/// one with P-AXIS-00522 = 1; it moves no farther than ``travel``, by default 10 mm or degrees. Returns a document with the
/// names of the programs.
#[pyfunction]
#[pyo3(signature = (into, *, axis=None, travel=None, machine=None, cnc_build=None))]
pub(crate) fn ask_write(
    py: Python<'_>,
    into: PathBuf,
    axis: Option<String>,
    travel: Option<f64>,
    machine: Option<&Bound<'_, PyAny>>,
    cnc_build: Option<&str>,
) -> PyResult<JsonText> {
    let asked = Asked::of(machine, cnc_build)?;
    interruptible(py, move |stop| {
        let registry = FileRegistry::default();
        let loaded = asked.loaded(&registry)?;
        let control = AskedControl::new(&loaded, asked.build)?;
        let axis = control.axis(control.axis_name(axis.as_deref()))?;
        let axis = axis.within(travel.unwrap_or(TRAVEL))?;
        let mut outputs = OutputFiles::new(&registry);
        let programs = AskedControl::write(&axis, &into, &mut outputs)?;
        place(outputs, stop)?;
        let written = WrittenPrograms {
            axis: &axis.name,
            travel: axis.travel,
            build: axis.build,
            folder: shown_path(&into),
            programs,
        };
        Ok(JsonText(written.render_json()))
    })
}

/// Reads the answers of a control: the document of ``frictcomp ask read --format json``.
///
/// The files are ``message.txt`` of the control, notes, and recordings, in which ``axis`` is read, by default the first one
/// with P-AXIS-00522 = 1; their channels are named as for ``identify``, ``torque`` being the additive current. Only
/// ``into``, a ``frictcomp.toml`` that may be new, records what is decided; without it nothing is written. ``unread`` of the
/// document has the lines that are marked as answers and cannot be read.
#[pyfunction]
#[pyo3(signature = (files, *, axis=None, time=None, position=None, velocity=None, torque=None, units=None, cycle_time_ms=None, machine=None, cnc_build=None, into=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn ask_read(
    py: Python<'_>,
    files: OneOrSeveral<PathBuf>,
    axis: Option<String>,
    time: Option<String>,
    position: Option<String>,
    velocity: Option<String>,
    torque: Option<String>,
    units: Option<HashMap<String, String>>,
    cycle_time_ms: Option<f64>,
    machine: Option<&Bound<'_, PyAny>>,
    cnc_build: Option<&str>,
    into: Option<PathBuf>,
) -> PyResult<JsonText> {
    let job = ReadJob {
        asked: Asked::of(machine, cnc_build)?,
        files: files.0,
        axis,
        channels: ChannelSelection {
            time,
            position,
            velocity,
            torque,
            units: given_units(units)?,
            ..ChannelSelection::default()
        },
        cycle_s: seconds(py, cycle_time_ms)?,
        into,
    };
    interruptible(py, move |stop| job.done(stop))
}

/// The open questions, what is assumed, and what is answered: the document of ``frictcomp ask list --format json``.
#[pyfunction]
#[pyo3(signature = (*, machine=None, cnc_build=None))]
pub(crate) fn ask_list(
    py: Python<'_>,
    machine: Option<&Bound<'_, PyAny>>,
    cnc_build: Option<&str>,
) -> PyResult<JsonText> {
    let asked = Asked::of(machine, cnc_build)?;
    interruptible(py, move |_| {
        let loaded = asked.loaded(&FileRegistry::default())?;
        let build = AskedControl::new(&loaded, asked.build)?.build();
        Ok(JsonText(render_json(&loaded.machine, build)))
    })
}

/// The control that is asked, as Python describes it.
struct Asked {
    machine: MachineOptions,
    build: Option<CncBuild>,
}

impl Asked {
    fn of(machine: Option<&Bound<'_, PyAny>>, cnc_build: Option<&str>) -> PyResult<Self> {
        Ok(Self {
            machine: machine_options(machine)?,
            build: meant_if_given("cnc_build", cnc_build)?,
        })
    }

    fn loaded(&self, registry: &FileRegistry) -> Result<Arc<LoadedMachine>, Failure> {
        machine_here(self.machine.clone(), registry)
    }
}

/// The answers to be read, independent of Python.
struct ReadJob {
    asked: Asked,
    files: Vec<PathBuf>,
    axis: Option<String>,
    channels: ChannelSelection,
    cycle_s: Option<f64>,
    into: Option<PathBuf>,
}

impl ReadJob {
    fn done(self, stop: &Stop) -> Result<JsonText, Failure> {
        if self.files.is_empty() {
            return Err(Failure::new("no file was given")
                .with_help("name `message.txt` of the control, notes or recordings"));
        }
        let registry = FileRegistry::default();
        let loaded = self.asked.loaded(&registry)?;
        let control = AskedControl::new(&loaded, self.asked.build)?;
        let axis = control.axis_name(self.axis.as_deref()).to_owned();
        let recorded = RecordedAnswers {
            channels: ChannelSelection {
                axis: Some(axis.clone()),
                ..self.channels
            },
            cycle_s: self.cycle_s,
            axis,
        };
        let mut unread = Vec::new();
        let read = control.read(
            &self.files,
            &recorded,
            (&registry, |line| unread.push(line.clone())),
        );
        let read = read.map_err(|error| Failure::from(error).after(&unread))?;
        stop.refuse()?;
        let mut recorded_in = None;
        if let Some(path) = &self.into
            && read.keep(path)?
        {
            recorded_in = Some(shown_path(path));
        }
        let report = AnswersReport {
            answers: &read.answers,
            unread,
            recorded_in,
            lacks_build: read.lacks_build(),
        };
        Ok(JsonText(report.render_json()))
    }
}
