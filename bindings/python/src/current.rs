//! `frictcomp.current`: the additive current of axes, cycle by cycle, as `NumPy` arrays.

use std::ops::ControlFlow;
use std::path::PathBuf;

use frictcomp::Diagnostic;
use frictcomp::comp::State;
use frictcomp::session::{Motions, Options, SessionOptions};
use frictcomp::timeline::{Record, Sink};
use frictcomp_host::{
    Axes, FileRegistry, LoadedMachine, MachineOptions, Naming, SingleRun, read_value_list,
    run_alone,
};
use frictcomp_physics::current::{
    CurrentCycle, CurrentOptions, CurrentSample, CurrentSink, ProgramCurrents, Reading,
    axes_to_follow,
};
use frictcomp_physics::motion::{PlannerOptions, check_cycle};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyImportError, PyKeyError};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::limits::{self, PyLimits};
use crate::machine::{machine_of, machine_options};
use crate::messages::{PyMessage, PyMessages, Said};
use crate::program::Programs;
use crate::several::Several;
use crate::states;
use crate::words::meant;
use crate::work::{Stop, interruptible};

/// The additive current of one axis in each cycle, with the columns of ``frictcomp current``.
#[pyclass(frozen, name = "AxisCurrent", module = "frictcomp")]
pub(crate) struct PyAxisCurrent {
    axis: String,
    x: Py<PyArray1<f64>>,
    v: Py<PyArray1<f64>>,
    w_before: Py<PyArray1<f64>>,
    w_after: Py<PyArray1<f64>>,
    current: Py<PyArray1<f64>>,
    output: Py<PyArray1<i16>>,
    states: Py<PyArray1<i8>>,
    unknown_cycles: usize,
    saturated_cycles: u64,
    cycles_at_rest: u64,
}

/// The additive currents of axes over the path of a program, cycle by cycle.
#[pyclass(frozen, name = "Currents", module = "frictcomp")]
pub(crate) struct PyCurrents {
    t: Py<PyArray1<f64>>,
    line: Py<PyArray1<u32>>,
    axes: Vec<Py<PyAxisCurrent>>,
    messages: Py<PyMessages>,
    left_out: u64,
}

/// What is computed, away from Python.
struct Job {
    programs: Programs,
    machine: MachineOptions,
    axes: Vec<String>,
    value_list: Option<PathBuf>,
    cycle_s: Option<f64>,
    reading: Reading,
    start: Vec<(String, f64)>,
    max_cycles: u64,
    run: Options,
}

/// The cycles of a program.
struct Cycles {
    t: Vec<f64>,
    line: Vec<u32>,
    axes: Vec<AxisCycles>,
    stop: Stop,
}

/// Those of one axis.
#[derive(Default)]
struct AxisCycles {
    x: Vec<f64>,
    v: Vec<f64>,
    w_before: Vec<f64>,
    w_after: Vec<f64>,
    current: Vec<f64>,
    output: Vec<i16>,
    states: Vec<i8>,
}

/// What came of it.
struct Computed {
    names: Vec<String>,
    cycles: Cycles,
    saturated: Vec<u64>,
    at_rest: Vec<u64>,
    left_out: u64,
    said: Said,
}

