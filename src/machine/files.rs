//! The list files of the host, and their paths (R3.12).
//!
//! The control resolves relative paths from its own working folder, which lies somewhere above the
//! start-up list, and Windows paths on its own disk. The library opens no file: it says which paths
//! are to be tried, the host which of them there is.

use crate::text::SourceFile;

/// Why there is no list at a path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoList {
    /// Nothing is there.
    #[error("it is not found")]
    Missing,
    /// Something is there that cannot be read; the reason.
    #[error("{0}")]
    Unreadable(String),
}

/// Hands list files to the library, which opens none itself.
pub trait ListFiles {
    /// The list at a path. A relative path has been resolved against the folder of the list that
    /// asks, as far as that list's own name has one. The name of the source is what diagnostics
    /// show, and what further paths are resolved against.
    ///
    /// # Errors
    /// It does not exist or cannot be read.
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList>;

    /// The folder above a folder; both are empty for the folder in which relative paths begin.
    /// `None` when there is none, or the host knows none.
    fn above(&self, folder: &str) -> Option<String> {
        parent(folder).map(str::to_owned)
    }
}

/// A host that has no list files.
pub struct NoLists;

impl ListFiles for NoLists {
    fn read(&mut self, _path: &str) -> Result<SourceFile, NoList> {
        Err(NoList::Missing)
    }
}

/// The folder of a path as it is written, without its separator; empty for a bare name.
pub(super) fn folder(path: &str) -> &str {
    match path.rfind(['/', '\\']) {
        Some(0) => "/",
        Some(at) => &path[..at],
        None => "",
    }
}

/// The folder above, as far as the path itself says.
fn parent(path: &str) -> Option<&str> {
    let named = !matches!(path, "" | "." | "/") && !path.ends_with("..");
    named.then(|| folder(path))
}

pub(super) fn is_absolute(path: &str) -> bool {
    path.starts_with(['/', '\\']) || path.get(1..2) == Some(":")
}

/// A path seen from a folder, with `/` between its parts and without `.` among them.
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
