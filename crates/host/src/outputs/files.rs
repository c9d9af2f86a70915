//! The output files of a piece of work: at the end all are put in place, or none (R9.70).

use std::collections::BTreeSet;
use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use super::atomic_file::{AtomicFile, Placed, take_away_left};
use crate::disk::{Claim, FileRegistry, Replaces};
use crate::error::HostError;
use frictcomp::text::{shown_json, shown_path};

/// The output files of a piece of work. If dropped before [`finish`](Self::finish), nothing is
/// written.
#[derive(Debug)]
pub struct OutputFiles {
    registry: FileRegistry,
    claims: Vec<Claim>,
    open: Vec<OutputFile>,
    /// The number of inputs with which the claims have been compared.
    compared: usize,
    /// Folders from which the leftovers of killed runs have been removed.
    swept: BTreeSet<PathBuf>,
    /// The files that every output may replace, in place of those that each says.
    forced: Option<Replaces>,
}

/// A result that is being written to a file or a device. Its copies write to the same file.
#[derive(Debug, Clone)]
pub struct OutputFile {
    path: Arc<Path>,
    place: Arc<Mutex<OutputPlace>>,
}

enum OutputPlace {
    /// A device or a pipe, which cannot be replaced.
    Open(Box<dyn Write + Send>),
    /// Next to the file that it replaces.
    Beside(AtomicFile),
}

impl fmt::Debug for OutputPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open(_) => f.write_str("Open"),
            Self::Beside(file) => f.debug_tuple("Beside").field(file).finish(),
        }
    }
}

impl OutputFiles {
    /// Creates an empty set; outputs are compared with the inputs of a registry.
    pub fn new(registry: &FileRegistry) -> Self {
        Self {
            registry: registry.clone(),
            claims: Vec::new(),
            open: Vec::new(),
            compared: 0,
            swept: BTreeSet::new(),
            forced: None,
        }
    }

    /// Returns the set whose outputs all may replace these files, if they are given.
    #[must_use]
    pub fn forced(self, forced: Option<Replaces>) -> Self {
        Self { forced, ..self }
    }

    /// Returns the files that an output may replace.
    pub fn replaces(&self, replaces: Replaces) -> Replaces {
        self.forced.unwrap_or(replaces)
    }

    /// Begins an output as [`create`](Self::create) does, and creates its folder if it is missing.
    ///
    /// # Errors
    /// The folder cannot be made, or the file cannot be written.
    pub fn create_in_folder(
        &mut self,
        name: &'static str,
        path: &Path,
        replaces: Replaces,
    ) -> Result<OutputFile, HostError> {
        let folder = path.parent().unwrap_or(path);
        std::fs::create_dir_all(folder).map_err(|error| HostError::write(folder, error))?;
        self.create(name, path, replaces)
    }

    /// Creates a part of the outputs of other work, which has compared them with all known inputs.
    pub(crate) fn part_of(whole: &Self) -> Self {
        Self {
            compared: whole.registry.count(),
            ..Self::new(&whole.registry)
        }
    }

