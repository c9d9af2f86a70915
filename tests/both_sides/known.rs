//! The number of states that are known, which may not fall.

use std::fmt::Write as _;
use std::fs;
use std::iter::Sum;
use std::ops::{AddAssign, ControlFlow};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use frictcomp::interpreter::{Event, Interpreter, Limits, Options};
use frictcomp::text::SourceFile;

use crate::{COUNTED, Shown, count, machine};

/// Numbers of states, one for each line and axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    /// Known states.
    known: u64,
    /// Sets of states to each of which some answers lead.
    sets: u64,
    /// Sets with states to which no answers lead.
    supersets: u64,
    /// States of which nothing is known.
    unknown: u64,
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.known += other.known;
        self.sets += other.sets;
        self.supersets += other.supersets;
        self.unknown += other.unknown;
    }
}

impl Sum for Tally {
    fn sum<I: Iterator<Item = Self>>(tallies: I) -> Self {
        tallies.fold(Self::default(), |mut sum, tally| {
            sum += tally;
            sum
        })
    }
}

/// The first line of the file.
const HEAD: &str = "programs           known     sets supersets  unknown\n";

/// Lock of the file, which one test writes at a time.
static FILE: Mutex<()> = Mutex::new(());

impl Tally {
    /// Counts what a run shows without answers; those with answers say which states there are.
    pub(crate) fn of(told: &Shown, found: &Shown) -> Self {
        let mut tally = Self::default();
        for (line, states) in &told.lines {
            for (axis, states) in states.iter().enumerate() {
                let found = found.lines.get(line);
                let counted = if told.unknown.contains(&(*line, axis)) {
                    &mut tally.unknown
                } else if states.len() == 1 {
                    &mut tally.known
                } else if found.is_some_and(|found| found[axis] == *states) {
                    &mut tally.sets
                } else {
                    &mut tally.supersets
                };
                *counted += 1;
            }
        }
        tally
    }

    /// Fails where fewer states are known than the file says, or writes it again.
    pub(crate) fn is_no_less(self, programs: &str) {
        if count() < COUNTED {
            return;
        }
        let _written = FILE.lock().expect("the file");
        let path = root().join("tests/both_sides/known.txt");
        let text = fs::read_to_string(&path).expect("the file");
        let is_row = |line: &&str| line.starts_with(programs);
        if std::env::var_os("UPDATE_DOCS").is_some() {
            let mut rows: Vec<String> = text.lines().skip(1).map(str::to_owned).collect();
            rows.retain(|row| !is_row(&row.as_str()));
            rows.push(self.row(programs));
            rows.sort();
            let rows = rows.join("\n");
            fs::write(path, format!("{HEAD}{rows}\n")).expect("the file is written");
            return;
        }
        let row = text.lines().find(is_row).expect("a row");
        let numbers = row[programs.len()..].split_whitespace();
        let numbers: Vec<u64> = numbers.map(|it| it.parse().expect("a number")).collect();
        let is_less = self.known < numbers[0] || self.known + self.sets < numbers[0] + numbers[1];
        assert!(
            !is_less,
            "less is known:\n{HEAD}{}\nit was\n{row}",
            self.row(programs)
        );
    }

    fn row(self, programs: &str) -> String {
        let mut row = format!("{programs:15}");
        for number in [self.known, self.sets, self.supersets, self.unknown] {
            let _ = write!(row, "{number:9}");
        }
        row
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the programs below a folder.
fn programs(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(programs(&path));
        } else if path.extension().is_some_and(|it| it == "nc") {
            found.push(path);
        }
    }
    found
}

/// Runs a program that no answers are tried for.
fn shown(path: &Path) -> Shown {
    let read = |path: &Path| {
        let bytes = fs::read(path).ok()?;
        Some(String::from_utf8_lossy(&bytes).into_owned())
    };
    let machine = machine();
    let compensation = machine.compensation();
    let options = Options::default().with_limits(Limits::default().with_blocks(5000));
    let mut run = Interpreter::new(machine, compensation, options);
    let mut shown = Shown::default();
    let source = SourceFile::new("a.nc", read(path).expect("a program"));
    let mut find = |name: &str, _: &str| {
        let text = read(&path.parent()?.join(name))?;
        Some(SourceFile::new(name, text))
    };
    run.program(source, &mut find, &mut |event: Event<'_>| {
        shown.event(&event);
        ControlFlow::Continue(())
    });
    shown
}

#[test]
fn no_less_is_known_in_programs() {
    let tallies = programs(&root().join("programs")).into_iter().map(|path| {
        let shown = shown(&path);
        Tally::of(&shown, &shown)
    });
    tallies.sum::<Tally>().is_no_less("programs/");
}
