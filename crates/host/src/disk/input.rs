//! The programs that the user names.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::decode::decode;
use super::fixed_length::FixedLengthReader;
use super::lines::LineReader;
use super::read::{read_text, read_whole};
use super::registry::{FileRegistry, PROGRAM};
use crate::error::HostError;
use frictcomp::syntax::{FlowScan, HEAD, no_program};
use frictcomp::text::{LineSource, SourceFile, shown_path};

/// The name of standard input in records and diagnostics.
const STDIN: &str = "<stdin>";

/// Form of the names of files in records and diagnostics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Naming {
    /// Names as given by the user.
    AsGiven,
    /// Last parts of the names only, so that the folder does not matter.
    FileName,
}

impl Naming {
    /// Returns the name of a file.
    pub fn name(self, path: &Path) -> String {
        match (self, path.file_name()) {
            (Self::FileName, Some(name)) => name.to_string_lossy().into_owned(),
            _ => shown_path(path),
        }
    }
}

/// A program that the user named.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Input {
    /// A file.
    File(PathBuf),
    /// A text that stands in for a file.
    Open(OpenText),
    /// Standard input, `-`.
    Stdin,
}

/// A program that is ready to run.
pub(crate) enum Opened<'a> {
    /// A file without flow, or one that can be read only once: line by line.
    Lines(LineReader<Box<dyn Read + 'a>>),
    /// A program with flow.
    Whole(SourceFile),
}

/// A reader that may have to wait for more, and reports this before it waits.
struct Waiting<'a, R> {
    reader: R,
    before: &'a dyn Fn(),
}

impl<'a, R> Waiting<'a, R> {
    fn new(reader: R, before: &'a dyn Fn()) -> Self {
        Self { reader, before }
    }
}

impl<R: Read> Read for Waiting<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        (self.before)();
        self.reader.read(buffer)
    }
}

impl Input {
    /// Creates the input that a user's argument means.
    pub fn new(argument: &Path) -> Self {
        if argument == Path::new("-") {
            Self::Stdin
        } else {
            Self::File(argument.to_owned())
        }
    }

    /// Returns its name in records and diagnostics.
    pub fn name(&self, naming: Naming) -> String {
        match self {
            Self::File(path) | Self::Open(OpenText { path, .. }) => naming.name(path),
            Self::Stdin => STDIN.to_owned(),
        }
    }

    /// Returns the folder in which the search for a configuration begins.
    pub fn folder(&self) -> &Path {
        match self {
            Self::File(path) | Self::Open(OpenText { path, .. }) => path.parent().unwrap_or(path),
            Self::Stdin => Path::new(""),
        }
    }

    /// Checks whether the program can be run, to the extent that this is known before.
    ///
    /// # Errors
    /// It does not exist, cannot be read, is a folder, or plainly no program.
    pub fn probe(&self) -> Result<(), HostError> {
        let Self::File(path) = self else {
            return Ok(());
        };
        let metadata = std::fs::metadata(path).map_err(|error| HostError::read(path, error))?;
        if metadata.is_dir() {
            return Err(HostError::FolderAsProgram(path.clone()));
        }
        if !metadata.is_file() {
            return Ok(());
        }
        let read = |error| HostError::read(path, error);
        let mut head = Vec::with_capacity(HEAD);
        let file = File::open(path).map_err(read)?;
        file.take(HEAD as u64)
            .read_to_end(&mut head)
            .map_err(read)?;
        refuse_other_files(path, &decode(head))
    }

    /// Notes the program among the files that are read.
    pub fn note(&self, registry: &FileRegistry) {
        let path = match self {
            Self::File(path) | Self::Open(OpenText { path, .. }) => path,
            Self::Stdin => Path::new(STDIN),
        };
        registry.reads(PROGRAM, path);
    }

    /// Opens the program. Standard input or a pipe calls `before_waiting` whenever it may have to
    /// wait for more.
    ///
    /// # Errors
    /// It cannot be read.
    pub(crate) fn open<'a>(
        &self,
        naming: Naming,
        before_waiting: &'a dyn Fn(),
    ) -> Result<Opened<'a>, HostError> {
        match self {
            Self::File(path) => {
                let read = |error| HostError::read(path, error);
                let file = File::open(path).map_err(read)?;
                let metadata = file.metadata().map_err(read)?;
                if metadata.is_file() || metadata.is_dir() {
                    return open_file((file, &metadata), self.name(naming)).map_err(read);
                }
                arriving(path, Waiting::new(file, before_waiting))
            }
            Self::Open(open) => Ok(open_text(open, self.name(naming))),
            Self::Stdin => {
                let name = Path::new(STDIN);
                match standard_input() {
                    // A file redirected with `<` must not change while it is read, like one that is named.
                    Some((file, metadata)) => {
                        let file = FixedLengthReader::new(file, &metadata);
                        arriving(name, Waiting::new(file, before_waiting))
                    }
                    None => arriving(name, Waiting::new(io::stdin().lock(), before_waiting)),
                }
            }
        }
    }
}

