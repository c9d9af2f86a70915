//! An input as a user's files, and the places in them.

use frictcomp::diagnostic::Diagnostic;
use frictcomp::interpreter::{Finder, NoProgram};
use frictcomp::machine::{ListFiles, NoList};
use frictcomp::text::{LineSource, Place, SourceFile, TextLines};

/// The name of the file that is run or read.
pub const MAIN: &str = "main";

/// Separates the two files in an input.
pub(crate) const SEPARATOR: char = '\u{1e}';

/// The file that is run or read, and the text of every other file name.
#[derive(Debug, Clone, Copy)]
pub struct Files<'a> {
    pub main: &'a str,
    other: &'a str,
}

impl<'a> Files<'a> {
    pub fn new(input: &'a str) -> Self {
        let (main, other) = input.split_once(SEPARATOR).unwrap_or((input, ""));
        Self { main, other }
    }

    /// Returns the size of both files in bytes.
    pub fn len(self) -> usize {
        self.main.len() + self.other.len()
    }

    /// Returns the text of every other file name.
    pub fn other_text(self) -> Option<&'a str> {
        (!self.other.is_empty()).then_some(self.other)
    }

    pub fn source(self) -> SourceFile {
        SourceFile::new(MAIN, self.main)
    }

    /// Checks a diagnostic against the texts: each of its places shows lines of its file, and its
    /// span covers whole characters of them.
    pub fn hold(self, diagnostic: &Diagnostic) {
        let labels = diagnostic.labels.iter().map(|label| &label.place);
        for place in std::iter::once(&diagnostic.place).chain(labels) {
            assert!(place.text.get(place.span.range()).is_some(), "{place:?}");
            assert!(place.start() <= place.end(), "{place:?}");
            self.hold_lines(place);
        }
        assert!(!diagnostic.message.is_empty());
    }

    fn hold_lines(self, place: &Place) {
        let text = if &*place.file == MAIN {
            self.main
        } else {
            self.other
        };
        let mut shown = TextLines::starting_at(&place.text, 0);
        let mut lines = TextLines::new(text);
        for _ in 1..place.first_line {
            assert!(lines.advance(), "{place:?} lies beyond the file");
        }
        while shown.advance() {
            let line = if lines.advance() {
                lines.line().text
            } else {
                ""
            };
            let is_there = line.starts_with(shown.line().text);
            assert!(is_there, "{place:?} is not in the file, {line:?} is");
        }
    }

    fn find(self, name: &str) -> Option<SourceFile> {
        let there = name != MAIN && !self.other.is_empty();
        there.then(|| SourceFile::new(name, self.other))
    }
}

impl Finder for Files<'_> {
    fn find(&mut self, name: &str, _caller: &str) -> Result<SourceFile, NoProgram> {
        Files::find(*self, name).ok_or(NoProgram::Absent)
    }
}

impl ListFiles for Files<'_> {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        Files::find(*self, path).ok_or(NoList::Missing)
    }
}
