//! The cycles of a program.

use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyList};

use super::ProgramsCurrents;
use super::axis::{Counted, PyAxisCurrent, array};
use super::picture::{Marks, drawn};
use crate::messages::PyMessages;
use crate::notebook;
use crate::pickled::{self, Reduced};

/// The additive currents of axes over the path of a program, cycle by cycle.
#[pyclass(frozen, name = "Currents", module = "frictcomp")]
pub(crate) struct PyCurrents {
    t: Py<PyArray1<f64>>,
    line: Py<PyArray1<u32>>,
    axes: Vec<Py<PyAxisCurrent>>,
    messages: Py<PyMessages>,
    left_out: u64,
    marks: Marks,
}

/// Times, lines, axes, messages, motions that were left out, marks.
type PickledCurrents = (
    Py<PyArray1<f64>>,
    Py<PyArray1<u32>>,
    Vec<Py<PyAxisCurrent>>,
    Py<PyMessages>,
    (u64, String),
);

impl PyCurrents {
    pub(super) fn new(py: Python<'_>, computed: ProgramsCurrents) -> PyResult<Self> {
        let ProgramsCurrents { cycles, .. } = computed;
        let t = array(py, cycles.t);
        let figures = computed.saturated.into_iter().zip(computed.at_rest);
        let figures = figures.map(|(saturated, at_rest)| Counted { saturated, at_rest });
        let axes = computed.axes.into_iter().zip(figures).zip(cycles.axes);
        let axes = axes.map(|(axis, cycles)| {
            Py::new(py, PyAxisCurrent::new(axis, cycles, t.bind(py), vec![]))
        });
        Ok(Self {
            axes: axes.collect::<PyResult<_>>()?,
            line: array(py, cycles.line),
            messages: Py::new(py, PyMessages::new(computed.said))?,
            left_out: computed.left_out,
            marks: cycles.marks,
            t,
        })
    }
}

#[pymethods]
impl PyCurrents {
    #[staticmethod]
    fn _unpickled(
        t: Py<PyArray1<f64>>,
        line: Py<PyArray1<u32>>,
        axes: Vec<Py<PyAxisCurrent>>,
        messages: Py<PyMessages>,
        cut: (u64, String),
    ) -> PyResult<Self> {
        let (left_out, marks) = cut;
        Ok(Self {
            t,
            line,
            axes,
            messages,
            left_out,
            marks: pickled::read(&marks)?,
        })
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<PickledCurrents>> {
        let (this, py) = (slf.get(), slf.py());
        let axes = this.axes.iter().map(|axis| axis.clone_ref(py));
        let arguments = (
            this.t.clone_ref(py),
            this.line.clone_ref(py),
            axes.collect(),
            this.messages.clone_ref(py),
            (this.left_out, pickled::written(&this.marks)?),
        );
        pickled::reduced(slf, arguments)
    }

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
            .map(|axis| axis.get().axis.name.as_str())
            .collect()
    }

    /// Causes that stopped the program or the trace, and simplifications of the trace.
    #[getter]
    fn messages(&self, py: Python<'_>) -> Py<PyMessages> {
        self.messages.clone_ref(py)
    }

    /// The number of motions that are not in the trace, because their start or end is not known.
    #[getter]
    fn left_out(&self) -> u64 {
        self.left_out
    }

    fn __getitem__(&self, py: Python<'_>, axis: &str) -> PyResult<Py<PyAxisCurrent>> {
        let found = self.axes.iter().find(|it| it.get().axis.name == axis);
        let found = found.ok_or_else(|| PyKeyError::new_err(axis.to_owned()))?;
        Ok(found.clone_ref(py))
    }

    fn __contains__(&self, axis: &str) -> bool {
        self.axes().contains(&axis)
    }

    /// Iterates over the names of the axes.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.axes())?.try_iter()
    }

    /// The picture of currents, velocities, weights and states over time, as ``frictcomp current --svg``
    /// draws it.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let axes = self.axes.iter().map(|axis| axis.get().plot(py));
        drawn(axes.collect::<PyResult<_>>()?, &self.marks)
    }

    /// Its picture, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let words = format!("Current of {}", self.axes().join(", "));
        notebook::pictured(py, &words, &[self.svg(py)?])
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
