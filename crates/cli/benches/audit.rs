//! Time of an audit relative to `check` over the same archive: the ratio of paired runs, the speed, and the goal
//! (R10.4).
//!
//! `FRICTCOMP_BENCH_PROGRAMS` sets how many programs the archive has, 2 000 unless it is given;
//! `FRICTCOMP_BENCH_RUNS` how often each pair runs, 5 times; the median counts.

#![allow(clippy::print_stdout)] // The table is what it is for.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const TOOL: &str = env!("CARGO_BIN_EXE_frictcomp");

/// The greatest ratio of an audit to `check`.
const GOAL: f64 = 2.2;

/// Blocks of each program, about 20 KB.
const BLOCKS: u32 = 600;

const MACHINE: &str = "\
[[axis]]
name = \"X\"
frict_comp = true
[[axis]]
name = \"Y\"
frict_comp = true
[[axis]]
name = \"Z\"
frict_comp = true
";

fn main() -> Result<(), Box<dyn Error>> {
    let programs = setting("FRICTCOMP_BENCH_PROGRAMS", 2000)?;
    let runs = setting("FRICTCOMP_BENCH_RUNS", 5)?;
    let folder = tempfile::tempdir()?;
    let bytes = write_archive(folder.path(), programs)?;
    let mut ratios = Vec::new();
    let mut times = Vec::new();
    for _ in 0..runs.max(1) {
        let check = time(&["check", "-q"], folder.path())?;
        let audit = time(&["audit"], folder.path())?;
        ratios.push(audit.as_secs_f64() / check.as_secs_f64());
        times.push(audit.as_secs_f64());
    }
    let (ratio, seconds) = (median(&mut ratios), median(&mut times));
    let verdict = if ratio <= GOAL { "met" } else { "missed" };
    println!(
        "audit of {programs} programs, {:.0} MB: {ratio:.2} x check   goal {GOAL} x  {verdict}; {:.2} s for 100 MB",
        bytes / 1e6,
        seconds * 1e8 / bytes
    );
    Ok(())
}

fn setting(name: &str, default: u32) -> Result<u32, Box<dyn Error>> {
    match std::env::var(name) {
        Ok(text) => Ok(text.parse()?),
        Err(_) => Ok(default),
    }
}

/// Programs of which every third sets what it needs and every seventh leaves X off.
fn write_archive(folder: &Path, programs: u32) -> Result<f64, Box<dyn Error>> {
    std::fs::write(folder.join("frictcomp.toml"), MACHINE)?;
    let mut bytes = 0.0;
    for program in 0..programs {
        let mut text = String::new();
        if program % 3 == 0 {
            text.push_str("N5 X[COMP ON FRICT] Y[COMP ON FRICT] Z[COMP ON FRICT]\n");
        }
        for block in 1..=BLOCKS {
            let (x, y) = (block * 37 % 1000, block * 61 % 1000);
            let _ = writeln!(text, "N{} G01 X{x}.125 Y-{y}.25 F1500", block * 10);
        }
        if program % 7 == 0 {
            text.push_str("N900000 X[COMP OFF FRICT]\n");
        }
        text.push_str("N900010 M30\n");
        bytes += f64::from(u32::try_from(text.len())?);
        std::fs::write(folder.join(format!("p{program:05}.nc")), text)?;
    }
    Ok(bytes)
}

fn time(command: &[&str], folder: &Path) -> Result<Duration, Box<dyn Error>> {
    let start = Instant::now();
    let status = Command::new(TOOL)
        .args(command)
        .arg(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    let took = start.elapsed();
    if status.code() == Some(2) {
        return Err(format!("`{}` fails", command.join(" ")).into());
    }
    Ok(took)
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
