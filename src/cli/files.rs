//! The programs that the user names.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::ledger::{Ledger, PROGRAM};
use super::lines::{LineReader, MOST_KEPT, decode_lines, too_big};
use super::steady::Steady;
use crate::text::SourceFile;

/// The name of standard input in records and diagnostics.
const STDIN: &str = "<stdin>";

/// How files are named in records and diagnostics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Naming {
    /// As the user named them.
    AsGiven,
    /// By their last part only, so that the folder does not matter.
    FileName,
}

impl Naming {
    pub(super) fn name(self, path: &Path) -> String {
        match (self, path.file_name()) {
            (Self::FileName, Some(name)) => name.to_string_lossy().into_owned(),
            _ => path.display().to_string(),
        }
    }
}

/// A program that the user named.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Input {
    /// A file.
    File(PathBuf),
    /// Standard input, `-`.
    Stdin,
}

/// A program that is ready to run.
pub(super) enum Opened<'a> {
    /// A file without flow, or what can be read only once: the lines come one after another.
    Lines(LineReader<Box<dyn Read + 'a>>),
    /// A program with flow.
    Whole(SourceFile),
}

/// A reader that may have to wait for more, and says so before it does.
struct Waiting<'a, R> {
    reader: R,
    before: &'a dyn Fn(),
}

impl<R: Read> Read for Waiting<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        (self.before)();
        self.reader.read(buffer)
    }
}

impl Input {
    /// What the user means by an argument.
    pub(super) fn new(argument: &Path) -> Self {
        if argument == Path::new("-") {
            Self::Stdin
        } else {
            Self::File(argument.to_owned())
        }
    }

    /// Its name in records and diagnostics.
    pub(super) fn name(&self, naming: Naming) -> String {
        match self {
            Self::File(path) => naming.name(path),
            Self::Stdin => STDIN.to_owned(),
        }
    }

    /// The folder in which the search for a configuration begins.
    pub(super) fn folder(&self) -> &Path {
        match self {
            Self::File(path) => path.parent().unwrap_or(path),
            Self::Stdin => Path::new(""),
        }
    }

    /// Says why the program cannot be run, as far as that is known before it runs.
    pub(super) fn probe(&self) -> Result<(), Failure> {
        let Self::File(path) = self else {
            return Ok(());
        };
        let metadata = std::fs::metadata(path).map_err(|error| Failure::reading(path, &error))?;
        if metadata.is_dir() {
            return Err(Failure::directory(path));
        }
        if metadata.is_file() {
            File::open(path).map_err(|error| Failure::reading(path, &error))?;
        }
        Ok(())
    }

    /// Notes the program among the files that are read.
    pub(super) fn note(&self, ledger: &Ledger) {
        let path = match self {
            Self::File(path) => path,
            Self::Stdin => Path::new(STDIN),
        };
        ledger.reads(PROGRAM, path);
    }

    /// Opens the program. Standard input or a pipe calls `before_waiting` whenever it may have to
    /// wait for more.
    pub(super) fn open<'a>(
        &self,
        naming: Naming,
        before_waiting: &'a dyn Fn(),
    ) -> Result<Opened<'a>, Failure> {
        match self {
            Self::File(path) => open_file(path, self.name(naming), before_waiting)
                .map_err(|error| Failure::reading(path, &error)),
            Self::Stdin => Ok(match standard_input() {
                // A file behind `<` must stay as it is, as one that is named must.
                Some((file, metadata)) => arriving(Steady::new(file, &metadata), before_waiting),
                None => arriving(io::stdin().lock(), before_waiting),
            }),
        }
    }
}

/// Standard input, where it is a file and no pipe.
fn standard_input() -> Option<(File, Metadata)> {
    let file = File::from(owned_input().ok()?);
    let metadata = file.metadata().ok()?;
    metadata.is_file().then_some((file, metadata))
}

#[cfg(unix)]
fn owned_input() -> io::Result<std::os::fd::OwnedFd> {
    std::os::fd::AsFd::as_fd(&io::stdin()).try_clone_to_owned()
}

#[cfg(windows)]
fn owned_input() -> io::Result<std::os::windows::io::OwnedHandle> {
    std::os::windows::io::AsHandle::as_handle(&io::stdin()).try_clone_to_owned()
}

fn open_file<'a>(
    path: &Path,
    name: String,
    before_waiting: &'a dyn Fn(),
) -> io::Result<Opened<'a>> {
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !metadata.is_file() {
        return Ok(arriving(file, before_waiting));
    }
    let mut lines = LineReader::of_length(Steady::new(file, &metadata), metadata.len());
    if !lines.is_wide() && !lines.scan()?.needs_whole_text() {
        return Ok(Opened::Lines(lines.boxed()));
    }
    let mut file = lines.into_reader();
    file.rewind()?;
    let bytes = read_whole(file, metadata.len())?;
    Ok(Opened::Whole(SourceFile::new(name, decode(bytes))))
}

/// Reads a file of a length that is kept in memory.
fn read_whole(reader: impl Read, length: u64) -> io::Result<Vec<u8>> {
    let most = u64::try_from(MOST_KEPT).expect("1 GiB is below 2^64");
    if length > most {
        return Err(too_big());
    }
    let mut bytes = Vec::new();
    reader.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() > MOST_KEPT {
        return Err(too_big());
    }
    Ok(bytes)
}

/// Lines that are given out as they arrive.
fn arriving<'a>(reader: impl Read + 'a, before: &'a dyn Fn()) -> Opened<'a> {
    Opened::Lines(LineReader::new(Box::new(Waiting { reader, before }) as Box<dyn Read>).narrow())
}

/// The text of a file, decoded as a stream of its lines is. A byte order mark at its start is passed
/// over.
pub(super) fn decode(bytes: Vec<u8>) -> String {
    if let Some(text) = decode_wide(&bytes) {
        return text;
    }
    let mut text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let mut text = String::with_capacity(error.as_bytes().len());
            decode_lines(error.as_bytes(), &mut false, &mut text);
            text
        }
    };
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    text
}

/// The text of bytes whose byte order mark says UTF-16, as some editors of Windows save.
fn decode_wide(bytes: &[u8]) -> Option<String> {
    let (encoding, mark) = encoding_rs::Encoding::for_bom(bytes)?;
    let is_wide = encoding != encoding_rs::UTF_8;
    is_wide.then(|| {
        encoding
            .decode_without_bom_handling(&bytes[mark..])
            .0
            .into_owned()
    })
}

/// Opens what is a file and nothing else: a pipe would be waited for, a device has no end.
///
/// # Errors
/// There is none, it may not be read, is a folder or no regular file.
pub(super) fn open_regular(path: &Path) -> io::Result<(File, Metadata)> {
    // Asked before it is opened: opening a pipe waits for its other end.
    let metadata = std::fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !metadata.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    Ok((file, metadata))
}

/// Reads and decodes a whole file.
pub(super) fn read_text(path: &Path) -> Result<String, Failure> {
    read_bytes(path)
        .map(decode)
        .map_err(|error| Failure::reading(path, &error))
}

/// Reads a whole file.
///
/// # Errors
/// There is none, it may not be read, is a folder, or is too big to be kept.
pub(super) fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let (file, metadata) = open_regular(path)?;
    read_whole(file, metadata.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::LineSource;

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
        assert!(failure.message.contains("is a folder"));
        let failure = Input::new(&root.path().join("no.nc")).probe().unwrap_err();
        assert!(failure.message.starts_with("there is no file"));
    }
}
