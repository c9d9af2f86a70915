//! Messages, one by one and as a table.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use arrow_array::builder::{ListBuilder, StringBuilder};
use arrow_array::{ArrayRef, StringArray, UInt32Array, UInt64Array};
use frictcomp::diagnostic::{Advice, Fix, ReachedFrom};
use frictcomp::text::Place;
use frictcomp::{diagnostic::Diagnostic, diagnostic::Severity};
use frictcomp_host::LoadedMachine;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList, PySlice};
use serde::{Deserialize, Serialize};

use crate::arrow::{ArrowColumn, ArrowTable};
use crate::exceptions::error;
use crate::notebook;
use crate::pickled::{self, Reduced};

/// A word of a table of frictcomp, or one that was pickled.
pub(crate) type PickledWord = Cow<'static, str>;

/// A change to the text that does what a message advises.
///
/// The text from ``line``, ``column`` up to ``end_line``, ``end_column`` is replaced.
#[pyclass(frozen, eq, hash, name = "Fix", module = "frictcomp")]
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(crate) struct PyFix {
    #[pyo3(get)]
    file: String,
    #[pyo3(get)]
    line: u32,
    #[pyo3(get)]
    column: u32,
    #[pyo3(get)]
    end_line: u32,
    #[pyo3(get)]
    end_column: u32,
    #[pyo3(get)]
    text: String,
    #[pyo3(get)]
    safety: PickledWord,
    also: Option<Box<PyFix>>,
}

/// An end of the program that a message about program end refers to.
#[pyclass(frozen, get_all, eq, hash, name = "End", module = "frictcomp")]
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(crate) struct PyEnd {
    file: String,
    /// Line of the block, from 1.
    line: u32,
}

/// One message about a program or a list, with the fields of a record of ``--format ndjson``.
///
/// ``str(message)`` is ``file:line:column: severity[CODE] message``.
#[pyclass(frozen, get_all, eq, hash, name = "Message", module = "frictcomp")]
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(crate) struct PyMessage {
    /// The program of the session, from 1; None if the message is about a list.
    program: Option<u32>,
    /// The executed block of the program, from 1.
    seq: Option<u64>,
    code: PickledWord,
    severity: PickledWord,
    file: String,
    /// Line of the block, from 1.
    line: u32,
    /// From 1, in characters.
    column: u32,
    end_line: u32,
    end_column: u32,
    /// The axis that it refers to.
    axis: Option<String>,
    message: String,
    /// Advice.
    help: Vec<String>,
    /// The ends of the program that a message about program end refers to.
    ends: Vec<PyEnd>,
    /// Changes to the text, each of which alone does what is advised.
    fixes: Vec<PyFix>,
    /// The main programs that reach the place of the message in a called program, at most 20.
    reached_from: Vec<String>,
    /// Number of main programs that reach it.
    reached_from_count: usize,
}

/// The messages.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct GivenMessages {
    /// The messages in their order.
    pub(crate) messages: Vec<PyMessage>,
    /// The remark above everything else: that no machine is described (R1.37).
    pub(crate) remark: Option<String>,
    /// Number of further messages, by severity (R2.85).
    pub(crate) left_out: BTreeMap<PickledWord, u64>,
}

impl GivenMessages {
    /// Errors, and remarks on a trace with the severities of the user.
    pub(crate) fn of_trace(
        (errors, remarks): (&[Diagnostic], &[Diagnostic]),
        loaded: &LoadedMachine,
    ) -> Self {
        let remarks = remarks.iter().filter_map(|said| {
            let severity = loaded.levels.severity(said.code)?;
            Some(PyMessage::of(&Diagnostic {
                severity,
                ..said.clone()
            }))
        });
        Self {
            messages: errors.iter().map(PyMessage::of).chain(remarks).collect(),
            ..Self::default()
        }
    }

    /// Counts the messages of a program that are not listed.
    pub(crate) fn leave_out(&mut self, unsaid: &BTreeMap<Severity, u64>) {
        for (severity, more) in unsaid.iter().filter(|(_, more)| **more > 0) {
            *self.left_out.entry(severity.as_str().into()).or_default() += more;
        }
    }

    /// Counts the messages, listed or not.
    pub(crate) fn count_all(&mut self, counts: &BTreeMap<Severity, u64>) {
        for (severity, all) in counts {
            let word = severity.as_str();
            let messages = self.messages.iter();
            let listed = messages.filter(|it| it.severity == word).count() as u64;
            if *all > listed {
                self.left_out.insert(word.into(), all - listed);
            }
        }
    }
}

/// Messages in their order, and a table of them for pandas, polars and DuckDB.
///
/// It has the methods of a ``Sequence`` and is not registered as one: polars reads a ``Sequence`` item
/// by item, and not as a table.
#[pyclass(frozen, sequence, name = "Messages", module = "frictcomp")]
pub(crate) struct PyMessages(GivenMessages);

