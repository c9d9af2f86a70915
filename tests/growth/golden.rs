//! Agreed results in many folders (R9.90).

use std::cell::Cell;
use std::fs;
use std::path::PathBuf;

use frictcomp_host::{FileRegistry, GoldenFile, GoldenKind, GoldenResults, HostError, Input};
use tempfile::TempDir;

use crate::measure::{TWICE, excess};

const TIMELINE: GoldenKind = GoldenKind {
    extension: "timeline",
    writer: "golden --update",
};

/// Folders with one program each, and the agreed result next to it.
struct Archive {
    root: TempDir,
    agreed: GoldenResults,
    files: Vec<GoldenFile>,
    registry: FileRegistry,
}

impl Archive {
    fn new(folders: usize) -> Self {
        let root = tempfile::tempdir().expect("a folder");
        let agreed = GoldenResults::of(TIMELINE, &[root.path().to_owned()]);
        let registry = FileRegistry::default();
        let program = |number: usize| -> PathBuf {
            let folder = root.path().join(number.to_string());
            fs::create_dir(&folder).expect("a folder");
            let program = folder.join("a.nc");
            fs::write(&program, "M30\n").expect("written");
            program
        };
        let inputs: Vec<Input> = (0..folders).map(|n| Input::File(program(n))).collect();
        for input in &inputs {
            input.note(&registry);
        }
        let files = inputs.iter().map(|input| agreed.beside(input));
        Self {
            files: files.collect::<Result<_, _>>().expect("files"),
            root,
            agreed,
            registry,
        }
    }

    /// Agrees on another result for each program.
    fn update(&self, result: &str) {
        let now = |_: &Input, _: Option<&str>| Ok::<_, HostError>(result.to_owned());
        let updated = self.agreed.update(&self.files, &self.registry, now);
        for folder in updated.expect("nothing prevents it") {
            assert!(folder.failures.is_empty(), "{:?}", folder.failures);
            assert_eq!(folder.written.len(), 1);
        }
        let last = self.root.path().join("0/a.nc.timeline");
        assert_eq!(fs::read_to_string(last).expect("a result"), result);
    }
}

/// Checks that twice as many folders take at most the bound times as long.
#[track_caller]
fn is_linear(folders: usize, bound: f64) {
    let archives = [folders, 2 * folders].map(Archive::new);
    let times = Cell::new(0_u64);
    let growth = excess([0, 1], bound, |which| {
        times.set(times.get() + 1);
        archives[which].update(&format!("result {}\n", times.get()));
    });
    assert_eq!(growth, None, "twice {folders} folders");
}

#[test]
fn what_is_agreed_on_grows_with_the_folders() {
    // R9.90
    is_linear(100, 1.2 * TWICE);
}

#[test]
#[ignore = "minutes: `scripts/full`"]
fn what_is_agreed_on_grows_with_a_thousand_folders() {
    // R9.90
    is_linear(1_000, TWICE);
}
