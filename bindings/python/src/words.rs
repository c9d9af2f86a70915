//! Small languages of the command line, as Python hands them over.

use std::fmt::Display;
use std::str::FromStr;

use pyo3::PyResult;

use crate::exceptions::refused;

/// What a word means; the usual where there is none.
pub(crate) fn meant<T: FromStr<Err: Display> + Default>(word: Option<&str>) -> PyResult<T> {
    word.map_or_else(
        || Ok(T::default()),
        |word| {
            word.parse()
                .map_err(|error: T::Err| refused(error.to_string()))
        },
    )
}

/// What a word means, where there is one.
pub(crate) fn meant_if_given<T: FromStr<Err: Display>>(word: Option<&str>) -> PyResult<Option<T>> {
    let meant = word.map(str::parse).transpose();
    meant.map_err(|error: T::Err| refused(error.to_string()))
}
