//! A case as its file describes it.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;
use toml::{Table, Value};

use super::cycles::{ExpectedCycles, WrittenCycles};
use frictcomp::comp::{Kind, State};
use frictcomp::readings::{Alternative, Question};
use frictcomp::text::shown_path;

/// Reason why a case cannot be run.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}: {message}", shown_path(.file))]
#[non_exhaustive]
pub struct CaseError {
    /// The file of the case.
    pub file: PathBuf,
    /// Fault in words.
    pub message: String,
}

/// A program or list of a case.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct CaseFile {
    /// Name, used in calls and lists.
    pub name: String,
    /// Text.
    pub text: String,
}

/// Moment at which a state is examined.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Moment {
    /// Moment after the last execution of the block that begins on this line.
    Line(u32),
    /// Moment after the end of the program.
    End,
}

impl fmt::Display for Moment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "{line}"),
            Self::End => f.write_str("end"),
        }
    }
}

/// Expectation at one point.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Expectation {
    /// The state of a kind on an axis.
    State {
        /// The file with the block, or the main program that ends.
        program: String,
        /// Moment of the examination.
        after: Moment,
        /// Name of the axis.
        axis: String,
        /// The kind.
        kind: Kind,
        /// The state.
        state: State,
    },
    /// A refusal by the control.
    Refusal {
        /// The error number; `error` where no document gives one.
        code: String,
        /// The file and the line, where the case gives them.
        at: Option<(String, u32)>,
    },
    /// The additive current at a constant velocity, long after the last reversal (chapter 4).
    Current {
        /// Name of the axis.
        axis: String,
        /// Velocity in units of the list, µm/s or 0.001°/s.
        velocity: f64,
        /// Current in drive units.
        current: f64,
    },
    /// The additive currents of a commanded motion, cycle by cycle (chapter 4).
    Currents(ExpectedCycles),
}

/// One case.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Case {
    /// File.
    pub file: PathBuf,
    /// Chapter and name, `1/off`.
    pub name: String,
    /// The rule under test.
    pub rule: String,
    /// The document on which it is based; `None` where it is assumed.
    pub source: Option<String>,
    /// Subject in one sentence.
    pub about: String,
    /// Programs and lists.
    pub files: Vec<CaseFile>,
    /// Sequence of the run: names of programs, `reset` and `restart`.
    pub run: Vec<String>,
    /// The machine as a `frictcomp.toml`.
    pub machine: String,
    /// Expectations in any case.
    pub expected: Vec<Expectation>,
    /// Expectations under each reading, where the documents leave it open.
    pub readings: Vec<(Alternative, Vec<Expectation>)>,
}

/// Events between two programs.
pub(super) const BETWEEN: [&str; 2] = ["reset", "restart"];

