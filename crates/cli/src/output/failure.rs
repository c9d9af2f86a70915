//! Failures of the tool in its work or in a part of it; the other parts are done nevertheless (R9.77).

use std::io;
use std::path::Path;

use super::console::Console;
use super::exit;
use frictcomp::diagnostic::Diagnostic;
use frictcomp::text::shown_path;
use frictcomp_host::ask::AskError;
use frictcomp_host::commission::CommissionError;
use frictcomp_host::{HostError, TraceError};
use frictcomp_physics::circle::{CircleError, RecordedError};
use frictcomp_physics::current::FollowError;
use frictcomp_physics::motion::CycleError;
use frictcomp_report::visible_line;

/// Returns a path as shown in a text of several lines (R9.76).
pub(crate) fn shown(path: &Path) -> String {
    visible_line(&shown_path(path)).into_owned()
}

/// A failure: one clear sentence, what to do, and the place of the reason in the user's file.
#[derive(Debug, Default)]
pub(crate) struct Failure {
    /// The failure: one sentence in lower case.
    pub(crate) message: String,
    /// Advice.
    pub(crate) help: Vec<String>,
    /// The lines of a configuration or list that are at fault.
    pub(crate) diagnostics: Vec<Diagnostic>,
}

impl Failure {
    /// Creates a failure without advice.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            ..Self::default()
        }
    }

    /// Adds a piece of advice.
    pub(crate) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }

    /// Returns the failure with its first advice in one sentence.
    pub(crate) fn sentence(&self) -> String {
        match self.help.first() {
            Some(help) => format!("{}; {help}", self.message),
            None => self.message.clone(),
        }
    }

    /// Creates the failure for a file that cannot be written.
    pub(crate) fn writing(path: &Path, error: io::Error) -> Self {
        HostError::write(path, error).into()
    }

    /// Creates the failure for output that cannot be written.
    pub(crate) fn output(error: io::Error) -> Self {
        HostError::Output(error).into()
    }
}

impl From<HostError> for Failure {
    fn from(error: HostError) -> Self {
        Self::from(&error)
    }
}

impl From<&HostError> for Failure {
    fn from(error: &HostError) -> Self {
        Self {
            message: error.to_string(),
            help: match error {
                HostError::Commission(CommissionError::NoTrend { left_out, .. }) => {
                    let left_out = left_out.iter();
                    left_out
                        .map(|(file, reason)| format!("{file}: {reason}"))
                        .collect()
                }
                HostError::Ask(AskError::Recording(reason)) => {
                    let mut help = Self::from(&**reason).help;
                    help.push(AskError::ANSWERS.to_owned());
                    help
                }
                _ => circle_option(error)
                    .map(str::to_owned)
                    .or_else(|| error.help())
                    .or_else(|| options_for(error))
                    .into_iter()
                    .collect(),
            },
            diagnostics: error.diagnostics().to_vec(),
        }
    }
}

/// Returns the advice in terms of command line options, if the host has none.
fn options_for(error: &HostError) -> Option<String> {
    let help = match error {
        HostError::ReplacesSource { .. } => "name another file, or use `--force` to replace it",
        HostError::FolderAsProgram(folder) => {
            return Some(format!(
                "name its programs, or use `frictcomp check {}`, which searches folders",
                shown_path(folder)
            ));
        }
        HostError::NotAStartupList { path, .. } if frictcomp_host::is_configuration(path) => {
            "`--config` takes a `frictcomp.toml`"
        }
        HostError::NotAStartupList { .. } => {
            "`--startup` takes the list that names all others, `hochlauf.lis`, and `--project` a TwinCAT project"
        }
        HostError::Trace(TraceError::Cycles { .. } | TraceError::SeveralClocks(_)) => {
            "record one row per CNC cycle, give the cycle with `--cycle-time`, or make cycles of \
             the rows with `--resample`"
        }
        HostError::Baseline { .. } => {
            "write a new one with `frictcomp check --write-baseline FILE`"
        }
        HostError::NoGit => "install git, or compare two files: `frictcomp diff OLD NEW`",
        HostError::SeveralStartupLists(_) => {
            "name that of the machine with `--startup LIST` or `--project FILE`"
        }
        HostError::AlreadyThere(path) if frictcomp_host::is_configuration(path) => {
            "`frictcomp config show` shows the machine that it describes"
        }
        HostError::AxisName(_) => "write `--enable X,Y`",
        HostError::NoPlant(_) => {
            return Some(format!(
                "known plants are {}, and files: `--plant FILE.toml`",
                frictcomp_physics::simulation::Preset::names()
            ));
        }
        HostError::Commission(error) => return commission_option(error),
        _ => return None,
    };
    Some(help.to_owned())
}

