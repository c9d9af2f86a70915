//! Files that are replaced in one step: whether the tool is killed or the disk is full, the old or
//! the new file is there, whole.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::failure::Failure;

/// The end of the name of a file that is not whole yet.
const SUFFIX: &str = ".tmp";

/// A file that is written beside the old one. Dropped before [`commit`](Self::commit), it leaves
/// the old one as it was.
pub(super) struct Replacement {
    file: NamedTempFile,
    target: PathBuf,
}

impl Replacement {
    /// Begins a file beside the old one. It keeps the rights of the old one; a link stays a link.
    pub(super) fn begin(path: &Path) -> io::Result<Self> {
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let prefix = prefix(&target);
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(SUFFIX);
        #[cfg(unix)]
        builder.permissions(new_file_permissions());
        let file = builder.tempfile_in(folder(&target))?;
        if let Ok(old) = std::fs::metadata(&target) {
            file.as_file().set_permissions(old.permissions())?;
        }
        Ok(Self { file, target })
    }

    /// Syncs the file and lets it take the old one's place.
    pub(super) fn commit(self) -> io::Result<()> {
        self.file.as_file().sync_all()?;
        self.file.persist(&self.target)?;
        #[cfg(unix)]
        File::open(folder(&self.target))?.sync_all()?;
        Ok(())
    }
}

impl Write for Replacement {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Replaces a file by these bytes.
///
/// # Errors
/// The file cannot be written. The old one is as it was.
pub(super) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    Replacement::begin(path)
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.commit()
        })
        .map_err(|error| Failure::writing(path, &error))
}

/// Takes away what killed runs left half written. The caller holds the lock of the file, so that
/// nobody is writing it.
pub(super) fn take_away_unfinished(path: &Path) {
    let prefix = prefix(path);
    let Ok(entries) = std::fs::read_dir(folder(path)) else {
        return;
    };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        if name.starts_with(prefix.as_encoded_bytes()) && name.ends_with(SUFFIX.as_bytes()) {
            // What cannot be removed does no harm.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// `.state.json-` for `state.json`.
fn prefix(path: &Path) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(path.file_name().unwrap_or_default());
    prefix.push("-");
    prefix
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// What a new file gets; the user's mask takes away from it.
#[cfg(unix)]
fn new_file_permissions() -> std::fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    std::fs::Permissions::from_mode(0o666)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("v.lis");
        replace(&path, b"old").unwrap();
        let mut unfinished = Replacement::begin(&path).unwrap();
        unfinished.write_all(b"hal").unwrap();
        drop(unfinished);
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        replace(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(replace(&folder.path().join("no/v.lis"), b"x").is_err());
    }

    #[test]
    fn only_unfinished_files_of_the_same_name_are_taken_away() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in [
            ".s.json-a1.tmp",
            ".t.json-a1.tmp",
            "s.json-a1.tmp",
            ".s.json-a1",
        ] {
            std::fs::write(path(name), "").unwrap();
        }
        replace(&path("s.json"), b"{}").unwrap();
        take_away_unfinished(&path("s.json"));
        assert_eq!(std::fs::read(path("s.json")).unwrap(), b"{}");
        assert!(!path(".s.json-a1.tmp").exists());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4);
    }
}
