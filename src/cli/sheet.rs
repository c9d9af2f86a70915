//! A result that is whole or not there: a file takes its place in one step, at the end.

use std::io::{self, Write};
use std::path::Path;

use super::console::Console;
use super::failure::Failure;
use super::replace::Replacement;

/// Where a result goes.
pub(super) enum Sheet {
    /// To stdout, or to what is no file.
    Open(Box<dyn Write>),
    /// Beside the file whose place it takes.
    Beside(Replacement),
    /// It is whole.
    Done,
}

impl Sheet {
    /// A place for the result: the file that the user named, or stdout.
    pub(super) fn create(file: Option<&Path>, console: Console) -> Result<Self, Failure> {
        match file {
            None => Ok(Self::Open(console.stdout().writer)),
            // A device or a pipe cannot be replaced.
            Some(path) if path.exists() && !path.is_file() => {
                Ok(Self::Open(console.target(file)?.writer))
            }
            Some(path) => Replacement::begin(path)
                .map(Self::Beside)
                .map_err(|error| Failure::writing(path, &error)),
        }
    }

    /// Everything is written: a file takes its place.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        match std::mem::replace(self, Self::Done) {
            Self::Beside(file) => file.commit(),
            Self::Open(mut writer) => writer.flush(),
            Self::Done => Ok(()),
        }
    }
}

impl Write for Sheet {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Open(writer) => writer.write(bytes),
            Self::Beside(file) => file.write(bytes),
            Self::Done => Ok(bytes.len()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Open(writer) => writer.flush(),
            Self::Beside(file) => file.flush(),
            Self::Done => Ok(()),
        }
    }
}

impl Console {
    /// Writes a text into the file that the user named, or to stdout.
    pub(super) fn deliver(self, file: Option<&Path>, text: &str) -> Result<(), Failure> {
        let Some(path) = file else {
            return self.print(text);
        };
        let mut sheet = Sheet::create(file, self)?;
        sheet
            .write_all(text.as_bytes())
            .and_then(|()| sheet.finish())
            .map_err(|error| Failure::writing(path, &error))
    }
}
