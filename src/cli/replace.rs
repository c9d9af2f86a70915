//! Files that are replaced in one step: whether the tool is killed or the disk is full, the old or
//! the new file is there, whole.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use super::console::Console;
use super::failure::Failure;

/// The end of the name of a file that is not whole yet.
const SUFFIX: &str = ".tmp";

impl Console {
    /// Writes a text into the file that the user named, or to stdout.
    ///
    /// # Errors
    /// It cannot be written. An old file is as it was.
    pub(super) fn deliver(self, file: Option<&Path>, text: &str) -> Result<(), Failure> {
        match file {
            None => self.print(text),
            Some(path) => replace(path, text.as_bytes()),
        }
    }
}

/// Writes a file beside the old one, syncs it and lets it take the old one's place. It keeps the
/// rights of the old one; a link stays a link.
///
/// # Errors
/// The file cannot be written. The old one is as it was.
pub(super) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    write(path, bytes).map_err(|error| Failure::writing(path, &error))
}

fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let old = std::fs::metadata(path).ok();
    // A device or a pipe cannot be replaced.
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        return std::fs::write(path, bytes);
    }
    let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = folder(&path);
    let prefix = prefix(&path);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    builder.permissions(new_file_permissions());
    let mut file = builder.tempfile_in(folder)?;
    if let Some(old) = old {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(&path).map_err(|error| error.error)?;
    #[cfg(unix)]
    File::open(folder)?.sync_all()?;
    Ok(())
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
        replace(&path, b"new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
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
