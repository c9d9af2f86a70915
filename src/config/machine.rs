//! The tables `[machine]`, `[reading]` and `[confirmed]` of `frictcomp.toml` (R15.2).

use super::error::ConfigError;
use super::section::{Section, Shape};
use crate::comp::{CncBuild, NoBuild};
use crate::lists::Given;
use crate::readings::{Confirmation, Question, Readings};
use crate::syntax::SkipLevels;

/// Contents of `[machine]`.
#[derive(Debug, Clone, Default)]
pub(crate) struct MachineTable {
    /// The start-up list or the project that describes the axes.
    pub(crate) axes: Option<Given<String>>,
    /// The CNC cycle in milliseconds.
    pub(crate) cycle_time_ms: Option<f64>,
    /// The kernel version.
    pub(crate) build: Option<CncBuild>,
    /// The folders of called programs.
    pub(crate) program_dirs: Vec<String>,
    /// The program that runs before every main program.
    pub(crate) start_program: Option<Given<String>>,
    /// The program that runs before the end of every main program.
    pub(crate) end_program: Option<Given<String>>,
    /// Words and the programs that they call, `[machine.programs]`.
    pub(crate) words: Vec<(String, Given<String>)>,
    /// Patterns of programs that only the machine has.
    pub(crate) external: Vec<String>,
    /// Patterns of those that keep compensation states, `[machine.external_keeps]`.
    pub(crate) keep_compensation: Vec<String>,
    /// Patterns of those that keep positions.
    pub(crate) keep_positions: Vec<String>,
    /// Patterns of those that write neither parameters nor variables.
    pub(crate) external_parameters: Vec<String>,
    /// Words of the shop that change nothing.
    pub(crate) harmless: Vec<Given<String>>,
    /// Whether P parameters outlive a program.
    pub(crate) keep_parameters: bool,
    /// The skip levels that are on.
    pub(crate) skip: Option<SkipLevels>,
}

pub(super) const MACHINE: Shape = Shape {
    name: "[machine]",
    keys: Some(&[
        "startup",
        "project",
        "cycle_time_ms",
        "cnc_build",
        "program_dirs",
        "start_program",
        "end_program",
        "keep_parameters",
        "skip",
        "programs",
        "external",
        "external_keeps",
        "harmless",
    ]),
};

pub(super) const EXTERNAL_KEEPS: Shape = Shape {
    name: "[machine.external_keeps]",
    keys: Some(&["compensation", "positions", "parameters"]),
};

pub(super) const WORDS: Shape = Shape {
    name: "[machine.programs]",
    keys: None,
};

impl MachineTable {
    /// Reads the table from the whole file; a missing table is not an error.
    pub(super) fn read(root: &Section<'_>) -> Result<Self, ConfigError> {
        let Some(section) = root.table("machine", &MACHINE)? else {
            return Ok(Self::default());
        };
        let dirs = section.strings("program_dirs")?;
        let mut table = Self {
            axes: axes(&section)?,
            cycle_time_ms: section.positive("cycle_time_ms")?,
            build: build(&section)?,
            program_dirs: dirs.into_iter().map(|dir| dir.value).collect(),
            start_program: section.string("start_program")?,
            end_program: section.string("end_program")?,
            words: words(&section)?,
            harmless: section.strings("harmless")?,
            keep_parameters: section
                .truth("keep_parameters")?
                .is_some_and(|given| given.value),
            skip: section.skip_levels("skip")?,
            ..Self::default()
        };
        let patterns = section.strings("external")?;
        table.external = patterns.into_iter().map(|given| given.value).collect();
        if let Some(keeps) = section.table("external_keeps", &EXTERNAL_KEEPS)? {
            table.keep_compensation = kept(&keeps, "compensation", &table.external)?;
            table.keep_positions = kept(&keeps, "positions", &table.external)?;
            table.external_parameters = kept(&keeps, "parameters", &table.external)?;
        }
        Ok(table)
    }
}

/// Reads the file that describes the axes: a start-up list, or a project (R3.42).
fn axes(section: &Section<'_>) -> Result<Option<Given<String>>, ConfigError> {
    match (section.string("startup")?, section.string("project")?) {
        (Some(_), Some(project)) => {
            let message = "a machine has a `startup` list or a `project`, not both";
            Err(ConfigError::at(&project, message.to_owned()))
        }
        (startup, project) => Ok(startup.or(project)),
    }
}

