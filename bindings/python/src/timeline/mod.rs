//! The timeline of a run: its blocks as a table, its programs, its messages.

mod bars;
mod recorder;
mod rows;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use frictcomp_report::svg::Frame;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule};
use serde::{Deserialize, Serialize};

use crate::arrow::ArrowTable;
use crate::exceptions::refused;
use crate::json::JsonText;
use crate::messages::{GivenMessages, PickledWord, PyMessages};
use crate::notebook;
use crate::pickled::{self, Reduced};
use crate::state::PyState;

use bars::Bars;

pub(crate) use recorder::{RecordedSession, Recorder};
pub(crate) use rows::ShownColumns;

/// The number of programs that a notebook shows at once.
const SHOWN: usize = 20;

/// Course of a program of a run.
#[pyclass(frozen, get_all, name = "ProgramRun", module = "frictcomp")]
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PyProgramRun {
    /// Its number in the session, from 1.
    program: u32,
    file: String,
    /// The name after ``%``.
    name: Option<String>,
    /// Cause of the end: ``M30``, ``M02``, ``end-of-file`` without either, ``error``, ``budget``.
    ///
    /// None if an interrupt or the end of the session came first.
    by: Option<PickledWord>,
    /// Number of executed blocks.
    blocks: u64,
    /// Friction compensation before its first block, by axis.
    start: BTreeMap<String, PickledWord>,
    /// Friction compensation after its end, by axis.
    end: BTreeMap<String, PickledWord>,
    /// The possible states after its end, by axis, where they differ between ways.
    ///
    /// Such an axis is ``unknown`` in ``end``. Each state has its ``ways``, lists of conditions that
    /// apply together, at most four, and ``more``, how many ways are not named. The state on all other
    /// ways has None for ``ways``.
    possible: JsonText,
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

/// The data that a timeline is restored from: the record, the blocks, the messages.
type PickledTimeline<'py> = (String, Bound<'py, PyBytes>, Py<PyMessages>);

/// The timeline of a run: one row for each executed block.
///
/// pandas, polars and DuckDB take it without a copy: ``polars.DataFrame(timeline)``,
/// ``pandas.DataFrame.from_arrow(timeline)``, ``duckdb.sql("select * from timeline")``. The columns
/// are those of ``frictcomp run --format csv``, with ``level`` as in NDJSON. ``branch`` gives the
/// ways on which a block is executed, None for all of them; the CSV rows that are not a block, where ways
/// meet, are left out.
#[pyclass(frozen, name = "Timeline", module = "frictcomp")]
pub(crate) struct PyTimeline {
    recorded: RecordedSession,
    table: ArrowTable,
    messages: Py<PyMessages>,
}

impl PyTimeline {
    /// Creates the timeline of a recorded session.
    pub(crate) fn new(
        py: Python<'_>,
        (recorded, table, said): (RecordedSession, ArrowTable, GivenMessages),
    ) -> PyResult<Self> {
        Ok(Self {
            messages: Py::new(py, PyMessages::new(said))?,
            recorded,
            table,
        })
    }
}

impl PyTimeline {
    /// "5 blocks, 0 errors, 2 warnings"
    fn counted(&self) -> String {
        let (blocks, said) = (self.table.rows(), self.messages.get().counted());
        format!("{blocks} blocks, {said}")
    }

    fn drawn(&self, run: &PyProgramRun) -> String {
        let friction = Bars {
            run,
            axes: &self.recorded.axes,
            start_up: &self.recorded.start_up,
        };
        friction.chart(&self.table).render(Frame::Alone)
    }
}

#[pymethods]
impl PyTimeline {
    #[staticmethod]
    fn _unpickled(text: &str, blocks: &[u8], messages: Py<PyMessages>) -> PyResult<Self> {
        Ok(Self {
            recorded: pickled::read(text)?,
            table: ArrowTable::unpickled(blocks)?,
            messages,
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<PickledTimeline<'py>>> {
        let this = slf.get();
        let arguments = (
            pickled::written(&this.recorded)?,
            this.table.pickled(slf.py())?,
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
    fn friction(&self) -> BTreeMap<String, PickledWord> {
        self.recorded.friction.clone()
    }

    /// The possible states at the end, as in ``ProgramRun``.
    #[getter]
    fn possible(&self) -> JsonText {
        self.recorded.possible.clone()
    }

    /// The state with which the next run starts.
    #[getter]
    fn state(&self) -> PyState {
        self.recorded.state.clone()
    }

    /// Elements that were accepted and passed over, with their counts.
    #[getter]
    fn opaque(&self) -> BTreeMap<String, u64> {
        self.recorded.opaque.clone()
    }

    /// Whether the states rest on an assumption (FC210, FC325, FC902).
    #[getter]
    fn is_assumed(&self) -> bool {
        self.recorded.is_assumed
    }

    /// Number of programs that did not run because an earlier one stopped the session.
    #[getter]
    fn unrun(&self) -> usize {
        self.recorded.unrun
    }

    /// Raises ``Error`` if there is a message of severity error.
    fn raise_for_errors(&self, py: Python<'_>) -> PyResult<()> {
        self.messages.get().raise_for_errors(py)
    }

    /// The picture of the states of friction compensation over the executed blocks of a program.
    ///
    /// ``program`` is its number in the session, from 1.
    #[pyo3(signature = (program=1))]
    fn svg(&self, program: i64) -> PyResult<String> {
        let found = self.recorded.programs.iter();
        let found = found.clone().find(|run| i64::from(run.program) == program);
        let run = found.ok_or_else(|| {
            let count = self.recorded.programs.len();
            refused(format!("there is no program {program}: {count} were run"))
        })?;
        Ok(self.drawn(run))
    }

    /// The state bars of its first programs, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let programs = &self.recorded.programs;
        let shown = programs.iter().take(SHOWN);
        let pictures: Vec<String> = shown.map(|run| self.drawn(run)).collect();
        let mut html = notebook::pictured(py, &self.counted(), &pictures)?;
        if let more @ 1.. = programs.len().saturating_sub(SHOWN) {
            let words = "more programs: <code>svg(program)</code> draws one";
            let _ = write!(html, "<p>{more} {words}</p>");
        }
        Ok(html)
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
        format!("<frictcomp.Timeline: {}>", self.counted())
    }
}