/// The additive current of axes over the path of a program, as NumPy arrays.
///
/// ``value_list`` replaces the lists of the machine. ``start`` says where axes stand at first,
/// ``[("X", 0.0)]``, in mm or degrees. ``reading`` is that of ``--reading``. The trace ends after
/// ``max_cycles``, which a message says.
#[pyfunction]
#[pyo3(signature = (program, axes, *, machine=None, value_list=None, cycle_time_ms=None, reading=None, start=None, max_cycles=3_600_000, limits=None))]
// Each is an argument of its own for Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn current(
    program: &Bound<'_, PyAny>,
    axes: Several<String>,
    machine: Option<&Bound<'_, PyAny>>,
    value_list: Option<PathBuf>,
    cycle_time_ms: Option<f64>,
    reading: Option<&str>,
    start: Option<Several<(String, f64)>>,
    max_cycles: u64,
    limits: Option<&Bound<'_, PyLimits>>,
) -> PyResult<PyCurrents> {
    let py = program.py();
    // Without NumPy nothing is computed in vain.
    py.import("numpy").map_err(|error| {
        // Ctrl+C while it is loaded is no reason to install it.
        if !error.is_instance_of::<PyImportError>(py) {
            return error;
        }
        Failure::new("the currents are NumPy arrays, and NumPy is not installed")
            .with_help("`pip install frictcomp[numpy]`")
            .into_error(py)
    })?;
    let job = Job {
        programs: Programs::one(program)?,
        machine: machine_options(machine)?,
        axes: axes.0,
        value_list,
        cycle_s: cycle_time_ms.map(|ms| ms / 1000.0),
        reading: meant(reading)?,
        start: start.map_or_else(Vec::new, |Several(places)| places),
        max_cycles: max_cycles.max(1),
        run: limits::options(limits),
    };
    let computed = interruptible(py, move |stop| job.done(stop))?;
    PyCurrents::new(py, computed)
}

