//! The cycles of one axis.

use frictcomp::comp::State;
use frictcomp::lists::AxisType;
use frictcomp_physics::current::{Added, Commanded};
use frictcomp_report::pictures::AxisPlot;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

use super::picture::{DrawnColumns, Marks, drawn};
use crate::failure::Failure;
use crate::notebook;
use crate::pickled::{self, Reduced};
use crate::states;

/// The additive current of one axis in each cycle, with the columns of ``frictcomp current``.
#[pyclass(frozen, name = "AxisCurrent", module = "frictcomp")]
pub(crate) struct PyAxisCurrent {
    pub(super) axis: NamedAxis,
    t: Py<PyArray1<f64>>,
    x: Py<PyArray1<f64>>,
    v: Py<PyArray1<f64>>,
    w_before: Py<PyArray1<f64>>,
    w_after: Py<PyArray1<f64>>,
    current: Py<PyArray1<f64>>,
    output: Py<PyArray1<i16>>,
    states: Py<PyArray1<i8>>,
    unknown_cycles: usize,
    counted: Counted,
    remarks: Vec<String>,
}

/// An axis, and its type if a machine gives it.
#[derive(Debug, Clone)]
pub(crate) struct NamedAxis {
    pub(super) name: String,
    pub(super) axis_type: Option<AxisType>,
}

impl NamedAxis {
    pub(super) fn new(name: &str, axis_type: Option<AxisType>) -> Self {
        Self {
            name: name.to_owned(),
            axis_type,
        }
    }
}

/// Cycles with a remark on the current.
#[derive(Debug, Clone, Copy)]
pub(super) struct Counted {
    pub(super) saturated: u64,
    pub(super) at_rest: u64,
}

type Floats<'py> = Bound<'py, PyArray1<f64>>;

/// The arrays of an axis as they are pickled.
type Arrays<'py> = (
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Floats<'py>,
    Bound<'py, PyArray1<i16>>,
    Bound<'py, PyArray1<i8>>,
);

/// The axis with its type, its arrays, the cycles that were cut and those at rest, the remarks.
type PickledAxis<'py> = (String, String, Arrays<'py>, (u64, u64), Vec<String>);

/// The cycles of one axis.
#[derive(Default)]
pub(super) struct AxisCycles {
    x: Vec<f64>,
    v: Vec<f64>,
    w_before: Vec<f64>,
    w_after: Vec<f64>,
    current: Vec<f64>,
    output: Vec<i16>,
    states: Vec<i8>,
}

impl AxisCycles {
    pub(super) fn push(&mut self, commanded: &Commanded, added: &Added) {
        self.x.push(commanded.position_units);
        self.v.push(commanded.velocity_units);
        self.w_before.push(added.w_before);
        self.w_after.push(added.w_after);
        self.current.push(added.current_units);
        self.output.push(added.output);
        self.states.push(states::number(commanded.friction));
    }
}

/// The values themselves, in an array that owns them.
pub(super) fn array<T: numpy::Element>(py: Python<'_>, values: Vec<T>) -> Py<PyArray1<T>> {
    PyArray1::from_vec(py, values).unbind()
}

impl PyAxisCurrent {
    /// The cycles of an axis at their times.
    pub(super) fn new(
        (axis, counted): (NamedAxis, Counted),
        cycles: AxisCycles,
        t: &Bound<'_, PyArray1<f64>>,
        remarks: Vec<String>,
    ) -> Self {
        let py = t.py();
        let unknown = states::number(State::Unknown);
        let is_unknown = cycles.states.iter().filter(|state| **state == unknown);
        Self {
            axis,
            t: t.clone().unbind(),
            unknown_cycles: is_unknown.count(),
            x: array(py, cycles.x),
            v: array(py, cycles.v),
            w_before: array(py, cycles.w_before),
            w_after: array(py, cycles.w_after),
            current: array(py, cycles.current),
            output: array(py, cycles.output),
            states: array(py, cycles.states),
            counted,
            remarks,
        }
    }
}

