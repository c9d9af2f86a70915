//! Changes to files that leave everything else as it is (R9.82).

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::atomic_file::{AtomicFile, Placed, take_away_left};
use crate::disk::{EncodedText, decode, read_bytes, read_text};
use crate::error::HostError;
use frictcomp::diagnostic::{Fix, edits};
use frictcomp::text::{SourceFile, shown_path};

/// A file before and after changes.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MendedFile {
    /// Path of the file.
    pub path: PathBuf,
    /// The original text.
    pub before: String,
    /// The text after the changes.
    pub after: String,
    /// The bytes of that text, in the code page and with the line ends of the file.
    pub bytes: Vec<u8>,
    /// Number of changes.
    pub changes: usize,
}

impl MendedFile {
    /// Applies changes, which name ranges of its text from start to end, to a file; `None` without any.
    ///
    /// # Errors
    /// A change cannot be written in its code page.
    pub(crate) fn new(
        path: &Path,
        encoded: &EncodedText,
        changes: &[(Range<usize>, String)],
    ) -> Result<Option<Self>, HostError> {
        if changes.is_empty() {
            return Ok(None);
        }
        let unwritable = |reason: String| HostError::Unwritable {
            path: path.to_owned(),
            reason,
        };
        let before = encoded.text();
        let mut after = String::with_capacity(before.len());
        let mut copied = 0;
        for (range, text) in changes {
            after.push_str(&before[copied..range.start]);
            after.push_str(text);
            copied = range.end;
        }
        after.push_str(&before[copied..]);
        let replacements = changes
            .iter()
            .map(|(range, text)| (range.clone(), text.as_str()));
        let bytes = encoded.replaced(replacements);
        let bytes = bytes.map_err(|error| unwritable(error.to_string()))?;
        if decode(bytes.clone()) != after {
            return Err(unwritable("its code page is not certain".to_owned()));
        }
        Ok(Some(Self {
            path: path.to_owned(),
            before: before.to_owned(),
            after,
            bytes,
            changes: changes.len(),
        }))
    }
}

/// Applies changes to a file, in memory; `None` if its lines no longer match those of the changes.
///
/// # Errors
/// The file cannot be read, or a change cannot be written in its code page.
pub fn mend(path: &Path, fixes: &[Fix]) -> Result<Option<MendedFile>, HostError> {
    let encoded = read_encoded(path)?;
    let source = SourceFile::new(shown_path(path), encoded.text());
    let edits = edits(&source, fixes).into_iter();
    let changes: Vec<_> = edits.map(|it| (it.span.range(), it.text)).collect();
    MendedFile::new(path, &encoded, &changes)
}

/// Reads a file with the bytes of its text.
pub(crate) fn read_encoded(path: &Path) -> Result<EncodedText, HostError> {
    let bytes = read_bytes(path).map_err(|error| HostError::read(path, error))?;
    Ok(EncodedText::new(bytes))
}

/// Replaces the old files by the mended ones, all or none. One that changed since it was read is
/// not overwritten.
///
/// # Errors
/// A file cannot be read or written, or has changed. If only the last step of one fails, the error
/// names those already in place.
pub fn write_mended<'a>(files: impl IntoIterator<Item = &'a MendedFile>) -> Result<(), HostError> {
    let mut unfinished = Vec::new();
    for mended in files {
        let path = &mended.path;
        if read_text(path)? != mended.before {
            return Err(HostError::ChangedMeanwhile(path.clone()));
        }
        let failed = |error| HostError::write(path, error);
        let mut file = AtomicFile::begin(path).map_err(failed)?;
        file.write_all(&mended.bytes).map_err(failed)?;
        file.sync().map_err(failed)?;
        file.check_place().map_err(failed)?;
        unfinished.push((path, file));
    }
    let mut placed = Placed::default();
    for (path, mut file) in unfinished {
        placed.take_place(&mut file, path)?;
    }
    placed.settle()
}

/// Creates a file as a whole; an existing one stays.
///
/// # Errors
/// The file already exists, or cannot be written.
pub fn write_new(target: &Path, text: &str) -> Result<(), HostError> {
    let mut placed = Placed::default();
    let written = AtomicFile::begin(target).and_then(|mut file| {
        take_away_left(&file, &mut BTreeSet::new());
        file.write_all(text.as_bytes())?;
        file.take_free_place()?;
        placed.add(&file, target);
        Ok(())
    });
    written.map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => HostError::AlreadyThere(target.to_owned()),
        _ => HostError::write(target, error),
    })?;
    placed.settle()
}
