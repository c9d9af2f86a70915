//! Lists in memory and on disk, and helpers for diagnostics.

use std::collections::BTreeMap;
use std::path::PathBuf;

use frictcomp::comp::CncBuild;
use frictcomp::diagnostic::Diagnostic;
use frictcomp::machine::{
    Configuration, ListFiles, ListsReport, NoList, NoLists, Parameterisation, check_list,
};
use frictcomp::text::SourceFile;

/// Lists by their paths.
pub(crate) struct Memory(pub(crate) BTreeMap<&'static str, &'static str>);

impl ListFiles for Memory {
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

/// Checks a list by itself.
pub(crate) fn judge(text: &str) -> ListsReport {
    check_list(SourceFile::new("a.lis", text), None, &mut NoLists)
}

/// Checks a list by itself for a kernel version.
pub(crate) fn judge_for(build: &str, text: &str) -> ListsReport {
    let build: CncBuild = build.parse().unwrap();
    check_list(SourceFile::new("a.lis", text), Some(build), &mut NoLists)
}

/// Returns `CODE line:column` of each diagnostic.
pub(crate) fn codes(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics
        .iter()
        .map(|d| format!("{} {}", d.code, d.place.start()))
        .collect()
}

/// Returns the text that a diagnostic points at.
pub(crate) fn meant(diagnostic: &Diagnostic) -> &str {
    diagnostic.place.span.of(&diagnostic.place.text)
}

/// Returns the machine of lists whose start-up list is `hochlauf.lis`.
pub(crate) fn start(files: &[(&'static str, &'static str)]) -> Configuration {
    let mut memory = Memory(files.iter().copied().collect());
    let startup = memory.read("hochlauf.lis").expect("a start-up list");
    Configuration::from_startup(startup, &mut memory)
}

/// Returns the parameterisation of the only axis of a machine whose value list is `text` and whose
/// P-AXIS-00522 is 1.
pub(crate) fn parameterise(text: &'static str) -> Parameterisation {
    let files = [
        ("hochlauf.lis", "achs_mds[0] x.lis\nachs_kw[0] c.lis\nEnde"),
        (
            "x.lis",
            "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nEnde",
        ),
        ("c.lis", text),
    ];
    start(&files).machine.axes.remove(0).friction
}
