//! Faults of machines in recorded circles, and the findings on each (R5.28): alone, in pairs, with
//! noise. The table is in docs/circular-test.md; `UPDATE_DOCS=1` writes it again.

mod confusion;

use std::f64::consts::TAU;
use std::fmt::Write as _;

use frictcomp_testing::table::agrees;

use crate::recorder::{Noise, Recorder, backlash, friction};
use frictcomp_physics::circle::{
    CommandedCircle, Direction, Figures, Finding, PathCentre, RecordedCircle, Recording, diagnose,
};

const RADIUS: f64 = 50.0;

const FEED: f64 = 2000.0;

type Deviation = fn(Direction, f64) -> f64;

/// Returns the time in s since the axis was at X+.
fn time(direction: Direction, angle: f64) -> f64 {
    (direction.sign() * angle).rem_euclid(TAU) * RADIUS / (FEED / 60.0)
}

/// Degrees since the last crossing.
fn after(direction: Direction, angle: f64) -> f64 {
    (direction.sign() * angle)
        .rem_euclid(TAU / 4.0)
        .to_degrees()
}

const NOTHING: (&str, Deviation, &[Finding]) = ("nothing", |_, _| 0.0, &[]);

/// Faults with their expected findings.
const FAULTS: [(&str, Deviation, &[Finding]); 11] = [
    (
        "backlash of 8 and 2 µm",
        |direction, angle| backlash([8.0, 2.0], direction, angle),
        &[Finding::Backlash],
    ),
    (
        "friction, 10 µm",
        |direction, angle| friction(10.0, 2.0, direction, angle),
        &[Finding::Friction],
    ),
    (
        "screw of X, ±4 µm every 10 mm",
        |_, angle| 4.0 * angle.cos() * (TAU * RADIUS * angle.cos() / 10.0 + 0.7).sin(),
        &[Finding::Periodic],
    ),
    (
        "position loops differ, 6 µm",
        |direction, angle| 3.0 * direction.sign() * (2.0 * angle).sin(),
        &[Finding::GainMismatch],
    ),
    (
        "axes not square, 6 µm",
        |_, angle| 3.0 * (2.0 * angle).sin(),
        &[Finding::Squareness],
    ),
    (
        "vibration, ±2 µm at 23 Hz",
        |direction, angle| 2.0 * (TAU * 23.0 * time(direction, angle)).sin(),
        &[Finding::Vibration],
    ),
    (
        "stick-slip, 8 µm",
        |direction, angle| {
            let after = after(direction, angle);
            8.0 * (-after / 5.0).exp() * (TAU * after / 2.5).cos()
        },
        &[Finding::StickSlip],
    ),
    (
        "lateral play of X, 6 µm",
        |direction, angle| 3.0 * direction.sign() * angle.cos().abs(),
        &[Finding::LateralPlay],
    ),
    (
        "drift of X, 6 µm a turn",
        |direction, angle| {
            6.0 * time(direction, angle) / (TAU * RADIUS / (FEED / 60.0)) * angle.cos()
        },
        &[Finding::OtherShape],
    ),
    (
        "screw of Y, ±4 µm every 40 mm",
        |_, angle| 4.0 * angle.sin() * (TAU * RADIUS * angle.sin() / 40.0 + 0.7).sin(),
        &[Finding::Periodic],
    ),
    (
        "vibration of X, ±2 µm at 180 Hz",
        |direction, angle| 2.0 * angle.cos() * (TAU * 180.0 * time(direction, angle)).sin(),
        &[Finding::Vibration],
    ),
];

/// The recording of each direction.
#[derive(Clone, Copy)]
struct Turns {
    count: f64,
    /// The shift of X from turn to turn.
    drift_um: f64,
}

const ONE_TURN: Turns = Turns {
    count: 1.05,
    drift_um: 0.0,
};
const TWO_TURNS: Turns = Turns {
    count: 2.05,
    drift_um: 0.0,
};
const SHIFTING: Turns = Turns {
    drift_um: 6.0,
    ..TWO_TURNS
};

/// Faults that occur together.
const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (2, 3), (0, 5), (1, 3), (0, 7)];

/// Standard deviations of white noise in µm.
const NOISES: [f64; 3] = [0.0, 0.3, 1.0];

/// Returns the figures of both directions with some faults and noise.
fn figures(faults: &[Deviation], noise_um: f64, turns: Turns) -> Figures {
    let deviation = |direction: Direction, angle: f64| {
        faults.iter().map(|it| it(direction, angle)).sum::<f64>()
    };
    let recorder = Recorder {
        feed: FEED,
        noise: Noise::of_um(noise_um * 3.0_f64.sqrt()),
        drift_um: [turns.drift_um, 0.0],
        ..Recorder::new(RADIUS)
    };
    let trace = recorder
        .turns(Direction::Ccw, turns.count, &deviation)
        .standstill(0.3)
        .turns(Direction::Cw, turns.count, &deviation)
        .trace();
    let circles = RecordedCircle::find(&trace, None).expect("circles");
    let recording = Recording::new(circles, CommandedCircle::default(), PathCentre::Common);
    recording.expect("both directions").side.figures
}

