//! A dry run from memory that is stopped in the middle, saved, and resumed.
//!
//! `cargo run --example embed_run`

use std::ops::ControlFlow;

use frictcomp::interpreter::{Event, Interpreter, NoFiles, Options, RunOutcome, Snapshot};
use frictcomp::machine::Machine;
use frictcomp::text::SourceFile;

const PROGRAM: &str = "\
N10 X[COMP OFF FRICT]
N20 G01 X50 F1500
N30 X[COMP ON FRICT]
N40 M30
";

/// Prints each block with its changes and stops the run after a block number.
fn watch(machine: &Machine, event: &Event<'_>, stop_after: Option<i64>) -> ControlFlow<()> {
    let Event::Executed(block) = event else {
        return ControlFlow::Continue(());
    };
    say(block.text);
    for change in block.changes {
        let axis = &machine.axis(change.axis).name;
        say(&format!(
            "    {axis}: {} → {}",
            change.from.as_str(),
            change.to.as_str()
        ));
    }
    if stop_after.is_some() && block.number == stop_after {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let machine = Machine::enabled(["X"]);
    let program = || SourceFile::new("a.nc", PROGRAM);

    let start = machine.compensation();
    let mut run = Interpreter::new(machine.clone(), start, Options::default());
    let mut observer = |event: Event<'_>| watch(&machine, &event, Some(20));
    let outcome = run.program(program(), &mut NoFiles, &mut observer);
    assert_eq!(outcome, RunOutcome::Paused);

    let saved = serde_json::to_string(&run.snapshot().ok_or("its text is in memory")?)?;
    drop(run);
    say(&format!("saved in {} bytes", saved.len()));

    let snapshot: Snapshot = serde_json::from_str(&saved)?;
    let mut source = |name: &str| (name == "a.nc").then(program);
    let mut run = Interpreter::resume(machine.clone(), Options::default(), snapshot, &mut source)?;
    let mut observer = |event: Event<'_>| watch(&machine, &event, None);
    let outcome = run.go_on(&mut NoFiles, &mut observer);
    assert!(matches!(outcome, RunOutcome::Ended(_)));
    Ok(())
}

#[test]
fn it_runs() {
    main().expect("a run");
}

#[allow(clippy::print_stdout, reason = "an example shows what happens")]
fn say(text: &str) {
    println!("{text}");
}
