//! Changes of files that touch nothing else (R9.82).

use std::path::{Path, PathBuf};

use super::error::HostError;
use super::read::read_bytes;
use crate::diagnostic::{Fix, edited, edits};
use crate::text::{EncodedText, SourceFile, decode};

/// A file and what changes make of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MendedFile {
    /// The file.
    pub path: PathBuf,
    /// Its text.
    pub before: String,
    /// The text after the changes.
    pub after: String,
    /// The bytes of that text, in the code page and with the line ends of the file.
    pub bytes: Vec<u8>,
    /// How many changes were made.
    pub changes: usize,
}

/// Makes changes of a file, in memory; `None` where its lines are no longer those of the changes.
///
/// # Errors
/// The file cannot be read, or its code page has no way to write a change.
pub fn mend(path: &Path, fixes: &[Fix]) -> Result<Option<MendedFile>, HostError> {
    let bytes = read_bytes(path).map_err(|error| HostError::read(path, error))?;
    let encoded = EncodedText::new(bytes);
    let source = SourceFile::new(path.display().to_string(), encoded.text());
    let edits = edits(&source, fixes);
    let changes = edits.len();
    if changes == 0 {
        return Ok(None);
    }
    let unwritable = |reason: String| HostError::Unwritable {
        path: path.to_owned(),
        reason,
    };
    let after = edited(encoded.text(), &edits);
    let replacements = edits.iter().map(|it| (it.span.range(), it.text.as_str()));
    let bytes = encoded.replaced(replacements);
    let bytes = bytes.map_err(|error| unwritable(error.to_string()))?;
    if decode(bytes.clone()) != after {
        return Err(unwritable("its code page is not certain".to_owned()));
    }
    Ok(Some(MendedFile {
        path: path.to_owned(),
        before: encoded.text().to_owned(),
        after,
        bytes,
        changes,
    }))
}
