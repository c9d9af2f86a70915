//! A result that is whole or not there: a file takes its place in one step, at the end.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::console::Console;
use super::failure::Failure;

/// Where a long result goes.
pub(super) enum Sheet {
    /// To stdout, or to what is no file.
    Open(Box<dyn Write>),
    /// Beside the file whose place it takes.
    Beside(NamedTempFile, PathBuf),
    /// It is whole.
    Done,
}

impl Sheet {
    /// A place for the result: the file that the user named, or stdout.
    pub(super) fn create(file: Option<&Path>, console: Console) -> Result<Self, Failure> {
        let Some(path) = file else {
            return Ok(Self::Open(console.stdout().writer));
        };
        if path.exists() && !path.is_file() {
            return Ok(Self::Open(console.target(file)?.writer));
        }
        // A link stays a link: the file that it names is replaced.
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let beside = builder.prefix(".frictcomp-").tempfile_in(folder);
        let beside = beside.and_then(|beside| {
            if let Ok(old) = std::fs::metadata(&target) {
                beside.as_file().set_permissions(old.permissions())?;
            }
            Ok(beside)
        });
        let beside = beside.map_err(|error| Failure::writing(path, &error))?;
        Ok(Self::Beside(beside, target))
    }

    /// Everything is written: a file takes its place.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        match std::mem::replace(self, Self::Done) {
            Self::Beside(file, path) => {
                file.as_file().sync_all()?;
                file.persist(path)?;
                Ok(())
            }
            Self::Open(mut writer) => writer.flush(),
            Self::Done => Ok(()),
        }
    }
}

impl Write for Sheet {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Open(writer) => writer.write(bytes),
            Self::Beside(file, _) => file.write(bytes),
            Self::Done => Ok(bytes.len()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Open(writer) => writer.flush(),
            Self::Beside(file, _) => file.flush(),
            Self::Done => Ok(()),
        }
    }
}
