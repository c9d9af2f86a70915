//! Time of a circle and of a tuning, its ratio to as many exponentials, and the goal.
//!
//! `cargo bench --bench circle`. The exponential is what the friction cannot do without: a step of
//! one axis needs two.

#![allow(clippy::print_stdout)] // The table is what it is for.

use std::hint::black_box;
use std::process::{Command, Stdio};
use std::time::Duration;

use frictcomp_physics::circle::{Circle, CircularTest, LapRun, Method};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::{FrictionModel, Preset};
use frictcomp_testing::measure::Bench;

const TOOL: &str = env!("CARGO_BIN_EXE_frictcomp");

/// Computes a number of exponentials, one after the other.
fn exponentials(count: u32) {
    let mut sum = 0.0;
    for number in 0..count {
        sum += (-f64::from(number) * 1e-6).exp();
    }
    black_box(sum);
}

fn row(name: &str, took: Duration, base: Duration, goal: Duration) {
    let ratio = took.as_secs_f64() / base.as_secs_f64();
    let verdict = if took <= goal { "met" } else { "missed" };
    println!(
        "{name:<44}{:>9.1} ms{ratio:>8.1} x   goal {:>6.0} ms  {verdict}",
        took.as_secs_f64() * 1e3,
        goal.as_secs_f64() * 1e3
    );
}

fn main() {
    let bench = Bench::new(7);
    let plant = Preset::Stiff.plant();
    let test = CircularTest {
        circle: Circle {
            feed_mm_per_min: 2000.0,
            ..Circle::default()
        },
        compensation: Method::of_plant(&plant),
        plant,
        model: FrictionModel::Lugre,
        reading: Reading::default(),
    };
    let base = bench.fastest(|| exponentials(1_809_557));
    println!(
        "{:<44}{:>9.1} ms",
        "2 exponentials a step and axis",
        base.as_secs_f64() * 1e3
    );
    let circle = bench.fastest(|| {
        black_box(test.run(LapRun::ALL[2])).expect("a circle");
    });
    row(
        "circle, 2 m/min, R 100 mm, 1.5 turns",
        circle,
        base,
        Duration::from_millis(60),
    );
    let tune = |options: &[&str]| {
        bench.fastest(|| {
            let status = Command::new(TOOL)
                .args(["tune", "--feeds", "500,1000,2000,5000"])
                .args(options)
                .stdout(Stdio::null())
                .status();
            assert!(status.is_ok_and(|status| status.success()));
        })
    };
    row(
        "tune, four feeds, all cores, no shaping",
        tune(&["--no-shaping"]),
        base,
        Duration::from_secs(5),
    );
    row(
        "tune, four feeds, all cores, shaped",
        tune(&[]),
        base,
        Duration::from_secs(10),
    );
}
