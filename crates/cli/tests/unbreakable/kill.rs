//! Runs that are killed at any moment, two writers at once: the state is always complete, and the result
//! of a completed run is never lost.
//!
//! `cargo test --release --test unbreakable -- --ignored kill` kills 500 runs.

use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Instant;

use fastrand::Rng;

use crate::folder::{Bench, json, starting};

/// Program of which each run counts itself in the state.
const COUNT: &str = "V.S.RUNS = V.S.RUNS + 1\nX[COMP OFF FRICT]\nM30\n";
const RUN: [&str; 4] = ["run", "--state", "s.json", "a.nc"];

/// The exit status of a killed run: none, but on Windows the one that its killer sets.
const KILLED: Option<i32> = if cfg!(windows) { Some(1) } else { None };

/// Counts of the runs so far.
#[derive(Default)]
struct Tally {
    started: AtomicU64,
    completed: AtomicU64,
    killed: AtomicU64,
}

impl Tally {
    fn of(counter: &AtomicU64) -> u64 {
        counter.load(Ordering::SeqCst)
    }
}

/// Returns the number of runs that the state has counted; it must be complete.
fn counted(bench: &Bench) -> u64 {
    let state = json(&bench.read("s.json"));
    let runs = state["variables"]["V.S.RUNS"]["Number"].as_f64();
    format!("{}", runs.expect("a number"))
        .parse()
        .expect("a whole number")
}

/// Starts runs and kills them until enough were killed.
fn kill_runs(bench: &Bench, tally: &Tally, enough: u64, mut rng: Rng) {
    let begin = Instant::now();
    assert_eq!(bench.status(&["run", "zero.nc"]), Some(0));
    let usual = begin.elapsed();
    while Tally::of(&tally.killed) < enough {
        let before = Tally::of(&tally.completed);
        tally.started.fetch_add(1, Ordering::SeqCst);
        let mut child = starting(|| bench.command(&RUN).spawn());
        thread::sleep(usual.mul_f64(rng.f64() * 1.5));
        let _ = child.kill();
        match child.wait().expect("it ends").code() {
            Some(0) => tally.completed.fetch_add(1, Ordering::SeqCst),
            status if status == KILLED => tally.killed.fetch_add(1, Ordering::SeqCst),
            status => panic!("status {status:?}"),
        };
        let counted = counted(bench);
        assert!(
            counted >= before,
            "{before} runs completed, the state knows {counted}"
        );
        assert!(counted <= Tally::of(&tally.started));
    }
}

fn kill_two_writers(kills: u64) {
    let bench = Bench::new(&[("a.nc", COUNT), ("zero.nc", "V.S.RUNS = 0\nM30\n")]);
    assert_eq!(
        bench.status(&["run", "--state", "s.json", "zero.nc"]),
        Some(0)
    );
    let tally = Tally::default();
    thread::scope(|scope| {
        for seed in [1, 2] {
            let (bench, tally) = (&bench, &tally);
            scope.spawn(move || kill_runs(bench, tally, kills, Rng::with_seed(seed)));
        }
    });
    let (started, completed) = (Tally::of(&tally.started), Tally::of(&tally.completed));
    let counted = counted(&bench);
    assert!(
        completed <= counted && counted <= started,
        "{completed} {counted} {started}"
    );
    // Nothing from the killed runs is in the way or is left for long.
    assert_eq!(bench.status(&RUN), Some(0));
    let files = std::fs::read_dir(bench.folder()).expect("a folder").count();
    assert_eq!(files, 5, "two programs, a machine, the state and its lock");
    eprintln!("{kills} killed, {completed} completed, {counted} counted of {started} started");
}

#[test]
fn killed_runs_leave_a_whole_state() {
    // R9.31
    kill_two_writers(40);
}

#[test]
#[ignore = "500 kills take a while"]
fn five_hundred_killed_runs_leave_a_whole_state() {
    // R9.31
    kill_two_writers(500);
}

#[test]
fn a_run_waits_for_the_other_and_then_says_so() {
    // R9.31
    let bench = Bench::new(&[("a.nc", COUNT)]);
    let lock = std::fs::File::create(bench.folder().join("s.json.lock")).expect("a lock");
    lock.lock().expect("locked");
    let output = bench.call(&RUN);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.contains("another run uses the state file"), "{said}");
}

/// Two processes that run again and again on the same state and on the same output, neither of them
/// killed: each run is counted once, whatever the other does meanwhile.
#[test]
fn two_processes_take_turns() {
    // R9.31, R9.70
    const RUNS: u32 = 25;
    let bench = Bench::new(&[
        ("a.nc", COUNT),
        ("zero.nc", "V.S.RUNS = 0\nM30\n"),
        ("s.json-2.nc", COUNT),
    ]);
    assert_eq!(
        bench.status(&["run", "--state", "s.json", "zero.nc"]),
        Some(0)
    );
    // The names begin alike: an unfinished file of one process is not mistaken for the other's.
    let commands: [&[&str]; 2] = [
        &["run", "--state", "s.json", "a.nc", "-o", "s.json-out"],
        &[
            "run",
            "--state",
            "s.json",
            "s.json-2.nc",
            "-o",
            "s.json-out",
        ],
    ];
    thread::scope(|scope| {
        for command in commands {
            let bench = &bench;
            scope.spawn(move || {
                for _ in 0..RUNS {
                    assert_eq!(bench.status(command), Some(0));
                    let shown = bench.read("s.json-out");
                    assert!(
                        shown.contains("end by M30") && shown.ends_with('\n'),
                        "{shown}"
                    );
                }
            });
        }
    });
    assert_eq!(counted(&bench), u64::from(2 * RUNS));
    let files = std::fs::read_dir(bench.folder()).expect("a folder").count();
    assert_eq!(
        files, 7,
        "three programs, a machine, the state and its lock, the output"
    );
}
