//! Programs, as Python names them: paths and texts.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use frictcomp::text::shown_path;
use frictcomp_host::decode;
use frictcomp_host::{Disk, FoundPrograms, Input, Machines, OpenText, find_programs};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyFrozenSet, PySet, PyString};

use crate::failure::Failure;

/// The name of a text that does not represent a file.
const NAMELESS: &str = "<text>";

/// The text of a program, instead of a file.
///
/// ``path`` names the file that it represents: called programs and the configuration are looked for
/// from its folder, and messages name it. Bytes are decoded like a file: UTF-8, UTF-16 with its
/// mark, otherwise code page 1252.
#[pyclass(frozen, name = "Text", module = "frictcomp")]
pub(crate) struct PyText(OpenText);

#[pymethods]
impl PyText {
    #[new]
    #[pyo3(signature = (text, path=None))]
    fn new(text: &Bound<'_, PyAny>, path: Option<PathBuf>) -> PyResult<Self> {
        let text = match text.cast::<PyBytes>() {
            Ok(bytes) => decode(bytes.as_bytes().to_vec()),
            Err(_) => text.extract()?,
        };
        Ok(Self(OpenText {
            path: path.unwrap_or_else(|| NAMELESS.into()),
            text: Arc::new(text),
        }))
    }

    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }

    #[getter]
    fn path(&self) -> String {
        shown_path(&self.0.path)
    }

    fn __getnewargs__(&self) -> (&str, String) {
        (&self.0.text, self.path())
    }

    fn __repr__(&self) -> String {
        format!("<frictcomp.Text '{}'>", self.path())
    }
}

/// The programs that were given.
pub(crate) struct GivenPrograms {
    pub(crate) inputs: Vec<Input>,
    /// The disk with the texts among them, so that one may call another.
    pub(crate) disk: Disk,
}

impl GivenPrograms {
    /// One program, or a list of them.
    pub(crate) fn of(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        let inputs = inputs(given)?;
        if inputs.is_empty() {
            return Err(Failure::new("no program was given")
                .with_help("name a program, or a list of them")
                .into_error(given.py()));
        }
        let texts = inputs.iter().filter_map(|input| match input {
            Input::Open(open) => Some(open.clone()),
            _ => None,
        });
        let disk = Disk::with_open(texts);
        Ok(Self { inputs, disk })
    }

    /// Programs that run in the given order.
    pub(crate) fn in_order(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        if given.is_instance_of::<PySet>() || given.is_instance_of::<PyFrozenSet>() {
            return Err(PyTypeError::new_err(
                "a set has no order, and each program runs in the state that the one before it leaves: give a list",
            ));
        }
        Self::of(given)
    }

    /// Exactly one program.
    pub(crate) fn one(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        let programs = Self::of(given)?;
        if programs.inputs.len() > 1 {
            return Err(Failure::new("several programs were given")
                .with_help("give one program")
                .into_error(given.py()));
        }
        Ok(programs)
    }

    /// The programs, including those of the folders, each once; and the paths that gave no program.
    pub(crate) fn found(self, machines: &mut Machines) -> FoundPrograms {
        let mut found = FoundPrograms::default();
        for input in self.inputs {
            match input {
                Input::File(path) => {
                    let below = find_programs(&[path], |folder| machines.selection(folder));
                    found.inputs.extend(below.inputs);
                    found.failures.extend(below.failures);
                    found.left_out.files.extend(below.left_out.files);
                }
                text => found.inputs.push(text),
            }
        }
        let mut seen = BTreeSet::new();
        found.inputs.retain(|input| seen.insert(input.clone()));
        found
    }

    /// Names a program that cannot be run, before any of them is.
    pub(crate) fn probe(&self) -> Result<(), Failure> {
        for input in &self.inputs {
            input.probe().map_err(|error| match input {
                Input::File(path) if looks_like_a_text(&path.to_string_lossy()) => {
                    Failure::from(error).with_help("give the text of a program as `frictcomp.Text`")
                }
                _ => error.into(),
            })?;
        }
        Ok(())
    }
}

fn inputs(given: &Bound<'_, PyAny>) -> PyResult<Vec<Input>> {
    let is_one = given.is_instance_of::<PyString>() || given.is_instance_of::<PyBytes>();
    // A file is iterable, too: over its lines.
    let is_file = given.hasattr("read")?;
    match given.try_iter() {
        Ok(several) if !is_one && !is_file => several.map(|it| input(&it?)).collect(),
        _ => Ok(vec![input(given)?]),
    }
}

/// A path, or a text: bytes, or `Text`.
fn input(given: &Bound<'_, PyAny>) -> PyResult<Input> {
    let nameless = |text: String| {
        Input::Open(OpenText {
            path: NAMELESS.into(),
            text: Arc::new(text),
        })
    };
    if let Ok(text) = given.cast::<PyText>() {
        return Ok(Input::Open(text.get().0.clone()));
    }
    if let Ok(bytes) = given.cast::<PyBytes>() {
        return Ok(nameless(decode(bytes.as_bytes().to_vec())));
    }
    if given.is_instance_of::<PyString>() && given.extract::<String>()?.contains(['\n', '\r']) {
        return Err(Failure::new("a path has no line ends")
            .with_help("give the text of a program as `frictcomp.Text`")
            .into_error(given.py()));
    }
    let path: PathBuf = given.extract().map_err(|_| {
        let class = given.get_type();
        let name = class
            .name()
            .map_or_else(|_| "this".into(), |it| it.to_string());
        PyTypeError::new_err(format!(
            "a program is a path, bytes or `frictcomp.Text`, not `{name}`"
        ))
    })?;
    Ok(Input::File(path))
}

/// Returns whether a path that leads nowhere may have been meant as a text.
fn looks_like_a_text(path: &str) -> bool {
    path.contains(['[', '%', ';']) || path.contains("M30")
}