    /// Begins an output; `name` identifies it in errors. A device or a pipe is opened, a file
    /// is written next to the one that it replaces.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn create(
        &mut self,
        name: &'static str,
        path: &Path,
        replaces: Replaces,
    ) -> Result<OutputFile, HostError> {
        if is_device(path) {
            let file = std::fs::File::options().append(true).open(path);
            let file = file.map_err(|error| HostError::write(path, error))?;
            return Ok(self.keep(path, OutputPlace::Open(Box::new(file))));
        }
        self.claim(name, path, replaces);
        self.begin(path)
    }

    /// Notes a file that will be written, before its content is known.
    pub fn claim(&mut self, name: &'static str, path: &Path, replaces: Replaces) {
        self.claims.push(Claim {
            name,
            path: path.to_owned(),
            replaces: self.replaces(replaces),
        });
    }

    /// Begins a file that was claimed.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn begin(&mut self, path: &Path) -> Result<OutputFile, HostError> {
        let beside = AtomicFile::begin(path).map_err(|error| HostError::write(path, error))?;
        take_away_left(&beside, &mut self.swept);
        Ok(self.keep(path, OutputPlace::Beside(beside)))
    }

    /// Reports which output would destroy an input, once the inputs are known and before anything runs.
    ///
    /// # Errors
    /// An output is an input or another output.
    pub fn check(&self) -> Result<(), HostError> {
        self.registry.check(&self.claims, self.compared)
    }

    /// Puts every file in place once everything is written, and calls `placed` for each.
    ///
    /// # Errors
    /// A file cannot be written, or has become an input meanwhile.
    pub fn finish(self, mut placed: impl FnMut(&Path)) -> Result<(), HostError> {
        for file in &self.open {
            file.sync()?;
        }
        // The called programs are known now.
        self.registry.check(&self.claims, self.compared)?;
        // Either all files are put in place, or none.
        for file in &self.open {
            if let OutputPlace::Beside(beside) = &*file.place() {
                beside
                    .check_place()
                    .map_err(|error| HostError::write(&file.path, error))?;
            }
        }
        let mut in_place = Placed::default();
        for file in &self.open {
            if let OutputPlace::Beside(beside) = &mut *file.place() {
                in_place.take_place(beside, &file.path)?;
                placed(&file.path);
            }
        }
        in_place.settle()
    }

    fn keep(&mut self, path: &Path, place: OutputPlace) -> OutputFile {
        let file = OutputFile {
            path: path.into(),
            place: Arc::new(Mutex::new(place)),
        };
        self.open.push(file.clone());
        file
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = match &mut *self.place() {
            OutputPlace::Open(writer) => writer.write(bytes),
            OutputPlace::Beside(file) => file.write(bytes),
        };
        written.map_err(|error| self.named(error))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = match &mut *self.place() {
            OutputPlace::Open(writer) => writer.flush(),
            OutputPlace::Beside(file) => file.flush(),
        };
        flushed.map_err(|error| self.named(error))
    }
}

impl OutputFile {
    /// Creates a result that goes to an open writer, under the name of a path.
    pub fn open(path: &Path, writer: Box<dyn Write + Send>) -> Self {
        Self {
            path: path.into(),
            place: Arc::new(Mutex::new(OutputPlace::Open(writer))),
        }
    }

    /// Flushes the finished file to the disk, where it waits for the others.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn sync(&self) -> Result<(), HostError> {
        let synced = match &mut *self.place() {
            OutputPlace::Open(writer) => writer.flush(),
            OutputPlace::Beside(beside) => beside.sync(),
        };
        synced.map_err(|error| HostError::write(&self.path, error))
    }

    /// Writes bytes.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn bytes(&mut self, bytes: &[u8]) -> Result<(), HostError> {
        self.write_all(bytes).map_err(HostError::Output)
    }

    /// Writes a value as JSON without hidden characters, and a line end.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn json(&mut self, value: &impl Serialize) -> Result<(), HostError> {
        self.bytes(json_text(value)?.as_bytes())
    }

    fn place(&self) -> MutexGuard<'_, OutputPlace> {
        self.place.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the error with the name of the file.
    fn named(&self, error: io::Error) -> io::Error {
        match error.kind() {
            io::ErrorKind::BrokenPipe | io::ErrorKind::Interrupted => error,
            kind => io::Error::new(kind, format!("{error} (`{}`)", shown_path(&self.path))),
        }
    }
}

/// Returns a value as JSON without hidden characters, and a line end.
pub(crate) fn json_text(value: &impl Serialize) -> Result<String, HostError> {
    let text = serde_json::to_string_pretty(value).map_err(io::Error::other);
    Ok(shown_json(&text.map_err(HostError::Output)?).into_owned() + "\n")
}

/// Returns whether a path names something that can only be opened, not replaced: a device, a pipe, or an open file of
/// this process.
fn is_device(path: &Path) -> bool {
    if cfg!(windows) {
        return path
            .to_str()
            .is_some_and(|name| name.eq_ignore_ascii_case("nul"));
    }
    let system = ["/dev", "/proc"].iter().any(|root| path.starts_with(root));
    let is_special = std::fs::metadata(path).is_ok_and(|it| !it.is_file() && !it.is_dir());
    is_special || (cfg!(unix) && system && !path.starts_with("/dev/shm"))
}
