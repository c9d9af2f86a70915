//! The recordings in a folder.

use std::path::{Path, PathBuf};

use crate::disk::{has_extension, sha256_of};
use crate::error::HostError;

/// Extensions of recordings.
const RECORDINGS: [&str; 3] = ["csv", "txt", "xml"];

/// Returns the earlier recording of which each one is a copy, byte by byte: a copy proves nothing (R18.9).
pub(crate) fn copies_among(paths: &[PathBuf]) -> Vec<Option<&Path>> {
    // A file that cannot be read is reported by the code that reads it.
    let sums: Vec<Option<String>> = paths.iter().map(|it| sha256_of(it).ok()).collect();
    let earlier = |(at, sum): (usize, &Option<String>)| {
        let first = sums[..at].iter().position(|it| it == sum && sum.is_some());
        first.map(|first| paths[first].as_path())
    };
    sums.iter().enumerate().map(earlier).collect()
}

/// Refuses recordings of which one was given twice (R18.9).
///
/// # Errors
/// One is a copy of another.
pub fn refuse_copies(paths: &[PathBuf]) -> Result<(), HostError> {
    let mut copies = paths.iter().zip(copies_among(paths));
    let copy = copies.find_map(|(path, of)| Some((path.clone(), of?.to_owned())));
    copy.map_or(Ok(()), |(path, of)| Err(HostError::Copy { path, of }))
}

/// Returns the recordings of a folder, by their names.
///
/// # Errors
/// The folder does not exist, or cannot be read.
pub fn recordings_in(folder: &Path) -> Result<Vec<PathBuf>, HostError> {
    let failed = |reason| HostError::Recordings {
        folder: folder.to_owned(),
        reason,
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if has_extension(&path, &RECORDINGS) {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}
