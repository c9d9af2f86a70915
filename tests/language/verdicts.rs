//! Verdicts across calls, sessions and state files (chapter 18).

use std::ops::ControlFlow;

use frictcomp::diagnostic::Severity;
use frictcomp::interpreter::NoFiles;
use frictcomp::machine::Machine;
use frictcomp::session::{Causes, SavedState, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::Record;

use crate::support::{Bench, SourceMode};

/// Machine on which X is described, of Y nothing is known but its name, and Z has no friction compensation.
const PARTLY_DESCRIBED: &str = "[[axis]]\nname = \"X\"\nenable = true\n[[axis]]\nname = \"Y\"\n\
    [[axis]]\nname = \"Z\"\nfrict_comp = false\n";

#[test]
fn an_enabled_axis_is_described() {
    // R18.2 R1.20
    let machine = Machine::enabled(["X"]);
    let described = machine.axes.iter().filter(|axis| axis.is_described());
    let names: Vec<_> = described.map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["X"]);
}

#[test]
fn one_message_for_each_axis_of_a_call() {
    // R18.2
    let mut causes = Causes::default();
    for name in ["a.nc", "b.nc"] {
        let file = SourceFile::new(name, "Y[COMP OFF FRICT]\nG1 Y1 F100\nM30\n");
        let machine = Machine::from_toml(PARTLY_DESCRIBED).expect("a machine");
        let options = SessionOptions::default();
        causes.add(frictcomp::check(file, machine, options, &mut NoFiles));
    }
    let said = causes.diagnostics().iter();
    let said: Vec<_> = said.map(|it| (it.code.as_str(), &*it.place.file)).collect();
    assert_eq!(said, [("FC408", "a.nc")]);
}

#[test]
fn switching_what_is_not_described_is_not_known() {
    // R18.2 R2.98
    let unknown = |program: &str| {
        let bench = Bench::on(PARTLY_DESCRIBED).keep_going();
        let mut session = bench.session();
        bench.run_in(&mut session, &[program]);
        let unknown = session.unknown().map(|(axis, _)| axis.to_owned());
        unknown.collect::<Vec<_>>()
    };
    assert_eq!(unknown("Y[COMP OFF FRICT]\nM30\n"), ["Y"]);
    assert_eq!(unknown("Y[COMP ON FRICT]\nM30\n"), ["Y"]);
    assert!(unknown("G1 Y5 F100\nM30\n").is_empty());
    assert!(unknown("Z[COMP OFF FRICT]\nM30\n").is_empty());
}

#[test]
fn a_shift_over_a_state_file_counts_what_it_cuts() {
    // R18.4
    let bench = Bench::on(PARTLY_DESCRIBED).keep_going();
    let mut first = bench.session();
    bench.run_in(&mut first, &["X[COMP OFF FRICT]\nM30\n"]);
    let text = serde_json::to_string(&first.save()).expect("JSON");
    let saved: SavedState = serde_json::from_str(&text).expect("a state");
    let resumed = Session::resume(bench.machine.clone(), SessionOptions::default(), saved);
    let (mut second, _) = resumed.expect("the same machine");
    let mut cut = Vec::new();
    let mut sink = |record: &Record<'_>| {
        let said = record.diagnostics().map(|it| it.diagnostic().clone());
        let said = said.filter(|it| it.code.as_str() == "FC403");
        cut.extend(said.map(|it| (it.severity, it.place.start().to_string())));
        ControlFlow::Continue(())
    };
    let program = ["G0 X0 Z0\nG2 X10 I5 F100\nM30\n"];
    bench.run_into(&mut second, (&program, SourceMode::Whole), &mut sink);
    assert_eq!(cut, [(Severity::Warning, "2:4".to_owned())]);
    assert_eq!(second.counts().get(&Severity::Warning), Some(&1));
}
