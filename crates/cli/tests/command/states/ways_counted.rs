//! The number of states that remain unknown in the programs of `programs/`, if a condition makes unknown what it
//! could change (R2.51) and if both of its sides are followed (R14.1).

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use frictcomp::comp::{AxisIndex, Compensation, Kind, State};
use frictcomp::interpreter::{Branches, Event, Interpreter, Options};
use frictcomp::text::SourceFile;
use frictcomp_host::{
    FileRegistry, Input, LoadedMachine, MachineOptions, Machines, Naming, ProgramFinder, read_text,
};

use crate::workspace::root;

/// The first line of the table in the document.
const HEAD: &str = "| programs | lines before | lines now | ends before | ends now | without a way |\n|---|---|---|---|---|---|\n";

/// A line and an axis.
type Place = (String, u32, usize);

/// The findings of one run of a program.
#[derive(Default)]
struct Found {
    /// The lines at which axes are checked.
    executed: BTreeSet<Place>,
    /// The lines at which friction compensation of an axis is unknown.
    unknown: BTreeSet<Place>,
    /// Axes whose compensation is unknown at program end, and those of them without a named way.
    ends: usize,
    unnamed: usize,
}

fn unknown_axes(compensation: &Compensation) -> impl Iterator<Item = AxisIndex> {
    let axes = (0..compensation.len()).map(AxisIndex::new);
    axes.filter(|axis| compensation.state(*axis, Kind::Frict) == State::Unknown)
}

fn run(program: &Path, branches: Branches) -> Found {
    let mut machines = Machines::new(MachineOptions::default(), &FileRegistry::default());
    let input = Input::new(program);
    let loaded = machines.for_folder(input.folder()).expect("a machine");
    let LoadedMachine {
        machine,
        search_path,
        disk,
        ..
    } = &*loaded;
    let options = Options::default().with_branches(branches);
    let mut run = Interpreter::new(machine.clone(), machine.compensation(), options);
    for (name, setting) in &loaded.settings {
        run.set(name, setting);
    }
    let mut finder = ProgramFinder::new(&input, search_path, Naming::AsGiven, disk);
    let source = SourceFile::new(
        input.name(Naming::AsGiven),
        read_text(program).expect("text"),
    );
    let mut found = Found::default();
    let _ = run.program(source, &mut finder, &mut |event: Event<'_>| {
        match event {
            Event::Executed(block) => {
                let place = |axis: AxisIndex| (block.file.to_string(), block.line, axis.get());
                let all = (0..block.compensation.len()).map(AxisIndex::new);
                found.executed.extend(all.map(place));
                let unknown = unknown_axes(block.compensation);
                found.unknown.extend(unknown.map(place));
            }
            Event::Ended(ended) => {
                let named = |axis: &AxisIndex| {
                    let mut possible = ended.possible.iter();
                    possible.any(|it| (it.axis, it.kind) == (*axis, Kind::Frict))
                };
                found.ends = unknown_axes(ended.compensation).count();
                found.unnamed = unknown_axes(ended.compensation)
                    .filter(|axis| !named(axis))
                    .count();
            }
            _ => {}
        }
        ControlFlow::Continue(())
    });
    found
}

/// Lines that both runs execute and where a state is unknown, before and now; ends before and now; ends now
/// without a way.
fn count(program: &Path) -> [usize; 5] {
    let [before, now] = [Branches::Passed, Branches::Followed].map(|way| run(program, way));
    let lines = |found: &Found, other: &Found| {
        let unknown = found.unknown.intersection(&other.executed);
        unknown.count()
    };
    [
        lines(&before, &now),
        lines(&now, &before),
        before.ends,
        now.ends,
        now.unnamed,
    ]
}

fn programs(folder: &Path) -> Vec<PathBuf> {
    let (mut folders, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|it| it == "nc") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The rows of the table, and their sums.
fn table() -> (String, [usize; 5]) {
    let (mut rows, mut all) = (String::new(), [0; 5]);
    for folder in ["demo", "ok/manual", "ok", "err"] {
        let mut of_folder = [0; 5];
        let path = root().join("programs").join(folder);
        // Where no way is followed, what a program wrote into V.E. counts (R2.99), and a feed move without a feed ends
        // nothing (R2.110): there is nothing to compare.
        let is_apart = |it: &PathBuf| {
            let mut apart = ["manual", "handshakes", "FC327-no-feed.nc"].iter();
            apart.any(|name| it.starts_with(path.join(name)))
        };
        for program in programs(&path).iter().filter(|it| !is_apart(it)) {
            let found = count(program);
            for (place, found) in found.into_iter().enumerate() {
                of_folder[place] += found;
                all[place] += found;
            }
        }
        let numbers = of_folder.map(|number| number.to_string()).join(" | ");
        writeln!(rows, "| `programs/{folder}` | {numbers} |").expect("text");
    }
    (rows, all)
}

#[test]
fn both_sides_leave_no_more_states_unknown_and_name_their_ways() {
    // R14.1: `UPDATE_DOCS=1` writes the table.
    let document = root().join("docs/reliability.md");
    let text = read_text(&document).expect("the document");
    let (rows, [lines, lines_now, ends, ends_now, unnamed]) = table();
    let (start, rest) = text.split_once(HEAD).expect("the table");
    let end = rest.find("\n\n").expect("a paragraph after it");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        let new = format!("{start}{HEAD}{}{}", rows.trim_end(), &rest[end..]);
        fs::write(&document, new).expect("written");
    } else {
        assert_eq!(
            rest[..end],
            *rows.trim_end(),
            "the table in {}",
            document.display()
        );
    }
    assert!(
        lines_now <= lines && ends_now <= ends && unnamed < ends,
        "{rows}"
    );
}
