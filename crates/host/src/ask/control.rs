//! A control that is asked: programs written for it, answers read and kept.

use std::fs;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::answers::read_answers;
use super::programs::{ask, readme};
use super::recording::{RecordedQuestions, read_recorded_answers};
use super::written::{AnsweredReading, date_of, with_findings};
use crate::disk::{CONFIG_NAME, FileRegistry, Replaces, read_text};
use crate::error::HostError;
use crate::machines::{LoadedMachine, is_configuration};
use crate::outputs::{MendedFile, OutputFiles, write_mended, write_new};
use frictcomp::comp::{AxisIndex, CncBuild, Kind};
use frictcomp::diagnostic::{Diagnostic, Severity, UnknownName};
use frictcomp::machine::Machine;
use frictcomp::readings::Question;
use frictcomp::text::shown_path;
use frictcomp_recordings::evidence::{
    Answer, AnswerVerdict, UnreadAnswer, contradicted, drop_answered,
};
use frictcomp_recordings::trace::ChannelSelection;

/// The usual distance that an axis may move, in mm or degrees.
pub const TRAVEL: f64 = 10.0;

/// Reason why a control cannot be asked: one sentence in lower case.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AskError {
    /// A machine whose description has errors.
    #[error("the description of the machine has errors")]
    Machine(Vec<Diagnostic>),
    /// A text without an answer that can be read.
    #[error("`{}` holds no answer", shown_path(.0))]
    NoAnswer(PathBuf),
    /// A file that is neither answers nor a recording.
    #[error(transparent)]
    Recording(Box<HostError>),
    /// Answers to the question of this rule that contradict each other.
    #[error("the answers to {0} contradict each other")]
    Contradiction(&'static str),
    /// A distance that is too short for a test, or too long for a careful one.
    #[error("no axis is tested within {0} mm or degrees")]
    Travel(f64),
    /// A file that answers cannot be kept in.
    #[error("`{}` is not a configuration: its name does not end in `.toml`", shown_path(.0))]
    NotAConfiguration(PathBuf),
    /// A configuration that is not valid TOML.
    #[error("{}: {reason}", shown_path(.path))]
    InvalidToml {
        /// Path of the file.
        path: PathBuf,
        /// The place, and what is wrong there.
        reason: String,
    },
}

impl AskError {
    /// What answers are.
    pub const ANSWERS: &str =
        "answers are lines that begin with `frictcomp-ask`, as in `message.txt`, or a recording";

    /// Returns the file at fault.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::NoAnswer(path)
            | Self::NotAConfiguration(path)
            | Self::InvalidToml { path, .. } => Some(path),
            _ => None,
        }
    }

    /// Returns the advice, unless it depends on the calling program.
    pub(crate) fn help(&self) -> Option<String> {
        let help = match self {
            Self::Contradiction(_) => {
                "give the files of one control, and one at a time to see which it is"
            }
            Self::NoAnswer(_) => Self::ANSWERS,
            Self::Travel(_) => "give a distance from 0.1 to 1000",
            Self::NotAConfiguration(_) => "name a `frictcomp.toml`",
            _ => return None,
        };
        Some(help.to_owned())
    }
}

/// A control that is asked.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AskedControl<'a> {
    /// Machine.
    pub loaded: &'a LoadedMachine,
    /// Build, if it is given.
    pub build: Option<CncBuild>,
}

/// The answers of a control.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ReadAnswers {
    /// The answers in the order of the questions.
    pub answers: Vec<Answer>,
    /// What they decide.
    decided: Vec<AnsweredReading>,
}

impl ReadAnswers {
    /// Whether something is decided that is not confirmed, because the build is not known.
    pub fn lacks_build(&self) -> bool {
        self.decided.iter().any(|it| it.build.is_none())
    }

