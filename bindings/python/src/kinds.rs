//! Kinds of compensation, as Python names them.

use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::UnknownName;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::exceptions::refused;
use crate::several::Several;

/// `"FRICT"`, `"all"`, or several kinds.
pub(crate) enum Kinds {
    /// One word.
    One(String),
    /// Several.
    Several(Several<String>),
}

impl<'py> FromPyObject<'_, 'py> for Kinds {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let one = given.extract().map(Self::One);
        one.or_else(|_| given.extract().map(Self::Several))
            .map_err(|_| {
                let kinds = Kind::ALL.map(Kind::as_str).join(", ");
                PyTypeError::new_err(format!(
                    "`kinds` is one kind, several, or \"all\"; kinds are {kinds}"
                ))
            })
    }
}

impl Kinds {
    /// The kinds, by default friction compensation.
    pub(crate) fn of(given: Option<Self>) -> PyResult<KindSet> {
        given.map_or(Ok(KindSet::of(Kind::Frict)), |kinds| kinds.set())
    }

    fn set(&self) -> PyResult<KindSet> {
        match self {
            Self::One(word) if word.eq_ignore_ascii_case("all") => Ok(KindSet::ALL),
            Self::One(word) => word.split(',').map(kind).collect(),
            Self::Several(Several(words)) => words.iter().map(|word| kind(word)).collect(),
        }
    }
}

fn kind(word: &str) -> PyResult<Kind> {
    let word = word.trim();
    word.parse().map_err(|_| {
        let unknown = UnknownName::new(word, Kind::ALL.iter().map(|kind| kind.as_str()));
        let help = unknown.help("kinds are").unwrap_or_default();
        refused(format!("`{word}` is not a kind of compensation; {help}"))
    })
}
