//! `frictcomp.audit`: the effect of the order of programs.

use std::sync::Arc;

use arrow_array::{ArrayRef, StringArray, UInt32Array};
use frictcomp::audit::{AxisAudit, ProgramAudit};
use frictcomp_host::{
    ArchiveAuditor, AuditOptions, FileRegistry, HostError, Input, MachineOptions, Machines,
};
use frictcomp_report::results::audit::{AuditReport, MachineAudit, records};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule};
use serde_json::Value;

use crate::arrow::{ArrowColumn, ArrowTable};
use crate::failure::Failure;
use crate::json::parsed;
use crate::kinds::Kinds;
use crate::limits::{self, PyLimits};
use crate::machine::{machine_options, remark_without_machine};
use crate::messages::{GivenMessages, PyMessage, PyMessages};
use crate::notebook;
use crate::pickled::{self, Reduced};
use crate::program::GivenPrograms;
use crate::work::{Stop, interruptible};

/// The effect of the order of programs: one row for each program, axis and kind.
///
/// The table has the columns of ``frictcomp audit --format csv``.
#[pyclass(frozen, name = "Audit", module = "frictcomp")]
pub(crate) struct PyAudit {
    table: ArrowTable,
    records: String,
    messages: Py<PyMessages>,
    programs: usize,
    hazards: u64,
    has_warnings: bool,
}

/// The audit, independent of Python.
struct Audited {
    report: AuditReport,
    said: GivenMessages,
}

/// Which programs leave an axis away from its start-up state, and which move it in the state that they find.
#[pyfunction]
#[pyo3(signature = (programs, *, machine=None, kinds=None, limits=None))]
pub(crate) fn audit(
    programs: &Bound<'_, PyAny>,
    machine: Option<&Bound<'_, PyAny>>,
    kinds: Option<Kinds>,
    limits: Option<&Bound<'_, PyLimits>>,
) -> PyResult<PyAudit> {
    let py = programs.py();
    let job = AuditJob {
        programs: GivenPrograms::of(programs)?,
        machine: machine_options(machine)?,
        options: AuditOptions::new(limits::brief(limits)).with_kinds(Kinds::of(kinds)?),
    };
    let Audited { report, said } = interruptible(py, move |stop| audited(job, stop))?;
    Ok(PyAudit {
        table: table(&report),
        records: Value::from(records(&report)).to_string(),
        messages: Py::new(py, PyMessages::new(said))?,
        programs: report.programs(),
        hazards: report.hazards(),
        has_warnings: report.has_warnings(),
    })
}

fn audited(job: AuditJob, stop: &Stop) -> Result<Audited, Failure> {
    let find: Find = |programs, machines| {
        let found = programs.found(machines);
        (found.inputs, found.failures)
    };
    let (auditor, mut errors) = job.auditor(find, stop);
    let (archives, unread) = auditor.audit();
    errors.extend(unread);
    if let Some(failure) = Failure::of_several(errors) {
        return Err(failure);
    }
    Ok(Audited {
        report: AuditReport::new(auditor.described(), archives, None),
        said: said(&auditor),
    })
}

/// Programs to audit, independent of Python.
pub(crate) struct AuditJob {
    pub(crate) programs: GivenPrograms,
    pub(crate) machine: MachineOptions,
    pub(crate) options: AuditOptions,
}

/// Finds the programs among the given paths, and the paths that have none.
type Find = fn(GivenPrograms, &mut Machines) -> (Vec<Input>, Vec<HostError>);

impl AuditJob {
    /// The programs that can run on their machines, and what cannot be audited.
    pub(crate) fn auditor(self, find: Find, stop: &Stop) -> (ArchiveAuditor, Vec<HostError>) {
        let machines = Machines::new(self.machine, &FileRegistry::default());
        let machines = machines.on_disk(&self.programs.disk);
        let mut machines = machines.watched_by(Arc::new(stop.clone()));
        let (inputs, mut errors) = find(self.programs, &mut machines);
        let (auditor, no_machine) = ArchiveAuditor::new(inputs, &mut machines, self.options);
        errors.extend(no_machine);
        (auditor, errors)
    }
}

/// The errors that keep the control from accepting its lists, and the remark that no machine is described.
pub(crate) fn said(auditor: &ArchiveAuditor) -> GivenMessages {
    GivenMessages {
        messages: auditor.list_errors().map(PyMessage::of).collect(),
        remark: remark_without_machine(auditor.undescribed()),
        ..GivenMessages::default()
    }
}