    /// Writes what is decided into a configuration, which may be a new one; returns whether there was anything to write.
    ///
    /// # Errors
    /// The file is not a configuration, is not valid TOML, or cannot be written.
    pub fn keep(&self, configuration: &Path) -> Result<bool, HostError> {
        if self.decided.is_empty() {
            return Ok(false);
        }
        let path = configuration.to_owned();
        if !is_configuration(&path) {
            return Err(AskError::NotAConfiguration(path).into());
        }
        let is_new = !path.exists();
        let before = if is_new {
            String::new()
        } else {
            read_text(&path)?
        };
        let with_decided = with_findings(&before, &self.decided);
        let after = with_decided.map_err(|error| AskError::InvalidToml {
            path: path.clone(),
            reason: error.to_string(),
        })?;
        if is_new {
            write_new(&path, &after)?;
        } else {
            write_mended([&MendedFile {
                path,
                bytes: after.clone().into_bytes(),
                before,
                after,
                changes: self.decided.len(),
            }])?;
        }
        Ok(true)
    }
}

impl<'a> AskedControl<'a> {
    /// Asks a control whose machine is described without errors.
    ///
    /// # Errors
    /// The description has errors.
    pub fn new(loaded: &'a LoadedMachine, build: Option<CncBuild>) -> Result<Self, HostError> {
        let mut said = loaded.diagnostics.iter();
        if said.any(|it| it.severity == Severity::Error) {
            return Err(AskError::Machine(loaded.diagnostics.clone()).into());
        }
        Ok(Self { loaded, build })
    }

    /// Returns the build of the control.
    pub fn build(&self) -> Option<CncBuild> {
        self.build.or(self.loaded.machine.build)
    }

    /// Returns the configuration that keeps answers: that of the machine, or one in the current folder.
    pub fn configuration(&self) -> PathBuf {
        let own = self.loaded.origin.as_ref();
        let own = own.filter(|path| is_configuration(path));
        own.map_or_else(|| PathBuf::from(CONFIG_NAME), Clone::clone)
    }

