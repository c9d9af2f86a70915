//! Files that are replaced in one step: if the tool is killed or the disk is full, the old or
//! the new file is there, complete.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, Metadata};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use tempfile::{NamedTempFile, TempPath};

use super::in_use::{check_replaceable, device, patiently, told_of_replacing};
use super::interrupt::Unfinished;
use crate::disk::folder;
use crate::error::HostError;

/// Beginning and end of the name of an unfinished file. The letters between are random.
const PREFIX: &str = ".frictcomp-";
const SUFFIX: &str = ".tmp";
const LETTERS: usize = 16;

/// Number of attempts for a new file where another run takes it for a leftover.
const TRIES: u32 = 8;

/// Number of waiting files that stay open and locked; a process may open some hundreds.
const MOST_HELD: usize = 200;

static HELD: AtomicUsize = AtomicUsize::new(0);

/// A locked file that is completely written. While it is open, other runs do not mistake what it
/// locks for a leftover.
#[derive(Debug)]
struct Held(#[allow(dead_code, reason = "it is there to be dropped")] File);

impl Held {
    fn keep(file: File) -> Option<Self> {
        if HELD.fetch_add(1, Ordering::SeqCst) < MOST_HELD {
            return Some(Self(file));
        }
        HELD.fetch_sub(1, Ordering::SeqCst);
        None
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        HELD.fetch_sub(1, Ordering::SeqCst);
    }
}

/// A file that is written next to the old one. Dropped before [`take_place`](Self::take_place), it
/// leaves the old one as it was.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    stage: FileStage,
    target: PathBuf,
}

#[derive(Debug)]
enum FileStage {
    /// Open file to which more data may follow. The file is locked, so that other runs know that it is being written.
    Open(NamedTempFile),
    /// File written to the disk under a temporary name. Many files may wait for each other; most of them stay locked.
    Synced(TempPath, Option<Held>),
    /// File in its final place.
    Done,
}

impl AtomicFile {
    /// Begins a file next to the old one. It keeps the permissions of the old one; a link stays a link.
    ///
    /// # Errors
    /// The old file may not be written or is a link to nothing, or no new one can be created.
    pub(crate) fn begin(path: &Path) -> io::Result<Self> {
        let target = target(path)?;
        let file = create(folder(&target))?;
        if let Ok(old) = std::fs::metadata(&target) {
            file.as_file().set_permissions(old.permissions())?;
        }
        Ok(Self {
            stage: FileStage::Open(file),
            target,
        })
    }

    /// Flushes the finished file to the disk.
    ///
    /// # Errors
    /// It cannot be written to the disk.
    pub(crate) fn sync(&mut self) -> io::Result<()> {
        if let FileStage::Open(file) = &mut self.stage {
            file.flush()?;
            file.as_file().sync_all()?;
        }
        self.stage = match std::mem::replace(&mut self.stage, FileStage::Done) {
            FileStage::Open(file) => {
                let (file, path) = file.into_parts();
                FileStage::Synced(path, Held::keep(file))
            }
            stage => stage,
        };
        Ok(())
    }

    /// Checks beforehand, to the extent possible, that the old file can be replaced.
    ///
    /// # Errors
    /// Another program has it open.
    pub(crate) fn check_place(&self) -> io::Result<()> {
        check_replaceable(&self.target)
    }

    /// Replaces the old file.
    ///
    /// # Errors
    /// It cannot be written, or moved.
    pub(crate) fn take_place(&mut self) -> io::Result<()> {
        self.place(|file, target| file.persist(target))
    }

    /// Moves the file to a free place; a file that is there by now stays.
    ///
    /// # Errors
    /// It cannot be written, or the place is taken.
    pub(crate) fn take_free_place(&mut self) -> io::Result<()> {
        self.place(|file, target| file.persist_noclobber(target))
    }

    fn place(
        &mut self,
        persist: fn(TempPath, &Path) -> Result<(), tempfile::PathPersistError>,
    ) -> io::Result<()> {
        self.sync()?;
        let FileStage::Synced(file, _held) = std::mem::replace(&mut self.stage, FileStage::Done)
        else {
            return Ok(());
        };
        let mut unfinished = Unfinished::lock();
        let path = file.to_path_buf();
        let mut file = Some(file);
        let persisted = patiently(|| match file.take() {
            Some(waiting) => persist(waiting, &self.target).map_err(|failed| {
                file = Some(failed.path);
                failed.error
            }),
            None => Ok(()),
        });
        drop(file);
        unfinished.forget(&path);
        persisted.map_err(told_of_replacing)
    }
}

