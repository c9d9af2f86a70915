//! Records as Python's own values.

use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

/// The content of a JSON text, as dictionaries, lists, texts and numbers.
pub(crate) fn parsed<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

/// A JSON text, which Python receives as its own values.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct JsonText(pub(crate) String);

impl<'py> IntoPyObject<'py> for JsonText {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        parsed(py, &self.0)
    }
}