    /// Returns the name of the axis that is asked: the given one, or that of the first with P-AXIS-00522 = 1.
    pub fn axis_name<'n>(&self, given: Option<&'n str>) -> &'n str
    where
        'a: 'n,
    {
        given.unwrap_or_else(|| self.usual_axis())
    }

    fn usual_axis(&self) -> &'a str {
        let mut axes = self.loaded.machine.axes.iter();
        let configured = axes.find(|axis| axis.configured.contains(Kind::Frict));
        configured.map_or("X", |axis| &axis.name)
    }

    /// Returns the axis of a name.
    ///
    /// # Errors
    /// The machine has no such axis.
    pub fn axis(&self, name: &str) -> Result<AskedAxis, HostError> {
        let machine = &self.loaded.machine;
        if machine.find(name).is_none() {
            let known = machine.axes.iter().map(|it| it.name.as_str());
            return Err(HostError::NoAxis(UnknownName::new(name, known)));
        }
        Ok(self.named(name))
    }

    fn named(&self, name: &str) -> AskedAxis {
        let machine = &self.loaded.machine;
        let found = machine.find(name);
        AskedAxis {
            name: name.to_owned(),
            number: found.and_then(|axis| machine.axis(axis).number),
            index: found.map_or(0, AxisIndex::get),
            build: self.build(),
            travel: TRAVEL,
        }
    }

    /// Writes the programs that ask the control, and a page for the operator, to a folder; returns the names of the
    /// programs.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(
        axis: &AskedAxis,
        folder: &Path,
        outputs: &mut OutputFiles,
    ) -> Result<Vec<String>, HostError> {
        let questions = Question::ALL.into_iter();
        let programs: Vec<_> = questions.flat_map(|it| ask(it, axis)).collect();
        let texts = programs.iter().map(|it| (it.name.as_str(), &it.text));
        for (name, text) in texts.chain([("README.txt", &readme(axis))]) {
            let path = folder.join(name);
            let mut file = outputs.create_in_folder("a program", &path, Replaces::Results)?;
            file.bytes(text.as_bytes())?;
        }
        Ok(programs.into_iter().map(|it| it.name).collect())
    }

    /// Reads answers; `unread` hears of lines that are marked as answers but cannot be read. In recordings the axis and
    /// the channels of `recorded` are read.
    ///
    /// # Errors
    /// A file cannot be read or holds no answer, or answers contradict each other.
    pub fn read(
        &self,
        files: &[PathBuf],
        recorded: &RecordedAnswers,
        (registry, mut unread): (&FileRegistry, impl FnMut(&UnreadAnswer)),
    ) -> Result<ReadAnswers, HostError> {
        let mut answers = Vec::new();
        let mut decided = Vec::new();
        for path in files {
            registry.reads("answers", path);
            let changed = fs::metadata(path).and_then(|it| it.modified());
            let date = date_of(changed.map_err(|error| HostError::read(path, error))?);
            for answer in self.answers_in(path, recorded, &mut unread)? {
                if let AnswerVerdict::Reading(reading) = answer.verdict {
                    let build = self.build.or(answer.build).or(self.loaded.machine.build);
                    decided.push(AnsweredReading {
                        question: answer.question,
                        reading,
                        build,
                        date: date.clone(),
                    });
                }
                answers.push(answer);
            }
        }
        if let Some(question) = contradicted(&answers) {
            return Err(AskError::Contradiction(question.facts().rule).into());
        }
        drop_answered(&mut answers);
        Ok(ReadAnswers { answers, decided })
    }

    /// Returns the answers in a file: lines of a text, or what a recording shows.
    fn answers_in(
        &self,
        path: &Path,
        recorded: &RecordedAnswers,
        unread: &mut impl FnMut(&UnreadAnswer),
    ) -> Result<Vec<Answer>, HostError> {
        let (answers, lines) = read_answers((path, &read_text(path)?), |name| self.named(name));
        lines.iter().for_each(&mut *unread);
        if !answers.is_empty() {
            return Ok(answers);
        }
        if !lines.is_empty() {
            return Err(AskError::NoAnswer(path.to_owned()).into());
        }
        let machine: &Machine = &self.loaded.machine;
        let axis = self.axis(&recorded.axis)?;
        let own = machine.axes.iter().find(|it| it.name == axis.name);
        let channels = recorded.channels.clone();
        let asked = RecordedQuestions {
            axis: &axis,
            machine,
            selection: &ChannelSelection {
                lead_mm: channels.lead_mm.or(own.and_then(|it| it.motor_lead_mm)),
                ..channels
            },
            cycle_s: recorded
                .cycle_s
                .or(machine.cycle_time_ms.map(|ms| ms / 1000.0)),
        };
        let read = read_recorded_answers(path, asked);
        Ok(read.map_err(|error| AskError::Recording(Box::new(error)))?)
    }
}

/// The axis and the channels of recordings that hold answers.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedAnswers {
    /// The name of the axis.
    pub axis: String,
    /// The channels named by the user.
    pub channels: ChannelSelection,
    /// The CNC cycle in s, if it is given.
    pub cycle_s: Option<f64>,
}

/// The axis under test.
#[derive(Debug, Clone)]
pub struct AskedAxis {
    /// Name.
    pub name: String,
    /// Logical number, P-AXIS-00016; without it axis exchange is not asked.
    pub number: Option<u32>,
    /// Place among the axes of the channel, from 0.
    pub index: usize,
    /// The build of the control.
    pub build: Option<CncBuild>,
    /// Permitted travel in mm or degrees, from the present position in the positive direction and
    /// back.
    pub travel: f64,
}

impl AskedAxis {
    /// Returns the axis with the distance that it may move, in mm or degrees.
    ///
    /// # Errors
    /// The distance is not one for a test.
    pub fn within(self, travel: f64) -> Result<Self, HostError> {
        if (0.1..=1000.0).contains(&travel) {
            return Ok(Self { travel, ..self });
        }
        Err(AskError::Travel(travel).into())
    }
}
