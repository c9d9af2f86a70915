//! Records as Python's own values.

use pyo3::prelude::*;

/// What a text in JSON says, as dictionaries, lists, texts and numbers.
pub(crate) fn parsed<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}
