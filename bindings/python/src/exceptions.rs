//! The exceptions that Python receives.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyType};

/// Returns a `frictcomp.Error` with the given attributes.
pub(crate) fn error(py: Python<'_>, message: &str, given: &Bound<'_, PyDict>) -> PyResult<PyErr> {
    static ERROR: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let class = ERROR.import(py, "frictcomp._error", "Error")?;
    Ok(PyErr::from_value(class.call((message,), Some(given))?))
}

/// An argument with a value that makes no sense.
pub(crate) fn refused(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}
