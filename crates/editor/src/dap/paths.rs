//! Files under any of their names.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The real paths of the files of a run, by the names that records give them.
#[derive(Debug, Default)]
pub(super) struct RealPaths(HashMap<String, PathBuf>);

impl RealPaths {
    /// Returns the real path of a file; the name itself if the file does not exist.
    pub(super) fn of(&mut self, name: &str) -> &Path {
        self.0.entry(name.to_owned()).or_insert_with(|| real(name))
    }
}

/// Returns the path of a file with all links resolved.
pub(super) fn real(name: &str) -> PathBuf {
    let path = Path::new(name);
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
