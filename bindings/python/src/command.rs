//! The command line in the wheel.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command line, the name of the program first; returns its exit status.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| frictcomp_cli::status(arguments))
}