/// Returns the advice on a commissioning in terms of the command line.
fn commission_option(error: &CommissionError) -> Option<String> {
    let help = match error {
        CommissionError::NotAPlan { .. } => "`frictcomp commission plan` writes it",
        CommissionError::NoPlan(_) => {
            "`frictcomp commission plan --into FOLDER` writes it with the programs"
        }
        CommissionError::OtherPlan(_) => {
            "its recordings would count for the new plan; plan in another folder, or use `--force` if there are none"
        }
        CommissionError::NoLimit { .. } => {
            "give it in `frictcomp.toml`, or the axis list with `--startup`: the way to accelerate has to fit into the \
             travel"
        }
        CommissionError::NotBegun(_) => {
            "begin with the measured friction, `--friction X=comp_x.lis --friction Y=comp_y.lis`"
        }
        CommissionError::Begun(_) => {
            "leave `--friction` and `--value-list` out to continue, or name another folder"
        }
        CommissionError::NoBestList => {
            "leave `--write-list` out until the circles of a round are recorded"
        }
        _ => return None,
    };
    Some(help.to_owned())
}

/// Returns the option that corrects an error in a recorded circle.
fn circle_option(error: &HostError) -> Option<&'static str> {
    let HostError::Trace(TraceError::Circle { reason, .. } | TraceError::Circles(reason)) = error
    else {
        return None;
    };
    match reason {
        RecordedError::Radius { .. } => Some("check `--radius` and the unit of the columns"),
        RecordedError::CommandedRadius(_) => Some("write the commanded radius, `--radius 100`"),
        RecordedError::CommandedFeed(_) => Some("write the commanded feed, `--feed 1000`"),
        RecordedError::Apart { .. } => Some(
            "record both directions with the same zero point, or compare the shapes alone with \
             `--centre own`",
        ),
        _ => None,
    }
}

impl From<CircleError> for Failure {
    fn from(error: CircleError) -> Self {
        Self::new(error.to_string()).with_help(match error {
            CircleError::Radius(_) => "write the radius in mm, `--radius 100`",
            CircleError::CycleTime(_) => "write the milliseconds of a cycle, `--cycle-time 1`",
            _ => error.help(),
        })
    }
}

impl From<CycleError> for Failure {
    fn from(error: CycleError) -> Self {
        Self::new(error.to_string())
            .with_help("write the milliseconds of a cycle, `--cycle-time 1`")
    }
}

impl From<FollowError> for Failure {
    fn from(error: FollowError) -> Self {
        let help = match &error {
            FollowError::NoAxis(unknown) => unknown.help("its axes are"),
            FollowError::Assumed(_) | FollowError::NoList => {
                Some("name its compensation value list with `--value-list`".to_owned())
            }
        };
        Self {
            message: error.to_string(),
            help: help.into_iter().collect(),
            diagnostics: Vec::new(),
        }
    }
}

/// Failures of parts of a command.
#[derive(Debug, Default)]
pub(crate) struct Failures(Vec<Failure>);

impl From<Vec<HostError>> for Failures {
    fn from(errors: Vec<HostError>) -> Self {
        Self(errors.into_iter().map(Failure::from).collect())
    }
}

impl Failures {
    /// Adds a failure; a reason that stops many programs is reported once.
    pub(crate) fn push(&mut self, failure: Failure) {
        if self.0.iter().all(|it| it.message != failure.message) {
            self.0.push(failure);
        }
    }

    /// Adds the failures of another part of the work.
    pub(crate) fn extend(&mut self, others: Self) {
        others.0.into_iter().for_each(|it| self.push(it));
    }

    /// Returns the results, and keeps the failures.
    pub(crate) fn keep<T>(&mut self, (done, errors): (T, Vec<HostError>)) -> T {
        for error in errors {
            self.push(error.into());
        }
        done
    }

    /// Returns whether everything was done.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Executes work that collects its failures, and reports all of them at the end, even if the work is aborted
    /// (R9.95).
    pub(crate) fn of(
        console: Console,
        work: impl FnOnce(&mut Self) -> Result<u8, Failure>,
    ) -> Result<u8, Failure> {
        let mut failures = Self::default();
        let done = work(&mut failures).unwrap_or_else(|failure| {
            failures.push(failure);
            exit::CLEAN
        });
        failures.status(console, done)
    }

    /// Reports what could not be done, and returns the status of a command that could do the rest.
    fn status(mut self, console: Console, done: u8) -> Result<u8, Failure> {
        let Some(last) = self.0.pop() else {
            return Ok(done);
        };
        for failure in &self.0 {
            console.explain(failure);
        }
        Err(last)
    }
}
