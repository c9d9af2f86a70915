//! `frictcomp.current`: the additive current of axes, cycle by cycle, as `NumPy` arrays.

mod axis;
mod currents;
mod picture;
mod recording;

use std::ops::ControlFlow;
use std::path::PathBuf;

use frictcomp::interpreter::{Motions, Options};
use frictcomp::machine::Parameterisation;
use frictcomp::timeline::{Record, Sink};
use frictcomp_host::{
    Axes, Disk, FileRegistry, LoadedMachine, MachineOptions, Naming, SingleRun, read_value_list,
    run_alone,
};
use frictcomp_physics::current::{
    ChosenOptions, CurrentCycle, CurrentOptions, CurrentSample, CurrentSink, ProgramCurrents,
    Reading, axes_to_follow,
};
use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::limits::{self, PyLimits};
use crate::machine::{machine_of, machine_options};
use crate::messages::GivenMessages;
use crate::planner::planner;
use crate::program::GivenPrograms;
use crate::several::Several;
use crate::start::{Places, positions};
use crate::words::meant;
use crate::work::{Stop, interruptible};

use axis::{AxisCycles, NamedAxis};
use picture::Marks;

pub(crate) use axis::PyAxisCurrent;
pub(crate) use currents::PyCurrents;
pub(crate) use recording::current_of_recording;

/// Input of a computation, independent of Python.
struct ProgramsJob {
    programs: GivenPrograms,
    machine: MachineOptions,
    axes: Vec<String>,
    value_list: Option<PathBuf>,
    cycle_s: Option<f64>,
    reading: ChosenOptions,
    start: Vec<(String, f64)>,
    max_cycles: u64,
    run: Options,
}

/// The cycles of a program.
struct Cycles {
    t: Vec<f64>,
    line: Vec<u32>,
    axes: Vec<AxisCycles>,
    marks: Marks,
    stop: Stop,
}

/// Its result.
struct ProgramsCurrents {
    axes: Vec<NamedAxis>,
    cycles: Cycles,
    saturated: Vec<u64>,
    at_rest: Vec<u64>,
    left_out: u64,
    said: GivenMessages,
}

/// The additive current of axes over the path of a program, as NumPy arrays.
///
/// Without ``axes`` it is that of all axes with a value list. ``value_list`` replaces the lists of the
/// machine. ``start`` gives the axis positions at the start, ``{"X": 0.0}``, in mm or degrees. ``reading``
/// is that of ``--reading``. The trace ends after ``max_cycles``, which a message reports.
#[pyfunction]
#[pyo3(signature = (program, axes=None, *, machine=None, value_list=None, cycle_time_ms=None, reading=None, start=None, max_cycles=3_600_000, limits=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn current(
    program: &Bound<'_, PyAny>,
    axes: Option<Several<String>>,
    machine: Option<&Bound<'_, PyAny>>,
    value_list: Option<PathBuf>,
    cycle_time_ms: Option<f64>,
    reading: Option<&str>,
    start: Option<Places>,
    max_cycles: u64,
    limits: Option<&Bound<'_, PyLimits>>,
) -> PyResult<PyCurrents> {
    let py = program.py();
    expect_numpy(py)?;
    let axes = axes.map(|it| it.0);
    if axes.as_ref().is_some_and(Vec::is_empty) {
        let failure = Failure::new("no axis was given").with_help(
            "name one, `['X']`; without `axes` the current is that of all axes with a value list",
        );
        return Err(failure.into_error(py));
    }
    let axes = axes.unwrap_or_default();
    let job = ProgramsJob {
        programs: GivenPrograms::one(program)?,
        machine: machine_options(machine)?,
        axes,
        value_list,
        cycle_s: cycle_time_ms.map(|ms| ms / 1000.0),
        reading: meant("reading", reading)?,
        start: start.map_or_else(Vec::new, |Places(places)| places),
        max_cycles: max_cycles.max(1),
        run: limits::options(limits),
    };
    let computed = interruptible(py, move |stop| job.done(stop))?;
    PyCurrents::new(py, computed)
}

