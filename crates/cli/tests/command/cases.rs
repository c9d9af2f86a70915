//! The cases of `crates/cli/tests/cases`: what commands print in a folder with a few files.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::thread;

use crate::console::{Stage, replayed};
use crate::folder::{Bench, MACHINE};
use crate::workspace::{agree, copy, files};

/// The folder of a case.
struct Case {
    /// The machine of the document.
    machine: String,
    /// The folder, since the first heading.
    bench: Option<Bench>,
    /// Whether the programs that the document needs are here.
    is_equipped: bool,
}

impl Case {
    fn describe(bench: &Bench, machine: &str) {
        if machine.is_empty() {
            fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
        } else {
            bench.write("frictcomp.toml", machine);
        }
    }
}

impl Stage for Case {
    fn begin(&mut self) {
        let bench = Bench::new(&[]);
        Self::describe(&bench, &self.machine);
        self.bench = Some(bench);
    }

    fn take(&mut self, kind: &str, text: &str) {
        match (kind.split_once(' '), &self.bench) {
            (None, Some(bench)) if kind == "toml" => Self::describe(bench, text),
            (None, Some(bench)) if kind == "copy" => {
                for folder in text.lines() {
                    copy(folder, bench.folder());
                }
            }
            (None, None) if kind == "toml" => text.clone_into(&mut self.machine),
            (None, None) if kind == "needs" => self.is_equipped = text.lines().all(is_here),
            (Some(("file", name)), Some(bench)) => {
                let path = bench.folder().join(name);
                fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
                bench.write(name, text);
            }
            _ => panic!("a block of `{kind}` is not known here"),
        }
    }

    fn is_equipped(&self) -> bool {
        self.is_equipped
    }

    fn folder(&mut self, command: &str) -> PathBuf {
        let bench = self.bench.as_ref();
        bench
            .unwrap_or_else(|| panic!("`{command}` is before the first heading"))
            .folder()
            .to_owned()
    }
}

/// Returns whether a program can be started. Only Windows may lack one.
#[allow(clippy::print_stdout, reason = "what a system cannot try")]
fn is_here(program: &str) -> bool {
    let is_here = !cfg!(windows) || Command::new(program).arg("--version").output().is_ok();
    if !is_here {
        println!("not tried: the cases that need `{program}`, which is not installed");
    }
    is_here
}

#[test]
fn every_case_shows_what_is_written_below_it() {
    thread::scope(|scope| {
        let documents = files("crates/cli/tests/cases", &["md"]);
        for path in documents
            .into_iter()
            .filter(|it| !it.ends_with("README.md"))
        {
            scope.spawn(move || {
                let text = fs::read_to_string(&path).expect("a document");
                let mut case = Case {
                    machine: MACHINE.to_owned(),
                    bench: None,
                    is_equipped: true,
                };
                agree(&path, &replayed(&text, &mut case));
            });
        }
    });
}
