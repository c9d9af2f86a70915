//! Results that go to another process and come back: as JSON, and tables as streams of Arrow.

use pyo3::PyClass;
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::exceptions::refused;

/// The result of `__reduce__`: the function that restores the object, and its arguments.
pub(crate) type Reduced<A> = (Py<PyAny>, A);

/// The function `_unpickled` of the class of an object, with its arguments.
pub(crate) fn reduced<T: PyClass, A>(object: &Bound<'_, T>, arguments: A) -> PyResult<Reduced<A>> {
    let made_anew = object.as_any().get_type().getattr("_unpickled")?;
    Ok((made_anew.unbind(), arguments))
}

/// The text of a value.
pub(crate) fn written(value: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|error| refused(error.to_string()))
}

/// The value of a text.
pub(crate) fn read<T: DeserializeOwned>(text: &str) -> PyResult<T> {
    serde_json::from_str(text)
        .map_err(|error| refused(format!("this was not pickled here: {error}")))
}
