//! The lists on the disk (R3.12).

use std::io;
use std::path::{Component, Path, PathBuf};

use crate::disk::{Disk, FileRegistry, spelt_as};
use crate::error::HostError;
use frictcomp::machine::{ListFiles, NoList};
use frictcomp::text::{SourceFile, shown_path};

/// The lists on a disk.
#[derive(Debug, Clone, Default)]
pub struct ListsOnDisk {
    disk: Disk,
    registry: FileRegistry,
}

impl ListsOnDisk {
    /// Creates the lists on this disk.
    pub fn new(disk: &Disk) -> Self {
        Self {
            disk: disk.clone(),
            registry: FileRegistry::default(),
        }
    }

    /// Notes the lists that are read in this registry.
    pub fn noting(self, registry: &FileRegistry) -> Self {
        let registry = registry.clone();
        Self { registry, ..self }
    }
}

impl ListFiles for ListsOnDisk {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let path = Path::new(path);
        let spelt = as_spelt(path, &self.disk);
        let found = spelt.as_deref().unwrap_or(path);
        match self.disk.read_list(found) {
            Ok(text) => {
                self.registry.reads("list", found);
                Ok(SourceFile::new(shown_path(found), text))
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => Err(NoList::Missing),
            Err(error) => Err(NoList::Unreadable(error.to_string())),
        }
    }

    /// Goes up by name where the path has one, then by `..` up to the root.
    fn above(&self, folder: &str) -> Option<String> {
        let path = Path::new(folder);
        match path.components().next_back() {
            Some(Component::Normal(_)) => Some(shown_path(path.parent()?)),
            None | Some(Component::CurDir | Component::ParentDir) => {
                let above = path.join("..");
                let (here, there) = (self.disk.real(path).ok()?, self.disk.real(&above).ok()?);
                (here != there).then(|| shown_path(&above))
            }
            Some(Component::RootDir | Component::Prefix(_)) => None,
        }
    }
}

/// Reads a list or a configuration that the user names.
///
/// # Errors
/// It does not exist, cannot be read, is a folder, or is too big to be kept.
pub fn read_list(path: &Path, disk: &Disk) -> Result<SourceFile, HostError> {
    let text = disk.read_list(path).map_err(|error| match error.kind() {
        io::ErrorKind::IsADirectory => HostError::FolderAsList(path.to_owned()),
        _ => HostError::read(path, error),
    })?;
    Ok(SourceFile::new(shown_path(path), text))
}

/// Returns the path as it is spelt on the disk. The control's disk does not distinguish upper from lower case.
fn as_spelt(path: &Path, disk: &Disk) -> Option<PathBuf> {
    if disk.entry(path).is_ok() {
        let real = disk.real(path).ok().filter(|_| cfg!(windows));
        return Some(real.map_or_else(|| path.to_owned(), |real| spelt_as(path, &real)));
    }
    let mut spelt = PathBuf::new();
    for part in path.components() {
        let whole = spelt.join(part);
        spelt = if disk.entry(&whole).is_ok() {
            whole
        } else {
            alike(&spelt, part.as_os_str().to_str()?, disk)?
        };
    }
    Some(spelt)
}

/// Returns the entry with a name in a folder, case ignored.
fn alike(folder: &Path, wanted: &str, disk: &Disk) -> Option<PathBuf> {
    let mut names = disk.names(folder).into_iter();
    let is_alike = |name: &str| name.eq_ignore_ascii_case(wanted);
    let found = names.find(|name| name.to_str().is_some_and(is_alike));
    found.map(|name| folder.join(name))
}
