//! The disk that programs, lists and configurations are read from: that of the system, with texts in
//! place of some of its files (R12.2), or one in memory (R13.3).

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::decode::decode;
use super::input::OpenText;
use super::input::reopen;
use super::memory_disk::MemoryDisk;
use super::paths::{FolderEntry, normal, or_here, relative};
use super::read::{open_regular, read_bytes};
use super::shared_map::SharedMap;
use frictcomp::text::{LineSource, TextLines};

/// Limit on the size of a file in bytes, beyond any list or configuration.
const MOST_LIST: u64 = 64 << 20;

/// The disk that a host reads from. By default it is that of the system. File names are looked up
/// without regard to case in a listing that is made once per folder; copies share these listings.
#[derive(Debug, Clone)]
pub struct Disk {
    kind: Kind,
    listings: Arc<Mutex<BTreeMap<PathBuf, Arc<FolderListing>>>>,
}

/// The names in a folder, keyed by their lower-case form.
pub(crate) type FolderListing = BTreeMap<String, Vec<OsString>>;

#[derive(Debug, Clone)]
enum Kind {
    /// The disk of the system, with texts in place of files, by their real paths.
    System(SharedMap<PathBuf, Arc<String>>),
    /// The disk of the system, with some of its files as they were in a revision.
    Revision(Arc<RevisedFiles>),
    /// Texts in memory only.
    Memory(Arc<MemoryDisk>),
}

/// Files of a revision in place of files of the system, by their real paths.
#[derive(Debug, Default)]
struct RevisedFiles {
    texts: BTreeMap<PathBuf, Arc<String>>,
    /// Files that the revision does not have.
    absent: BTreeSet<PathBuf>,
    /// The names of the texts, by their folders.
    names: BTreeMap<PathBuf, BTreeSet<OsString>>,
}

impl From<Kind> for Disk {
    fn from(kind: Kind) -> Self {
        let listings = Arc::default();
        Self { kind, listings }
    }
}

impl Default for Disk {
    fn default() -> Self {
        Kind::System(SharedMap::default()).into()
    }
}

impl Disk {
    /// Returns the disk of the system with texts in place of files, whatever name finds them: what an editor
    /// has open and may not have saved.
    pub fn with_open(texts: impl IntoIterator<Item = OpenText>) -> Self {
        let system = Self::default();
        let texts = texts.into_iter();
        let texts = texts.map(|open| (system.place_of(&open.path), open.text));
        Kind::System(texts.collect()).into()
    }

    /// Returns the disk of the system with texts that are already keyed by the [places](Self::place) of their files.
    pub fn with_placed(texts: SharedMap<PathBuf, Arc<String>>) -> Self {
        Kind::System(texts).into()
    }

    /// Returns the disk of the system with the texts that some files had in a revision, and without the files
    /// that it does not have.
    pub fn of_revision(
        texts: impl IntoIterator<Item = OpenText>,
        absent: impl IntoIterator<Item = PathBuf>,
    ) -> Self {
        let system = Self::default();
        let mut revised = RevisedFiles::default();
        for OpenText { path, text } in texts {
            let path = system.place_of(&path);
            if let (Some(folder), Some(name)) = (path.parent(), path.file_name()) {
                let names = revised.names.entry(folder.to_owned()).or_default();
                names.insert(name.to_owned());
            }
            revised.texts.insert(path, text);
        }
        let absent = absent.into_iter().map(|path| system.place_of(&path));
        revised.absent = absent.collect();
        Kind::Revision(Arc::new(revised)).into()
    }

    /// Returns a path of the system relative to the current folder, which itself is `.`.
    pub fn named(path: &Path) -> PathBuf {
        Self::named_from(path, Path::new("."))
    }

    /// Returns a path of the system relative to a folder, which itself is `.`.
    pub fn named_from(path: &Path, folder: &Path) -> PathBuf {
        let folder = Self::place(folder);
        match Self::place(path) {
            path if path == folder => ".".into(),
            path => relative(&path, &folder),
        }
    }

    /// Returns whether a file of the system is missing in a revision.
    fn is_absent(&self, path: &Path) -> bool {
        match &self.kind {
            Kind::Revision(revised) => revised.absent.contains(&self.place_of(path)),
            Kind::System(_) | Kind::Memory(_) => false,
        }
    }

