//! Small languages of the command line, as Python passes them.

use std::fmt::Display;
use std::str::FromStr;

use frictcomp_physics::motion::check_cycle;
use pyo3::{PyResult, Python};

use crate::exceptions::refused;
use crate::failure::Failure;

/// The meaning of a word for an argument; the usual one if there is none.
pub(crate) fn meant<T: FromStr<Err: Display> + Default>(
    argument: &str,
    word: Option<&str>,
) -> PyResult<T> {
    meant_if_given(argument, word).map(Option::unwrap_or_default)
}

/// The meaning of a word for an argument, if there is one.
pub(crate) fn meant_if_given<T: FromStr<Err: Display>>(
    argument: &str,
    word: Option<&str>,
) -> PyResult<Option<T>> {
    let meant = word.map(str::parse).transpose();
    meant.map_err(|error: T::Err| refused(format!("`{argument}`: {error}")))
}

/// The CNC cycle in s.
pub(crate) fn seconds(py: Python<'_>, milliseconds: Option<f64>) -> PyResult<Option<f64>> {
    let checked = milliseconds.map(|ms| check_cycle(ms / 1000.0)).transpose();
    checked.map_err(|error| Failure::new(error.to_string()).into_error(py))
}
