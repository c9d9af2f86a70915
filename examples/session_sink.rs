//! Two programs in one session of the control, with a custom sink.
//!
//! `cargo run --example session_sink`

use std::ops::ControlFlow;

use frictcomp::interpreter::NoFiles;
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

/// Collects the changes, as `file:line axis: from → to`.
#[derive(Default)]
struct Changes(Vec<String>);

impl Sink for Changes {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record {
            for change in row.changes {
                let axis = row.state.name(change.axis);
                let (from, to) = (change.from.as_str(), change.to.as_str());
                let (file, line) = (row.file, row.line);
                self.0.push(format!("{file}:{line} {axis}: {from} → {to}"));
            }
        }
        ControlFlow::Continue(())
    }
}

fn main() {
    let mut session = Session::new(Machine::enabled(["X", "Y"]), SessionOptions::default());
    let mut changes = Changes::default();
    for (name, text) in [
        ("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n"),
        ("b.nc", "N10 X[COMP ON FRICT] Y[COMP OFF FRICT]\nN20 M30\n"),
    ] {
        let program = Program::Whole(SourceFile::new(name, text));
        let _ = session.program(name, program, &mut NoFiles, &mut changes);
    }
    changes.0.iter().for_each(|change| say(change));
    assert_eq!(
        changes.0,
        [
            "a.nc:1 X: active → inactive",
            "b.nc:1 X: inactive → active",
            "b.nc:1 Y: active → inactive",
        ]
    );
}

#[test]
fn it_runs() {
    main();
}

#[allow(clippy::print_stdout, reason = "an example shows what happens")]
fn say(text: &str) {
    println!("{text}");
}
