//! The recordings in a folder.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use frictcomp::text::shown_path;
use frictcomp_host::sha256_of;

/// Extensions of recordings.
const RECORDINGS: [&str; 3] = ["csv", "txt", "xml"];

/// Returns the earlier recording of which each one is a copy, byte by byte: a copy proves nothing (R18.9).
pub(super) fn copies_among(paths: &[PathBuf]) -> Vec<Option<&Path>> {
    // What cannot be read is said by whoever reads it.
    let sums: Vec<Option<String>> = paths.iter().map(|it| sha256_of(it).ok()).collect();
    let earlier = |(at, sum): (usize, &Option<String>)| {
        let first = sums[..at].iter().position(|it| it == sum && sum.is_some());
        first.map(|first| paths[first].as_path())
    };
    sums.iter().enumerate().map(earlier).collect()
}

/// Refuses recordings of which one was given twice (R18.9).
pub(super) fn refuse_copies(paths: &[PathBuf]) -> Result<(), Failure> {
    let copies = copies_among(paths);
    let copy = paths
        .iter()
        .zip(copies)
        .find_map(|(path, of)| Some((path, of?)));
    copy.map_or(Ok(()), |(path, of)| {
        let message = if path == of {
            format!("`{}` was given twice", shown_path(path))
        } else {
            format!("`{}` is a copy of `{}`", shown_path(path), shown_path(of))
        };
        Err(Failure::new(message)
            .with_help("leave it out: the same recording twice proves nothing more"))
    })
}

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
