//! The machine of the programs, as Python describes it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use frictcomp::machine::{Machine, Setting};
use frictcomp::session::undescribed;
use frictcomp::text::shown_path;
use frictcomp_host::{
    ConfigurationChoice, FileRegistry, Input, LoadedMachine, MachineOptions, Machines,
    OutsidePolicy, UnusedAxes, Watcher, switched_axes,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::exceptions::refused;
use crate::failure::Failure;
use crate::program::GivenPrograms;
use crate::several::Several;

/// The machine that programs run on.
///
/// Without arguments it is described by the nearest ``frictcomp.toml``, from the folder of the
/// program upwards, as on the command line. ``config`` names another one, ``isolated`` uses none.
/// ``startup`` reads the axes from a start-up list or a TwinCAT project. ``enable`` assumes P-AXIS-00522 = 1 and an
/// accepted value list for axes. ``variables`` are values that only the machine knows,
/// ``{"V.E.PART": 3}``. ``allow_outside`` lets programs call others in any folder.
#[pyclass(frozen, name = "Machine", module = "frictcomp")]
pub(crate) struct PyMachine(MachineOptions);

/// The value of a variable.
enum VariableValue {
    Number(f64),
    Text(String),
}

impl<'py> FromPyObject<'_, 'py> for VariableValue {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let number = given.extract().map(Self::Number);
        number
            .or_else(|_| given.extract().map(Self::Text))
            .map_err(|_| PyTypeError::new_err("a value of `variables` is a number or a text"))
    }
}

#[pymethods]
impl PyMachine {
    #[new]
    #[pyo3(signature = (config=None, *, startup=None, isolated=false, enable=None, variables=None, allow_outside=false))]
    // Each is a separate argument in Python.
    #[allow(clippy::too_many_arguments)]
    fn new(
        config: Option<PathBuf>,
        startup: Option<PathBuf>,
        isolated: bool,
        enable: Option<Several<String>>,
        variables: Option<HashMap<String, VariableValue>>,
        allow_outside: bool,
    ) -> PyResult<Self> {
        let configuration = match (config, isolated) {
            (Some(_), true) => {
                return Err(refused(
                    "a machine has a `config` or is `isolated`, not both",
                ));
            }
            (Some(path), false) => ConfigurationChoice::File(path),
            (None, true) => ConfigurationChoice::Isolated,
            (None, false) => ConfigurationChoice::Nearest,
        };
        let mut options = MachineOptions {
            configuration,
            startup,
            enable: enable.map_or_else(Vec::new, |Several(axes)| axes),
            unused_axes: UnusedAxes::PassedOver,
            ..MachineOptions::default()
        };
        if allow_outside {
            options.outside_policy = OutsidePolicy::Allowed;
        }
        for (name, value) in variables.unwrap_or_default() {
            if !Setting::is_for(&name) {
                return Err(refused(format!(
                    "`variables`: `{name}` is not a variable; variables are, for example, `V.E.PART`, `P5` and `@P5`"
                )));
            }
            let value = match value {
                VariableValue::Number(number) if !number.is_finite() => {
                    return Err(refused(format!(
                        "the variable `{name}` cannot be {number}; leave out what is not known"
                    )));
                }
                VariableValue::Number(number) => Setting::Number(number),
                VariableValue::Text(text) => Setting::Text(text),
            };
            options.settings.push((name, value));
        }
        options.settings.sort_by(|one, other| one.0.cmp(&other.0));
        Ok(Self(options))
    }

