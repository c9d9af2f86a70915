//! State files: any text is refused, or a session continues from it and saves the same state again.
#![no_main]

use frictcomp::session::{SavedState, Session};
use frictcomp_fuzz::{Bench, Files, POLICIES, machine};
use frictcomp_report::{Ndjson, View};
use libfuzzer_sys::fuzz_target;

const PROGRAM: &str = "V.S.A = V.S.A + 1\nV.S.B = V.S.B\nX[COMP OFF FRICT]\nX=V.S.A Y1 Z2\nM30\n";

fuzz_target!(|input: &str| {
    let Ok(mut saved) = serde_json::from_str::<SavedState>(input) else {
        return;
    };
    let bench = Bench {
        files: Files::new(PROGRAM),
        stop: POLICIES[1],
    };
    // A fuzzer cannot guess the fingerprint of a machine.
    saved.machine = Session::new(machine(), bench.options()).save().machine;
    let Ok((mut session, said)) = Session::resume(machine(), bench.options(), saved) else {
        return;
    };
    let mut sink = Ndjson::new(std::io::sink(), View::default());
    let _ = session.begin(&said, &mut sink);
    bench.whole(&mut session, &mut sink);
    let left = session.save();
    let text = serde_json::to_string(&left).expect("a state is JSON");
    let read: SavedState = serde_json::from_str(&text).expect("a state is read back");
    assert_eq!(serde_json::to_string(&read).expect("a state is JSON"), text);
});