/// Refuses to compute arrays in vain if NumPy is missing.
fn expect_numpy(py: Python<'_>) -> PyResult<()> {
    py.import("numpy").map_err(|error| {
        // Ctrl+C while it is loaded does not mean that it is missing.
        if !error.is_instance_of::<PyImportError>(py) {
            return error;
        }
        Failure::new("the currents are NumPy arrays, and NumPy is not installed")
            .with_help("`pip install frictcomp[numpy]`")
            .into_error(py)
    })?;
    Ok(())
}

impl ProgramsJob {
    fn done(self, stop: &Stop) -> Result<ProgramsCurrents, Failure> {
        self.programs.probe()?;
        let input = &self.programs.inputs[0];
        let loaded = machine_of(self.machine.clone(), &self.programs, Vec::new())?;
        let mut loaded = loaded.as_ref().clone();
        if let Some(path) = &self.value_list {
            let list = read_value_list(path, &FileRegistry::default(), &Disk::default())?.list;
            let axes = loaded.machine.axes.iter_mut();
            let named = |it: &str| self.axes.is_empty() || self.axes.iter().any(|axis| axis == it);
            for axis in axes.filter(|it| named(&it.name)) {
                axis.friction = Parameterisation::Accepted(list.clone());
            }
        }
        let followed = axes_to_follow(&self.axes, &loaded.machine).map_err(Failure::of_axes)?;
        let axes = followed.iter().map(|axis| loaded.machine.axis(*axis));
        let axes = axes.map(|axis| NamedAxis::new(&axis.name, Some(axis.axis_type)));
        let axes: Vec<NamedAxis> = axes.collect();
        let cycles = Cycles {
            t: Vec::new(),
            line: Vec::new(),
            axes: axes.iter().map(|_| AxisCycles::default()).collect(),
            marks: Marks::default(),
            stop: stop.clone(),
        };
        let options = self.options(&loaded)?;
        let mut currents = ProgramCurrents::new(&loaded.machine, &followed, options, cycles);
        let mut sink = |record: &Record<'_>| {
            stop.flow()?;
            currents.record(record)
        };
        run_alone(input, &loaded, self.alone(&loaded)?, &mut sink)?;
        currents.finish();
        let said = GivenMessages::of_trace(currents.diagnostics(), &loaded);
        Ok(ProgramsCurrents {
            axes,
            saturated: currents.saturated().collect(),
            at_rest: currents.at_rest().collect(),
            left_out: currents.left_out(),
            said,
            cycles: currents.sink().take(),
        })
    }

    fn options(&self, loaded: &LoadedMachine) -> Result<CurrentOptions, Failure> {
        let planner = planner(self.cycle_s, self.max_cycles, loaded)?;
        let reading = self.reading.over(Reading::from(&loaded.machine.readings));
        Ok(CurrentOptions::from(planner).with_reading(reading))
    }

    fn alone(&self, loaded: &LoadedMachine) -> Result<SingleRun, Failure> {
        Ok(SingleRun {
            options: loaded
                .session(self.run.with_motions(Motions::Taken))
                .with_start(positions(&self.start, loaded)?),
            naming: Naming::AsGiven,
            axes: Axes::AsTheyOccur,
        })
    }
}

impl Cycles {
    fn take(&mut self) -> Self {
        Self {
            t: std::mem::take(&mut self.t),
            line: std::mem::take(&mut self.line),
            axes: std::mem::take(&mut self.axes),
            marks: std::mem::take(&mut self.marks),
            stop: self.stop.clone(),
        }
    }
}

impl CurrentSink for Cycles {
    fn begin(&mut self, _: f64, _: u32) {
        self.marks.begin(self.t.len());
    }

    fn cycle(&mut self, cycle: &CurrentCycle<'_>) -> ControlFlow<()> {
        self.marks.block(self.t.len(), cycle.cause);
        self.t.push(cycle.time_s);
        self.line.push(cycle.cause.line);
        for (axis, sample) in self.axes.iter_mut().zip(cycle.axes) {
            let CurrentSample { commanded, added } = sample;
            axis.push(commanded, added);
        }
        self.stop.flow()
    }
}
