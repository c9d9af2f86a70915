//! Failures as exceptions of Python.

use std::path::{Path, PathBuf};

use frictcomp::diagnostic::Diagnostic;
use frictcomp::session::StateError;
use frictcomp::text::shown_path;
use frictcomp_host::{HostError, NoDrivenContour};
use frictcomp_physics::circle::CircleError;
use frictcomp_physics::contour::NoContour;
use frictcomp_physics::current::FollowError;
use frictcomp_recordings::evidence::UnreadAnswer;
use frictcomp_recordings::identify::IdentifyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::advice;
use crate::exceptions::error;
use crate::messages::PyMessage;

/// Reason why something could not be done.
#[derive(Debug)]
pub(crate) struct Failure {
    message: String,
    help: Option<String>,
    file: Option<PathBuf>,
    diagnostics: Vec<Diagnostic>,
}

impl Failure {
    /// A sentence in lower case.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: None,
            file: None,
            diagnostics: Vec::new(),
        }
    }

    /// A failure with advice on what to do.
    pub(crate) fn with_help(self, help: impl Into<String>) -> Self {
        let help = Some(help.into());
        Self { help, ..self }
    }

    /// The failure after lines that could not be read as answers: they are named first.
    pub(crate) fn after(self, unread: &[UnreadAnswer]) -> Self {
        let places = unread.iter();
        let places = places.map(|it| format!("{}:{}: {}", it.file, it.line, it.reason));
        let help: Vec<String> = places.chain(self.help).collect();
        let help = (!help.is_empty()).then(|| help.join("; "));
        Self { help, ..self }
    }

    /// A state that a session does not accept.
    pub(crate) fn of_state(error: StateError) -> Self {
        Self::new(format!("the state cannot be used: {error}"))
            .with_help("begin without a state, or give the machine that it was made on")
    }

    /// An axis whose current cannot be computed.
    pub(crate) fn of_axes(error: FollowError) -> Self {
        let help = match &error {
            FollowError::NoAxis(unknown) => unknown.help("its axes are"),
            FollowError::Assumed(_) | FollowError::NoList => {
                Some("name its compensation value list with `value_list=`".to_owned())
            }
        };
        let failure = Self::new(error.to_string());
        Self { help, ..failure }
    }

    /// A circle that cannot be simulated.
    pub(crate) fn of_circle(error: CircleError) -> Self {
        Self::new(error.to_string()).with_help(error.help())
    }

    /// A recording in which nothing can be found.
    pub(crate) fn of_identification(error: IdentifyError) -> Self {
        Self::new(error.to_string()).with_help(error.help())
    }

    /// The message if several things could not be done.
    pub(crate) fn of_several(errors: Vec<HostError>) -> Option<Self> {
        let count = errors.len();
        let mut failures = errors.into_iter().map(Self::from);
        let mut first = failures.next()?;
        if count > 1 {
            first.message = format!("{count} errors, the first of them: {}", first.message);
        }
        first
            .diagnostics
            .extend(failures.flat_map(|more| more.diagnostics));
        Some(first)
    }

    /// The exception `frictcomp.Error`.
    pub(crate) fn into_error(self, py: Python<'_>) -> PyErr {
        self.raised(py).unwrap_or_else(|error| error)
    }

    fn raised(self, py: Python<'_>) -> PyResult<PyErr> {
        let messages = self.diagnostics.iter().map(PyMessage::of);
        let given = PyDict::new(py);
        given.set_item("help", self.help)?;
        given.set_item("file", self.file.as_deref().map(shown_path))?;
        given.set_item("messages", messages.collect::<Vec<_>>())?;
        error(py, &self.message, &given)
    }
}

impl From<HostError> for Failure {
    fn from(error: HostError) -> Self {
        let file = match &error {
            HostError::Read { path, .. }
            | HostError::Write { path, .. }
            | HostError::FolderAsProgram(path)
            | HostError::FolderAsList(path)
            | HostError::FolderAsRecording(path)
            | HostError::NoFolder(path)
            | HostError::StateNotRegular(path)
            | HostError::StateInUse(path)
            | HostError::State { path, .. }
            | HostError::Baseline { path, .. }
            | HostError::ValueList { path, .. }
            | HostError::Plant { path, .. }
            | HostError::NotAProject { path, .. }
            | HostError::NotAStartupList { path, .. } => Some(path.clone()),
            HostError::Commission(error) => error.path().map(Path::to_owned),
            HostError::Ask(error) => error.path().map(Path::to_owned),
            _ => None,
        };
        Self {
            message: error.to_string(),
            help: advice::about(&error),
            file,
            diagnostics: error.diagnostics().to_vec(),
        }
    }
}

impl From<NoDrivenContour> for Failure {
    fn from(error: NoDrivenContour) -> Self {
        let help = match &error {
            NoDrivenContour::Axes(NoContour::NoAxis(unknown)) => unknown.help("its axes are"),
            NoDrivenContour::Unstable { .. } => {
                Some("check gains and masses of the plant".to_owned())
            }
            _ => None,
        };
        if let NoDrivenContour::Host(error) = error {
            return error.into();
        }
        let failure = Self::new(error.to_string());
        Self { help, ..failure }
    }
}
