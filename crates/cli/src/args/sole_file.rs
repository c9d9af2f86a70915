//! A program as the only argument: typed as `frictcomp part.nc`, or dropped on the command (R13.15).

use std::ffi::OsString;
use std::io::{self, BufRead as _};
use std::path::{Path, PathBuf};

use crate::output::exit;

/// Arguments as intended.
pub(crate) struct Meant {
    pub(crate) arguments: Vec<OsString>,
    /// The report to open after the run.
    report: Option<PathBuf>,
}

/// Way in which the command was started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Invocation {
    /// Start by a shell or another program.
    Typed,
    /// Start by a file dropped on it: its console closes with it.
    Dropped,
}

impl Meant {
    /// Inserts `run` before a sole file argument; `is_command` recognises the commands.
    pub(crate) fn new(arguments: Vec<OsString>, is_command: impl Fn(&str) -> bool) -> Self {
        Self::of(arguments, is_command, start())
    }

    fn of(
        mut arguments: Vec<OsString>,
        is_command: impl Fn(&str) -> bool,
        start: Invocation,
    ) -> Self {
        let alone = match arguments.as_slice() {
            [_, only] => Some(only),
            _ => None,
        };
        let is_file = alone.is_some_and(|only| {
            !is_command(&only.to_string_lossy()) && is_meant_as_file(Path::new(only))
        });
        if !is_file {
            return Self {
                arguments,
                report: None,
            };
        }
        arguments.insert(1, "run".into());
        let report = (start == Invocation::Dropped).then(new_report).flatten();
        if let Some(report) = &report {
            arguments.push("--html".into());
            arguments.push(report.into());
        }
        Self { arguments, report }
    }

    /// Opens the report of a run that made one. Error messages stay on screen until Enter.
    pub(crate) fn finish(report: Option<PathBuf>, status: u8) {
        let Some(report) = report else { return };
        if status == exit::FAILED || !open(&report) {
            let _ = io::stdin().lock().read_line(&mut String::new());
        }
    }

    /// Returns the arguments, and the report that [`finish`](Self::finish) opens.
    pub(crate) fn split(self) -> (Vec<OsString>, Option<PathBuf>) {
        (self.arguments, self.report)
    }
}

/// Returns whether an argument is a file, or looks like the path of one; `run` reports a missing file.
fn is_meant_as_file(path: &Path) -> bool {
    let is_option = path.to_string_lossy().starts_with('-');
    let is_written_so = path.extension().is_some() || path.components().count() > 1;
    path.is_file() || (!is_option && is_written_so)
}

/// Creates a temporary file for the report, which the browser reads after the command has ended.
fn new_report() -> Option<PathBuf> {
    let file = tempfile::Builder::new()
        .prefix("frictcomp-")
        .suffix(".html")
        .tempfile()
        .ok()?;
    file.into_temp_path().keep().ok()
}

/// Opens a file with its default program.
fn open(file: &Path) -> bool {
    let mut command = std::process::Command::new("explorer.exe");
    command.arg(file).spawn().is_ok()
}

#[cfg(windows)]
fn start() -> Invocation {
    use win32console::console::WinConsole;
    // A shell would be in the list, too.
    match WinConsole::get_process_list() {
        Ok(processes) if processes.len() == 1 => Invocation::Dropped,
        _ => Invocation::Typed,
    }
}

#[cfg(not(windows))]
fn start() -> Invocation {
    Invocation::Typed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meant(words: &[&str], start: Invocation) -> Vec<String> {
        let arguments = words.iter().map(OsString::from).collect();
        let meant = Meant::of(arguments, |word| word == "check", start);
        let words = meant.arguments.iter();
        words
            .map(|word| word.to_string_lossy().into_owned())
            .collect()
    }

    #[test]
    fn a_file_alone_is_a_program_to_run() {
        // R13.15
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("part.nc");
        std::fs::write(&file, "M30\n").expect("written");
        let file = file.to_string_lossy();
        assert_eq!(
            meant(&["frictcomp", &file], Invocation::Typed),
            ["frictcomp", "run", &file]
        );
        let dropped = meant(&["frictcomp", &file], Invocation::Dropped);
        assert_eq!(dropped[..4], ["frictcomp", "run", &file, "--html"]);
        let report = Path::new(&dropped[4]).extension();
        assert_eq!(report.and_then(|it| it.to_str()), Some("html"));
        std::fs::remove_file(&dropped[4]).expect("it is there");
        for missing in ["no.nc", "programs/no"] {
            assert_eq!(
                meant(&["frictcomp", missing], Invocation::Typed),
                ["frictcomp", "run", missing]
            );
        }
        for other in [
            &["frictcomp"][..],
            &["frictcomp", "check"],
            &["frictcomp", "no such file"],
            &["frictcomp", &file, &file],
            &["frictcomp", "--help"],
        ] {
            assert_eq!(meant(other, Invocation::Dropped), other);
        }
    }
}