impl Job {
    fn done(self, stop: &Stop) -> Result<Computed, Failure> {
        self.programs.probe()?;
        let input = &self.programs.inputs[0];
        let loaded = machine_of(self.machine.clone(), &self.programs, Vec::new())?;
        let mut loaded = loaded.as_ref().clone();
        let list = match &self.value_list {
            Some(path) => Some(read_value_list(path, &FileRegistry::default())?.list),
            None => None,
        };
        let followed = axes_to_follow(&self.axes, &mut loaded.machine, list.as_ref())
            .map_err(Failure::of_axes)?;
        if followed.is_empty() {
            return Err(Failure::new("no axis was given").with_help("name one, `['X']`"));
        }
        let names = followed.iter().map(|axis| loaded.machine.axis(*axis));
        let names: Vec<String> = names.map(|axis| axis.name.clone()).collect();
        let cycles = Cycles {
            t: Vec::new(),
            line: Vec::new(),
            axes: names.iter().map(|_| AxisCycles::default()).collect(),
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
        let said = said(currents.diagnostics(), &loaded);
        Ok(Computed {
            names,
            saturated: currents.saturated().collect(),
            at_rest: currents.at_rest().collect(),
            left_out: currents.left_out(),
            said,
            cycles: currents.sink().take(),
        })
    }

    /// The cycle that was given, else that of the machine.
    fn options(&self, loaded: &LoadedMachine) -> Result<CurrentOptions, Failure> {
        let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
        let cycle = self.cycle_s.or(of_machine);
        let mut planner = PlannerOptions::default();
        let cycle_s = check_cycle(cycle.unwrap_or(planner.cycle_s));
        planner.cycle_s = cycle_s.map_err(|error| Failure::new(error.to_string()))?;
        planner.max_cycles = self.max_cycles;
        Ok(CurrentOptions::from(planner).with_reading(self.reading))
    }

    fn alone(&self, loaded: &LoadedMachine) -> Result<SingleRun, Failure> {
        for (name, position) in &self.start {
            if loaded.machine.find(name).is_none() || !position.is_finite() {
                return Err(
                    Failure::new(format!("axis `{name}` cannot start at {position}"))
                        .with_help("give axes of the machine with positions in mm or degrees"),
                );
            }
        }
        Ok(SingleRun {
            options: SessionOptions::from(self.run.with_motions(Motions::Taken))
                .with_levels(loaded.levels.clone())
                .with_settings(loaded.settings.clone())
                .with_start(self.start.clone()),
            naming: Naming::AsGiven,
            axes: Axes::AsTheyOccur,
        })
    }
}

/// Errors, and remarks with the severities of the user.
fn said((errors, remarks): (&[Diagnostic], &[Diagnostic]), loaded: &LoadedMachine) -> Said {
    let remarks = remarks.iter().filter_map(|said| {
        let severity = loaded.levels.severity(said.code)?;
        Some(PyMessage::of(&Diagnostic {
            severity,
            ..said.clone()
        }))
    });
    Said {
        messages: errors.iter().map(PyMessage::of).chain(remarks).collect(),
        ..Said::default()
    }
}

impl Cycles {
    fn take(&mut self) -> Self {
        Self {
            t: std::mem::take(&mut self.t),
            line: std::mem::take(&mut self.line),
            axes: std::mem::take(&mut self.axes),
            stop: self.stop.clone(),
        }
    }
}

impl AxisCycles {
    fn push(&mut self, sample: &CurrentSample) {
        let CurrentSample { commanded, added } = sample;
        self.x.push(commanded.position_units);
        self.v.push(commanded.velocity_units);
        self.w_before.push(added.w_before);
        self.w_after.push(added.w_after);
        self.current.push(added.current_units);
        self.output.push(added.output);
        self.states.push(states::number(commanded.friction));
    }
}

impl CurrentSink for Cycles {
    fn cycle(&mut self, cycle: &CurrentCycle<'_>) -> ControlFlow<()> {
        self.t.push(cycle.time_s);
        self.line.push(cycle.cause.line);
        for (axis, sample) in self.axes.iter_mut().zip(cycle.axes) {
            axis.push(sample);
        }
        self.stop.flow()
    }
}

impl PyCurrents {
    fn new(py: Python<'_>, computed: Computed) -> PyResult<Self> {
        let Computed { cycles, .. } = computed;
        let figures = computed.saturated.into_iter().zip(computed.at_rest);
        let axes = computed.names.into_iter().zip(cycles.axes).zip(figures);
        let axes = axes.map(|((axis, cycles), (saturated_cycles, cycles_at_rest))| {
            let unknown = states::number(State::Unknown);
            let is_unknown = cycles.states.iter().filter(|state| **state == unknown);
            Py::new(
                py,
                PyAxisCurrent {
                    axis,
                    unknown_cycles: is_unknown.count(),
                    x: array(py, cycles.x),
                    v: array(py, cycles.v),
                    w_before: array(py, cycles.w_before),
                    w_after: array(py, cycles.w_after),
                    current: array(py, cycles.current),
                    output: array(py, cycles.output),
                    states: array(py, cycles.states),
                    saturated_cycles,
                    cycles_at_rest,
                },
            )
        });
        Ok(Self {
            axes: axes.collect::<PyResult<_>>()?,
            t: array(py, cycles.t),
            line: array(py, cycles.line),
            messages: Py::new(py, PyMessages::new(computed.said))?,
            left_out: computed.left_out,
        })
    }
}

/// The values themselves, in an array that owns them.
fn array<T: numpy::Element>(py: Python<'_>, values: Vec<T>) -> Py<PyArray1<T>> {
    PyArray1::from_vec(py, values).unbind()
}

#[pymethods]
impl PyCurrents {
    /// The time of each cycle since the beginning of the program in s.
    #[getter]
    fn t(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.t.clone_ref(py)
    }

    /// The line of the block that is executed.
    #[getter]
    fn line(&self, py: Python<'_>) -> Py<PyArray1<u32>> {
        self.line.clone_ref(py)
    }

    #[getter]
    fn axes(&self) -> Vec<&str> {
        self.axes
            .iter()
            .map(|axis| axis.get().axis.as_str())
            .collect()
    }

    /// What stopped the program or the trace, and what the trace simplifies.
    #[getter]
    fn messages(&self, py: Python<'_>) -> Py<PyMessages> {
        self.messages.clone_ref(py)
    }