fn build(section: &Section<'_>) -> Result<Option<CncBuild>, ConfigError> {
    let Some(build) = section.string("cnc_build")? else {
        return Ok(None);
    };
    let refused = |error: NoBuild| ConfigError::at(&build, error.to_string());
    build.value.parse().map(Some).map_err(refused)
}

fn words(section: &Section<'_>) -> Result<Vec<(String, Given<String>)>, ConfigError> {
    let mut words = Vec::new();
    if let Some(programs) = section.table("programs", &WORDS)? {
        for name in programs.names() {
            if let Some(program) = programs.string(name.value)? {
                words.push((name.value.to_owned(), program));
            }
        }
    }
    Ok(words)
}

/// Returns the programs that keep something: all that exist only on the machine, none, or those
/// that match.
fn kept(keeps: &Section<'_>, key: &str, all: &[String]) -> Result<Vec<String>, ConfigError> {
    if let Ok(on) = keeps.truth(key) {
        let all = on.filter(|on| on.value).map(|_| all.to_vec());
        return Ok(all.unwrap_or_default());
    }
    let patterns = keeps.strings(key)?;
    Ok(patterns.into_iter().map(|given| given.value).collect())
}

pub(super) const READING: Shape = Shape {
    name: "[reading]",
    keys: None,
};

pub(super) const CONFIRMED: Shape = Shape {
    name: "[confirmed]",
    keys: None,
};

pub(super) const CONFIRMATION: Shape = Shape {
    name: "an answer of [confirmed]",
    keys: Some(&["build", "date"]),
};

/// Reads the selected reading of each open question.
pub(super) fn selected_readings(root: &Section<'_>) -> Result<Readings, ConfigError> {
    let mut readings = Readings::default();
    if let Some(section) = root.table("reading", &READING)? {
        for key in section.names() {
            let question = question(&section, &key)?;
            let Some(name) = section.string(key.value)? else {
                continue;
            };
            let reading = question.reading(&name.value);
            let reading = reading.ok_or_else(|| no_reading(question, &name))?;
            readings.select(question, reading);
        }
    }
    if let Some(section) = root.table("confirmed", &CONFIRMED)? {
        for key in section.names() {
            let question = question(&section, &key)?;
            if let Some(answer) = section.table(key.value, &CONFIRMATION)? {
                readings.confirm(question, confirmation(&answer)?);
            }
        }
    }
    Ok(readings)
}

fn question(section: &Section<'_>, key: &Given<&str>) -> Result<Question, ConfigError> {
    if let Some(question) = Question::of_rule(key.value) {
        return Ok(question);
    }
    let is_quoted = key.value.contains('.');
    if let Some((dotted, value)) = section.dotted(key.value).filter(|_| !is_quoted) {
        let error = ConfigError::at(key, format!("the rule `{dotted}` has no quotes"));
        return Err(error.with_help(format!("write `\"{dotted}\" = {value}`")));
    }
    let rules = Question::ALL.map(|question| question.facts().rule);
    let error = ConfigError::at(key, format!("no open question belongs to `{}`", key.value));
    let error = error.with_near(key.value, rules);
    Err(error.with_help(format!("the questions are those of {}", rules.join(", "))))
}

fn no_reading(question: Question, name: &Given<String>) -> ConfigError {
    let facts = question.facts();
    let [first, second] = facts.readings;
    let message = format!("`{}` is not a reading of {}", name.value, facts.rule);
    let error = ConfigError::at(name, message).with_near(&name.value, facts.readings);
    error.with_help(format!("its readings are `{first}` and `{second}`"))
}

fn confirmation(answer: &Section<'_>) -> Result<Confirmation, ConfigError> {
    let missing = |key: &str| {
        ConfigError::at(&answer.whole(), format!("`{key}` is missing"))
            .with_help("write `{ build = \"3.1.3081.5\", date = \"2026-01-31\" }`")
    };
    let build = answer.string("build")?.ok_or_else(|| missing("build"))?;
    let refused = |error: NoBuild| ConfigError::at(&build, error.to_string());
    let parsed = build.value.parse().map_err(refused)?;
    let date = answer.string("date")?.ok_or_else(|| missing("date"))?;
    Ok(Confirmation {
        build: parsed,
        date: date.value,
    })
}
