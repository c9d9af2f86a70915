//! Writes the recordings of `programs/demo/recorded`, for `commission run`, `commission learn` and `commission trend`:
//!
//!     frictcomp commission plan --axis X,Y --travel X0..60,Y-30..30 --feeds 1200,1600,2100,2800,3700,5000 --radius 10 \
//!         --slowest 1 -o PLANNED
//!     cargo run -p frictcomp-testing --example demo_recordings -- PLANNED programs/demo/recorded
//!
//! `PLANNED` is the folder of the plan, with its programs. Rows are few, and numbers short, so that the files stay small.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "rows and times of recordings"
)]
#![allow(clippy::print_stderr, reason = "a program of the console")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use frictcomp_testing::{Machine, Program, Random, Run, ValueList};

const AXES: [&str; 2] = ["X", "Y"];

/// Start position of the measuring programs, in mm.
const START: [f64; 2] = [10.0, 10.0];

/// Milliseconds between two rows of constant speeds, and of circles.
const COARSE_MS: usize = 20;
const FINE_MS: usize = 2;

/// Milliseconds after which the machine is at its feed.
const AT_FEED_MS: usize = 400;

/// Feeds of the circles in mm/min, and their radius in mm: at faster ones a glitch runs into the next.
const FEEDS: [f64; 6] = [1900.0, 2000.0, 2100.0, 2200.0, 2350.0, 2500.0];
const RADIUS: f64 = 20.0;

/// The dates of the trend, with the friction of X as a part of the first.
const DATES: [(&str, f64); 3] = [
    ("2026-03-01", 1.0),
    ("2026-06-01", 1.02),
    ("2026-09-01", 1.16),
];

fn main() {
    let mut folders = std::env::args().skip(1).map(PathBuf::from);
    let (Some(planned), Some(to)) = (folders.next(), folders.next()) else {
        eprintln!("usage: demo_recordings PLANNED FOLDER");
        std::process::exit(2);
    };
    let machine = Machine::bristle();
    let text = read(&planned.join("01-friction-X.nc"));
    let run = machine.run(&Program::parse(&text, AXES, START), START, [None; 2]);
    let name = "machine/recordings/friction-X.csv";
    write(&to.join(name), &constant_speeds(&run, 1));
    let text = short_speeds();
    for (seed, (date, friction)) in (2..).zip(DATES) {
        let mut worn = machine.clone();
        worn.axes = worn.axes.map(|it| it.with_friction(friction));
        let run = worn.run(&Program::parse(&text, AXES, START), START, [None; 2]);
        let name = format!("trend/x-{date}.csv");
        write(&to.join(name), &constant_speeds(&run, seed));
    }
    let round = to.join("learning/round-1");
    let lists = AXES.map(|axis| round.join(format!("{axis}.lis")));
    if lists.iter().all(|it| it.exists()) {
        circles(
            &machine,
            &round,
            &lists.map(|it| ValueList::parse(&read(&it))),
        );
    }
}

/// Returns a program with six speeds of X, back and forth, of which a test bench has time each month.
fn short_speeds() -> String {
    let mut text = String::from("G4 X0.2\n");
    for mm_per_min in [60.0, 150.0, 400.0, 1000.0, 2400.0, 5000.0] {
        let way = 10.0 + (mm_per_min / 60.0_f64 * 0.9).max(2.0);
        for to in [way, 10.0] {
            writeln!(text, "G1 X{to} F{mm_per_min}\nG4 X0.1").expect("text");
        }
    }
    text
}

/// Records the circles of a round, each twice.
fn circles(machine: &Machine, round: &Path, lists: &[ValueList; 2]) {
    let start = [RADIUS, 0.0];
    for feed in FEEDS {
        for take in [1, 2] {
            let turn = format!("G3 X{RADIUS} Y0 I-{RADIUS} J0 F{feed}\n");
            let text = turn.repeat(2);
            let run = machine.run(
                &Program::parse(&text, AXES, start),
                start,
                lists.each_ref().map(Some),
            );
            let mut random = Random::new((feed as u64) * 10 + take);
            let mut rows = String::from("t,x,y\n");
            // From where the machine is at its feed: a turn and as much beside it as is left out at the ends.
            let turn_ms = std::f64::consts::TAU * RADIUS / (feed / 60.0) * 1000.0;
            let rows_ms = AT_FEED_MS..AT_FEED_MS + (1.28 * turn_ms) as usize;
            for at in rows_ms.step_by(FINE_MS) {
                let place = |axis: usize, random: &mut Random| {
                    run.load_mm[axis][at] + 3e-4 * random.normal()
                };
                let [x, y] = [place(0, &mut random), place(1, &mut random)];
                let time = (at - AT_FEED_MS) as f64 * run.cycle_s;
                writeln!(rows, "{time:.3},{x:.4},{y:.4}").expect("text");
            }
            write(&round.join(format!("F{feed}-{take}.csv")), &rows);
        }
    }
}

/// Returns the rows of constant speeds of X: s, µm/s, drive units.
fn constant_speeds(run: &Run, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut rows = String::from("t,v,torque\n");
    for at in (0..run.units[0].len()).step_by(COARSE_MS) {
        let velocity = run.commanded.velocities[0][at] * 1e3;
        let torque = run.units[0][at] + random.normal();
        let time = at as f64 * run.cycle_s;
        writeln!(rows, "{time:.2},{velocity:.0},{torque:.0}").expect("text");
    }
    rows
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn write(path: &Path, text: &str) {
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    std::fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}
