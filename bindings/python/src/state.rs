//! The result of a run with which the next one starts.

use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::session::SavedState;
use frictcomp_host::{FileRegistry, OutputFiles, StateFile};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::exceptions::refused;
use crate::failure::Failure;

/// The result of a run with which the next one starts: states, variables, value lists.
#[pyclass(frozen, eq, name = "State", module = "frictcomp")]
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PyState(Arc<SavedState>);

impl PyState {
    /// Wraps the saved state of a session.
    pub(crate) fn new(saved: SavedState) -> Self {
        Self(Arc::new(saved))
    }
}

#[pymethods]
impl PyState {
    /// Reads a state file, including one of the command line.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let saved = StateFile::read(&path);
        let saved = saved.map_err(|error| Failure::from(error).into_error(py))?;
        Ok(Self::new(saved))
    }

    /// Writes a state file, which the command line also reads.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let state = Arc::clone(&self.0);
        let saved = py.detach(move || save(&StateFile::lock(&path)?, &state));
        saved.map_err(|failure| failure.into_error(py))
    }

    /// Reads the text of a state file.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let saved = serde_json::from_str(text);
        let saved = saved.map_err(|error| refused(format!("this is not a state: {error}")))?;
        Ok(Self::new(saved))
    }

    /// The text of a state file.
    fn to_json(&self) -> PyResult<String> {
        let text = serde_json::to_string_pretty(&*self.0);
        text.map_err(|error| refused(error.to_string()))
    }

    #[getter]
    fn axes(&self) -> Vec<&str> {
        self.0.axes.iter().map(|axis| axis.axis.as_str()).collect()
    }

    /// The axes that are not in their start-up state, each with the kind.
    #[getter]
    fn away(&self) -> Vec<(&str, &'static str)> {
        let axes = self.0.axes.iter();
        axes.flat_map(|axis| {
            let kinds = axis.away.iter();
            kinds.map(|away| (axis.axis.as_str(), away.kind.as_str()))
        })
        .collect()
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<(Py<PyAny>, (String,))> {
        let read = slf.get_type().getattr("from_json")?;
        Ok((read.unbind(), (slf.get().to_json()?,)))
    }

    fn __repr__(&self) -> String {
        let away = self
            .away()
            .iter()
            .map(|(axis, kind)| format!("{axis} {kind}"))
            .collect::<Vec<_>>();
        match away.as_slice() {
            [] => "<frictcomp.State: all axes in their start-up state>".to_owned(),
            away => format!(
                "<frictcomp.State: away from its start-up state: {}>",
                away.join(", ")
            ),
        }
    }
}

/// The initial state of a run.
pub(crate) enum StartState {
    /// The start of the control.
    Fresh,
    /// State that another run left.
    Left(Arc<SavedState>),
    /// The content of a file, to which the result of the run is also written.
    File(PathBuf),
}

impl StartState {
    /// Reads the start of a session: nothing, a `State`, or the path of a state file.
    pub(crate) fn of(given: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let Some(given) = given else {
            return Ok(Self::Fresh);
        };
        if let Ok(state) = given.cast::<PyState>() {
            return Ok(Self::Left(Arc::clone(&state.get().0)));
        }
        let path = given.extract();
        path.map(Self::File).map_err(|_| {
            PyTypeError::new_err("a state is a `frictcomp.State` or the path of a state file")
        })
    }

    /// The axes that the last run left.
    pub(crate) fn axes(&self) -> Vec<String> {
        match self {
            Self::Fresh => Vec::new(),
            Self::Left(saved) => saved.axes.iter().map(|axis| axis.axis.clone()).collect(),
            Self::File(path) => StateFile::axes(path),
        }
    }

    /// The file, which no other run touches in the meantime.
    pub(crate) fn lock(&self) -> Result<Option<StateFile>, Failure> {
        Ok(match self {
            Self::File(path) => Some(StateFile::lock(path)?),
            Self::Fresh | Self::Left(_) => None,
        })
    }
}

/// Writes a state to its file.
pub(crate) fn save(file: &StateFile, state: &SavedState) -> Result<(), Failure> {
    let mut outputs = OutputFiles::new(&FileRegistry::default());
    file.save(state, &mut outputs)?;
    Ok(outputs.finish(|_| ())?)
}