    /// How many motions are not in the trace, because their start or end is not known.
    #[getter]
    fn left_out(&self) -> u64 {
        self.left_out
    }

    fn __getitem__(&self, py: Python<'_>, axis: &str) -> PyResult<Py<PyAxisCurrent>> {
        let found = self.axes.iter().find(|it| it.get().axis == axis);
        let found = found.ok_or_else(|| PyKeyError::new_err(axis.to_owned()))?;
        Ok(found.clone_ref(py))
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        self.t.bind(py).len().unwrap_or_default()
    }

    fn __bool__(&self) -> bool {
        true
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let axes = self.axes().join(", ");
        format!(
            "<frictcomp.Currents: {} cycles of {axes}>",
            self.__len__(py)
        )
    }
}

#[pymethods]
impl PyAxisCurrent {
    #[getter]
    fn axis(&self) -> &str {
        &self.axis
    }

    /// The commanded position in 0.1 µm or 0.0001°.
    #[getter]
    fn x(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.x.clone_ref(py)
    }

    /// The commanded velocity in µm/s or 0.001°/s.
    #[getter]
    fn v(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.v.clone_ref(py)
    }

    /// The weight of the decay before a reversal, 0 to 1.
    #[getter]
    fn w_before(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.w_before.clone_ref(py)
    }

    /// The weight of the build-up after a reversal, 0 to 1.
    #[getter]
    fn w_after(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.w_after.clone_ref(py)
    }

    /// The additive current in drive units. ``Error`` where it is not known in every cycle.
    #[getter]
    fn current(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        self.known(py)?;
        Ok(self.current.clone_ref(py))
    }

    /// The integer that the drive gets. ``Error`` where it is not known in every cycle.
    #[getter]
    fn output(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i16>>> {
        self.known(py)?;
        Ok(self.output.clone_ref(py))
    }

    /// The state of friction compensation in each cycle.
    #[getter]
    fn comp<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let words = states::STATES.map(State::as_str).to_vec();
        let words = py.import("numpy")?.call_method1("array", (words,))?;
        words.call_method1("take", (self.states.bind(py),))
    }

    /// The current, and the given value in the cycles in which it is not known.
    fn filled<'py>(&self, py: Python<'py>, unknown: f64) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (current, states) = (self.current.bind(py), self.states.bind(py));
        let (current, states) = (current.try_readonly()?, states.try_readonly()?);
        let number = states::number(State::Unknown);
        let cycles = current.as_slice()?.iter().zip(states.as_slice()?);
        let filled =
            cycles.map(|(current, state)| if *state == number { unknown } else { *current });
        Ok(PyArray1::from_vec(py, filled.collect()))
    }

    /// In how many cycles the current is not known.
    #[getter]
    fn unknown_cycles(&self) -> usize {
        self.unknown_cycles
    }

    /// In how many cycles the output was cut to 16 bit.
    #[getter]
    fn saturated_cycles(&self) -> u64 {
        self.saturated_cycles
    }

    /// In how many cycles at standstill it matters what the control adds there.
    #[getter]
    fn cycles_at_rest(&self) -> u64 {
        self.cycles_at_rest
    }

    fn __repr__(&self) -> String {
        format!("<frictcomp.AxisCurrent of {}>", self.axis)
    }
}

impl PyAxisCurrent {
    /// Refuses to give currents of which some are not known.
    fn known(&self, py: Python<'_>) -> PyResult<()> {
        if self.unknown_cycles == 0 {
            return Ok(());
        }
        let (axis, cycles) = (&self.axis, self.unknown_cycles);
        let counted = if cycles == 1 {
            "1 cycle"
        } else {
            &format!("{cycles} cycles")
        };
        Err(Failure::new(format!(
            "the current of axis `{axis}` is not known in {counted}: its compensation is `unknown`"
        ))
        .with_help("`comp` says in which; `filled(value)` gives the others, and `value` there")
        .into_error(py))
    }
}