impl PyFix {
    fn of(fix: &Fix) -> Self {
        let (start, end) = (fix.place.start(), fix.place.end());
        Self {
            file: fix.place.file.to_string(),
            line: start.line,
            column: start.column,
            end_line: end.line,
            end_column: end.column,
            text: fix.text.clone(),
            safety: fix.safety.as_str().into(),
            also: fix.also.as_deref().map(|also| Box::new(Self::of(also))),
        }
    }
}

#[pymethods]
impl PyFix {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(slf.get())?,))
    }

    /// A further change of the file that is made with it.
    #[getter]
    fn also(&self) -> Option<Self> {
        self.also.as_deref().cloned()
    }

    fn __repr__(&self) -> String {
        let (line, column) = (self.line, self.column);
        format!(
            "<frictcomp.Fix {}:{line}:{column}: {:?}>",
            self.file, self.text
        )
    }
}

impl PyEnd {
    fn of(end: &Place) -> Self {
        Self {
            file: end.file.to_string(),
            line: end.start().line,
        }
    }
}

#[pymethods]
impl PyEnd {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(slf.get())?,))
    }

    fn __repr__(&self) -> String {
        format!("<frictcomp.End {}:{}>", self.file, self.line)
    }
}

/// The files of the main programs that reach a message.
fn named(reached: &ReachedFrom) -> Vec<String> {
    reached.programs().iter().map(ToString::to_string).collect()
}

impl PyMessage {
    /// A message that does not belong to a block.
    pub(crate) fn of(said: &Diagnostic) -> Self {
        let (start, end) = (said.place.start(), said.place.end());
        Self {
            program: None,
            seq: None,
            code: said.code.as_str().into(),
            severity: said.severity.as_str().into(),
            file: said.place.file.to_string(),
            line: start.line,
            column: start.column,
            end_line: end.line,
            end_column: end.column,
            axis: said.axis.clone(),
            message: said.message.clone(),
            help: said.advice.iter().map(Advice::to_string).collect(),
            ends: said.ends.iter().map(PyEnd::of).collect(),
            fixes: said.fixes.iter().map(PyFix::of).collect(),
            reached_from: named(&said.reached_from),
            reached_from_count: said.reached_from.count(),
        }
    }

    /// A message about an executed block of a program, or about the end of the program.
    pub(crate) fn of_block(said: &Diagnostic, program: u32, seq: u64) -> Self {
        Self {
            program: Some(program),
            seq: Some(seq),
            ..Self::of(said)
        }
    }

    /// Returns whether it is an error.
    pub(crate) fn is_error(&self) -> bool {
        self.severity == "error"
    }
}

/// `file:line:column: severity[CODE] message`.
impl fmt::Display for PyMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column) = (self.line, self.column);
        let (file, severity, code) = (&self.file, &self.severity, &self.code);
        write!(
            f,
            "{file}:{line}:{column}: {severity}[{code}] {}",
            self.message
        )
    }
}

#[pymethods]
impl PyMessage {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(slf.get())?,))
    }

    fn __str__(&self) -> String {
        self.to_string()
    }

    fn __repr__(&self) -> String {
        let (file, line, column) = (&self.file, self.line, self.column);
        format!("<frictcomp.Message {} {file}:{line}:{column}>", self.code)
    }
}

impl PyMessages {
    /// These messages.
    pub(crate) fn new(said: GivenMessages) -> Self {
        Self(said)
    }

    /// Returns the number of messages of a severity, listed or not.
    fn count_of(&self, severity: &str) -> u64 {
        let messages = self.0.messages.iter();
        let listed = messages.filter(|it| it.severity == severity).count() as u64;
        listed + self.0.left_out.get(severity).copied().unwrap_or_default()
    }

    /// `1 error, 2 warnings`.
    pub(crate) fn counted(&self) -> String {
        let counts = ["error", "warning"].map(|severity| {
            let count = self.count_of(severity);
            let plural = if count == 1 { "" } else { "s" };
            format!("{count} {severity}{plural}")
        });
        counts.join(", ")
    }

    fn table(&self) -> ArrowTable {
        let messages = &self.0.messages;
        let text = |of: fn(&PyMessage) -> Option<&str>| -> ArrayRef {
            Arc::new(messages.iter().map(of).collect::<StringArray>())
        };
        let number = |of: fn(&PyMessage) -> Option<u32>| -> ArrayRef {
            Arc::new(messages.iter().map(of).collect::<UInt32Array>())
        };
        let list = |of: fn(&PyMessage) -> &Vec<String>| -> ArrayRef {
            let mut lists = ListBuilder::new(StringBuilder::new());
            for message in messages {
                lists.append_value(of(message).iter().map(Some));
            }
            Arc::new(lists.finish())
        };
        let seq: UInt64Array = messages.iter().map(|it| it.seq).collect();
        let columns: Vec<ArrowColumn> = vec![
            ("program", number(|it| it.program)),
            ("seq", Arc::new(seq)),
            ("code", text(|it| Some(&it.code))),
            ("severity", text(|it| Some(&it.severity))),
            ("file", text(|it| Some(&it.file))),
            ("line", number(|it| Some(it.line))),
            ("column", number(|it| Some(it.column))),
            ("end_line", number(|it| Some(it.end_line))),
            ("end_column", number(|it| Some(it.end_column))),
            ("axis", text(|it| it.axis.as_deref())),
            ("message", text(|it| Some(&it.message))),
            ("help", list(|it| &it.help)),
            ("reached_from", list(|it| &it.reached_from)),
        ];
        ArrowTable::of(columns, &["program", "seq", "axis"])
    }
}

