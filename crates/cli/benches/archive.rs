//! Cost of an archive: 20 000 programs, of which 400 are called, three levels deep. The time and the memory of `check`,
//! `audit`, `show calls`, and of `check --changed` after a change of one subprogram, which costs what its callers cost
//! and a look over the texts (R17.4); and of calls of a missing program, which are looked for in every folder.
//!
//! `FRICTCOMP_BENCH_PROGRAMS` sets how many programs the archive has; a fiftieth of them are called.

#![allow(clippy::print_stdout)] // The table is what it is for.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const TOOL: &str = env!("CARGO_BIN_EXE_frictcomp");

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

/// Blocks of a main program, about 3 KB.
const BLOCKS: u32 = 80;

fn main() -> Result<(), Box<dyn Error>> {
    let programs = match std::env::var("FRICTCOMP_BENCH_PROGRAMS") {
        Ok(text) => text.parse()?,
        Err(_) => 20_000,
    };
    let folder = tempfile::tempdir()?;
    let folder = folder.path();
    let callers = write_archive(folder, programs)?;
    commit(folder)?;
    println!("{programs} programs, {} of them called", programs / 50);
    for command in [&["check", "-q"] as &[&str], &["audit"], &["show", "calls"]] {
        measure(command, folder)?;
    }
    measure(&["check", "-q", "--write-baseline", "known.json"], folder)?;
    measure(&["check", "-q", "--baseline", "known.json"], folder)?;
    measure_change("low00000.nc", callers, folder)?;
    measure_change("p00000.nc", 0, folder)?;
    println!("every main program calls one that is missing");
    call_missing(folder)?;
    measure(&["check", "-q"], folder)?;
    measure(&["show", "calls"], folder)
}

fn commit(folder: &Path) -> Result<(), Box<dyn Error>> {
    let user = ["-c", "user.name=b", "-c", "user.email=b@example.org"];
    let commit = [&user[..], &["commit", "-q", "-m", "all"]].concat();
    for arguments in [&["init", "-q"] as &[&str], &["add", "-A"], &commit] {
        let mut git = Command::new("git");
        if !git.current_dir(folder).args(arguments).status()?.success() {
            return Err("git is needed".into());
        }
    }
    Ok(())
}

/// Measures the cost of a change to one program that the given number of programs reach, and restores the file
/// afterwards.
fn measure_change(name: &str, callers: u32, folder: &Path) -> Result<(), Box<dyn Error>> {
    let path = folder.join(name);
    let before = std::fs::read_to_string(&path)?;
    std::fs::write(&path, before.replacen("N10 ", "N5 X1\nN10 ", 1))?;
    println!("`{name}` changed, reached from {callers} programs");
    measure(&["check", "-q", "--changed"], folder)?;
    measure(&["diff", "--git", "HEAD"], folder)?;
    Ok(std::fs::write(&path, before)?)
}

/// Has every main program call one that is not there, before its end.
fn call_missing(folder: &Path) -> Result<(), Box<dyn Error>> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|it| it == "nc") {
            let text = std::fs::read_to_string(&path)?;
            std::fs::write(&path, text.replace("N9010 ", "N9005 L none.nc\nN9010 "))?;
        }
    }
    Ok(())
}

/// Returns the main programs that call one of the upper subprograms, which calls a middle one, which calls a lower one.
/// Gives how many programs reach the first of the lower ones.
fn write_archive(folder: &Path, programs: u32) -> Result<u32, Box<dyn Error>> {
    std::fs::write(folder.join("frictcomp.toml"), MACHINE)?;
    let level = (programs / 150).max(1);
    for at in 0..level {
        let upper = format!("N10 Z[COMP OFF FRICT]\nN20 L mid{at:05}.nc\nM17\n");
        let middle = format!("N10 G1 Z{at} F100\nN20 L low{at:05}.nc\nM17\n");
        std::fs::write(folder.join(format!("up{at:05}.nc")), upper)?;
        std::fs::write(folder.join(format!("mid{at:05}.nc")), middle)?;
        std::fs::write(
            folder.join(format!("low{at:05}.nc")),
            "N10 Z[COMP ON FRICT]\nM17\n",
        )?;
    }
    let mut callers = 2;
    for program in 0..programs.saturating_sub(3 * level) {
        let mut text = String::new();
        for block in 1..=BLOCKS {
            let (x, y) = (block * 37 % 1000, block * 61 % 1000);
            let _ = writeln!(text, "N{} G01 X{x}.125 Y-{y}.25 F1500", block * 10);
        }
        let called = program % level;
        callers += u32::from(called == 0);
        let _ = writeln!(text, "N9000 L up{called:05}.nc\nN9010 M30");
        std::fs::write(folder.join(format!("p{program:05}.nc")), text)?;
    }
    Ok(callers)
}

fn measure(command: &[&str], folder: &Path) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let mut child = Command::new(TOOL)
        .args(command)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    let mut peak = 0;
    let status = loop {
        peak = peak.max(peak_kb(child.id()).unwrap_or_default());
        if let Some(status) = child.try_wait()? {
            break status;
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let took = start.elapsed().as_secs_f64();
    if status.code() == Some(2) {
        return Err(format!("`{}` fails", command.join(" ")).into());
    }
    println!(
        "{:<44} {took:6.2} s  {:5} MB",
        command.join(" "),
        peak / 1024
    );
    Ok(())
}

/// Returns the most memory that a process had so far, where the system reports it.
fn peak_kb(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
