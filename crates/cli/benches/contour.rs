//! Time of a contour: 30 s of machine time in one run, an hour in three runs (R11.7), and 300 000 lines of 0.1 mm that
//! a contour mode joins (R11.28), each on two axes, with the goals.
//!
//! `FRICTCOMP_BENCH_RUNS` sets how often each runs, 3 times unless it is given; the median counts.
//! `FRICTCOMP_BENCH_SECONDS` sets the machine time of the long program, 3600 unless it is given.

#![allow(clippy::print_stdout)] // The table is what it is for.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const TOOL: &str = env!("CARGO_BIN_EXE_frictcomp");

/// Permitted time for 30 s of machine time in one run, in s.
const SHORT_GOAL: f64 = 0.08;

/// Permitted time for an hour of machine time in three runs, in s.
const LONG_GOAL: f64 = 30.0;

/// Permitted time for 300 000 short lines in three runs, in s.
const LINES_GOAL: f64 = 10.0;

const MACHINE: &str = "\
[[axis]]
name = \"X\"
frict_comp = true
max_jerk = 1000.0
[[axis]]
name = \"Y\"
frict_comp = true
max_jerk = 1000.0
";

/// Time of a circle of 25 mm at 3000 mm/min, in s.
const TURN_S: f64 = std::f64::consts::TAU * 25.0 / 50.0;

fn main() -> Result<(), Box<dyn Error>> {
    let runs = setting("FRICTCOMP_BENCH_RUNS", 3)?;
    let long = setting("FRICTCOMP_BENCH_SECONDS", 3600)?;
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("frictcomp.toml"), MACHINE)?;
    let short = median(folder.path(), (&turns(30), runs))?.as_secs_f64() / 3.0;
    println!(
        "contour of 30 s, two axes, one of three runs: {:.0} ms   goal {:.0} ms  {}",
        short * 1000.0,
        SHORT_GOAL * 1000.0,
        verdict(short <= SHORT_GOAL)
    );
    let took = median(folder.path(), (&turns(long), runs))?.as_secs_f64();
    let goal = LONG_GOAL * f64::from(long) / 3600.0;
    println!(
        "contour of {long} s, two axes, three runs: {took:.1} s   goal {goal:.1} s  {}",
        verdict(took <= goal)
    );
    let took = median(folder.path(), (&lines(), 1))?.as_secs_f64();
    println!(
        "contour of 300 000 lines, two axes, three runs: {took:.1} s   goal {LINES_GOAL:.1} s  {}",
        verdict(took <= LINES_GOAL)
    );
    Ok(())
}

fn verdict(is_met: bool) -> &'static str {
    if is_met { "met" } else { "missed" }
}

fn setting(name: &str, default: u32) -> Result<u32, Box<dyn Error>> {
    match std::env::var(name) {
        Ok(text) => Ok(text.parse()?),
        Err(_) => Ok(default),
    }
}

/// Circles for so many seconds.
fn turns(seconds: u32) -> String {
    let mut text = String::from("X[COMP OFF FRICT]\nG01 X25 Y0 F3000\n");
    let mut time = 0.0;
    while time < f64::from(seconds) {
        let _ = writeln!(text, "G03 X25 Y0 I-25 J0");
        time += TURN_S;
    }
    text + "M30\n"
}

/// Writes short lines on arcs of 200 mm, to the left and to the right by turns.
fn lines() -> String {
    let mut text = String::from("G261\nG01 X25 Y0 F6000\n");
    let (mut x, mut y, mut angle) = (25.0, 0.0, 0.0_f64);
    for line in 0..300_000 {
        let turn = if line % 6000 < 3000 { 0.0005 } else { -0.0005 };
        angle += turn;
        x += 0.1 * angle.cos();
        y += 0.1 * angle.sin();
        let _ = writeln!(text, "X{x:.4} Y{y:.4}");
    }
    text + "M30\n"
}

/// Returns the median time of the contour of a program.
fn median(folder: &Path, (text, runs): (&str, u32)) -> Result<Duration, Box<dyn Error>> {
    std::fs::write(folder.join("part.nc"), text)?;
    let mut times = Vec::new();
    for _ in 0..runs.max(1) {
        let start = Instant::now();
        let status = Command::new(TOOL)
            .args(["contour", "part.nc", "--start", "X25,Y-10"])
            .current_dir(folder)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()?;
        times.push(start.elapsed());
        if status.code() != Some(0) {
            return Err("`contour` fails".into());
        }
    }
    times.sort();
    Ok(times[times.len() / 2])
}
