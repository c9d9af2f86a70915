//! Why the tool could not do its work.

use std::io;
use std::path::Path;

use super::console::Console;
use crate::diagnostic::Diagnostic;
use crate::report::visible_line;

/// A path as it is shown in a text of several lines (R9.76).
pub(super) fn shown(path: &Path) -> String {
    visible_line(&path.to_string_lossy()).into_owned()
}

/// One clear sentence, what to do, and where the reason stands in a file of the user.
#[derive(Debug, Default)]
pub(super) struct Failure {
    /// One sentence in lower case.
    pub(super) message: String,
    /// What to do.
    pub(super) help: Vec<String>,
    /// The lines of a configuration or list that are the reason.
    pub(super) diagnostics: Vec<Diagnostic>,
}

impl Failure {
    /// A failure without advice.
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            ..Self::default()
        }
    }

    /// The same with one more piece of advice.
    pub(super) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }

    /// A file that cannot be read.
    pub(super) fn reading(path: &Path, error: &io::Error) -> Self {
        let shown = path.display();
        match error.kind() {
            io::ErrorKind::NotFound => Self::new(format!("there is no file `{shown}`"))
                .with_help("check the path; it is taken from the current folder"),
            io::ErrorKind::PermissionDenied => {
                Self::new(format!("`{shown}` cannot be read: permission denied"))
                    .with_help("check your permission to read it")
            }
            io::ErrorKind::IsADirectory => Self::directory(path),
            _ => Self::new(format!("`{shown}` cannot be read: {error}")),
        }
    }

    /// A folder in the place of a program.
    pub(super) fn directory(path: &Path) -> Self {
        let shown = path.display();
        Self::new(format!("`{shown}` is a folder, not a program")).with_help(format!(
            "name its programs, or use `frictcomp check {shown}`, which walks through folders"
        ))
    }

    /// A file that cannot be written.
    pub(super) fn writing(path: &Path, error: &io::Error) -> Self {
        let shown = path.display();
        match error.kind() {
            io::ErrorKind::NotFound => Self::new(format!(
                "`{shown}` cannot be written: its folder does not exist"
            ))
            .with_help("create the folder, or name another file"),
            io::ErrorKind::PermissionDenied => {
                Self::new(format!("`{shown}` cannot be written: permission denied"))
                    .with_help("check your permission to write there, or name another file")
            }
            io::ErrorKind::IsADirectory => {
                Self::new(format!("`{shown}` cannot be written: it is a folder"))
                    .with_help("name a file in it")
            }
            _ => Self::new(format!("`{shown}` cannot be written: {error}")),
        }
    }

    /// Output that cannot be written.
    pub(super) fn output(error: &io::Error) -> Self {
        Self::new(format!("the output cannot be written: {error}"))
    }
}

/// What could not be done of several things; the rest is done all the same (R9.77).
#[derive(Debug, Default)]
pub(super) struct Failures(Vec<Failure>);

impl From<Vec<Failure>> for Failures {
    fn from(failures: Vec<Failure>) -> Self {
        Self(failures)
    }
}

impl Failures {
    /// One more. One reason may stop many programs and is said once.
    pub(super) fn push(&mut self, failure: Failure) {
        if self.0.iter().all(|it| it.message != failure.message) {
            self.0.push(failure);
        }
    }

    /// Whether everything was done.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Says what could not be done: the status of a command that could do the rest.
    pub(super) fn status(mut self, console: Console, done: u8) -> Result<u8, Failure> {
        let Some(last) = self.0.pop() else {
            return Ok(done);
        };
        for failure in &self.0 {
            console.explain(failure);
        }
        Err(last)
    }
}
