//! The files read and written, so that no output destroys an input (R9.70), or a program, a
//! list or a configuration that this call does not read (R9.93).

use std::collections::hash_map::{Entry, HashMap};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::Disk;
use super::file_kind::FileKind;
use crate::error::HostError;
use frictcomp::lists::ListKind;
use frictcomp::machine::{NoLists, check_list};
use frictcomp::text::{SourceFile, shown_path};

/// The files that a piece of work reads. Its copies are the same registry: called programs become known only
/// while others already run.
#[derive(Debug, Clone, Default)]
pub struct FileRegistry(Arc<Mutex<Inputs>>);

#[derive(Debug, Default)]
struct Inputs {
    /// Each file with its role.
    files: BTreeMap<Arc<Path>, &'static str>,
    /// The files in the order in which they became known.
    order: Vec<Arc<Path>>,
    /// The names of called programs that were not found.
    missed: BTreeSet<String>,
}

/// Kind of a program in the registry.
pub(crate) const PROGRAM: &str = "program";

/// A file to be written, with its name in errors.
#[derive(Debug, Clone)]
pub(crate) struct Claim {
    /// Name used in errors.
    pub name: &'static str,
    /// Path of the file.
    pub path: PathBuf,
    /// Files that it may replace.
    pub replaces: Replaces,
}

/// Files that an output may replace (R9.93).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Replaces {
    /// An earlier result.
    #[default]
    Results,
    /// Another result or a value list, since the output is one; no list of another kind.
    Lists,
    /// Any file that is not an input of the same call.
    Anything,
}

impl Claim {
    fn shown(&self) -> String {
        format!("{} {}", self.name, shown_path(&self.path))
    }

    /// Checks that the output may be written where its name leads (R9.93).
    fn check_place(&self) -> Result<(), HostError> {
        let leads_to = std::fs::symlink_metadata(&self.path)
            .is_ok_and(|found| found.is_symlink())
            .then(|| self.path.canonicalize().ok())
            .flatten();
        if let Some(target) = leads_to
            && let Some(what) = FileKind::of(&target)
        {
            return Err(HostError::LeadsToSource {
                output: self.shown(),
                what: what.as_str(),
                target,
            });
        }
        let refused = match (FileKind::of(&self.path), self.replaces) {
            (None, _) | (_, Replaces::Anything) => None,
            (Some(FileKind::List), Replaces::Lists) => {
                is_other_list(&self.path).then_some("list that is not a value list")
            }
            (Some(what), _) => {
                let is_taken = what == FileKind::Configuration || self.path.exists();
                is_taken.then(|| what.as_str())
            }
        };
        match refused {
            Some(what) => Err(HostError::ReplacesSource {
                output: self.shown(),
                what,
            }),
            None => Ok(()),
        }
    }
}

/// Returns whether a file is an existing list of another kind than a value list, judged by its keys.
fn is_other_list(path: &Path) -> bool {
    let is_there = path.is_file();
    let text = is_there
        .then(|| Disk::default().read_list(path).ok())
        .flatten();
    let kind = text.and_then(|text| {
        let list = SourceFile::new(shown_path(path), text);
        check_list(list, None, &mut NoLists).kind
    });
    kind.is_some_and(|kind| !matches!(kind, ListKind::Value | ListKind::Head))
}

impl FileRegistry {
    /// Notes a file that is read, with its role.
    pub fn reads(&self, what: &'static str, path: &Path) {
        let mut inputs = self.inputs();
        if !inputs.files.contains_key(path) {
            let path: Arc<Path> = path.into();
            inputs.files.insert(path.clone(), what);
            inputs.order.push(path);
        }
    }

    /// Returns the number of known files.
    pub(crate) fn count(&self) -> usize {
        self.inputs().order.len()
    }

    /// Reports which output is a file that is read, or another output, including links, hard links and other
    /// spellings. The outputs have already been compared with the first `compared` files.
    ///
    /// # Errors
    /// An output is such a file.
    pub(crate) fn check(&self, outputs: &[Claim], compared: usize) -> Result<(), HostError> {
        self.compare(outputs, compared)?;
        outputs.iter().try_for_each(Claim::check_place)
    }

    fn compare(&self, outputs: &[Claim], compared: usize) -> Result<(), HostError> {
        let mut written: HashMap<Identity, &Claim> = HashMap::new();
        for output in outputs {
            let Some(identity) = Identity::of_output(&output.path) else {
                continue;
            };
            match written.entry(identity) {
                Entry::Vacant(vacant) => {
                    vacant.insert(output);
                }
                Entry::Occupied(other) => {
                    return Err(HostError::SameFile {
                        one: other.get().shown(),
                        other: output.shown(),
                    });
                }
            }
        }
        if !written.keys().any(Identity::exists) {
            return Ok(());
        }
        let inputs = self.inputs();
        for input in inputs.order.iter().skip(compared) {
            let identity = Identity::of_file(input);
            if let Some(output) = identity.and_then(|identity| written.get(&identity)) {
                return Err(HostError::Overwrites {
                    output: output.shown(),
                    what: inputs.files.get(input).copied().unwrap_or_default(),
                    input: input.to_path_buf(),
                });
            }
        }
        Ok(())
    }

