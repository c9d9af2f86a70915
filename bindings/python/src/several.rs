//! The iterables of Python: lists, tuples, sets, arrays, generators.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString};

/// The values of an iterable that is not a text.
pub(crate) struct Several<T>(pub(crate) Vec<T>);

impl<'py, T: FromPyObjectOwned<'py>> FromPyObject<'_, 'py> for Several<T> {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if given.is_instance_of::<PyString>() || given.is_instance_of::<PyBytes>() {
            return Err(PyTypeError::new_err(
                "several values are needed, not one text",
            ));
        }
        let values = given.try_iter()?;
        let values = values.map(|value| value?.extract::<T>().map_err(Into::into));
        values.collect::<PyResult<_>>().map(Self)
    }
}

/// One value, or the values of an iterable.
pub(crate) struct OneOrSeveral<T>(pub(crate) Vec<T>);

impl<'py, T: FromPyObjectOwned<'py>> FromPyObject<'_, 'py> for OneOrSeveral<T> {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(one) = given.extract::<T>() {
            return Ok(Self(vec![one]));
        }
        let Several(values) = given.extract()?;
        Ok(Self(values))
    }
}