    /// The machine whose lists a TwinCAT project holds: a ``.tsproj``, an ``.xti`` or an exported tree item.
    #[staticmethod]
    #[pyo3(signature = (project, *, enable=None, variables=None, allow_outside=false))]
    fn from_project(
        project: PathBuf,
        enable: Option<Several<String>>,
        variables: Option<HashMap<String, VariableValue>>,
        allow_outside: bool,
    ) -> PyResult<Self> {
        Self::new(None, Some(project), true, enable, variables, allow_outside)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        let MachineOptions {
            configuration,
            startup,
            enable,
            outside_policy,
            settings,
            ..
        } = &self.0;
        let config = match configuration {
            ConfigurationChoice::File(path) => Some(path),
            _ => None,
        };
        let variables = PyDict::new(py);
        for (name, value) in settings {
            match value {
                Setting::Number(number) => variables.set_item(name, number)?,
                Setting::Text(text) => variables.set_item(name, text)?,
            }
        }
        let given = PyDict::new(py);
        given.set_item("config", config)?;
        given.set_item("startup", startup)?;
        given.set_item("isolated", *configuration == ConfigurationChoice::Isolated)?;
        given.set_item("enable", enable)?;
        given.set_item("variables", variables)?;
        given.set_item("allow_outside", *outside_policy == OutsidePolicy::Allowed)?;
        Ok(((), given))
    }

    fn __repr__(&self) -> String {
        let described = match (&self.0.startup, &self.0.configuration) {
            (Some(path), _) | (None, ConfigurationChoice::File(path)) => {
                format!("'{}'", shown_path(path))
            }
            (None, ConfigurationChoice::Isolated) => "without a configuration".to_owned(),
            _ => "of the nearest frictcomp.toml".to_owned(),
        };
        format!("<frictcomp.Machine {described}>")
    }
}

/// The value of `machine=`: nothing, a `Machine`, a configuration or a start-up list.
pub(crate) fn machine_options(given: Option<&Bound<'_, PyAny>>) -> PyResult<MachineOptions> {
    let Some(given) = given else {
        return Ok(MachineOptions::default());
    };
    if let Ok(machine) = given.cast::<PyMachine>() {
        return Ok(machine.get().0.clone());
    }
    let path: PathBuf = given.extract().map_err(|_| {
        PyTypeError::new_err(
            "a machine is a `frictcomp.Machine`, or the path of a frictcomp.toml or of a start-up list",
        )
    })?;
    let mut options = MachineOptions::default();
    if is_configuration(&path) {
        options.configuration = ConfigurationChoice::File(path);
    } else {
        options.startup = Some(path);
    }
    Ok(options)
}

fn is_configuration(path: &Path) -> bool {
    let extension = path.extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// The machine of a session: that of its first program.
pub(crate) fn machine_of(
    options: MachineOptions,
    programs: &GivenPrograms,
    left: Vec<String>,
) -> Result<Arc<LoadedMachine>, Failure> {
    let mut machines = Machines::new(options, &FileRegistry::default());
    if !left.is_empty() {
        // Other runs of the same machine name the others.
        machines.expect_more(left);
    }
    of_first(machines, programs)
}

/// The machine of the current folder.
pub(crate) fn machine_here(
    options: MachineOptions,
    registry: &FileRegistry,
) -> Result<Arc<LoadedMachine>, Failure> {
    Ok(Machines::new(options, registry).for_folder(Path::new("."))?)
}

/// The machine of a program that is watched.
pub(crate) fn watched_machine_of(
    options: MachineOptions,
    programs: &GivenPrograms,
    watcher: Arc<dyn Watcher>,
) -> Result<Arc<LoadedMachine>, Failure> {
    let machines = Machines::new(options, &FileRegistry::default());
    of_first(machines.watched_by(watcher), programs)
}

fn of_first(machines: Machines, programs: &GivenPrograms) -> Result<Arc<LoadedMachine>, Failure> {
    let mut machines = machines.on_disk(&programs.disk);
    machines.look_ahead(&programs.inputs);
    let first = programs.inputs.first().expect("there is a program");
    Ok(machines.for_folder(first.folder())?)
}

/// The remark that no machine is described, if programs switch compensation without one (R1.37).
pub(crate) fn remark_without_machine<'a>(
    programs: impl IntoIterator<Item = &'a Input>,
) -> Option<String> {
    let axes = switched_axes(programs);
    if axes.is_empty() {
        return None;
    }
    Some(undescribed(&Machine::unconfigured(), &axes)?.to_string())
}
