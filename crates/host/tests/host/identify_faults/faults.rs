//! Faults of recordings × the messages about them (R6.21). The table is in docs/identification.md;
//! `UPDATE_DOCS=1` writes it again.

use std::fmt::Write as _;

use frictcomp::diagnostic::Code;
use frictcomp_recordings::identify::Track;

use super::{DOUBTS, both, found, said, velocities};
use frictcomp_testing::table::agrees;

/// A fault that is put into a recording.
type Fault = fn(&mut Track);

/// The fault, how it is put into the recording, and the code that has to come first.
const FAULTS: [(&str, Fault, Option<Code>); 13] = [
    ("none", |_| (), None),
    (
        "torque clipped at the friction of the third fastest speed",
        clip,
        Some(Code::Fc520),
    ),
    (
        "torque of one direction at a limit, with noise",
        limit_one_way,
        Some(Code::Fc520),
    ),
    (
        "output of a loop that is compensated to 90 %",
        |it| compensate(it, 0.9),
        Some(Code::Fc521),
    ),
    (
        "output of a loop that is compensated to 130 %",
        |it| compensate(it, 1.3),
        Some(Code::Fc521),
    ),
    (
        "torque inverted",
        |it| each(&mut it.torques, |it| -it),
        Some(Code::Fc522),
    ),
    (
        "velocity inverted",
        |it| each(velocities(it), |it| -it),
        Some(Code::Fc522),
    ),
    ("torque late by half a second", delay, Some(Code::Fc522)),
    (
        "absolute values of the torque",
        |it| each(&mut it.torques, f64::abs),
        Some(Code::Fc523),
    ),
    (
        "absolute values of the velocity",
        |it| each(velocities(it), f64::abs),
        Some(Code::Fc523),
    ),
    (
        "torque ten times as large",
        |it| each(&mut it.torques, |it| it * 10.0),
        Some(Code::Fc524),
    ),
    ("half a second missing", drop_rows, Some(Code::Fc525)),
    (
        "torque that stands still at the end",
        hold,
        Some(Code::Fc525),
    ),
];

fn each(values: &mut [f64], change: fn(f64) -> f64) {
    for value in values {
        *value = change(*value);
    }
}

fn clip(track: &mut Track) {
    let pairs = found(track).expect("friction").pairs;
    let limit = pairs[pairs.len() - 3].friction.round();
    for torque in &mut track.torques {
        *torque = torque.clamp(-limit, limit);
    }
}

fn limit_one_way(track: &mut Track) {
    let pairs = found(track).expect("friction").pairs;
    let least = pairs.iter().map(|it| it.friction);
    let limit = 0.95 * least.fold(f64::INFINITY, f64::min);
    for (torque, noise) in track
        .torques
        .iter_mut()
        .zip([0.4, -0.3, 0.1, -0.2].iter().cycle())
    {
        *torque = torque.min(limit) + noise;
    }
}

fn delay(track: &mut Track) {
    let samples = (0.5 / track.step_s).round() as usize;
    track.torques.rotate_right(samples);
}

fn hold(track: &mut Track) {
    let last = track.torques.len() * 4 / 5;
    let value = track.torques[last];
    track.torques[last..].fill(value);
}

fn compensate(track: &mut Track, part: f64) {
    let curve = found(track).expect("a curve").curve;
    let speeds = velocities(track).clone();
    for (torque, speed) in track.torques.iter_mut().zip(&speeds) {
        if *speed != 0.0 {
            *torque -= part * curve.at(speed.abs() / 1000.0) * speed.signum();
        }
    }
}

fn drop_rows(track: &mut Track) {
    let rows = 3000..3500;
    track.times_s.drain(rows.clone());
    track.torques.drain(rows.clone());
    for column in [&mut track.velocities, &mut track.positions]
        .into_iter()
        .flatten()
    {
        column.drain(rows.clone());
    }
}

#[test]
fn every_fault_is_named_first_and_the_document_says_so() {
    // R6.21
    let mut table = String::from("| fault | demo recording | simulation |\n|---|---|---|\n");
    for (name, fault, wanted) in FAULTS {
        let cells = both().map(|(recording, mut track)| {
            fault(&mut track);
            let result = found(&track);
            let first = said(&result).map(|(code, _)| code);
            let first = first.filter(|code| DOUBTS.contains(code));
            assert_eq!(first, wanted, "{name}, {recording}");
            let code = first.map_or("nothing", Code::as_str);
            let list = if result.is_ok() { "a list" } else { "no list" };
            format!("{code}, {list}")
        });
        let _ = writeln!(table, "| {name} | {} |", cells.join(" | "));
    }
    agrees("identification.md", "faults", &table);
}
