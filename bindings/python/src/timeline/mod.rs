//! The timeline of a run: its blocks as a table, its programs, its messages.

mod recorder;
mod rows;

use std::collections::BTreeMap;

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule};
use serde::{Deserialize, Serialize};

use crate::arrow::Table;
use crate::failure::{raised_for, refused};
use crate::json::Json;
use crate::messages::{PyMessages, Said, Word};
use crate::pickled::{self, Reduced};
use crate::state::PyState;

pub(crate) use recorder::{Recorded, Recorder};
pub(crate) use rows::Shown;

/// How a program of a run went.
#[pyclass(frozen, get_all, name = "ProgramRun", module = "frictcomp")]
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PyProgramRun {
    /// Its number in the session, from 1.
    program: u32,
    file: String,
    /// The name after ``%``.
    name: Option<String>,
    /// Why it ended: ``M30`` or ``M2``, ``text`` without either, ``error``, ``budget``.
    ///
    /// None where an interrupt or the end of the session came first.
    by: Option<Word>,
    /// How many blocks were executed.
    blocks: u64,
    /// Friction compensation before its first block, by axis.
    start: BTreeMap<String, Word>,
    /// Friction compensation after its end, by axis.
    end: BTreeMap<String, Word>,
    /// The states that are possible after its end, by axis, where they differ between ways.
    ///
    /// Such an axis is ``unknown`` in ``end``. Each state has its ``ways``, lists of conditions that
    /// hold together, at most four, and ``more``, how many ways are not named. The state on all other
    /// ways has None for ``ways``.
    possible: Json,
}

#[pymethods]
impl PyProgramRun {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(slf.get())?,))
    }

    fn __repr__(&self) -> String {
        let by = self.by.as_deref().unwrap_or("nothing");
        format!("<frictcomp.ProgramRun '{}' ended by {by}>", self.file)
    }
}

/// What a timeline is made of anew: what was recorded, the blocks, the messages.
type Pickled<'py> = (String, Bound<'py, PyBytes>, Py<PyMessages>);

/// The timeline of a run: one row for each executed block.
///
/// pandas, polars and DuckDB take it without a copy: ``polars.DataFrame(timeline)``,
/// ``pandas.DataFrame.from_arrow(timeline)``, ``duckdb.sql("select * from timeline")``. The columns
/// are those of ``frictcomp run --format csv``, with ``level`` as in NDJSON. ``branch`` says on which
/// ways a block is executed, None where on all of them; the rows of CSV that are no block, where ways
/// meet, are left out.
#[pyclass(frozen, name = "Timeline", module = "frictcomp")]
pub(crate) struct PyTimeline {
    recorded: Recorded,
    table: Table,
    messages: Py<PyMessages>,
}

impl PyTimeline {
    /// What was recorded.
    pub(crate) fn new(
        py: Python<'_>,
        (recorded, table, said): (Recorded, Table, Said),
    ) -> PyResult<Self> {
        Ok(Self {
            messages: Py::new(py, PyMessages::new(said))?,
            recorded,
            table,
        })
    }
}

#[pymethods]
impl PyTimeline {
    #[staticmethod]
    fn _unpickled(text: &str, blocks: &[u8], messages: Py<PyMessages>) -> PyResult<Self> {
        let table = Table::from_bytes(blocks).map_err(|error| refused(error.to_string()))?;
        Ok(Self {
            recorded: pickled::read(text)?,
            table,
            messages,
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<Pickled<'py>>> {
        let this = slf.get();
        let blocks = this.table.to_bytes();
        let blocks = blocks.map_err(|error| refused(error.to_string()))?;
        let arguments = (
            pickled::written(&this.recorded)?,
            PyBytes::new(slf.py(), &blocks),
            this.messages.clone_ref(slf.py()),
        );
        pickled::reduced(slf, arguments)
    }

    #[getter]
    fn columns(&self) -> Vec<String> {
        self.table.columns()
    }

    /// The axes that have a column.
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

    /// Friction compensation of each axis at the end.
    #[getter]
    fn friction(&self) -> BTreeMap<String, Word> {
        self.recorded.friction.clone()
    }

    /// The states that are possible at the end, as in ``ProgramRun``.
    #[getter]
    fn possible(&self) -> Json {
        self.recorded.possible.clone()
    }

    /// What the next run starts with.
    #[getter]
    fn state(&self) -> PyState {
        self.recorded.state.clone()
    }

    /// What was accepted and passed over, and how often.
    #[getter]
    fn opaque(&self) -> BTreeMap<String, u64> {
        self.recorded.opaque.clone()
    }

    /// Whether the states rest on an assumption about what only the machine knows (FC902).
    #[getter]
    fn is_assumed(&self) -> bool {
        self.recorded.is_assumed
    }

    /// How many programs did not run because an earlier one stopped the session.
    #[getter]
    fn unrun(&self) -> usize {
        self.recorded.unrun
    }

    /// Raises ``Error`` where there is a message of severity error.
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
        self.table.stream(py)
    }

    fn __len__(&self) -> usize {
        self.table.rows()
    }

    fn __bool__(&self) -> bool {
        true
    }

    fn __repr__(&self) -> String {
        let blocks = self.table.rows();
        let counted = self.messages.get().counted();
        format!("<frictcomp.Timeline: {blocks} blocks, {counted}>")
    }
}
