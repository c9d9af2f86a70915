//! The whole loop on machines whose parameters no command sees: plan, recordings, `run`, tuned lists, acceptance.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use frictcomp_host::{Watch, tune};
use frictcomp_physics::simulation::DriveParameters;
use serde_json::Value;

use super::fitted::{list, lists, program};
use super::{Driven, Recorder, circles_of, deviations_of, driven, planned_with, put};
use crate::folder::{document, succeeded};
use frictcomp_testing::{PITCH_MM, PresetMachine};

const RADIUS_MM: f64 = 100.0;

const FEEDS: [f64; 6] = [500.0, 800.0, 1300.0, 2000.0, 3200.0, 5000.0];

/// Feeds at which the lists are judged, including some between the recorded ones.
const JUDGED: [f64; 11] = [
    500.0, 630.0, 800.0, 1000.0, 1300.0, 1600.0, 2000.0, 2500.0, 3200.0, 4000.0, 5000.0,
];

/// About X50 Y0.
const PLAN: [&str; 11] = [
    "commission",
    "plan",
    "--axis",
    "X,Y",
    "--travel",
    "X-100..200,Y-150..150",
    "--feeds",
    "500,800,1300,2000,3200,5000",
    "--radius",
    "100",
    "--into",
];

/// R16.2, R16.3, R16.9: on a machine of the tests the lists of the loop are accepted, and leave at most 1.35 times
/// as much as lists tuned with knowledge of the machine.
#[allow(clippy::print_stdout, reason = "the figures are what it is for")]
fn comes_close_to_the_best_known_lists(name: &str) {
    let mut machines = PresetMachine::all().into_iter();
    let machine = machines.find(|it| it.name == name).expect("a machine");
    let folder = planned_with(&PLAN);
    let folder = folder.path();
    let [provisional, tuned] = looped(folder, &machine);
    let off = machine.left_um(&JUDGED, [None, None]);
    let [before, after] = [&provisional, &tuned].map(|names| {
        let on = names.each_ref().map(|name| list(&folder.join(name)));
        machine.left_um(&JUDGED, on.each_ref().map(Some))
    });
    let best = best_known(&machine);
    let ratios = [after[0] / best[0], after[1] / best[1]];
    println!(
        "{name}: X, Y off {off:.2?}, provisional {before:.2?}, loop {after:.2?}, best known {best:.2?}, ratio {ratios:.2?}"
    );
    assert!(ratios.iter().all(|it| *it <= 1.35), "{ratios:?}");
}

#[test]
#[ignore = "minutes"]
fn a_stiff_machine() {
    comes_close_to_the_best_known_lists("stiff");
}

#[test]
#[ignore = "minutes"]
fn a_machine_of_middle_stiffness() {
    comes_close_to_the_best_known_lists("mid");
}

#[test]
#[ignore = "minutes"]
fn a_soft_machine() {
    comes_close_to_the_best_known_lists("soft");
}

#[test]
#[ignore = "minutes"]
fn a_machine_whose_directions_differ() {
    comes_close_to_the_best_known_lists("uneven");
}

#[test]
#[ignore = "minutes"]
fn a_noisy_machine() {
    comes_close_to_the_best_known_lists("noisy");
}

#[test]
#[ignore = "minutes"]
fn a_machine_half_as_stiff_as_its_plant() {
    comes_close_to_the_best_known_lists("half");
}

#[test]
#[ignore = "minutes"]
fn a_machine_twice_as_stiff_as_its_plant() {
    comes_close_to_the_best_known_lists("double");
}

/// Returns the provisional lists and those that were tuned and accepted.
#[allow(clippy::print_stdout, reason = "the figures are what it is for")]
fn looped(folder: &Path, machine: &PresetMachine) -> [[PathBuf; 2]; 2] {
    for (axis, drive) in [&machine.plant.x, &machine.plant.y].into_iter().enumerate() {
        let text = friction_of(folder, axis, drive);
        put(folder, &format!("friction-{axis}.csv"), &text);
    }
    let reference = machine.reference.as_str();
    commission(folder, &["run", "m"]);
    let provisional = lists(folder, "provisional");
    plan(folder, &provisional);
    record(folder, (1, machine), None);
    record(folder, (2, machine), Some(&provisional));
    let found = commission(folder, &["run", "m", "--plant", reference]);
    println!(
        "{}: {}",
        machine.name,
        told_plant(&found["plants"][0], machine)
    );
    let tuned = lists(folder, "tuned");
    plan(folder, &tuned);
    record(folder, (3, machine), Some(&tuned));
    let found = commission(folder, &["run", "m", "--plant", reference]);
    let last = &found["rounds"][1];
    assert_eq!(last["against"], Value::Array(Vec::new()), "{last}");
    [provisional, tuned]
}