    /// Returns the programs that were read.
    pub fn programs(&self) -> Vec<PathBuf> {
        let inputs = self.inputs();
        let programs = inputs.files.iter().filter(|(_, what)| **what == PROGRAM);
        programs.map(|(path, _)| path.to_path_buf()).collect()
    }

    /// Returns all files that were read.
    pub fn files(&self) -> Vec<PathBuf> {
        let inputs = self.inputs();
        inputs.files.keys().map(|path| path.to_path_buf()).collect()
    }

    /// Returns whether a program came from a source that cannot be read again.
    pub fn has_streams(&self) -> bool {
        let inputs = self.inputs();
        inputs.order.iter().any(|path| !path.is_file())
    }

    /// Notes the name of a called program that was not found.
    pub(crate) fn misses(&self, name: &str) {
        let mut inputs = self.inputs();
        if !inputs.missed.contains(name) {
            inputs.missed.insert(name.to_owned());
        }
    }

    /// Returns the names of called programs that were not found.
    pub fn missed(&self) -> Vec<String> {
        self.inputs().missed.iter().cloned().collect()
    }

    fn inputs(&self) -> MutexGuard<'_, Inputs> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Identity of the file at a path.
#[derive(Debug, PartialEq, Eq, Hash)]
enum Identity {
    /// An existing file.
    File(FileKey),
    /// The place of a file that does not exist yet: its folder and its name.
    Place(FileKey, OsString),
}

/// Device and number of a file.
#[cfg(unix)]
type FileKey = (u64, u64);

/// The open file, by which the system identifies it.
#[cfg(windows)]
type FileKey = same_file::Handle;

/// Key of a file on a system without links.
#[cfg(not(any(unix, windows)))]
type FileKey = PathBuf;

impl Identity {
    fn of_file(path: &Path) -> Option<Self> {
        key(path).map(Self::File)
    }

    fn of_output(path: &Path) -> Option<Self> {
        if let Some(identity) = Self::of_file(path) {
            return Some(identity);
        }
        let name = path.file_name()?;
        // If a folder ignores case, so must this.
        let name = if cfg!(any(windows, target_os = "macos")) {
            name.to_ascii_lowercase()
        } else {
            name.to_owned()
        };
        Some(Self::Place(key(folder(path))?, name))
    }

    fn exists(&self) -> bool {
        matches!(self, Self::File(_))
    }
}

#[cfg(unix)]
fn key(path: &Path) -> Option<FileKey> {
    use std::os::unix::fs::MetadataExt;
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(windows)]
fn key(path: &Path) -> Option<FileKey> {
    same_file::Handle::from_path(path).ok()
}

#[cfg(not(any(unix, windows)))]
fn key(path: &Path) -> Option<FileKey> {
    path.canonicalize().ok()
}

/// Returns the folder of a file, `.` for a bare name.
pub(crate) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(inputs: &[&Path], outputs: &[&Path]) -> Option<String> {
        let registry = FileRegistry::default();
        for path in inputs {
            registry.reads(PROGRAM, path);
        }
        let claim = |path: &&Path| Claim {
            name: "-o",
            path: path.to_path_buf(),
            replaces: Replaces::default(),
        };
        let outputs: Vec<Claim> = outputs.iter().map(claim).collect();
        let refused = registry.check(&outputs, 0).err();
        refused.map(|error| error.to_string())
    }

    #[test]
    fn a_file_is_known_under_every_name() {
        // R9.70
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        std::fs::write(path("a.nc"), "").unwrap();
        std::fs::hard_link(path("a.nc"), path("hard")).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(path("a.nc"), path("soft")).unwrap();
        let soft = cfg!(unix).then_some("soft");
        for name in ["a.nc", "sub/../a.nc", "hard"].into_iter().chain(soft) {
            let name = &path(name);
            let said = refused(&[&path("a.nc")], &[name]).unwrap();
            assert!(said.contains("would overwrite the program"), "{said}");
        }
        assert_eq!(refused(&[&path("a.nc")], &[&path("new")]), None);
    }

    #[test]
    fn two_outputs_are_two_files() {
        // R9.70
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        let said = refused(&[], &[&path("new"), &path("sub/../new")]).unwrap();
        assert!(said.contains("are the same file"), "{said}");
        assert_eq!(refused(&[], &[&path("new"), &path("sub/new")]), None);
    }
}