    /// Returns the one path to which all names of a file of the system lead.
    pub fn place(path: &Path) -> PathBuf {
        Self::default().place_of(path)
    }

    /// Returns a disk in memory with these texts and the folders of their paths, for hosts that have no other.
    /// Relative paths begin at its root.
    pub fn in_memory(texts: impl IntoIterator<Item = OpenText>) -> Self {
        Kind::Memory(Arc::new(MemoryDisk::new(texts))).into()
    }

    /// Returns the text that stands in for a file; `None` for a file of the system itself.
    pub fn text(&self, path: &Path) -> Option<&Arc<String>> {
        match &self.kind {
            Kind::System(open) if open.is_empty() => None,
            Kind::System(open) => open.get(&self.place_of(path)),
            Kind::Revision(revised) => revised.texts.get(&self.place_of(path)),
            Kind::Memory(disk) => disk.text(path),
        }
    }

    /// Returns the lines of a program that was run, by its name in records. `None` for a pipe, which can be read
    /// only once.
    pub fn lines(&self, name: &str) -> Option<Box<dyn LineSource + '_>> {
        match (self.text(Path::new(name)), &self.kind) {
            (Some(text), _) => Some(Box::new(TextLines::new(text))),
            (None, Kind::System(_) | Kind::Revision(_)) => reopen(name),
            (None, Kind::Memory(_)) => None,
        }
    }

    /// Returns the entry of a path, after links.
    pub(crate) fn entry(&self, path: &Path) -> io::Result<FolderEntry> {
        if let Kind::Memory(disk) = &self.kind {
            return disk.entry(path);
        }
        if self.is_absent(path) {
            return Err(io::ErrorKind::NotFound.into());
        }
        match std::fs::metadata(path) {
            // A file that is open and was never saved is where its name says.
            Err(_) if self.text(path).is_some() => Ok(FolderEntry::File),
            Err(error) => Err(error),
            Ok(metadata) if metadata.is_file() => Ok(FolderEntry::File),
            Ok(metadata) if metadata.is_dir() => Ok(FolderEntry::Folder),
            Ok(_) => Ok(FolderEntry::Special),
        }
    }

    /// Returns whether there is a file.
    pub(crate) fn is_file(&self, path: &Path) -> bool {
        self.entry(path)
            .is_ok_and(|entry| entry == FolderEntry::File)
    }

    /// Returns the one path of an existing entry, all links resolved; an empty path is the current folder.
    pub(crate) fn real(&self, path: &Path) -> io::Result<PathBuf> {
        match &self.kind {
            Kind::Memory(disk) => disk.real(path),
            _ if self.is_absent(path) => Err(io::ErrorKind::NotFound.into()),
            Kind::System(_) | Kind::Revision(_) => match or_here(path).canonicalize() {
                Err(_) if self.text(path).is_some() => Ok(self.place_of(path)),
                real => real,
            },
        }
    }

    /// Returns the path from the root on, without `.` and with `..` resolved by name; an empty path is the
    /// current folder.
    pub fn absolute(&self, path: &Path) -> Option<PathBuf> {
        match &self.kind {
            Kind::Memory(_) => Some(MemoryDisk::absolute(path)),
            Kind::System(_) | Kind::Revision(_) => std::path::absolute(or_here(path))
                .ok()
                .map(|path| normal(&path)),
        }
    }

    /// Returns the names in a folder, listed once: calls of a missing program would list it each time.
    pub(crate) fn listing(&self, folder: &Path) -> Arc<FolderListing> {
        let mut known = self.listings.lock().unwrap_or_else(PoisonError::into_inner);
        let listing = known.entry(folder.to_owned()).or_insert_with(|| {
            let mut names = FolderListing::new();
            for name in self.names(folder) {
                if let Some(text) = name.to_str() {
                    names.entry(text.to_lowercase()).or_default().push(name);
                }
            }
            Arc::new(names)
        });
        Arc::clone(listing)
    }

    /// Returns the names in a folder, sorted; an empty path is the current one.
    pub(crate) fn names(&self, folder: &Path) -> Vec<OsString> {
        if let Kind::Memory(disk) = &self.kind {
            return disk.names(folder);
        }
        let entries = std::fs::read_dir(or_here(folder)).into_iter().flatten();
        let mut names: Vec<OsString> = entries.flatten().map(|entry| entry.file_name()).collect();
        if let Kind::Revision(revised) = &self.kind {
            let folder = self.place_of(folder);
            names.retain(|name| !revised.absent.contains(&folder.join(name)));
            names.extend(revised.names.get(&folder).into_iter().flatten().cloned());
        }
        names.sort();
        names.dedup();
        names
    }

    /// Opens a regular file, to be read piece by piece.
    ///
    /// # Errors
    /// It does not exist, cannot be read, or is not a regular file.
    pub(crate) fn open(&self, path: &Path) -> io::Result<Box<dyn Read + '_>> {
        Ok(match self.text(path) {
            Some(text) => Box::new(text.as_bytes()),
            None => Box::new(open_regular(path)?.0),
        })
    }

    /// Reads the text of a regular file.
    ///
    /// # Errors
    /// It does not exist, cannot be read, is not a regular file, or is too big to be kept.
    pub(crate) fn read(&self, path: &Path) -> io::Result<String> {
        match (self.text(path), &self.kind) {
            (Some(text), _) => Ok(text.to_string()),
            (None, _) if self.is_absent(path) => Err(io::ErrorKind::NotFound.into()),
            (None, Kind::System(_) | Kind::Revision(_)) => read_bytes(path).map(decode),
            (None, Kind::Memory(disk)) => Err(match disk.entry(path)? {
                FolderEntry::Folder => io::ErrorKind::IsADirectory.into(),
                FolderEntry::File | FolderEntry::Special => io::ErrorKind::NotFound.into(),
            }),
        }
    }

    /// Reads the text of a list or a configuration.
    ///
    /// # Errors
    /// As [`read`](Self::read); also if it is larger than any list (R9.94).
    pub(crate) fn read_list(&self, path: &Path) -> io::Result<String> {
        let length = std::fs::metadata(path).map_or(0, |found| found.len());
        if self.text(path).is_none() && length > MOST_LIST {
            let reason = "it is larger than 64 MiB, which no list or configuration is";
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, reason));
        }
        self.read(path)
    }

    /// Returns the one path to which all names of a file of the system lead; for a file that does not exist it
    /// is derived from its folder.
    fn place_of(&self, path: &Path) -> PathBuf {
        let there = || path.canonicalize().ok();
        let beside = || Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?));
        let named = || self.absolute(path);
        let found = there().or_else(beside).or_else(named);
        found.unwrap_or_else(|| path.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_found_under_every_name_of_its_file() {
        // R12.2
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir(path("deep")).unwrap();
        std::fs::write(path("a.nc"), "disk").unwrap();
        let open = |name: &str| OpenText {
            path: path(name),
            text: Arc::new(name.to_owned()),
        };
        let disk = Disk::with_open([open("a.nc"), open("deep/../new.nc")]);
        let of = |name: &str| disk.text(&path(name)).map(|text| text.as_str());
        assert_eq!(of("a.nc"), Some("a.nc"));
        assert_eq!(of("deep/../a.nc"), Some("a.nc"));
        assert_eq!(of("new.nc"), Some("deep/../new.nc"));
        assert_eq!(of("other.nc"), None);
        assert_eq!(Disk::default().text(&path("a.nc")), None);
        assert_eq!(disk.entry(&path("new.nc")).ok(), Some(FolderEntry::File));
        assert!(disk.real(&path("new.nc")).unwrap().ends_with("new.nc"));
    }

    #[test]
    fn a_revision_has_other_files() {
        // R17.4
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        for name in ["same.nc", "changed.nc", "new.nc"] {
            std::fs::write(path(name), "today").unwrap();
        }
        let open = |name: &str| OpenText {
            path: path(name),
            text: Arc::new("before".to_owned()),
        };
        let texts = [open("changed.nc"), open("gone.nc"), open("old/deep.nc")];
        let disk = Disk::of_revision(texts, [path("new.nc")]);
        let read = |name: &str| disk.read(&path(name)).ok();
        assert_eq!(read("same.nc").as_deref(), Some("today"));
        for name in ["changed.nc", "gone.nc", "old/deep.nc"] {
            assert_eq!(read(name).as_deref(), Some("before"), "{name}");
            assert!(disk.is_file(&path(name)), "{name}");
        }
        assert_eq!(
            (read("new.nc"), disk.is_file(&path("new.nc"))),
            (None, false)
        );
        let names = disk.names(root.path());
        assert_eq!(names, ["changed.nc", "gone.nc", "same.nc"]);
    }
}