/// Returns the contact, Kp and Fc of X relative to the true ones, with their ranges; the delay in ms.
fn told_plant(found: &Value, machine: &PresetMachine) -> String {
    let axis = &found["predicted_axes"][0];
    let own = &machine.plant.x;
    let part = |key: &str, own: f64| {
        let [value, low, high] =
            ["value", "low", "high"].map(|end| axis[key][end].as_f64().expect("a number") / own);
        format!("{key} {value:.2} ({low:.2} to {high:.2})")
    };
    [
        part("contact", own.friction.stiffness_n_per_m),
        part("speed_gain", own.speed_gain_n_s_per_m),
        part("coulomb", own.friction.coulomb_n),
        part("damping", own.friction.damping_n_s_per_m),
        part("delay", 1e-3),
    ]
    .join(", ")
}

/// Returns the record that a call of `frictcomp commission` prints; a plan prints none.
fn commission(folder: &Path, arguments: &[&str]) -> Value {
    let all = [&["commission"], arguments, &["--format", "json"]].concat();
    document(folder, &all)
}

fn plan(folder: &Path, lists: &[PathBuf; 2]) {
    let [x, y] = [0, 1].map(|at| format!("{}={}", ["X", "Y"][at], lists[at].display()));
    let arguments = [&PLAN[..], &["m", "--value-list", &x, "--value-list", &y]].concat();
    succeeded(folder, &arguments);
}

/// Records the circles of a round; the friction is a little different each time.
fn record(folder: &Path, (round, machine): (usize, &PresetMachine), lists: Option<&[PathBuf; 2]>) {
    let on = lists.map(|it| it.each_ref().map(|name| list(&folder.join(name))));
    for (at, feed) in FEEDS.into_iter().enumerate() {
        let seed = (10 * round + at) as u64;
        let friction = 0.99 + 0.02 * fastrand::Rng::with_seed(seed).f64();
        let deviations = deviations_of(&Driven {
            plant: machine.plant.with_friction(friction),
            radius: RADIUS_MM,
            feed,
            lists: on.clone(),
        });
        let recorder = Recorder {
            noise_um: machine.noise_um,
            screw_um: machine.screw_um,
            seed,
        };
        let program = program(folder, feed, round);
        let text = circles_of(folder, (&program, RADIUS_MM), (&deviations, recorder));
        put(folder, &format!("{feed}-in-{round}.csv"), &text);
    }
}

/// Returns a recording of the constant speeds of an axis: friction, the torque for the mass, ripple over the pitch and
/// noise.
fn friction_of(folder: &Path, axis: usize, drive: &DriveParameters) -> String {
    const NOISE_N: f64 = 20.0;
    const RIPPLE_N: f64 = 20.0;
    let program = ["m/01-friction-X.nc", "m/02-friction-Y.nc"][axis];
    let rows = driven(folder, program);
    let mut random = fastrand::Rng::with_seed(axis as u64 + 1);
    let mut text = String::from("t,v,x,torque\n");
    let mut before = 0.0;
    for (at, row) in rows.iter().enumerate() {
        let [place, speed] = [row[axis], row[axis + 2]];
        let acceleration = speed - before;
        before = speed;
        let noise: f64 = (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
        let force = drive.friction.steady_n(speed / 1000.0)
            + drive.mass_kg * acceleration
            + RIPPLE_N * (std::f64::consts::TAU * place / PITCH_MM).sin()
            + NOISE_N * noise;
        writeln!(
            text,
            "{:.3},{:.0},{:.0},{:.0}",
            at as f64 / 1000.0,
            speed * 1000.0,
            place * 1e4,
            force / drive.force_per_unit_n
        )
        .expect("text");
    }
    text
}

/// Returns the glitches left by lists tuned with knowledge of the machine: three searches of up to 3600 lists.
fn best_known(machine: &PresetMachine) -> [f64; 2] {
    let tuned = tune(&machine.task(&FEEDS), &Watch::default()).expect("circles");
    let lists = tuned.axes.each_ref().map(|it| it.list());
    machine.left_um(&JUDGED, lists)
}
