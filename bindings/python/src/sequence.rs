//! `frictcomp.audit_sequence`: the effect of programs in a given order.

use std::sync::Arc;

use arrow_array::{ArrayRef, StringArray, UInt32Array};
use frictcomp::audit::{Step, StepAxis};
use frictcomp_host::AuditOptions;
use frictcomp_report::Detail;
use frictcomp_report::results::audit::{SequenceReport, sequence_records, sequence_text};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule};
use serde_json::Value;

use crate::arrow::{ArrowColumn, ArrowTable};
use crate::audit::{AuditJob, said};
use crate::failure::Failure;
use crate::json::parsed;
use crate::kinds::Kinds;
use crate::limits::{self, PyLimits};
use crate::machine::machine_options;
use crate::messages::{GivenMessages, PyMessages};
use crate::notebook;
use crate::pickled::{self, Reduced};
use crate::program::GivenPrograms;
use crate::work::{Stop, interruptible};

/// The effect of programs in an order: one row for each program, axis and kind.
///
/// ``str(sequence)`` has the lines of ``frictcomp audit --sequence``, one for each program.
#[pyclass(frozen, name = "AuditSequence", module = "frictcomp")]
pub(crate) struct PyAuditSequence {
    table: ArrowTable,
    records: String,
    text: String,
    messages: Py<PyMessages>,
    has_warnings: bool,
}

/// Runs programs in the given order, from a start of the control, and reports their effect.
///
/// The result shows what each of them changes, and where an axis first moves outside its start-up state,
/// with the program that left it so.
#[pyfunction]
#[pyo3(signature = (programs, *, machine=None, kinds=None, limits=None))]
pub(crate) fn audit_sequence(
    programs: &Bound<'_, PyAny>,
    machine: Option<&Bound<'_, PyAny>>,
    kinds: Option<Kinds>,
    limits: Option<&Bound<'_, PyLimits>>,
) -> PyResult<PyAuditSequence> {
    let py = programs.py();
    let job = AuditJob {
        programs: GivenPrograms::in_order(programs)?,
        machine: machine_options(machine)?,
        options: AuditOptions::new(limits::brief(limits)).with_kinds(Kinds::of(kinds)?),
    };
    let (report, said) = interruptible(py, move |stop| followed(job, stop))?;
    Ok(PyAuditSequence {
        table: table(&report.steps),
        records: Value::from(sequence_records(&report)).to_string(),
        text: sequence_text(&report, Detail::Full),
        messages: Py::new(py, PyMessages::new(said))?,
        has_warnings: report.has_warnings(),
    })
}

fn followed(job: AuditJob, stop: &Stop) -> Result<(SequenceReport, GivenMessages), Failure> {
    job.programs.probe()?;
    // A program may come several times.
    let (auditor, mut errors) = job.auditor(|programs, _| (programs.inputs, Vec::new()), stop);
    let (steps, unread) = auditor.follow();
    errors.extend(unread);
    if let Some(failure) = Failure::of_several(errors) {
        return Err(failure);
    }
    let described = auditor.described().map(|(_, machine)| machine);
    Ok((SequenceReport::new(steps, described), said(&auditor)))
}

impl PyAuditSequence {
    /// The verdict, which is the last line of the text.
    fn verdict(&self) -> &str {
        self.text.lines().last().unwrap_or_default()
    }
}

/// A program at its position, and an axis.
struct PositionRow<'a> {
    position: u32,
    step: &'a Step,
    axis: &'a StepAxis,
}

fn table(steps: &[Step]) -> ArrowTable {
    let rows = (1..).zip(steps).flat_map(|(position, step)| {
        let axes = step.axes.iter();
        axes.map(move |axis| PositionRow {
            position,
            step,
            axis,
        })
    });
    let rows: Vec<PositionRow<'_>> = rows.collect();
    let text = |of: fn(&PositionRow<'_>) -> Option<String>| -> ArrayRef {
        Arc::new(rows.iter().map(of).collect::<StringArray>())
    };
    let number = |of: fn(&PositionRow<'_>) -> Option<u32>| -> ArrayRef {
        Arc::new(rows.iter().map(of).collect::<UInt32Array>())
    };
    let columns: Vec<ArrowColumn> = vec![
        ("position", number(|it| Some(it.position))),
        ("file", text(|it| Some(it.step.file.clone()))),
        ("axis", text(|it| Some(it.axis.axis.clone()))),
        ("kind", text(|it| Some(it.axis.kind.to_string()))),
        ("start", text(|it| Some(it.axis.start.as_str().to_owned()))),
        ("end", text(|it| Some(it.axis.end.as_str().to_owned()))),
        (
            "by_file",
            text(|it| Some(it.axis.by.as_ref()?.file.to_string())),
        ),
        ("by_line", number(|it| Some(it.axis.by.as_ref()?.line))),
        (
            "away_file",
            text(|it| Some(it.axis.away.as_ref()?.site.file.to_string())),
        ),
        (
            "away_line",
            number(|it| Some(it.axis.away.as_ref()?.site.line)),
        ),
        (
            "motion",
            text(|it| Some(it.axis.away.as_ref()?.motion.as_str().to_owned())),
        ),
        ("left_by", text(|it| it.axis.left_by.clone())),
        (
            "stopped",
            text(|it| Some(it.step.stopped.as_ref()?.message.clone())),
        ),
    ];
    let nullable = [
        "by_file",
        "by_line",
        "away_file",
        "away_line",
        "motion",
        "left_by",
        "stopped",
    ];
    ArrowTable::of(columns, &nullable)
}

/// The data that a sequence is restored from: the table, the records, the lines, the messages, the warnings.
type PickledSequence<'py> = (Bound<'py, PyBytes>, String, String, Py<PyMessages>, bool);

#[pymethods]
impl PyAuditSequence {
    #[staticmethod]
    fn _unpickled(
        table: &[u8],
        records: String,
        text: String,
        messages: Py<PyMessages>,
        has_warnings: bool,
    ) -> PyResult<Self> {
        Ok(Self {
            table: ArrowTable::unpickled(table)?,
            records,
            text,
            messages,
            has_warnings,
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<PickledSequence<'py>>> {
        let (this, py) = (slf.get(), slf.py());
        let arguments = (
            this.table.pickled(py)?,
            this.records.clone(),
            this.text.clone(),
            this.messages.clone_ref(py),
            this.has_warnings,
        );
        pickled::reduced(slf, arguments)
    }

    /// The records of ``frictcomp audit --sequence --format ndjson``.
    #[getter]
    fn records<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        parsed(py, &self.records)
    }

    #[getter]
    fn columns(&self) -> Vec<String> {
        self.table.columns()
    }

    /// The errors that keep the control from accepting its lists.
    #[getter]
    fn messages(&self, py: Python<'_>) -> Py<PyMessages> {
        self.messages.clone_ref(py)
    }

    /// Whether a program moves an axis in a state that another one left.
    #[getter]
    fn has_warnings(&self) -> bool {
        self.has_warnings
    }

    fn __len__(&self) -> usize {
        self.table.rows()
    }

    fn __bool__(&self) -> bool {
        true
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        self.table.stream(py)
    }

    fn __str__(&self) -> &str {
        &self.text
    }

    /// The states at the start and the end of each program, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let columns = [
            "position", "file", "axis", "kind", "start", "end", "left_by",
        ];
        notebook::tabular(py, self.verdict(), (&self.table, &columns))
    }

    fn __repr__(&self) -> String {
        format!("<frictcomp.AuditSequence: {}>", self.verdict())
    }
}