/// Effect of a program on an axis.
struct AxisEffectRow<'a> {
    machine: &'a MachineAudit,
    program: &'a ProgramAudit,
    axis: &'a AxisAudit,
}

/// The columns of `audit --format csv`: a row for each program, axis and kind.
fn table(report: &AuditReport) -> ArrowTable {
    let machines = report.machines.iter();
    let rows = machines.flat_map(|machine| {
        let programs = machine.archive.programs().iter();
        programs.flat_map(move |program| {
            let axes = program.axes.iter();
            axes.map(move |axis| AxisEffectRow {
                machine,
                program,
                axis,
            })
        })
    });
    let rows: Vec<AxisEffectRow<'_>> = rows.collect();
    let text = |of: fn(&AxisEffectRow<'_>) -> Option<String>| -> ArrayRef {
        Arc::new(rows.iter().map(of).collect::<StringArray>())
    };
    let line = |of: fn(&AxisEffectRow<'_>) -> Option<u32>| -> ArrayRef {
        Arc::new(rows.iter().map(of).collect::<UInt32Array>())
    };
    let columns: Vec<ArrowColumn> = vec![
        ("machine", text(|it| it.machine.origin.clone())),
        ("file", text(|it| Some(it.program.file.clone()))),
        ("axis", text(|it| Some(it.axis.axis.clone()))),
        ("kind", text(|it| Some(it.axis.kind.to_string()))),
        (
            "effect",
            text(|it| Some(it.axis.effect.as_str().to_owned())),
        ),
        (
            "by_file",
            text(|it| Some(it.axis.by.as_ref()?.file.to_string())),
        ),
        ("by_line", line(|it| Some(it.axis.by.as_ref()?.line))),
        (
            "reason",
            text(|it| {
                let reason = it.axis.reason.as_ref().map(|it| it.message.clone());
                reason.or_else(|| it.axis.leaves_away_when(&it.program.file))
            }),
        ),
        (
            "inherits",
            text(|it| Some(it.axis.inherits.as_str().to_owned())),
        ),
        (
            "inherits_file",
            text(|it| Some(it.axis.inherits.motion()?.site.file.to_string())),
        ),
        (
            "inherits_line",
            line(|it| Some(it.axis.inherits.motion()?.site.line)),
        ),
        (
            "motion",
            text(|it| Some(it.axis.inherits.motion()?.motion.as_str().to_owned())),
        ),
        (
            "inherits_if",
            text(|it| it.axis.inherits.motion()?.condition(&it.program.file)),
        ),
    ];
    let by = ["machine", "by_file", "by_line", "reason"];
    let inherited = ["inherits_file", "inherits_line", "motion", "inherits_if"];
    ArrowTable::of(columns, &[&by[..], &inherited].concat())
}

/// The data that an audit is restored from: the table, the records, the messages, the counts.
type PickledAudit<'py> = (
    Bound<'py, PyBytes>,
    String,
    Py<PyMessages>,
    (usize, u64, bool),
);

#[pymethods]
impl PyAudit {
    #[staticmethod]
    fn _unpickled(
        table: &[u8],
        records: String,
        messages: Py<PyMessages>,
        counted: (usize, u64, bool),
    ) -> PyResult<Self> {
        let (programs, hazards, has_warnings) = counted;
        Ok(Self {
            table: ArrowTable::unpickled(table)?,
            records,
            messages,
            programs,
            hazards,
            has_warnings,
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<PickledAudit<'py>>> {
        let (this, py) = (slf.get(), slf.py());
        let arguments = (
            this.table.pickled(py)?,
            this.records.clone(),
            this.messages.clone_ref(py),
            (this.programs, this.hazards, this.has_warnings),
        );
        pickled::reduced(slf, arguments)
    }

    /// The records of ``frictcomp audit --format ndjson``.
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

    #[getter]
    fn programs(&self) -> usize {
        self.programs
    }

    /// The pairs of a program that leaves an axis away from its start-up state and one that inherits it.
    #[getter]
    fn hazards(&self) -> u64 {
        self.hazards
    }

    /// Whether something needs to be corrected, or is not known.
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

    /// The effect of each program on each axis, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let words = notebook::verdict(&self.records);
        let columns = ["file", "axis", "kind", "effect", "reason", "inherits"];
        notebook::tabular(py, &words, (&self.table, &columns))
    }

    fn __repr__(&self) -> String {
        let (programs, hazards) = (self.programs, self.hazards);
        format!("<frictcomp.Audit: {programs} programs, {hazards} hazards>")
    }
}