/// The files that took their place, by their folders.
#[derive(Debug, Default)]
pub(crate) struct Placed(BTreeMap<PathBuf, Vec<PathBuf>>);

impl Placed {
    /// Moves a file to its place, under the name that the user gave it.
    ///
    /// # Errors
    /// It cannot be written; the error names the files already in place (R9.95).
    pub(crate) fn take_place(
        &mut self,
        file: &mut AtomicFile,
        path: &Path,
    ) -> Result<(), HostError> {
        if let Err(reason) = file.take_place() {
            let failed = HostError::write(path, reason);
            let written: Vec<PathBuf> = self.0.values().flatten().cloned().collect();
            return Err(if written.is_empty() {
                failed
            } else {
                let failed = Box::new(failed);
                HostError::PartlyWritten { failed, written }
            });
        }
        self.add(file, path);
        Ok(())
    }

    /// Records a file under the name that the user gave it.
    pub(crate) fn add(&mut self, file: &AtomicFile, path: &Path) {
        let folder = folder(&file.target).to_owned();
        self.0.entry(folder).or_default().push(path.to_owned());
    }

    /// Flushes the new names to the disk, so that the files stay in place when the power fails.
    ///
    /// # Errors
    /// The disk fails. The files are in place nevertheless.
    pub(crate) fn settle(self) -> Result<(), HostError> {
        for (folder, files) in self.0 {
            settle(&folder).map_err(|reason| HostError::Unsettled { files, reason })?;
        }
        Ok(())
    }
}

/// Flushes a folder. One that may not be read, or a file system without this call, is not an error.
#[cfg(unix)]
fn settle(folder: &Path) -> io::Result<()> {
    let Ok(file) = File::open(folder) else {
        return Ok(());
    };
    file.sync_all().or_else(|error| match error.kind() {
        io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported => Ok(()),
        _ => Err(error),
    })
}

#[cfg(not(unix))]
#[allow(
    clippy::unnecessary_wraps,
    reason = "elsewhere the names go to the disk with the files"
)]
fn settle(_: &Path) -> io::Result<()> {
    Ok(())
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.stage {
            FileStage::Open(file) => file.write(bytes),
            FileStage::Synced(..) | FileStage::Done => Err(io::Error::other("it is complete")),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.stage {
            FileStage::Open(file) => file.flush(),
            FileStage::Synced(..) | FileStage::Done => Ok(()),
        }
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        let path = match &self.stage {
            FileStage::Open(file) => file.path().to_owned(),
            FileStage::Synced(path, _) => path.to_path_buf(),
            FileStage::Done => return,
        };
        let mut unfinished = Unfinished::lock();
        self.stage = FileStage::Done;
        unfinished.forget(&path);
    }
}

/// Returns the file that a path names, with links followed. It may be missing, a link to nothing may not.
///
/// # Errors
/// It may not be written.
pub(crate) fn target(path: &Path) -> io::Result<PathBuf> {
    if let Some(device) = device(path).filter(|_| cfg!(windows)) {
        let reason = format!("`{device}` is the name of a device on Windows");
        return Err(io::Error::other(reason));
    }
    let Ok(found) = std::fs::symlink_metadata(path) else {
        return Ok(place(path));
    };
    if found.is_symlink() && !path.exists() {
        let reason = "it is a link to a file that does not exist";
        return Err(io::Error::other(reason));
    }
    let target = if found.is_symlink() {
        std::fs::canonicalize(path)?
    } else {
        place(path)
    };
    let metadata = std::fs::metadata(&target)?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if metadata.permissions().readonly() {
        return Err(io::Error::other("it is read-only"));
    }
    Ok(target)
}

/// Returns the place of a file that is not a link. On Windows an absolute path may be longer than others.
fn place(path: &Path) -> PathBuf {
    let whole = || Some(folder(path).canonicalize().ok()?.join(path.file_name()?));
    let whole = if cfg!(windows) { whole() } else { None };
    whole.unwrap_or_else(|| path.to_owned())
}

/// Creates a file in a folder that no run takes for a leftover.
fn create(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(LETTERS);
    #[cfg(unix)]
    builder.permissions(new_file_permissions());
    let mut unfinished = Unfinished::lock();
    for _ in 0..TRIES {
        let file = builder.tempfile_in(folder)?;
        // The process that holds the lock is alive (see `take_away_left`). Not every file system has locks.
        let is_taken = matches!(
            file.as_file().try_lock(),
            Err(std::fs::TryLockError::WouldBlock)
        );
        if !is_taken && file.path().exists() {
            unfinished.add(file.path());
            return Ok(file);
        }
    }
    Err(io::Error::other("other runs delete every new file"))
}

