//! The list files of the host, and their paths (R3.12).
//!
//! The control resolves relative paths from its own working folder, which is somewhere above the
//! start-up list, and Windows paths on its own disk. The library opens no files: it gives the paths
//! to try, and the host determines which of them exists.

use crate::text::SourceFile;

/// The reason for which a path has no list.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoList {
    /// Nothing exists there.
    #[error("it is not found")]
    Missing,
    /// Something exists there that cannot be read; the reason.
    #[error("{0}")]
    Unreadable(String),
}

/// Provides list files to the library, which opens none itself.
pub trait ListFiles {
    /// Reads the list at a path. A relative path has been resolved against the folder in the name
    /// of the referring list, if that name has one. Diagnostics show the name of the source, and
    /// further paths are resolved against it.
    ///
    /// # Errors
    /// It does not exist or cannot be read.
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList>;

    /// Returns the folder above a folder; an empty text means the folder in which relative paths
    /// begin. `None` if there is none, or the host does not know it.
    fn above(&self, folder: &str) -> Option<String> {
        parent(folder).map(str::to_owned)
    }
}

/// A host without list files.
pub struct NoLists;

impl ListFiles for NoLists {
    fn read(&mut self, _path: &str) -> Result<SourceFile, NoList> {
        Err(NoList::Missing)
    }
}

/// Returns the folder of a path as written, without its separator; empty for a bare name.
pub(super) fn folder(path: &str) -> &str {
    match path.rfind(['/', '\\']) {
        Some(0) => "/",
        Some(at) => &path[..at],
        None => "",
    }
}

/// Returns the folder above if the path itself contains it.
fn parent(path: &str) -> Option<&str> {
    let named = !matches!(path, "" | "." | "/") && !path.ends_with("..");
    named.then(|| folder(path))
}

pub(super) fn is_absolute(path: &str) -> bool {
    path.starts_with(['/', '\\']) || path.get(1..2) == Some(":")
}

/// Returns a path relative to a folder, with `/` between its parts and without `.` parts.
pub(super) fn join(folder: &str, path: &str) -> String {
    let slashed = path.replace('\\', "/");
    if is_absolute(path) {
        return slashed;
    }
    let mut joined = folder.to_owned();
    for part in slashed.split('/').filter(|part| !matches!(*part, "" | ".")) {
        if !joined.is_empty() && !joined.ends_with('/') {
            joined.push('/');
        }
        joined.push_str(part);
    }
    joined
}
