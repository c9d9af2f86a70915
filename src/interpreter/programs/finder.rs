//! The source of called programs: the library opens no file itself.

use crate::text::SourceFile;

/// Reason why a called program is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoProgram {
    /// It does not exist (FC320).
    Absent,
    /// It does not exist, but one with a similar name, which may be meant, does (FC320).
    Near(String),
    /// It is in a folder that programs are not called from (FC321).
    Outside,
    /// It exists but cannot be used (FC320); the words that follow its name: `is a folder`.
    Unusable(String),
}

/// Finds called programs.
pub trait Finder {
    /// The text of the program called `name`, asked for by the file `caller`.
    ///
    /// # Errors
    /// It is missing.
    fn find(&mut self, name: &str, caller: &str) -> Result<SourceFile, NoProgram>;

    /// The names of further files with other content that the name may mean on the control (FC329).
    fn others(&mut self, _name: &str, _caller: &str) -> Vec<String> {
        Vec::new()
    }
}

impl<F: FnMut(&str, &str) -> Option<SourceFile>> Finder for F {
    fn find(&mut self, name: &str, caller: &str) -> Result<SourceFile, NoProgram> {
        self(name, caller).ok_or(NoProgram::Absent)
    }
}

/// A finder that finds nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoFiles;

impl Finder for NoFiles {
    fn find(&mut self, _name: &str, _caller: &str) -> Result<SourceFile, NoProgram> {
        Err(NoProgram::Absent)
    }
}
