//! The timeline of a run: its blocks as a table, its programs, its messages.

mod recorder;
mod rows;

use std::collections::BTreeMap;

use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use crate::failure::raised_for;
use crate::json::Json;
use crate::messages::PyMessages;
use crate::state::PyState;

pub(crate) use recorder::{Recorded, Recorder};
pub(crate) use rows::Shown;

/// How a program of a run went.
#[pyclass(frozen, get_all, name = "ProgramRun", module = "frictcomp")]
#[derive(Debug, Clone)]
pub(crate) struct PyProgramRun {
    program: u32,
    file: String,
    name: Option<String>,
    /// Why it ended; `None` where the run was over before.
    by: Option<&'static str>,
    blocks: u64,
    start: BTreeMap<String, &'static str>,
    end: BTreeMap<String, &'static str>,
    /// The states that are possible after its end, by axis.
    possible: Json,
}

#[pymethods]
impl PyProgramRun {
    fn __repr__(&self) -> String {
        let by = self.by.unwrap_or("nothing");
        format!("<frictcomp.ProgramRun '{}' ended by {by}>", self.file)
    }
}

/// The timeline of a run.
#[pyclass(frozen, name = "Timeline", module = "frictcomp")]
pub(crate) struct PyTimeline {
    recorded: Recorded,
    messages: Py<PyMessages>,
}

impl PyTimeline {
    /// What was recorded.
    pub(crate) fn new(py: Python<'_>, mut recorded: Recorded) -> PyResult<Self> {
        let messages = std::mem::take(&mut recorded.said);
        Ok(Self {
            messages: Py::new(py, PyMessages::new(messages))?,
            recorded,
        })
    }
}

#[pymethods]
impl PyTimeline {
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.recorded.table.columns()
    }

    #[getter]
    fn axes(&self) -> Vec<String> {
        self.recorded.axes.clone()
    }

    #[getter]
    fn messages(&self, py: Python<'_>) -> Py<PyMessages> {
        self.messages.clone_ref(py)
    }

    #[getter]
    fn programs(&self) -> Vec<PyProgramRun> {
        self.recorded.programs.clone()
    }

    #[getter]
    fn friction(&self) -> BTreeMap<String, &'static str> {
        self.recorded.friction.clone()
    }

    #[getter]
    fn possible(&self) -> Json {
        self.recorded.possible.clone()
    }

    #[getter]
    fn state(&self) -> PyState {
        self.recorded.state.clone()
    }

    #[getter]
    fn opaque(&self) -> BTreeMap<String, u64> {
        self.recorded.opaque.clone()
    }

    #[getter]
    fn is_assumed(&self) -> bool {
        self.recorded.is_assumed
    }

    #[getter]
    fn unrun(&self) -> usize {
        self.recorded.unrun
    }

    fn raise_for_errors(&self, py: Python<'_>) -> PyResult<()> {
        raised_for(py, self.messages.get())
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The interface lets the producer ignore it.
        let _ = requested_schema;
        self.recorded.table.stream(py)
    }

    fn __len__(&self) -> usize {
        self.recorded.table.rows()
    }

    fn __bool__(&self) -> bool {
        true
    }

    fn __repr__(&self) -> String {
        let blocks = self.recorded.table.rows();
        let counted = self.messages.get().counted();
        format!("<frictcomp.Timeline: {blocks} blocks, {counted}>")
    }
}
