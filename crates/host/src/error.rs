//! Failures of work with files.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::ask::AskError;
use crate::commission::CommissionError;
use crate::outputs::{device, told};
use crate::recordings::TraceError;
use frictcomp::diagnostic::{Diagnostic, UnknownName};
use frictcomp::text::shown_path;
use frictcomp_physics::simulation::{Preset, UnknownPreset};

/// A failure of work with files: one sentence in lower case.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HostError {
    /// A file that does not exist, or that may not be read.
    #[error("{}", reading(.path, .reason))]
    Read {
        /// The file as it was named.
        path: PathBuf,
        /// Reason given by the system.
        reason: io::Error,
    },
    /// A file in a folder that does not exist, or that may not be written.
    #[error("{}", writing(.path, .reason))]
    Write {
        /// The file as it was named.
        path: PathBuf,
        /// Reason given by the system.
        reason: io::Error,
    },
    /// A change that cannot be written in the code page of a file.
    #[error("`{}` cannot be changed: {reason}", shown_path(.path))]
    Unwritable {
        /// Path of the file.
        path: PathBuf,
        /// The reason, in words.
        reason: String,
    },
    /// A file that was changed by another program meanwhile.
    #[error("`{}` has changed since it was read; nothing was written", shown_path(.0))]
    ChangedMeanwhile(PathBuf),
    /// A file that cannot be put in place after others were.
    #[error("{failed}; {} in place already", are(.written))]
    PartlyWritten {
        /// The file, and the error of the system.
        failed: Box<HostError>,
        /// The others.
        written: Vec<PathBuf>,
    },
    /// Files that are in place on a disk that may lose them again.
    #[error("{} in place, but the disk did not confirm it: {reason}", are(.files))]
    Unsettled {
        /// The files.
        files: Vec<PathBuf>,
        /// Reason given by the system.
        reason: io::Error,
    },
    /// A full disk.
    #[error("the output cannot be written: {0}")]
    Output(io::Error),
    /// A folder where a program is expected.
    #[error("`{}` is a folder, not a program", shown_path(.0))]
    FolderAsProgram(PathBuf),
    /// A folder where a recording is expected.
    #[error("`{}` is a folder, not a recording", shown_path(.0))]
    FolderAsRecording(PathBuf),
    /// A folder whose recordings cannot be listed.
    #[error("cannot read the folder `{}`: {reason}", shown_path(.folder))]
    Recordings {
        /// The folder as it was named.
        folder: PathBuf,
        /// Reason given by the system.
        reason: io::Error,
    },
    /// A recording that was given twice, or is a copy of another one.
    #[error("{}", copied(.path, .of))]
    Copy {
        /// The recording.
        path: PathBuf,
        /// The one that it repeats.
        of: PathBuf,
    },
    /// A picture, settings, an archive where a program is expected.
    #[error("`{}` is {what}, not an NC program", shown_path(.path))]
    NoProgram {
        /// The file as it was named.
        path: PathBuf,
        /// The nature of the file in words.
        what: &'static str,
    },
    /// A folder where a list is expected.
    #[error("`{}` is a folder, not a list", shown_path(.0))]
    FolderAsList(PathBuf),
    /// A folder of which some parts may not be read.
    #[error("`{}` cannot be searched completely: {reason}", shown_path(.folder))]
    Search {
        /// The folder that is searched.
        folder: PathBuf,
        /// Reason given by the system.
        reason: String,
    },
    /// A pattern of files that is malformed.
    #[error("`{0}` is not a pattern of files")]
    Pattern(String),
    /// A folder without programs.
    #[error("there is no program below `{}`", shown_path(.folder))]
    NoPrograms {
        /// The folder that was searched.
        folder: PathBuf,
        /// The extensions of programs there.
        extensions: Vec<String>,
    },
    /// An order of programs without one.
    #[error("`{}` names no program", shown_path(.0))]
    NoProgramInOrder(PathBuf),
    /// A `frictcomp.toml` with a mistake.
    #[error("the configuration `{}` cannot be used", shown_path(.path))]
    Configuration {
        /// Path of the file.
        path: PathBuf,
        /// The lines at fault.
        diagnostics: Vec<Diagnostic>,
    },
    /// An axis list where a start-up list is expected.
    #[error("{message}")]
    NotAStartupList {
        /// Path of the file.
        path: PathBuf,
        /// The kind of file that was found.
        message: String,
    },
    /// XML that is no TwinCAT project, or one without a CNC.
    #[error("{message}")]
    NotAProject {
        /// Path of the file.
        path: PathBuf,
        /// The kind of file that was found.
        message: String,
    },
    /// A missing `git` command.
    #[error("the revisions need the command `git`, which is not installed")]
    NoGit,
    /// A folder outside any repository, or in one that git does not trust.
    #[error("`{}` is in no git repository that can be read: {reason}", shown_path(.folder))]
    NoRepository {
        /// Path of the folder.
        folder: PathBuf,
        /// Reason given by git.
        reason: String,
    },
    /// A name that is not a revision.
    #[error("there is no revision `{0}` in the git repository")]
    NoRevision(String),
    /// A git command that failed, with its message.
    #[error("`git diff` failed: {0}")]
    Git(String),
    /// A folder that does not exist.
    #[error("there is no folder `{}`", shown_path(.0))]
    NoFolder(PathBuf),
    /// A file that already exists and stays as it is.
    #[error("`{}` already exists and is not changed", shown_path(.0))]
    AlreadyThere(PathBuf),
    /// Several start-up lists or projects, and no choice between them.
    #[error("there are several start-up lists or projects: {}", listed(.0))]
    SeveralStartupLists(Vec<PathBuf>),
    /// A link to a file outside the given folders.
    #[error("`{}` is a link that leads out of the given folders", shown_path(.0))]
    LeadsOut(PathBuf),
    /// A program that has no folder for such a file.
    #[error("standard input has no folder for a `.{0}` file")]
    NothingBeside(&'static str),
    /// `X[` where the name of an axis is expected.
    #[error("`{0}` is not an axis name")]
    AxisName(String),
    /// `XX` on a machine with X, Y and Z.
    #[error("the machine has no axis `{}`", .0.name)]
    NoAxis(UnknownName),
    /// Compensation that is assumed on an axis that no program names.
    #[error("no program names an axis `{}`", .0.name)]
    AxisNotNamed(UnknownName),
    /// Two outputs in one file.
    #[error("`{one}` and `{other}` are the same file")]
    SameFile {
        /// Path of the first output.
        one: String,
        /// The other one.
        other: String,
    },
    /// An output that would overwrite an input.
    #[error("`{output}` would overwrite the {what} `{}`", shown_path(.input))]
    Overwrites {
        /// The output.
        output: String,
        /// Kind of the input.
        what: &'static str,
        /// The input.
        input: PathBuf,
    },
    /// An output through a link to a file that users write.
    #[error("`{output}` is a link to the {what} `{}`", shown_path(.target))]
    LeadsToSource {
        /// The output.
        output: String,
        /// The kind of file.
        what: &'static str,
        /// Path of the file.
        target: PathBuf,
    },
    /// An output that would replace a file that users write.
    #[error("`{output}` would take the place of a {what}")]
    ReplacesSource {
        /// The output.
        output: String,
        /// The kind of file.
        what: &'static str,
    },
    /// A folder where the state is expected.
    #[error("`{}` cannot hold a state: it is not a regular file", shown_path(.0))]
    StateNotRegular(PathBuf),
    /// A state that another run has locked.
    #[error("another run uses the state file `{}`", shown_path(.0))]
    StateInUse(PathBuf),
    /// A state that is damaged, or belongs to another machine.
    #[error("the state file `{}` cannot be used: {reason}", shown_path(.path))]
    State {
        /// Path of the file.
        path: PathBuf,
        /// Fault in words.
        reason: String,
    },
    /// A damaged baseline, or a file that is not a baseline.
    #[error("the baseline `{}` {reason}", shown_path(.path))]
    Baseline {
        /// Path of the file.
        path: PathBuf,
        /// The fault, in words.
        reason: String,
    },
    /// A value list that the control would reject.
    #[error("the value list `{}` cannot be used: {reason}", shown_path(.path))]
    ValueList {
        /// Path of the file.
        path: PathBuf,
        /// The fault.
        reason: &'static str,
        /// The lines at fault.
        diagnostics: Vec<Diagnostic>,
    },
    /// A plant that is neither a preset nor a file.
    #[error(transparent)]
    NoPlant(UnknownPreset),
    /// A plant file with a mistake.
    #[error("the plant `{}` cannot be used", shown_path(.path))]
    Plant {
        /// Path of the file.
        path: PathBuf,
        /// The lines at fault.
        diagnostics: Vec<Diagnostic>,
    },
    /// A recorded trace that cannot be read.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// A control that cannot be asked.
    #[error(transparent)]
    Ask(#[from] AskError),
    /// A commissioning that cannot go on.
    #[error(transparent)]
    Commission(#[from] CommissionError),
    /// A memory limit that is too low for a simulation.
    #[error("not enough memory: a simulation needs {mebibytes} MiB")]
    Memory {
        /// Required memory.
        mebibytes: usize,
    },
}

impl HostError {
    /// Creates the error for a file that cannot be read.
    pub fn read(path: &Path, reason: io::Error) -> Self {
        if reason.kind() == io::ErrorKind::IsADirectory {
            return Self::FolderAsProgram(path.to_owned());
        }
        let (path, reason) = (path.to_owned(), told(reason));
        Self::Read { path, reason }
    }

    /// Creates the error for a file that cannot be written.
    pub fn write(path: &Path, reason: io::Error) -> Self {
        let (path, reason) = (path.to_owned(), told(reason));
        Self::Write { path, reason }
    }

    /// Returns the lines of a user's file that are at fault.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Configuration { diagnostics, .. }
            | Self::ValueList { diagnostics, .. }
            | Self::Plant { diagnostics, .. }
            | Self::Ask(AskError::Machine(diagnostics)) => diagnostics,
            _ => &[],
        }
    }

    /// Returns the advice, unless it depends on the calling program.
    pub fn help(&self) -> Option<String> {
        let help = match self {
            Self::Read { reason, .. } => match reason.kind() {
                io::ErrorKind::NotFound => "check the path; it is taken from the current folder",
                io::ErrorKind::PermissionDenied => "check your permission to read it",
                io::ErrorKind::ResourceBusy => "close it there, then try again",
                _ => return None,
            },
            Self::Recordings { reason, .. } => match reason.kind() {
                io::ErrorKind::NotFound => "make the folder, and put the recordings into it",
                io::ErrorKind::NotADirectory => "name a folder with recordings, not a file",
                _ => return None,
            },
            Self::Copy { .. } => "leave it out: the same recording twice proves nothing more",
            Self::Write { reason, .. } => match reason.kind() {
                io::ErrorKind::NotFound => "create the folder, or name another file",
                io::ErrorKind::ResourceBusy => "close it there and try again, or name another file",
                io::ErrorKind::IsADirectory => "name a file in it",
                io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => {
                    "name an existing folder, or a new one"
                }
                kind => return to_write(kind).map(str::to_owned),
            },
            Self::Output(reason) => return to_write(reason.kind()).map(str::to_owned),
            Self::PartlyWritten { failed, .. } => return failed.help(),
            Self::Unsettled { .. } => "check the disk before you rely on them",
            Self::NotAProject { .. } => {
                "a project (`.tsproj`, `.xti`, an exported tree item) has a CNC, whose items hold its lists"
            }
            Self::NoRepository { .. } => "go to the work tree of the programs",
            Self::NoRevision(_) => {
                "`git log --oneline` names them; a clone with little history gets more with \
                 `git fetch --unshallow`"
            }
            Self::FolderAsList(_) | Self::FolderAsRecording(_) => "name the file in it",
            Self::NoProgram { .. } => "name the program itself",
            Self::NoProgramInOrder(_) => {
                "write the path of one program on each line, from the folder of this file"
            }
            Self::Pattern(_) => {
                "write it as in a `.gitignore`: `old`, `*.bak.nc`, `archive/**/*.nc`"
            }
            Self::NoFolder(_) => "name the folder of the programs",
            Self::LeadsOut(_) => "put the file itself there, or name its folder",
            Self::NoPrograms { extensions, .. } => {
                return Some(format!(
                    "programs end in .{}; `[check] extensions` in frictcomp.toml names others",
                    extensions.join(", .")
                ));
            }
            Self::NoAxis(unknown) => return unknown.help("its axes are"),
            Self::AxisNotNamed(unknown) => return unknown.help("they name"),
            Self::SameFile { .. } => "give each output its own file",
            Self::Overwrites { .. } | Self::LeadsToSource { .. } => {
                "name another file for the output"
            }
            Self::StateInUse(_) => "wait until it has ended, or give each run a state file",
            Self::State { .. } => {
                "name another file, or remove this one to begin from a start of the control"
            }
            Self::NoPlant(unknown) => {
                return Some(match unknown.near() {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!(
                        "the presets are {}; a plant may also be a TOML file",
                        Preset::names()
                    ),
                });
            }
            Self::Trace(error) => return error.help(),
            Self::Ask(error) => return error.help(),
            Self::Commission(error) => return error.help(),
            Self::Memory { .. } if cfg!(windows) => "close other programs",
            Self::Memory { .. } => {
                "close other programs, or raise the limit of the shell (`ulimit -v`)"
            }
            _ => return None,
        };
        Some(help.to_owned())
    }
}

