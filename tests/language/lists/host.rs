//! Lists in memory and on disk.

use std::collections::BTreeMap;
use std::path::PathBuf;

use frictcomp::diagnostic::Diagnostic;
use frictcomp::machine::{ListFiles, NoList};
use frictcomp::text::SourceFile;

/// Lists by their paths.
pub(crate) struct Memory<'a>(pub(crate) BTreeMap<&'a str, &'a str>);

impl ListFiles for Memory<'_> {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let text = self.0.get(path).ok_or(NoList::Missing)?;
        Ok(SourceFile::new(path, *text))
    }
}

/// Lists below `programs/machines`.
pub(crate) struct Disk;

impl Disk {
    pub(crate) fn root() -> PathBuf {
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("programs/machines")
    }

    pub(crate) fn open(path: &str) -> SourceFile {
        Self.read(path)
            .unwrap_or_else(|why| panic!("{path}: {why}"))
    }
}

impl ListFiles for Disk {
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList> {
        let text = std::fs::read_to_string(Self::root().join(path));
        let text = text.map_err(|_| NoList::Missing)?;
        Ok(SourceFile::new(path, text))
    }
}

/// Returns `CODE line:column` of each diagnostic.
pub(crate) fn codes(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics
        .iter()
        .map(|d| format!("{} {}", d.code, d.place.start()))
        .collect()
}