/// Removes what killed runs of the same user left in the folder of a file. The unfinished file of a
/// live run is locked.
pub(crate) fn take_away_left(beside: &AtomicFile, seen: &mut BTreeSet<PathBuf>) {
    let folder = folder(&beside.target);
    let FileStage::Open(own) = &beside.stage else {
        return;
    };
    if !seen.insert(folder.to_owned()) {
        return;
    }
    let (Ok(entries), Ok(mine)) = (std::fs::read_dir(folder), own.as_file().metadata()) else {
        return;
    };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        if !name.to_str().is_some_and(is_unfinished) || own.path().file_name() == Some(&name) {
            continue;
        }
        let is_ours = std::fs::symlink_metadata(entry.path())
            .is_ok_and(|metadata| metadata.is_file() && same_owner(&metadata, &mine));
        if is_ours
            && let Ok(file) = File::open(entry.path())
            && file.try_lock().is_ok()
        {
            // A file that cannot be removed does no harm.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Returns whether a name has exactly the form that [`create`] gives.
fn is_unfinished(name: &str) -> bool {
    name.strip_prefix(PREFIX)
        .and_then(|rest| rest.strip_suffix(SUFFIX))
        .is_some_and(|letters| {
            letters.len() == LETTERS && letters.bytes().all(|it| it.is_ascii_alphanumeric())
        })
}

#[cfg(unix)]
fn same_owner(one: &Metadata, other: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    one.uid() == other.uid()
}

#[cfg(not(unix))]
fn same_owner(_: &Metadata, _: &Metadata) -> bool {
    true
}

/// Returns the permissions of a new file; the user's mask takes away from them.
#[cfg(unix)]
fn new_file_permissions() -> std::fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    std::fs::Permissions::from_mode(0o666)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut file = AtomicFile::begin(path)?;
        file.write_all(bytes)?;
        file.sync()?;
        file.take_place()
    }

    #[test]
    fn a_file_is_replaced_whole() {
        // R9.31
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("v.lis");
        replace(&path, b"old").unwrap();
        let mut unfinished = AtomicFile::begin(&path).unwrap();
        unfinished.write_all(b"hal").unwrap();
        drop(unfinished);
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        replace(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(replace(&folder.path().join("no/v.lis"), b"x").is_err());
    }

    #[test]
    fn only_what_killed_runs_left_is_taken_away() {
        // R9.31
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let others = [
            ".mill-backup.tmp",
            ".frictcomp-notes.tmp",
            ".frictcomp-abcdefghijklmnop.tmp~",
            ".frictcomp-abcdefgh-jklmnop.tmp",
            ".st-2-abcdef.tmp",
        ];
        let left = ".frictcomp-abcdefghijklmnop.tmp";
        for name in others.into_iter().chain([left]) {
            std::fs::write(path(name), "").unwrap();
        }
        let alive = AtomicFile::begin(&path("st-2")).unwrap();
        let mine = AtomicFile::begin(&path("st")).unwrap();
        take_away_left(&mine, &mut BTreeSet::new());
        assert!(!path(left).exists());
        assert!(others.iter().all(|name| path(name).exists()));
        for mut file in [alive, mine] {
            // A file that is complete and waits for others stays, too.
            file.sync().unwrap();
            let other = AtomicFile::begin(&path("other")).unwrap();
            take_away_left(&other, &mut BTreeSet::new());
            file.take_place().unwrap();
        }
        assert!(path("st").exists() && path("st-2").exists());
    }

    #[test]
    fn what_may_not_be_written_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("kept");
        std::fs::write(&path, "kept").unwrap();
        let mut rights = std::fs::metadata(&path).unwrap().permissions();
        rights.set_readonly(true);
        std::fs::set_permissions(&path, rights).unwrap();
        let error = AtomicFile::begin(&path).unwrap_err();
        assert!(error.to_string().contains("read-only"));
        assert!(AtomicFile::begin(folder.path()).is_err());
        #[cfg(unix)]
        {
            let link = folder.path().join("link");
            std::os::unix::fs::symlink(folder.path().join("no"), &link).unwrap();
            let error = AtomicFile::begin(&link).unwrap_err();
            assert!(error.to_string().contains("does not exist"));
        }
    }
}