/// Returns the findings, each once.
fn said(faults: &[Deviation], noise_um: f64, turns: Turns) -> Vec<Finding> {
    let figures = figures(faults, noise_um, turns);
    let mut found: Vec<Finding> = diagnose(&figures, None)
        .iter()
        .map(|it| it.finding)
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns the findings as JSON names them.
fn names(findings: &[Finding]) -> String {
    let name = |it: &Finding| serde_json::to_value(it).expect("a name");
    let named = findings.iter().map(name);
    let named: Vec<String> = named
        .map(|it| it.as_str().expect("a name").to_owned())
        .collect();
    if named.is_empty() {
        return "–".to_owned();
    }
    named.join(", ")
}

/// A row of the table: the faults, the expected and the actual findings.
struct Row {
    name: String,
    turns: Turns,
    faults: Vec<Deviation>,
    wanted: Vec<Finding>,
}

fn rows() -> Vec<Row> {
    let alone = std::iter::once(NOTHING).chain(FAULTS);
    let mut rows: Vec<Row> = alone
        .map(|(name, fault, wanted)| Row {
            name: name.to_owned(),
            turns: ONE_TURN,
            faults: vec![fault],
            wanted: wanted.to_vec(),
        })
        .collect();
    for (one, other) in PAIRS {
        let [one, other] = [FAULTS[one], FAULTS[other]];
        let mut wanted = [one.2, other.2].concat();
        wanted.sort_unstable();
        wanted.dedup();
        rows.push(Row {
            name: format!("{}; {}", one.0, other.0),
            turns: ONE_TURN,
            faults: vec![one.1, other.1],
            wanted,
        });
    }
    let over_two_turns = std::iter::once(NOTHING).chain(FAULTS[..5].iter().copied());
    rows.extend(over_two_turns.map(|(name, fault, wanted)| {
        let mut wanted = [wanted, &[Finding::Drift]].concat();
        wanted.sort_unstable();
        Row {
            name: format!("two turns, X shifts by 6 µm a turn; {name}"),
            turns: SHIFTING,
            faults: vec![fault],
            wanted,
        }
    }));
    rows
}

#[test]
fn two_turns_without_a_shift_show_none() {
    // R5.28
    for (name, fault, _) in std::iter::once(NOTHING).chain(FAULTS) {
        for noise in NOISES {
            let said = said(&[fault], noise, TWO_TURNS);
            assert!(
                !said.contains(&Finding::Drift),
                "{name}, {noise} µm: {said:?}"
            );
        }
    }
}

#[test]
fn noise_that_swings_everywhere_is_no_stick_slip() {
    // R5.28: noise whose neighbouring samples are alike, as after a slow loop, by sines of no common period.
    let swinging: Deviation = |direction, angle| {
        let time = time(direction, angle);
        let sines = (0..40).map(|at| {
            let hertz = 3.0 + 1.37 * f64::from(at);
            (TAU * hertz * time + f64::from(at * at)).sin()
        });
        0.12 * sines.sum::<f64>()
    };
    for (name, fault, _) in [NOTHING, FAULTS[0], FAULTS[3]] {
        let said = said(&[fault, swinging], 0.1, ONE_TURN);
        assert!(!said.contains(&Finding::StickSlip), "{name}: {said:?}");
    }
}

#[test]
fn the_shift_is_as_large_as_it_was_made() {
    // R5.28
    let figures = figures(&[FAULTS[0].1], 0.3, SHIFTING);
    let found = diagnose(&figures, None);
    let drift = found.iter().find(|it| it.finding == Finding::Drift);
    let drift = drift.expect("a shift");
    let error = drift.grounds.error_um.expect("its error");
    assert!(
        (drift.size_um - 6.0).abs() < 4.0 * error.max(0.01),
        "{drift:?}"
    );
    assert!(error < 0.2, "{drift:?}");
}

#[test]
fn every_fault_is_named_and_no_other_and_the_document_says_so() {
    // R5.28
    let mut table = String::from(
        "| fault | without noise | 0.3 µm of noise | 1 µm of noise |\n|---|---|---|---|\n",
    );
    let mut wrong = Vec::new();
    for row in rows() {
        let said = NOISES.map(|noise| said(&row.faults, noise, row.turns));
        wrong.extend(
            said.iter()
                .zip(NOISES)
                .filter(|(said, _)| **said != row.wanted)
                .map(|(said, noise)| format!("{}, {noise} µm: {said:?}", row.name)),
        );
        let cells = said.map(|said| names(&said)).join(" | ");
        let _ = writeln!(table, "| {} | {cells} |", row.name);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    agrees("circular-test.md", "diagnosis", &table);
}
