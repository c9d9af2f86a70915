//! The files that a command writes: all take their place at the end, or none (R9.70).

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::console::{Console, Target};
use super::failure::Failure;
use super::ledger::{Claim, Ledger};
use super::unfinished::{UnfinishedFile, take_away_left};

/// The name that stands for standard output.
const STDOUT: &str = "-";

/// The results of a command. Dropped before [`finish`](Self::finish), nothing was written.
pub(super) struct Outputs {
    ledger: Ledger,
    console: Console,
    claims: Vec<Claim>,
    open: Vec<OutputFile>,
    /// Who writes to standard output.
    printing: Option<&'static str>,
    /// Folders from which the leavings of killed runs are gone.
    swept: BTreeSet<PathBuf>,
}

/// A result on its way: to a file, standard output or a device.
#[derive(Clone)]
pub(super) struct OutputFile {
    path: Rc<Path>,
    place: Rc<RefCell<Place>>,
}

enum Place {
    /// Standard output, a device or a pipe, which cannot be replaced.
    Open(Box<dyn Write>),
    /// Beside the file whose place it takes.
    Beside(UnfinishedFile),
}

impl Outputs {
    /// No output yet.
    pub(super) fn new(ledger: &Ledger, console: Console) -> Self {
        Self {
            ledger: ledger.clone(),
            console,
            claims: Vec::new(),
            open: Vec::new(),
            printing: None,
            swept: BTreeSet::new(),
        }
    }

    /// The place of the main result: the file behind `--output`, or standard output.
    pub(super) fn result(&mut self, path: Option<&Path>) -> Result<Target, Failure> {
        match path {
            None => {
                self.print("the result")?;
                Ok(self.console.stdout())
            }
            Some(path) if is_stdout(path) => {
                self.print("--output -")?;
                Ok(self.console.stdout())
            }
            Some(path) => Ok(Target {
                writer: Box::new(self.create("--output", path)?),
                look: self.console.file_look(),
            }),
        }
    }

    /// The file behind an option; `-` is standard output.
    pub(super) fn file(
        &mut self,
        option: &'static str,
        path: &Path,
    ) -> Result<OutputFile, Failure> {
        if !is_stdout(path) {
            return self.create(option, path);
        }
        self.print(option)?;
        Ok(OutputFile {
            path: path.into(),
            place: Rc::new(RefCell::new(Place::Open(self.console.stdout().writer))),
        })
    }

    /// Notes a file that will be written, before it is known with what.
    pub(super) fn claim(&mut self, option: &'static str, path: &Path) {
        self.claims.push(Claim {
            option,
            path: path.to_owned(),
        });
    }

    /// Begins a file that was claimed.
    pub(super) fn begin(&mut self, path: &Path) -> Result<OutputFile, Failure> {
        let beside = UnfinishedFile::begin(path).map_err(|error| Failure::writing(path, &error))?;
        take_away_left(&beside, &mut self.swept);
        Ok(self.keep(path, Place::Beside(beside)))
    }

    /// Says who writes to standard output; there is one.
    pub(super) fn print(&mut self, who: &'static str) -> Result<(), Failure> {
        if let Some(other) = self.printing.replace(who) {
            return Err(Failure::new(format!(
                "{other} and `{who}` would both go to standard output"
            ))
            .with_help("name a file for one of them"));
        }
        Ok(())
    }

    /// The inputs are known: says which output would destroy one, before anything runs.
    pub(super) fn check(&self) -> Result<(), Failure> {
        self.ledger.check(&self.claims)
    }

    /// Everything is written: every file takes its place, and is named on stderr.
    pub(super) fn finish(self) -> Result<(), Failure> {
        for file in &self.open {
            file.sync()?;
        }
        // What the programs called is known now.
        self.ledger.check(&self.claims)?;
        for file in &self.open {
            if let Place::Beside(beside) = &mut *file.place.borrow_mut() {
                beside
                    .take_place()
                    .map_err(|error| Failure::writing(&file.path, &error))?;
                self.console
                    .remark(&format!("wrote `{}`", file.path.display()));
            }
        }
        Ok(())
    }

    fn create(&mut self, option: &'static str, path: &Path) -> Result<OutputFile, Failure> {
        let failed = |error: io::Error| Failure::writing(path, &error);
        let place = if is_device(path) {
            let file = std::fs::File::options().append(true).open(path);
            Place::Open(Box::new(file.map_err(failed)?))
        } else {
            self.claim(option, path);
            return self.begin(path);
        };
        Ok(self.keep(path, place))
    }

    fn keep(&mut self, path: &Path, place: Place) -> OutputFile {
        let file = OutputFile {
            path: path.into(),
            place: Rc::new(RefCell::new(place)),
        };
        self.open.push(file.clone());
        file
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = match &mut *self.place.borrow_mut() {
            Place::Open(writer) => writer.write(bytes),
            Place::Beside(file) => file.write(bytes),
        };
        written.map_err(|error| self.named(error))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = match &mut *self.place.borrow_mut() {
            Place::Open(writer) => writer.flush(),
            Place::Beside(file) => file.flush(),
        };
        flushed.map_err(|error| self.named(error))
    }
}

impl OutputFile {
    /// Nothing more is written: the file lies on the disk and waits for the others.
    pub(super) fn sync(&self) -> Result<(), Failure> {
        let synced = match &mut *self.place.borrow_mut() {
            Place::Open(writer) => writer.flush(),
            Place::Beside(beside) => beside.sync(),
        };
        synced.map_err(|error| Failure::writing(&self.path, &error))
    }

    /// Writes a text.
    pub(super) fn text(&mut self, text: &str) -> Result<(), Failure> {
        self.bytes(text.as_bytes())
    }

    /// Writes bytes.
    pub(super) fn bytes(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let written = self.write_all(bytes);
        written.map_err(|error| Failure::output(&error))
    }

    /// The same error with the name of the file.
    fn named(&self, error: io::Error) -> io::Error {
        match error.kind() {
            io::ErrorKind::BrokenPipe | io::ErrorKind::Interrupted => error,
            kind => io::Error::new(kind, format!("{error} (`{}`)", self.path.display())),
        }
    }
}

fn is_stdout(path: &Path) -> bool {
    path == Path::new(STDOUT) || (cfg!(unix) && path == Path::new("/dev/stdout"))
}

/// Whether a path names what can only be opened, not replaced: a device, a pipe, or an open file of
/// this process.
fn is_device(path: &Path) -> bool {
    let system = ["/dev", "/proc"].iter().any(|root| path.starts_with(root));
    let is_special = std::fs::metadata(path).is_ok_and(|it| !it.is_file() && !it.is_dir());
    is_special || (cfg!(unix) && system && !path.starts_with("/dev/shm"))
}
