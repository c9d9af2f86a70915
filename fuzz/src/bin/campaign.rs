//! A campaign: a given number of generated programs in one process and thread, without a fuzzer's
//! counters.
//!
//! `cargo run --release --manifest-path fuzz/Cargo.toml --bin campaign -- run 10000000`. Inputs are
//! numbered; a third argument is the number to begin with, so that `campaign run 1 NUMBER` repeats
//! a find. A failing or slow input ends the campaign with status 1.

use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use frictcomp_fuzz::{
    Choices, Files, Profile, check_circle, check_growth, check_run, check_saved, check_snapshot,
    program,
};

/// Ways to run a program: policies, formats, as a whole or line by line.
const WAYS: u64 = 18;

/// Decisions of the longest inputs: enough for a program of some kilobytes. The others have a
/// half, a quarter or an eighth.
const DECISIONS: usize = 260;

/// The memory that an input may hold at a time, in bytes.
const MOST_HELD: u64 = 32 << 20;

/// The time that an input may take before the campaign is aborted.
const LONGEST: Duration = Duration::from_secs(20);

/// The results of a campaign's inputs so far.
#[derive(Default)]
struct Tally {
    inputs: u64,
    bytes: u64,
    finds: u64,
    slowest: (Duration, u64),
    largest: (u64, u64),
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize| {
        arguments
            .get(place)
            .and_then(|text| text.parse::<u64>().ok())
    };
    let (Some(target), Some(count)) = (arguments.first(), number(1)) else {
        return refuse("campaign TARGET COUNT [FIRST]");
    };
    let first = number(2).unwrap_or(0);
    if !["run", "saved", "growth", "snapshot", "circle"].contains(&target.as_str()) {
        return refuse("the targets are run, saved, growth, snapshot and circle");
    }
    let current = watched();
    let start = Instant::now();
    let mut tally = Tally::default();
    for number in first..first.saturating_add(count) {
        current.store(number + 1, Ordering::Relaxed);
        input(target, number, &mut tally);
        if count >= 100 && tally.inputs.is_multiple_of(count / 20) {
            tally.say(target, start);
        }
    }
    tally.say(target, start);
    if tally.finds == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn refuse(message: impl Display) -> ExitCode {
    eprintln!("{message}");
    ExitCode::from(2)
}

/// Returns the number of the current input, plus one. A process that stays too long with one input
/// is ended.
fn watched() -> Arc<AtomicU64> {
    let current = Arc::new(AtomicU64::new(0));
    let watched = Arc::clone(&current);
    std::thread::spawn(move || {
        let (mut seen, mut since) = (0, Instant::now());
        loop {
            std::thread::sleep(Duration::from_millis(500));
            let now = watched.load(Ordering::Relaxed);
            if now != seen {
                (seen, since) = (now, Instant::now());
            } else if now > 0 && since.elapsed() > LONGEST {
                eprintln!("input {} does not end", now - 1);
                std::process::exit(1);
            }
        }
    });
    current
}

fn input(target: &str, number: u64, tally: &mut Tally) {
    let mut choices = Choices::limited(number, DECISIONS >> (number / WAYS % 4));
    let profile = if target == "growth" {
        &Profile::GROWING
    } else {
        &Profile::HOSTILE
    };
    let text = if target == "circle" {
        String::new()
    } else {
        program(profile, &mut choices)
    };
    let way = usize::try_from(number % WAYS).expect("a small number");
    let start = Instant::now();
    let mut went_well = true;
    let held = allocation_counter::measure(|| {
        let check = || match target {
            "run" => check_run(Files::new(&text), way),
            "saved" => check_saved(Files::new(&text), way),
            "growth" => check_growth(Files::new(&text), way),
            "snapshot" => check_snapshot(Files::new(&text), &mut Choices::of_seed(!number)),
            _ => check_circle(&mut choices),
        };
        went_well = catch_unwind(AssertUnwindSafe(check)).is_ok();
    });
    let took = start.elapsed();
    if !went_well || held.bytes_max > MOST_HELD {
        tally.finds += 1;
        eprintln!("input {number} held {} bytes:\n{text}\n", held.bytes_max);
    }
    tally.inputs += 1;
    tally.bytes += u64::try_from(text.len()).expect("a small number");
    tally.slowest = tally.slowest.max((took, number));
    tally.largest = tally.largest.max((held.bytes_max, number));
}

impl Tally {
    fn say(&self, target: &str, start: Instant) {
        let (slowest, slow) = self.slowest;
        let (largest, large) = self.largest;
        println!(
            "{target}: {} inputs, {} MB, {} finds, {:.0} s; slowest {:.1} ms (input {slow}), most held {} KB (input {large})",
            self.inputs,
            self.bytes / 1_000_000,
            self.finds,
            start.elapsed().as_secs_f64(),
            slowest.as_secs_f64() * 1e3,
            largest / 1000,
        );
    }
}