/// The tables of a `frictcomp.toml` in a case.
const MACHINE: [&str; 3] = ["machine", "axis", "variables"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CaseText {
    rule: String,
    source: Option<String>,
    #[serde(default)]
    assumed: bool,
    about: String,
    #[serde(default)]
    file: Vec<CaseFile>,
    #[serde(default)]
    run: Vec<String>,
    #[serde(default)]
    expect: Vec<WrittenExpectation>,
    #[serde(default)]
    reading: BTreeMap<String, WrittenReading>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenReading {
    expect: Vec<WrittenExpectation>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenExpectation {
    program: Option<String>,
    after: Option<WrittenMoment>,
    axis: Option<String>,
    kind: Option<String>,
    state: Option<String>,
    refused: Option<String>,
    at: Option<u32>,
    velocity: Option<f64>,
    current: Option<f64>,
    positions: Option<Vec<f64>>,
    velocities: Option<Vec<f64>>,
    comp: Option<Vec<bool>>,
    currents: Option<Vec<f64>>,
    outputs: Option<Vec<i16>>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum WrittenMoment {
    Line(u32),
    Word(String),
}

/// Returns the files of cases in a folder and its chapters, sorted.
///
/// # Errors
/// The folder cannot be read.
pub fn find_cases(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            found.extend(toml_files(&path)?);
        } else if is_toml(&path) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn toml_files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.collect::<std::io::Result<Vec<_>>>()?;
    let paths = entries.into_iter().map(|entry| entry.path());
    Ok(paths.filter(|path| is_toml(path)).collect())
}

fn is_toml(path: &Path) -> bool {
    path.extension().is_some_and(|it| it == "toml")
}

/// Returns what is wrong with the TOML of a case, with the line where it is known.
fn in_words(text: &str, error: &toml::de::Error) -> String {
    let message = error.message();
    match error.span().and_then(|span| text.get(..span.start)) {
        Some(before) => format!("line {}: {message}", before.matches('\n').count() + 1),
        None => message.to_owned(),
    }
}

impl Case {
    /// Reads a case.
    ///
    /// # Errors
    /// The file cannot be read, is not valid TOML, or has a key or value that no case has.
    pub fn read(file: &Path) -> Result<Self, CaseError> {
        let text = fs::read_to_string(file).map_err(|error| error.to_string());
        let case = text.and_then(|text| Self::parse(file, &text));
        case.map_err(|message| CaseError {
            file: file.to_owned(),
            message,
        })
    }

    fn parse(file: &Path, text: &str) -> Result<Self, String> {
        let mut table: Table = text.parse().map_err(|error| in_words(text, &error))?;
        let of_machine = MACHINE.iter().filter_map(|key| table.remove_entry(*key));
        let machine: Table = of_machine.collect();
        let machine = toml::to_string(&machine).map_err(|error| error.to_string())?;
        let written: CaseText = Value::Table(table)
            .try_into()
            .map_err(|error| in_words(text, &error))?;
        if written.source.is_some() == (written.assumed || !written.reading.is_empty()) {
            return Err("a case has `source`, or `assumed = true`, or `[reading.…]`".to_owned());
        }
        let last = written.run.iter().rfind(|it| !is_between(it));
        let last = last.cloned().unwrap_or_default();
        let expected = expectations(written.expect, &last)?;
        let question = Question::of_rule(&written.rule);
        let mut readings = Vec::new();
        for (name, reading) in written.reading {
            let known = question.and_then(|question| question.reading(&name));
            let known = known.ok_or_else(|| format!("{} has no reading `{name}`", written.rule))?;
            readings.push((known, expectations(reading.expect, &last)?));
        }
        if !readings.is_empty() && readings.len() != 2 {
            return Err("an open question has both readings".to_owned());
        }
        for name in written.run.iter().filter(|name| !is_between(name)) {
            if !written.file.iter().any(|file| file.name == *name) {
                return Err(format!("there is no file `{name}` to run"));
            }
        }
        Ok(Self {
            name: name_of(file),
            file: file.to_owned(),
            rule: written.rule,
            source: written.source,
            about: written.about,
            files: written.file,
            run: written.run,
            machine,
            expected,
            readings,
        })
    }

    /// Returns the question that the case leaves open.
    pub fn question(&self) -> Option<Question> {
        Question::of_rule(&self.rule).filter(|_| !self.readings.is_empty())
    }
}

pub(super) fn is_between(step: &str) -> bool {
    BETWEEN.contains(&step)
}

/// Returns the folder and the file without its extension.
fn name_of(file: &Path) -> String {
    let part = |path: Option<&std::ffi::OsStr>| {
        path.map_or(String::new(), |it| it.to_string_lossy().into_owned())
    };
    let chapter = part(file.parent().and_then(Path::file_name));
    format!("{chapter}/{}", part(file.file_stem()))
}

fn expectations(written: Vec<WrittenExpectation>, last: &str) -> Result<Vec<Expectation>, String> {
    written.into_iter().map(|it| it.lower(last)).collect()
}

impl WrittenExpectation {
    fn lower(self, last: &str) -> Result<Expectation, String> {
        match self {
            Self {
                refused: Some(code),
                program,
                at,
                axis: None,
                ..
            } => Ok(Expectation::Refusal {
                code,
                at: at.map(|line| (program.unwrap_or_else(|| last.to_owned()), line)),
            }),
            Self {
                axis: Some(axis),
                velocity: Some(velocity),
                current: Some(current),
                ..
            } => Ok(Expectation::Current {
                axis,
                velocity,
                current,
            }),
            Self {
                axis: Some(axis),
                positions: Some(positions),
                velocities: Some(velocities),
                currents: Some(currents),
                comp,
                outputs,
                ..
            } => ExpectedCycles::new(
                axis,
                WrittenCycles {
                    positions,
                    velocities,
                    comp,
                    currents,
                    outputs,
                },
            )
            .map(Expectation::Currents),
            Self {
                axis: Some(axis),
                after: Some(after),
                state: Some(state),
                program,
                kind,
                ..
            } => Ok(Expectation::State {
                program: program.unwrap_or_else(|| last.to_owned()),
                after: moment(&after)?,
                axis,
                kind: kind.map_or(Ok(Kind::Frict), |kind| {
                    kind.parse().map_err(|_| format!("`{kind}` is not a kind"))
                })?,
                state: state_of(&state)?,
            }),
            _ => Err(
                "an expectation has `after`, `axis` and `state`, or `refused`, or `axis`, `velocity` and \
                 `current`, or `axis`, `positions`, `velocities` and `currents`"
                    .to_owned(),
            ),
        }
    }
}

fn moment(written: &WrittenMoment) -> Result<Moment, String> {
    match written {
        WrittenMoment::Line(line) => Ok(Moment::Line(*line)),
        WrittenMoment::Word(word) if word == "end" => Ok(Moment::End),
        WrittenMoment::Word(word) => Err(format!("`{word}` is neither a line nor `end`")),
    }
}

fn state_of(word: &str) -> Result<State, String> {
    let all = [
        State::Active,
        State::Ineffective,
        State::Inactive,
        State::Unconfigured,
        State::Unknown,
    ];
    let found = all.into_iter().find(|state| state.as_str() == word);
    found.ok_or_else(|| format!("`{word}` is not a state"))
}

impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::State {
                program,
                after,
                axis,
                kind,
                state,
            } => write!(
                f,
                "{axis} {kind} {} after {program}:{after}",
                state.as_str()
            ),
            Self::Refusal { code, at: None } => write!(f, "refused with {code}"),
            Self::Refusal {
                code,
                at: Some((program, line)),
            } => write!(f, "refused with {code} at {program}:{line}"),
            Self::Current {
                axis,
                velocity,
                current,
            } => write!(f, "{axis} {current} drive units at velocity {velocity}"),
            Self::Currents(cycles) => cycles.fmt(f),
        }
    }
}
