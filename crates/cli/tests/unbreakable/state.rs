//! The state file: damaged anywhere, it is refused and left unchanged.

use fastrand::Rng;
use frictcomp::interpreter::Value;
use frictcomp::machine::Machine;
use frictcomp::session::{SavedState, Session, SessionOptions};

use crate::folder::{Bench, MACHINE, of_schema_2};

const LEAVE_OFF: &str = "X[COMP OFF FRICT]\nV.S.PART = 7\nV.S.NAME = \"mill\"\nM30\n";
const RUN: [&str; 4] = ["run", "--state", "s.json", "a.nc"];

/// Returns a folder with the state that a run left, and its text.
fn bench_with_state() -> (Bench, String) {
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    assert_eq!(bench.status(&RUN), Some(0));
    let good = bench.read("s.json");
    (bench, good)
}

#[test]
fn a_state_cut_anywhere_is_refused_and_left_alone() {
    // R9.30
    let (bench, good) = bench_with_state();
    for length in 0..good.trim_end().len() {
        let cut = &good[..length];
        bench.write("s.json", cut);
        let output = bench.call(&RUN);
        assert_eq!(output.status.code(), Some(2), "{cut}");
        let said = String::from_utf8(output.stderr).expect("text");
        assert!(
            said.contains("the state file") && said.contains("s.json"),
            "{said}"
        );
        assert!(said.contains("help: name another file"), "{said}");
        assert!(output.stdout.is_empty(), "nothing ran");
        assert_eq!(bench.read("s.json"), cut);
    }
    bench.write("s.json", &good);
    assert_eq!(bench.status(&RUN), Some(0));
}

#[test]
fn a_state_of_another_time_or_machine_is_refused_and_left_alone() {
    // R9.30
    let (bench, good) = bench_with_state();
    let editable = of_schema_2(&good);
    let wrongs = [
        ("\"schema\": 2", "\"schema\": 5", "schema 5"),
        ("\"schema\": 2", "\"schema\": 0", "schema 0"),
        ("\"schema\": 2", "\"schema\": -1", "damaged"),
        ("axis Z number", "axis C number", "another machine"),
        ("\"variables\"", "\"variable\"", "damaged"),
        ("\"axis\": \"X\"", "\"axis\": 1", "damaged"),
        ("\"max_points\": 20", "\"max_points\": 1e99", "damaged"),
    ];
    for (right, wrong, reason) in wrongs {
        let text = editable.replacen(right, wrong, 1);
        assert_ne!(text, editable, "{right}");
        bench.write("s.json", &text);
        let output = bench.call(&RUN);
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{wrong}: {said}");
        assert!(said.contains(reason), "{wrong}: {said}");
        assert_eq!(bench.read("s.json"), text);
    }
    bench.write("s.json", &good);
    bench.write("frictcomp.toml", &MACHINE.replace("\"Z\"", "\"C\""));
    assert_eq!(bench.status(&RUN), Some(2));
    assert_eq!(bench.read("s.json"), good);
}

#[test]
fn a_state_with_one_changed_bit_is_refused_and_left_alone() {
    // R9.92: through the tool; every bit is tried where the file is read.
    let (bench, good) = bench_with_state();
    let path = bench.folder().join("s.json");
    for bit in (0..good.len() * 8).step_by(83) {
        let mut flipped = good.clone().into_bytes();
        flipped[bit / 8] ^= 1 << (bit % 8);
        std::fs::write(&path, &flipped).expect("written");
        assert_eq!(bench.status(&RUN), Some(2), "bit {bit}");
        assert_eq!(std::fs::read(&path).expect("read"), flipped, "bit {bit}");
    }
}

#[test]
fn a_run_that_does_not_end_well_leaves_the_state_as_an_error_does() {
    // R9.14, R9.30
    let (bench, good) = bench_with_state();
    bench.write("b.nc", "X[COMP ON FRICT]\nZ[COMP ON FRICT]\nM30\n");
    assert_eq!(bench.status(&["run", "--state", "s.json", "b.nc"]), Some(1));
    let left = bench.read("s.json");
    assert_ne!(
        left, good,
        "what ran before the error is part of the session"
    );
    assert_eq!(
        bench.status(&["run", "--state", "s.json", "missing.nc"]),
        Some(2)
    );
    assert_eq!(bench.read("s.json"), left);
}

#[test]
fn numbers_come_back_to_the_last_bit() {
    // R9.30
    let session = Session::new(Machine::enabled(["X"]), SessionOptions::default());
    let mut state = session.save();
    let mut rng = Rng::with_seed(3);
    let mut numbers: Vec<f64> = vec![0.1 + 0.2, 1.0 / 3.0, 1e-300, -1.5e300, 5e-324];
    numbers.extend((0..20_000).map(|_| f64::from_bits(rng.u64(..))));
    numbers.extend((0..20_000).map(|_| rng.f64() * 1000.0));
    for (at, number) in numbers
        .into_iter()
        .filter(|number| number.is_finite())
        .enumerate()
    {
        let name = format!("V.S.N{at}");
        state.variables.insert(name, Value::Number(number));
    }
    let text = serde_json::to_string(&state).expect("JSON");
    let read: SavedState = serde_json::from_str(&text).expect("a state");
    assert!(read == state, "a number changed");
}