/// Returns the lines of a program that was run, by its name in records. `None` for a pipe, which can be read
/// only once.
pub fn reopen(name: &str) -> Option<Box<dyn LineSource>> {
    let path = Path::new(name);
    if !path.is_file() {
        return None;
    }
    let lines = LineReader::new(File::open(path).ok()?);
    if lines.is_wide() {
        let text = read_text(path).ok()?;
        return Some(Box::new(LineReader::new(io::Cursor::new(text))));
    }
    Some(Box::new(lines))
}

/// Returns standard input, if it is a file and not a pipe.
fn standard_input() -> Option<(File, Metadata)> {
    let file = input_file().ok()?;
    let metadata = file.metadata().ok()?;
    metadata.is_file().then_some((file, metadata))
}

#[cfg(unix)]
fn input_file() -> io::Result<File> {
    let input = std::os::fd::AsFd::as_fd(&io::stdin()).try_clone_to_owned();
    input.map(File::from)
}

#[cfg(windows)]
fn input_file() -> io::Result<File> {
    let input = std::os::windows::io::AsHandle::as_handle(&io::stdin()).try_clone_to_owned();
    input.map(File::from)
}

#[cfg(not(any(unix, windows)))]
fn input_file() -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}

fn open_file<'a>((file, metadata): (File, &Metadata), name: String) -> io::Result<Opened<'a>> {
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    let mut lines = LineReader::of_length(FixedLengthReader::new(file, metadata), metadata.len());
    if !lines.is_wide() && !lines.scan()?.needs_whole_text() {
        return Ok(Opened::Lines(lines.boxed()));
    }
    let mut file = lines.into_reader();
    file.rewind()?;
    let bytes = read_whole(file, metadata.len())?;
    Ok(Opened::Whole(SourceFile::new(name, decode(bytes))))
}

/// Returns the lines of a text without flow, or the whole text.
fn open_text<'a>(open: &OpenText, name: String) -> Opened<'a> {
    let mut scan = FlowScan::default();
    scan.feed(open.text.as_bytes());
    if scan.needs_whole_text() {
        return Opened::Whole(SourceFile::new(name, open.text.as_str()));
    }
    let bytes = io::Cursor::new(Shared(Arc::clone(&open.text)));
    let length = u64::try_from(open.text.len()).unwrap_or(u64::MAX);
    Opened::Lines(LineReader::of_length(Box::new(bytes), length))
}

/// The bytes of a shared text.
struct Shared(Arc<String>);

impl AsRef<[u8]> for Shared {
    fn as_ref(&self) -> &[u8] {
        self.0.as_bytes()
    }
}

/// Returns lines that are passed on as they arrive, of a program that the user names.
fn arriving<'a, R: Read + 'a>(
    path: &Path,
    reader: Waiting<'a, R>,
) -> Result<Opened<'a>, HostError> {
    let mut lines = LineReader::new(Box::new(reader) as Box<dyn Read>);
    lines
        .narrow()
        .map_err(|error| HostError::read(path, error))?;
    refuse_other_files(path, lines.ahead())?;
    Ok(Opened::Lines(lines))
}

/// Reports a file whose head shows that it is no program (R18.6).
fn refuse_other_files(path: &Path, head: &str) -> Result<(), HostError> {
    match no_program(head) {
        Some(what) => Err(HostError::NoProgram {
            path: path.to_owned(),
            what,
        }),
        None => Ok(()),
    }
}

/// A text, and the file that it stands in for, whose content may differ or which may not
/// exist.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct OpenText {
    /// Path of the file.
    pub path: PathBuf,
    /// The text as shown in the editor.
    pub text: Arc<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_programs_with_flow_are_read_whole() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("a.nc");
        std::fs::write(&path, "N10 X1\nN20 M30").unwrap();
        let input = Input::new(&path);
        match input.open(Naming::FileName, &|| ()).unwrap() {
            Opened::Lines(mut lines) => {
                assert!(lines.advance());
                assert_eq!(lines.line().text, "N10 X1");
            }
            Opened::Whole(_) => panic!("a straight program is streamed"),
        }
        std::fs::write(&path, b"$IF 1\n(\xdc)").unwrap();
        match input.open(Naming::FileName, &|| ()).unwrap() {
            Opened::Whole(file) => assert_eq!(file.text(), "$IF 1\n(Ü)"),
            Opened::Lines(_) => panic!("flow needs the whole text"),
        }
    }

    #[test]
    fn what_cannot_be_run_is_said_before() {
        let root = tempfile::tempdir().unwrap();
        let failure = Input::new(root.path()).probe().unwrap_err();
        assert!(failure.to_string().contains("is a folder"));
        let failure = Input::new(&root.path().join("no.nc")).probe().unwrap_err();
        assert!(failure.to_string().starts_with("there is no file"));
    }
}
