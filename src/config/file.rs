//! The whole `frictcomp.toml`.

use std::sync::Arc;

use toml::de::DeTable;

use super::machine::{
    AXIS, AxisTable, MACHINE, MachineTable, VALUE, one_more_axis, selected_readings,
};
use super::section::{ConfigError, Section, Shape, no_toml};
use crate::diagnostic::{Code, Levels, NamedFix, Severity};
use crate::lists::{Given, Written};
use crate::readings::Readings;
use crate::text::SourceFile;

/// Contents of `frictcomp.toml`.
#[derive(Debug, Clone)]
pub(crate) struct ConfigFile {
    /// `[machine]`.
    pub(crate) machine: MachineTable,
    /// `[[axis]]`.
    pub(crate) axes: Vec<AxisTable>,
    /// The change that adds an axis.
    pub(crate) one_more_axis: Option<NamedFix>,
    /// `[variables]`.
    pub(crate) variables: Vec<(String, ConfiguredVariable)>,
    /// Variables of the machine that keep their values while a program runs.
    pub(crate) stable: Vec<String>,
    /// `V.E.` variables that only programs write.
    pub(crate) own: Vec<String>,
    /// `[lint]`.
    pub(crate) levels: Levels,
    /// The extensions of programs in `[check]`, in lower case and without a dot.
    pub(crate) extensions: Vec<String>,
    /// Patterns of files and folders that are no programs, in `[check]`.
    pub(crate) exclude: Vec<String>,
    /// `[reading]` and `[confirmed]`.
    pub(crate) readings: Readings,
}

