//! The recordings in a folder.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use frictcomp::text::shown_path;

/// Extensions of recordings.
const RECORDINGS: [&str; 3] = ["csv", "txt", "xml"];

/// Returns the recordings of a folder, by their names.
pub(super) fn recordings_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: std::io::Error| {
        let failure = Failure::new(format!(
            "cannot read the folder `{}`: {error}",
            shown_path(folder)
        ));
        match error.kind() {
            ErrorKind::NotFound => {
                failure.with_help("make the folder, and put the recordings into it")
            }
            ErrorKind::NotADirectory => {
                failure.with_help("name a folder with recordings, not a file")
            }
            _ => failure,
        }
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let ending = path
            .extension()
            .map(|it| it.to_string_lossy().to_lowercase());
        if ending.is_some_and(|it| RECORDINGS.contains(&it.as_str())) {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}