/// Returns the advice where writing fails.
fn to_write(kind: io::ErrorKind) -> Option<&'static str> {
    Some(match kind {
        io::ErrorKind::PermissionDenied => {
            "check your permission to write there, or name another file"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "make room there, or name a file on another disk, then try again"
        }
        io::ErrorKind::FileTooLarge if cfg!(windows) => {
            "write less, or name a file on another disk, then try again"
        }
        io::ErrorKind::FileTooLarge => {
            "raise the limit of the shell (`ulimit -f`), or write less, then try again"
        }
        io::ErrorKind::ReadOnlyFilesystem => "name a file on another disk",
        // Reasons given by the tool itself say what is wrong, not what failed.
        io::ErrorKind::Other | io::ErrorKind::InvalidInput => return None,
        _ => "check the disk or the network drive, then try again",
    })
}

/// Returns files with the verb that follows them.
fn are(files: &[PathBuf]) -> String {
    const MOST_NAMES: usize = 20;
    match files {
        [] => "all files are".to_owned(),
        [file] => format!("`{}` is", shown_path(file)),
        _ if files.len() > MOST_NAMES => {
            let more = files.len() - MOST_NAMES;
            format!("{} and {more} more are", listed(&files[..MOST_NAMES]))
        }
        [others @ .., last] => format!("{} and `{}` are", listed(others), shown_path(last)),
    }
}