/// The value of a variable.
#[derive(Debug, Clone)]
pub(crate) enum ConfiguredVariable {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

/// The whole file.
pub(super) const ROOT: Shape = Shape {
    name: "frictcomp.toml",
    keys: Some(&[
        "machine",
        "axis",
        "variables",
        "lint",
        "check",
        "reading",
        "confirmed",
    ]),
};

/// Keys of `[variables]` that are not variables: lists of names, with the family of their variables.
const NAMES: [(&str, &str); 2] = [("stable", "V."), ("own", "V.E.")];

pub(super) const VARIABLES: Shape = Shape {
    name: "[variables]",
    keys: None,
};

pub(super) const LINT: Shape = Shape {
    name: "[lint]",
    keys: None,
};

pub(super) const CHECK: Shape = Shape {
    name: "[check]",
    keys: Some(&["extensions", "exclude"]),
};

impl ConfigFile {
    /// Parses the file itself; the lists that it names are not read.
    pub(crate) fn parse(source: &Arc<SourceFile>) -> Result<Self, ConfigError> {
        let table = DeTable::parse(source.text());
        let table = table.map_err(|error| no_toml(source, &error))?;
        let table = table.get_ref();
        let root = Section::new(table, source, &ROOT);
        let root = root.map_err(|error| at_home(error, table))?;
        Ok(Self {
            machine: MachineTable::read(&root)?,
            variables: variables(&root)?,
            stable: names(&root, NAMES[0])?,
            own: names(&root, NAMES[1])?,
            levels: levels(&root)?,
            extensions: extensions(&root)?,
            exclude: exclude(&root)?,
            readings: selected_readings(&root)?,
            axes: AxisTable::read_all(&root)?,
            one_more_axis: one_more_axis(&root),
        })
    }
}

/// Adds to the error about a key above all tables which of them it belongs in.
fn at_home(error: ConfigError, table: &DeTable<'_>) -> ConfigError {
    let unknown = ROOT.first_unknown(table);
    let unknown = unknown.map(|key| key.get_ref().as_ref());
    let has = |shape: &&&Shape| {
        shape
            .keys
            .is_some_and(|keys| unknown.is_some_and(|it| keys.contains(&it)))
    };
    let mut homes = [&MACHINE, &AXIS, &VALUE, &CHECK].iter().filter(has);
    match homes.next() {
        Some(home) => error.with_help(format!("write it below the header `{}`", home.name)),
        None => error,
    }
}

/// Reads the extensions of programs, in lower case and without a dot.
fn extensions(root: &Section<'_>) -> Result<Vec<String>, ConfigError> {
    let Some(check) = root.table("check", &CHECK)? else {
        return Ok(Vec::new());
    };
    let extension = |given: Given<String>| {
        let text = given.value.trim_start_matches('.').to_ascii_lowercase();
        let is_one = !text.is_empty() && !text.contains(['.', '/', '\\', '*', ' ']);
        if is_one {
            return Ok(text);
        }
        let message = format!("`{}` is not a file extension", given.value);
        Err(ConfigError::at(&given, message).with_help("write `extensions = [\"nc\", \"spf\"]`"))
    };
    let given = check.strings("extensions")?;
    given.into_iter().map(extension).collect()
}

/// Reads the patterns of files and folders that are no programs (R18.5).
fn exclude(root: &Section<'_>) -> Result<Vec<String>, ConfigError> {
    let Some(check) = root.table("check", &CHECK)? else {
        return Ok(Vec::new());
    };
    let given = check.strings("exclude")?;
    Ok(given.into_iter().map(|given| given.value).collect())
}

/// Reads the variables of the machine that keep their values while a program runs (R14.1), or that only programs
/// write (R2.99).
fn names(root: &Section<'_>, (key, family): (&str, &str)) -> Result<Vec<String>, ConfigError> {
    let Some(variables) = root.table("variables", &VARIABLES)? else {
        return Ok(Vec::new());
    };
    let name = |given: Given<String>| {
        let is_one = given
            .value
            .get(..family.len())
            .is_some_and(|it| it.eq_ignore_ascii_case(family));
        if is_one {
            return Ok(given.value);
        }
        let message = format!("`{}` is not a variable of the machine", given.value);
        Err(ConfigError::at(&given, message).with_help(format!(
            "write `{key} = [\"V.E.PART\"]`, the names without a value"
        )))
    };
    variables.strings(key)?.into_iter().map(name).collect()
}

fn variables(root: &Section<'_>) -> Result<Vec<(String, ConfiguredVariable)>, ConfigError> {
    let Some(variables) = root.table("variables", &VARIABLES)? else {
        return Ok(Vec::new());
    };
    let mut found = Vec::new();
    let is_list = |name: &str| NAMES.iter().any(|(key, _)| *key == name);
    for name in variables.names().filter(|name| !is_list(name.value)) {
        let variable = match variables.number(name.value) {
            Some(Given {
                value:
                    Written {
                        number: Some(number),
                        ..
                    },
                ..
            }) => ConfiguredVariable::Number(number.to_f64()),
            _ => match variables.string(name.value) {
                Ok(Some(text)) => ConfiguredVariable::Text(text.value),
                _ => return Err(no_variable(&variables, &name)),
            },
        };
        found.push((name.value.to_owned(), variable));
    }
    Ok(found)
}

/// Reports a variable that is neither a number nor a text; most often its name lacks the quotes, so
/// that TOML takes its parts for tables.
fn no_variable(variables: &Section<'_>, name: &Given<&str>) -> ConfigError {
    match variables.dotted(name.value) {
        Some((dotted, value)) => {
            ConfigError::at(name, format!("the name `{dotted}` has no quotes"))
                .with_help(format!("write `\"{dotted}\" = {value}`"))
        }
        None => ConfigError::at(
            name,
            format!("`{}` is neither a number nor a text", name.value),
        )
        .with_help(format!("write `\"{}\" = 3` or `= \"TEXT\"`", name.value)),
    }
}

fn levels(root: &Section<'_>) -> Result<Levels, ConfigError> {
    let mut levels = Levels::default();
    let Some(lint) = root.table("lint", &LINT)? else {
        return Ok(levels);
    };
    for name in lint.names() {
        let Ok(code) = name.value.parse::<Code>() else {
            let message = format!("there is no diagnostic `{}`", name.value);
            let known = Code::ALL.iter().map(|code| code.as_str());
            return Err(ConfigError::at(&name, message).with_near(name.value, known));
        };
        let Some(word) = lint.string(name.value)? else {
            continue;
        };
        let level = match word.value.as_str() {
            "off" => None,
            "info" => Some(Severity::Info),
            "warning" => Some(Severity::Warning),
            "error" => Some(Severity::Error),
            other => {
                let message = format!("`{other}` is not a severity");
                return Err(ConfigError::at(&word, message)
                    .with_near(other, ["off", "info", "warning", "error"])
                    .with_help("write `off`, `info`, `warning` or `error`"));
            }
        };
        if !levels.set(code, level) {
            let message =
                format!("{code} is an error of the control; its severity cannot be changed");
            return Err(ConfigError::at(&name, message)
                .with_help("only codes that begin with `FC` may be changed"));
        }
    }
    Ok(levels)
}
