//! The lists on the disk (R3.12).

use std::io;
use std::path::{Component, Path, PathBuf};

use super::error::HostError;
use super::open_texts::OpenTexts;
use super::read::read_bytes;
use crate::machine::{ListFiles, NoList};
use crate::text::{SourceFile, decode};

/// The lists on the disk.
#[derive(Debug, Clone, Copy, Default)]
pub struct ListsOnDisk;

impl ListFiles for ListsOnDisk {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let found = as_spelt(Path::new(path)).ok_or(NoList::Missing)?;
        match read_regular(&found) {
            Ok(text) => Ok(SourceFile::new(found.to_string_lossy().into_owned(), text)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Err(NoList::Missing),
            Err(error) => Err(NoList::Unreadable(error.to_string())),
        }
    }

    /// By name as far as the name goes, then by `..` up to the root.
    fn above(&self, folder: &str) -> Option<String> {
        let path = Path::new(folder);
        match path.components().next_back() {
            Some(Component::Normal(_)) => Some(path.parent()?.to_string_lossy().into_owned()),
            None | Some(Component::CurDir | Component::ParentDir) => {
                let above = path.join("..");
                let (here, there) = (place(path).ok()?, place(&above).ok()?);
                (here != there).then(|| above.to_string_lossy().replace('\\', "/"))
            }
            Some(Component::RootDir | Component::Prefix(_)) => None,
        }
    }
}

/// The lists on the disk, but those that are open as they are there.
pub(super) struct OpenLists<'a>(pub(super) &'a OpenTexts);

impl OpenLists<'_> {
    /// Reads a list or a configuration that the user names.
    pub(super) fn named(&self, path: &Path) -> Result<SourceFile, HostError> {
        match self.0.of(path) {
            Some(text) => Ok(SourceFile::new(path.display().to_string(), text.as_str())),
            None => read_list(path),
        }
    }
}

impl ListFiles for OpenLists<'_> {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let spelt = as_spelt(Path::new(path));
        let found = spelt.as_deref().unwrap_or(Path::new(path));
        match self.0.of(found) {
            Some(text) => Ok(SourceFile::new(
                found.to_string_lossy().into_owned(),
                text.as_str(),
            )),
            None => ListsOnDisk.read(path),
        }
    }

    fn above(&self, folder: &str) -> Option<String> {
        ListsOnDisk.above(folder)
    }
}

/// Reads a list or a configuration that the user names.
///
/// # Errors
/// It does not exist, cannot be read, is a folder, or is too big to be kept.
pub fn read_list(path: &Path) -> Result<SourceFile, HostError> {
    let text = read_regular(path).map_err(|error| match error.kind() {
        io::ErrorKind::IsADirectory => HostError::FolderAsList(path.to_owned()),
        _ => HostError::read(path, error),
    })?;
    Ok(SourceFile::new(path.display().to_string(), text))
}

/// The text of a regular file.
fn read_regular(path: &Path) -> io::Result<String> {
    read_bytes(path).map(decode)
}

/// Where a folder really is; the empty path is the current one.
fn place(folder: &Path) -> io::Result<PathBuf> {
    if folder.as_os_str().is_empty() {
        std::env::current_dir()?.canonicalize()
    } else {
        folder.canonicalize()
    }
}

/// The path as it is spelt on the disk. The control's disk does not tell upper from lower case.
fn as_spelt(path: &Path) -> Option<PathBuf> {
    if path.exists() {
        return Some(path.to_owned());
    }
    let mut spelt = PathBuf::new();
    for part in path.components() {
        let whole = spelt.join(part);
        spelt = if whole.exists() {
            whole
        } else {
            alike(&spelt, part.as_os_str().to_str()?)?
        };
    }
    Some(spelt)
}

/// What has a name in a folder, upper and lower case aside.
fn alike(folder: &Path, wanted: &str) -> Option<PathBuf> {
    let listed = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let names = std::fs::read_dir(listed).ok()?.filter_map(Result::ok);
    let mut alike: Vec<_> = names
        .map(|entry| entry.file_name())
        .filter(|name| {
            name.to_str()
                .is_some_and(|it| it.eq_ignore_ascii_case(wanted))
        })
        .collect();
    alike.sort();
    alike.into_iter().next().map(|name| folder.join(name))
}