#[pymethods]
impl PyMessages {
    #[staticmethod]
    fn _unpickled(text: &str) -> PyResult<Self> {
        pickled::read(text).map(Self)
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Reduced<(String,)>> {
        pickled::reduced(slf, (pickled::written(&slf.get().0)?,))
    }

    fn __len__(&self) -> usize {
        self.0.messages.len()
    }

    fn __getitem__<'py>(&self, at: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let py = at.py();
        if let Ok(slice) = at.cast::<PySlice>() {
            let count = isize::try_from(self.0.messages.len()).unwrap_or(isize::MAX);
            let part = slice.indices(count)?;
            let mut at = part.start;
            let mut messages = Vec::new();
            for _ in 0..part.slicelength {
                messages.extend(
                    usize::try_from(at)
                        .ok()
                        .and_then(|at| self.0.messages.get(at))
                        .cloned(),
                );
                at += part.step;
            }
            return Ok(PyList::new(py, messages)?.into_any());
        }
        let at: isize = at.extract()?;
        let count = isize::try_from(self.0.messages.len()).unwrap_or(isize::MAX);
        let at = if at < 0 { at.saturating_add(count) } else { at };
        let message = usize::try_from(at)
            .ok()
            .and_then(|at| self.0.messages.get(at));
        let message = message.ok_or_else(|| PyIndexError::new_err("there is no such message"))?;
        Ok(Bound::new(py, message.clone())?.into_any())
    }

    fn __contains__(&self, message: &Bound<'_, PyAny>) -> bool {
        message
            .cast::<PyMessage>()
            .is_ok_and(|message| self.0.messages.contains(message.get()))
    }

    fn __reversed__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let messages = self.0.messages.iter().rev().cloned();
        PyList::new(py, messages)?.try_iter().map(Bound::into_any)
    }

    fn count(&self, value: &Bound<'_, PyAny>) -> usize {
        let Ok(message) = value.cast::<PyMessage>() else {
            return 0;
        };
        let messages = self.0.messages.iter();
        messages.filter(|it| *it == message.get()).count()
    }

    #[pyo3(signature = (value, start=0, stop=isize::MAX))]
    fn index(&self, value: &Bound<'_, PyAny>, start: isize, stop: isize) -> PyResult<usize> {
        let part = PySlice::new(value.py(), start, stop, 1);
        let part = part.indices(isize::try_from(self.0.messages.len()).unwrap_or(isize::MAX))?;
        let [from, to] = [part.start, part.stop].map(|at| usize::try_from(at).unwrap_or(0));
        let message = value.cast::<PyMessage>().ok();
        let is_it = |at: &usize| message.is_some_and(|it| self.0.messages[*at] == *it.get());
        (from..to)
            .find(is_it)
            .ok_or_else(|| PyValueError::new_err("there is no such message"))
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        PyList::new(py, self.0.messages.iter().cloned())?
            .try_iter()
            .map(Bound::into_any)
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // The interface lets the producer ignore it.
        let _ = requested_schema;
        self.table().stream(py)
    }

    /// The number of errors, including those that are left out.
    #[getter]
    fn errors(&self) -> u64 {
        self.count_of("error")
    }

    #[getter]
    fn warnings(&self) -> u64 {
        self.count_of("warning")
    }

    /// The number of messages of a severity that are not listed: the list for each file is limited.
    #[getter]
    fn left_out(&self) -> BTreeMap<PickledWord, u64> {
        self.0.left_out.clone()
    }

    /// A remark that no machine is described, where that matters.
    #[getter]
    fn remark(&self) -> Option<&str> {
        self.0.remark.as_deref()
    }

    /// Raises ``Error`` if there is a message of severity error.
    pub(crate) fn raise_for_errors(&self, py: Python<'_>) -> PyResult<()> {
        let errors = self.0.messages.iter().filter(|message| message.is_error());
        let errors: Vec<PyMessage> = errors.cloned().collect();
        let Some(first) = errors.first() else {
            return Ok(());
        };
        let message = first.to_string();
        let given = PyDict::new(py);
        given.set_item("messages", errors)?;
        Err(error(py, &message, &given)?)
    }

    /// The messages with their places, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let words = self.0.remark.iter().cloned().chain([self.counted()]);
        let words = words.collect::<Vec<_>>().join("; ");
        let columns = ["severity", "code", "file", "line", "message"];
        notebook::tabular(py, &words, (&self.table(), &columns))
    }

    fn __repr__(&self) -> String {
        format!("<frictcomp.Messages: {}>", self.counted())
    }
}
