//! Small languages of the command line, as Python passes them.

use std::fmt::Display;
use std::str::FromStr;

use pyo3::PyResult;

use crate::exceptions::refused;

/// The meaning of a word; the usual one if there is none.
pub(crate) fn meant<T: FromStr<Err: Display> + Default>(word: Option<&str>) -> PyResult<T> {
    word.map_or_else(
        || Ok(T::default()),
        |word| {
            word.parse()
                .map_err(|error: T::Err| refused(error.to_string()))
        },
    )
}

/// The meaning of a word, if there is one.
pub(crate) fn meant_if_given<T: FromStr<Err: Display>>(word: Option<&str>) -> PyResult<Option<T>> {
    let meant = word.map(str::parse).transpose();
    meant.map_err(|error: T::Err| refused(error.to_string()))
}