#[pymethods]
impl PyAxisCurrent {
    #[staticmethod]
    fn _unpickled(
        name: String,
        axis_type: &str,
        arrays: Arrays<'_>,
        counted: (u64, u64),
        remarks: Vec<String>,
    ) -> PyResult<Self> {
        let (saturated, at_rest) = counted;
        let (t, x, v, w_before, w_after, current, output, states) = arrays;
        let unknown = states::number(State::Unknown);
        let numbers = states.try_readonly()?;
        let is_unknown = numbers.as_slice()?.iter().filter(|it| **it == unknown);
        Ok(Self {
            axis: NamedAxis {
                name,
                axis_type: pickled::read(axis_type)?,
            },
            unknown_cycles: is_unknown.count(),
            t: t.unbind(),
            x: x.unbind(),
            v: v.unbind(),
            w_before: w_before.unbind(),
            w_after: w_after.unbind(),
            current: current.unbind(),
            output: output.unbind(),
            states: states.clone().unbind(),
            counted: Counted { saturated, at_rest },
            remarks,
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<PickledAxis<'py>>> {
        let (this, py) = (slf.get(), slf.py());
        let floats = |array: &Py<PyArray1<f64>>| array.bind(py).clone();
        let arrays = (
            floats(&this.t),
            floats(&this.x),
            floats(&this.v),
            floats(&this.w_before),
            floats(&this.w_after),
            floats(&this.current),
            this.output.bind(py).clone(),
            this.states.bind(py).clone(),
        );
        let NamedAxis { name, axis_type } = this.axis.clone();
        let counted = (this.counted.saturated, this.counted.at_rest);
        let axis_type = pickled::written(&axis_type)?;
        let arguments = (name, axis_type, arrays, counted, this.remarks.clone());
        pickled::reduced(slf, arguments)
    }

    /// The name of the axis; empty for a recording.
    #[getter]
    fn axis(&self) -> &str {
        &self.axis.name
    }

    /// The time of each cycle in s.
    #[getter]
    fn t(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.t.clone_ref(py)
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

    /// The additive current in drive units. ``Error`` if it is not known in every cycle.
    #[getter]
    fn current(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        self.known(py)?;
        Ok(self.current.clone_ref(py))
    }

    /// The integer that the drive gets. ``Error`` if it is not known in every cycle.
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

    /// The number of cycles in which the current is not known.
    #[getter]
    fn unknown_cycles(&self) -> usize {
        self.unknown_cycles
    }

    /// The number of cycles in which the output was limited to 16 bits.
    #[getter]
    fn saturated_cycles(&self) -> u64 {
        self.counted.saturated
    }

    /// The number of cycles at standstill in which it matters what the control adds.
    #[getter]
    fn cycles_at_rest(&self) -> u64 {
        self.counted.at_rest
    }

    /// The steps that converted the rows of a recording to cycles, a sentence each.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }

    /// The picture of current, velocity, weights and states over time.
    fn svg(slf: &Bound<'_, Self>) -> PyResult<String> {
        drawn(vec![slf.get().plot(slf.py())?], &Marks::default())
    }

    /// Its picture, for notebooks.
    fn _repr_html_(slf: &Bound<'_, Self>) -> PyResult<String> {
        let words = match slf.get().axis.name.as_str() {
            "" => "Current of a recording".to_owned(),
            name => format!("Current of {name}"),
        };
        notebook::pictured(slf.py(), &words, &[Self::svg(slf)?])
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        self.t.bind(py).len().unwrap_or_default()
    }

    fn __bool__(&self) -> bool {
        true
    }

    fn __repr__(&self) -> String {
        match self.axis.name.as_str() {
            "" => "<frictcomp.AxisCurrent of a recording>".to_owned(),
            name => format!("<frictcomp.AxisCurrent of {name}>"),
        }
    }
}

impl PyAxisCurrent {
    /// Its plot, and the columns that are drawn there.
    pub(super) fn plot<'py>(&self, py: Python<'py>) -> PyResult<(AxisPlot, DrawnColumns<'py>)> {
        let read = |array: &Py<PyArray1<f64>>| array.bind(py).try_readonly();
        let columns = DrawnColumns {
            t: read(&self.t)?,
            floats: [
                read(&self.v)?,
                read(&self.w_before)?,
                read(&self.w_after)?,
                read(&self.current)?,
            ],
            states: self.states.bind(py).try_readonly()?,
        };
        Ok((AxisPlot::new(&self.axis.name, self.axis.axis_type), columns))
    }

    /// Refuses to return currents of which some are not known.
    fn known(&self, py: Python<'_>) -> PyResult<()> {
        if self.unknown_cycles == 0 {
            return Ok(());
        }
        let (axis, cycles) = (&self.axis.name, self.unknown_cycles);
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
