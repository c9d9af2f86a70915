//! The list files of the host, and their paths (R3.12).
//!
//! The control resolves relative paths from its own working folder, which is somewhere above the
//! start-up list, and Windows paths on its own disk. The library opens no files: it gives the paths
//! to try, and the host determines which of them exists.

use crate::lists::{Entries, ListKind};
use crate::text::{SourceFile, lines_of};

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

/// Returns the kind of a file with its article: `a value list`, `a program`.
pub(super) fn describe(entries: &Entries) -> &'static str {
    if let Some(kind) = ListKind::detect(entries) {
        return kind.noun();
    }
    let text = entries.source().text();
    let first = lines_of(text)
        .map(str::trim)
        .find(|line| !line.is_empty() && !line.starts_with('#'));
    let Some(first) = first else {
        return "an empty file";
    };
    let tables = ["[machine", "[[axis", "[variables", "[lint", "[check"];
    if let Some(what) = entries.unread_kind() {
        what
    } else if first.starts_with('<') {
        "an XML file"
    } else if tables.iter().any(|table| first.starts_with(table)) {
        "a `frictcomp.toml`"
    } else if is_block(first) {
        "a program"
    } else if entries.entries.is_empty() {
        "no list of the control"
    } else {
        "a list of a kind that is not known"
    }
}

/// Whether a list contains nothing before its `Ende` except comments, like a template.
pub(super) fn has_nothing(entries: &Entries) -> bool {
    let is_plain = entries.diagnostics.is_empty() && entries.entries.is_empty();
    is_plain && !entries.source().text().trim().is_empty()
}

/// Whether a line begins like an NC program: with a name, a comment or a letter with its number.
fn is_block(line: &str) -> bool {
    let word = line.split([' ', '\t', '[']).next().unwrap_or_default();
    let mut letters = word.chars();
    let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    match letters.next() {
        Some('%' | ';' | '(' | '$' | '/') => true,
        Some(first) => first.is_ascii_alphabetic() && letters.all(number),
        None => false,
    }
}
