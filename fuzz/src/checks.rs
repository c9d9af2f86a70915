//! Properties of every run, whatever the program is.

use std::io::sink;

use frictcomp::session::{SavedState, Session};
use frictcomp_report::{Csv, Ndjson, Positions, Report, Text, TextOptions, View};

use crate::{Bench, Files, POLICIES, machine};

/// Runs a program in one of several ways, into one of several formats; `way` selects them.
pub fn check_run(files: Files<'_>, way: usize) {
    let stop = POLICIES[way % 3];
    let bench = Bench { files, stop };
    let mut session = Session::new(machine(), bench.options());
    let mut report: Box<dyn Report> = match way / 3 % 3 {
        0 => Box::new(Text::new(sink(), TextOptions::default())),
        1 => Box::new(Ndjson::new(sink(), View::default())),
        _ => Box::new(Csv::new(sink(), View::default()).with_positions(Positions::Shown)),
    };
    let _ = session.begin(&[], &mut *report);
    if way / 9 % 2 == 0 {
        bench.whole(&mut session, &mut *report);
    } else {
        bench.streamed(&mut session, &mut *report);
    }
    let _ = session.finish(&mut *report);
    report.finish().expect("a sink takes everything");
    check_work(&session, files);
}

/// Checks that the next run reads whatever a run saves, and starts with exactly that.
pub fn check_saved(files: Files<'_>, way: usize) {
    let (bench, session) = finished(files, way);
    let left = session.save();
    let text = serde_json::to_string(&left).expect("a state is JSON");
    let read: SavedState = serde_json::from_str(&text).expect("a saved state is read");
    assert_eq!(read, left, "{text}");
    let (mut next, _) = Session::resume(machine(), bench.options(), read)
        .unwrap_or_else(|error| panic!("its own state is refused: {error}\n{text}"));
    let again = serde_json::to_string(&next.save()).expect("a state is JSON");
    assert_eq!(again, text, "an untouched state has changed");
    bench.whole(&mut next, &mut Ndjson::new(sink(), View::default()));
}

/// Runs a program that grows: the budget of work ends it, and the memory that it holds stays small.
pub fn check_growth(files: Files<'_>, way: usize) {
    let (bench, session) = finished(files, way);
    check_work(&session, files);
    // Only lengths grow in a state; a text counts once more for every 32 bytes.
    let held = serde_json::to_string(&session.save()).expect("a state is JSON");
    let values = usize::try_from(bench.options().run.limits.values).expect("a small number");
    let most = 200 * (values + files.len()) + 10_000;
    assert!(
        held.len() <= most,
        "the run holds {} bytes, {most} are allowed",
        held.len()
    );
}

/// Returns a session that has run a program, in one of several ways.
fn finished(files: Files<'_>, way: usize) -> (Bench<'_>, Session) {
    let bench = Bench {
        files,
        stop: POLICIES[way % 3],
    };
    let mut session = Session::new(machine(), bench.options());
    bench.session(&mut session, &mut Ndjson::new(sink(), View::default()));
    (bench, session)
}

/// Checks that the work of a run is bounded by its budgets and its texts.
fn check_work(session: &Session, files: Files<'_>) {
    let bench = Bench {
        files,
        stop: POLICIES[0],
    };
    let limits = bench.options().run.limits;
    let bytes = u64::try_from(files.len()).expect("a small number");
    // Both passes read both files, each executed block adds its share, and the block that
    // exceeds the bound is finished.
    let bound = 4 * (limits.work + 16 * bytes + limits.blocks * (500 + 4 * bytes));
    let work = session.interpreter().work();
    assert!(work <= bound, "{work} units of work, {bound} are allowed");
}
