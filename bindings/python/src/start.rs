//! The axis positions at the start.

use frictcomp_host::LoadedMachine;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::Failure;
use crate::several::Several;

/// Positions of axes by their names: a mapping, or pairs.
pub(crate) struct Places(pub(crate) Vec<(String, f64)>);

impl<'py> FromPyObject<'_, 'py> for Places {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let pairs = match given.cast::<PyDict>() {
            Ok(mapping) => mapping.items().extract::<Several<(String, f64)>>(),
            Err(_) => given.extract(),
        };
        let Several(places) = pairs.map_err(|_| {
            PyTypeError::new_err("`start` has names of axes with their positions, `{\"X\": 0.0}`")
        })?;
        Ok(Self(places))
    }
}

/// The given positions of axes of the machine, in mm or degrees.
pub(crate) fn positions(
    given: &[(String, f64)],
    loaded: &LoadedMachine,
) -> Result<Vec<(String, f64)>, Failure> {
    for (name, position) in given {
        if loaded.machine.find(name).is_none() {
            let axes = loaded.machine.axes.iter().map(|it| it.name.as_str());
            let axes = axes.collect::<Vec<_>>().join(", ");
            return Err(Failure::new(format!(
                "the machine has no axis `{name}`, which `start` names"
            ))
            .with_help(format!("its axes are {axes}")));
        }
        if !position.is_finite() {
            return Err(
                Failure::new(format!("axis `{name}` cannot start at {position}"))
                    .with_help("give a position in mm or degrees"),
            );
        }
    }
    Ok(given.to_vec())
}
