//! Which file a list means by a path (R3.12).
//!
//! The control resolves relative paths from its own working folder, which lies somewhere above the
//! start-up list, and Windows paths on its own disk. The library opens no file: it says which paths
//! are to be tried, the host which of them there is.

use super::load::Loader;
use crate::diagnostic::{Code, Diagnostic};
use crate::lists::{Entries, Given, ListKind};
use crate::text::SourceFile;

/// Why there is no list at a path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
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
    /// There is none, or it cannot be read.
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

/// More folders above a list than there are on any disk.
const MAX_ABOVE: usize = 64;

impl Loader<'_> {
    /// The entries of a list that another one names; FC123 when there is no such file (R3.14),
    /// FC125 when it is a list of another kind.
    pub(super) fn load(&mut self, asked: &Given<String>, wanted: ListKind) -> Option<Entries> {
        match self.find(asked) {
            Ok(file) => {
                let entries = self.entries(&file.into());
                if wanted.admits(&entries) {
                    return Some(entries);
                }
                self.diagnostics.push(mistaken(asked, wanted, &entries));
                None
            }
            Err(diagnostic) => {
                self.missing += 1;
                self.diagnostics.push(*diagnostic);
                None
            }
        }
    }

    /// The first of the files that a path may mean: from the folder of the list that names it, from
    /// each folder above, and by its last part beside the start-up list.
    fn find(&mut self, asked: &Given<String>) -> Result<SourceFile, Box<Diagnostic>> {
        let beside = folder(asked.file());
        let first = join(beside, &asked.value);
        let mut unreadable = None;
        let mut read = |files: &mut dyn ListFiles, path: &str| match files.read(path) {
            Ok(file) => Some(file),
            Err(NoList::Missing) => None,
            Err(NoList::Unreadable(why)) => {
                unreadable.get_or_insert((path.to_owned(), why));
                None
            }
        };
        let mut found = read(self.files, &first);
        let mut from = beside.to_owned();
        for _ in 0..MAX_ABOVE {
            if found.is_some() || is_absolute(&asked.value) {
                break;
            }
            match self.files.above(&from) {
                Some(above) => from = above,
                None => break,
            }
            found = read(self.files, &join(&from, &asked.value));
        }
        let startup = self.startup_folder.as_deref().unwrap_or(beside);
        let last = asked.value.rsplit(['\\', '/']).next().unwrap_or_default();
        let bare = join(startup, last);
        if found.is_none() && bare != first {
            found = read(self.files, &bare);
        }
        if let Some(file) = found {
            return Ok(file);
        }
        let named = format!(
            "`{}`, named in line {} of `{}`",
            asked.value,
            asked.line(),
            asked.file()
        );
        let diagnostic = |message: String| Diagnostic::new(Code::Fc123, asked.place(), message);
        if let Some((path, why)) = unreadable {
            return Err(Box::new(
                diagnostic(format!("{named}, cannot be read: {why}"))
                    .with_help(format!("check your permission to read `{path}`")),
            ));
        }
        let looked = if is_absolute(&asked.value) {
            format!("looked for `{first}`")
        } else {
            format!("looked for `{first}`, in the same way from each folder above")
        };
        let looked = if bare == first {
            looked
        } else {
            format!("{looked}, and for `{bare}`")
        };
        let mut diagnostic = diagnostic(format!("{named}, is not found")).with_help(looked);
        if asked.value.contains([' ', '\t']) && asked.value.contains(['#', '/', '*']) {
            diagnostic = diagnostic.with_help("only `(` opens a comment after a path");
        }
        Err(Box::new(diagnostic))
    }
}

/// FC125 for a list that stands where one of another kind belongs.
fn mistaken(asked: &Given<String>, wanted: ListKind, entries: &Entries) -> Diagnostic {
    let message = format!(
        "`{}` is {}, not {}",
        asked.value,
        super::described::describe(entries),
        wanted.word()
    );
    Diagnostic::new(Code::Fc125, asked.place(), message).with_help("the list is not used")
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

fn is_absolute(path: &str) -> bool {
    path.starts_with(['/', '\\']) || path.get(1..2) == Some(":")
}

/// A path seen from a folder, with `/` between its parts and without `.` among them.
fn join(folder: &str, path: &str) -> String {
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
