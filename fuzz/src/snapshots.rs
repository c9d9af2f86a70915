//! Stops, saves, damages, forges and resumes a run.

use std::ops::ControlFlow;

use frictcomp::interpreter::{Event, Interpreter, RunOutcome, Snapshot};
use frictcomp::text::SourceFile;

use crate::damage::damage;
use crate::{Bench, Choices, Files, MAIN, POLICIES, machine};

/// Runs a program up to some block, and resumes it from the snapshot saved there: the unchanged one
/// leads to the same end, a damaged one is refused or leads to some end.
pub fn check_snapshot(files: Files<'_>, choices: &mut Choices<'_>) {
    let bench = Bench {
        files,
        stop: POLICIES[choices.below(3)],
    };
    let options = bench.options().run;
    let machine = machine();
    let compensation = machine.compensation();
    let mut run = Interpreter::new(machine.clone(), compensation, options);
    let mut left = 1 + choices.below(20);
    let outcome = run.program(files.source(), &mut { files }, &mut |_: Event<'_>| {
        // A run does not stop where ways meet.
        left = left.saturating_sub(1);
        if left == 0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    if outcome != RunOutcome::Paused {
        return;
    }
    let saved = run.snapshot().expect("its text is in memory");
    let mut document = serde_json::to_value(&saved).expect("a snapshot is JSON");
    let text = serde_json::to_string(&document).expect("a document is JSON");
    let read: Snapshot = serde_json::from_str(&text).expect("a saved snapshot is read");
    assert_eq!(
        serde_json::to_value(&read).expect("a snapshot is JSON"),
        document
    );
    let mut source = |name: &str| {
        let text = if name == MAIN {
            Some(files.main)
        } else {
            files.other_text()
        };
        text.map(|text| SourceFile::new(name, text))
    };
    let mut same = Interpreter::resume(machine.clone(), options, read, &mut source)
        .unwrap_or_else(|error| panic!("its own snapshot is refused: {error}\n{text}"));
    let mut ends = [String::new(), String::new()];
    for (run, end) in [&mut run, &mut same].into_iter().zip(&mut ends) {
        run.go_on(&mut { files }, &mut |event: Event<'_>| {
            if let Event::Ended(ended) = event {
                *end = format!("{} {:?} {:?}", ended.seq, ended.by, ended.changes);
            }
            ControlFlow::Continue(())
        });
    }
    assert_eq!(ends[0], ends[1], "the resumed run ends differently");

    damage(&mut document, choices);
    let Ok(damaged) = serde_json::from_value::<Snapshot>(document) else {
        return;
    };
    if damaged != saved {
        let refused = Interpreter::resume(machine.clone(), options, damaged.clone(), &mut source);
        assert!(refused.is_err(), "a damaged snapshot is resumed");
    }
    // A deliberate forgery passes as intact, and its contents are checked.
    let forged = damaged.sealed_anew();
    let Ok(mut run) = Interpreter::resume(machine, options, forged, &mut source) else {
        return;
    };
    run.go_on(
        &mut { files },
        &mut |_: Event<'_>| ControlFlow::Continue(()),
    );
}
