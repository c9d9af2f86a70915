//! Chapter 17 of the rules while a user works: checks after each save (R17.5).

use std::io::{BufRead, BufReader, Read};
use std::process::Child;
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use crate::folder::{Bench, MACHINE};

/// Time limit, longer than a check takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Long enough for output that should not appear.
const QUIET: Duration = Duration::from_secs(1);

/// The tool while it watches.
struct Watching {
    child: Child,
    printed: Receiver<String>,
    said: Receiver<String>,
}

fn lines(reader: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        for line in BufReader::new(reader).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}

impl Watching {
    fn new(bench: &Bench, arguments: &[&str]) -> Self {
        let mut child = bench.command(arguments).spawn().expect("the tool starts");
        let printed = lines(child.stdout.take().expect("a pipe"));
        let said = lines(child.stderr.take().expect("a pipe"));
        let watching = Self {
            child,
            printed,
            said,
        };
        watching.settle();
        watching
    }

    /// Waits until the output is complete and the next save is awaited.
    fn settle(&self) {
        loop {
            let line = self.said.recv_timeout(PATIENCE).expect("it goes on");
            // R18.27
            if line == "watching `.`; Ctrl-C ends" {
                return;
            }
        }
    }

    /// Returns the lines that were printed so far.
    fn printed(&self) -> Vec<String> {
        let mut lines = Vec::new();
        while let Ok(line) = self.printed.recv_timeout(QUIET) {
            lines.push(line);
        }
        lines
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_save_checks_what_it_reaches() {
    // R17.5
    let bench = Bench::new(&[
        ("a.nc", "N10 L sub.nc\nN20 M30\n"),
        ("alone.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n"),
        ("sub.nc", "X1\nM17\n"),
    ]);
    let watching = Watching::new(&bench, &["check", "--watch", "--format", "concise", "."]);
    let first = watching.printed();
    assert!(
        first.len() == 1 && first[0].starts_with("alone.nc:1:"),
        "{first:?}"
    );
    bench.write("sub.nc", "Y[COMP OFF FRICT]\nM17\n");
    watching.settle();
    let second = watching.printed();
    assert_eq!(second.len(), 1, "{second:?}");
    assert!(second[0].starts_with("sub.nc:1:") && second[0].ends_with("(reached from a.nc)"));
    // A file that is not a program, list or configuration causes no output.
    bench.write("notes.txt", "x");
    assert_eq!(watching.printed(), [""; 0]);
    // A mistake in the configuration does not end it.
    bench.write("frictcomp.toml", "[machin]\n");
    watching.settle();
    bench.write("frictcomp.toml", MACHINE);
    watching.settle();
    assert_eq!(watching.printed().len(), 2);
}

#[test]
fn a_save_runs_the_programs_that_it_reaches_again() {
    // R17.5
    let bench = Bench::new(&[
        ("a.nc", "N10 L sub.nc\nN20 M30\n"),
        ("alone.nc", "N20 M30\n"),
        ("sub.nc", "X1\nM17\n"),
    ]);
    let watching = Watching::new(&bench, &["run", "--watch", "--format", "ndjson", "a.nc"]);
    let sessions = |lines: &[String]| {
        let is_end = |line: &&String| line.contains("\"record\":\"summary\"");
        lines.iter().filter(is_end).count()
    };
    assert_eq!(sessions(&watching.printed()), 1);
    bench.write("alone.nc", "N20 X[COMP OFF FRICT]\nM30\n");
    assert_eq!(sessions(&watching.printed()), 0);
    bench.write("sub.nc", "Y[COMP OFF FRICT]\nM17\n");
    let again = watching.printed();
    assert_eq!(sessions(&again), 1, "{again:?}");
    assert!(again.iter().any(|line| line.contains("Y[COMP OFF FRICT]")));
}

#[test]
fn what_is_not_saved_cannot_be_watched() {
    // R17.5
    let bench = Bench::new(&[("a.nc", "M30\n")]);
    for arguments in [["check", "--watch", "-"], ["run", "--watch", "-"]] {
        assert_eq!(bench.status(&arguments), Some(2), "{arguments:?}");
    }
    assert_eq!(
        bench.status(&["check", "--watch", "-o", "out.txt", "."]),
        Some(2)
    );
}