fn listed(paths: &[PathBuf]) -> String {
    let names: Vec<String> = paths
        .iter()
        .map(|path| format!("`{}`", shown_path(path)))
        .collect();
    names.join(", ")
}

fn copied(path: &Path, of: &Path) -> String {
    let shown = shown_path(path);
    if path == of {
        return format!("`{shown}` was given twice");
    }
    format!("`{shown}` is a copy of `{}`", shown_path(of))
}

fn reading(path: &Path, reason: &io::Error) -> String {
    let shown = shown_path(path);
    if let Some(device) = device(path).filter(|_| cfg!(windows)) {
        return format!("`{shown}` cannot be read: `{device}` is the name of a device on Windows");
    }
    match reason.kind() {
        io::ErrorKind::NotFound if shown.is_empty() => {
            "no file is named: the path is empty".to_owned()
        }
        io::ErrorKind::NotFound => format!("there is no file `{shown}`"),
        io::ErrorKind::PermissionDenied => format!("`{shown}` cannot be read: permission denied"),
        io::ErrorKind::ResourceBusy => {
            format!("`{shown}` cannot be read: another program has it open")
        }
        _ => format!("`{shown}` cannot be read: {reason}"),
    }
}

fn writing(path: &Path, reason: &io::Error) -> String {
    let shown = shown_path(path);
    match reason.kind() {
        io::ErrorKind::NotFound => {
            format!("`{shown}` cannot be written: its folder does not exist")
        }
        io::ErrorKind::PermissionDenied => {
            format!("`{shown}` cannot be written: permission denied")
        }
        io::ErrorKind::ResourceBusy => {
            format!("`{shown}` cannot be written: another program has it open")
        }
        io::ErrorKind::IsADirectory => format!("`{shown}` cannot be written: it is a folder"),
        // A folder was to be created there.
        io::ErrorKind::AlreadyExists => format!("`{shown}` is a file, not a folder"),
        io::ErrorKind::NotADirectory => {
            format!("`{shown}` cannot be written: a part of its path is a file, not a folder")
        }
        _ => format!("`{shown}` cannot be written: {reason}"),
    }
}
