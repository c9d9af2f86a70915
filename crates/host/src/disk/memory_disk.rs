//! A disk in memory, for hosts that have no other (R13.3).

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::input::OpenText;
use super::paths::{FolderEntry, normal};

/// Texts by their paths from the root on, and the folders that these paths name.
#[derive(Debug, Default)]
pub(crate) struct MemoryDisk {
    texts: HashMap<PathBuf, Arc<String>>,
    folders: BTreeMap<PathBuf, BTreeSet<OsString>>,
}

impl MemoryDisk {
    /// Creates a disk with these texts. If two have the same path, the last one counts.
    pub(crate) fn new(texts: impl IntoIterator<Item = OpenText>) -> Self {
        let mut disk = Self::default();
        disk.folders.entry(Self::root()).or_default();
        for OpenText { path, text } in texts {
            let path = Self::absolute(&path);
            let mut below = path.as_path();
            while let (Some(folder), Some(name)) = (below.parent(), below.file_name()) {
                let names = disk.folders.entry(folder.to_owned()).or_default();
                names.insert(name.to_owned());
                below = folder;
            }
            disk.texts.insert(path, text);
        }
        disk
    }

    fn root() -> PathBuf {
        PathBuf::from("/")
    }

    /// Returns the path from the root on; relative ones begin there.
    pub(crate) fn absolute(path: &Path) -> PathBuf {
        normal(&Self::root().join(path))
    }

    /// Returns the text at a path.
    pub(crate) fn text(&self, path: &Path) -> Option<&Arc<String>> {
        self.texts.get(&Self::absolute(path))
    }

    /// Returns the entry of a path.
    pub(crate) fn entry(&self, path: &Path) -> io::Result<FolderEntry> {
        let path = Self::absolute(path);
        if self.texts.contains_key(&path) {
            Ok(FolderEntry::File)
        } else if self.folders.contains_key(&path) {
            Ok(FolderEntry::Folder)
        } else {
            Err(io::ErrorKind::NotFound.into())
        }
    }

    /// Returns the path of an existing entry. There are no links.
    pub(crate) fn real(&self, path: &Path) -> io::Result<PathBuf> {
        self.entry(path).map(|_| Self::absolute(path))
    }

    /// Returns the names in a folder, sorted.
    pub(crate) fn names(&self, folder: &Path) -> Vec<OsString> {
        let names = self.folders.get(&Self::absolute(folder));
        names.into_iter().flatten().cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_make_folders() {
        // R13.3
        let text = |path: &str| OpenText {
            path: PathBuf::from(path),
            text: Arc::new(path.to_owned()),
        };
        let disk = MemoryDisk::new([text("b/c/d.nc"), text("a.nc"), text("b/../e.nc")]);
        let entry = |path: &str| disk.entry(Path::new(path)).ok();
        assert_eq!(entry("a.nc"), Some(FolderEntry::File));
        assert_eq!(entry("/b/./c/x/../d.nc"), Some(FolderEntry::File));
        assert_eq!(entry("b/c"), Some(FolderEntry::Folder));
        assert_eq!(entry(""), Some(FolderEntry::Folder));
        assert_eq!(entry("B"), None);
        assert_eq!(disk.names(Path::new("")), ["a.nc", "b", "e.nc"]);
        assert_eq!(disk.names(Path::new("b/c")), ["d.nc"]);
        assert_eq!(disk.names(Path::new("a.nc")), [""; 0]);
        let none = MemoryDisk::new([]);
        assert_eq!(none.entry(Path::new("/")).ok(), Some(FolderEntry::Folder));
    }
}
