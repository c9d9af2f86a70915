//! R5.2: velocity, acceleration and jerk of each axis in every cycle.

use proptest::prelude::*;

use super::{MACHINE, assert_limits, trace};

const AXES: [&str; 4] = ["X", "Y", "Z", "C"];

/// Seconds of the fastest motion over a length between two rests, in closed form.
fn shortest(length: f64, velocity: f64, acceleration: f64, jerk: f64) -> f64 {
    // The acceleration is reached if a²/j fits into the velocity.
    let ramp = |peak: f64| {
        if peak * jerk <= acceleration * acceleration {
            2.0 * (peak / jerk).sqrt()
        } else {
            peak / acceleration + acceleration / jerk
        }
    };
    if velocity * ramp(velocity) <= length {
        return length / velocity + ramp(velocity);
    }
    // Without the full acceleration: L = 2·p·sqrt(p/j).
    let short = (length * length * jerk / 4.0).cbrt();
    if short * jerk <= acceleration * acceleration {
        return 2.0 * ramp(short);
    }
    // With it: p²/a + p·a/j = L.
    let lead = acceleration * acceleration / jerk;
    let peak = (lead * lead / 4.0 + length * acceleration).sqrt() - lead / 2.0;
    2.0 * ramp(peak)
}

#[test]
fn single_straight_moves_take_the_shortest_time() {
    // R5.1 R5.2: X has 200 mm/s, 2000 mm/s², 50 000 mm/s³; 1 % and the rounding up to a cycle.
    for (length, feed) in [
        (0.05, 12000.0),
        (1.0, 12000.0),
        (20.0, 12000.0),
        (500.0, 12000.0),
        (500.0, 600.0),
        (3.0, 60.0),
    ] {
        let program = format!("G01 X0 F{feed}\nX{length}\nM30");
        let found = trace(&program, &["X"]).seconds();
        let expected = shortest(length, (feed / 60.0_f64).min(200.0), 2000.0, 50_000.0);
        assert!(
            found >= expected * (1.0 - 1e-9) && found <= expected * 1.01 + 0.0011,
            "{length} mm at F{feed} take {found} s, not {expected} s"
        );
    }
}

#[test]
fn rapid_motions_go_as_fast_as_one_of_the_axes_can() {
    // R5.1: Z has half the velocity of X, both cover the same distance.
    let trace = trace("G00 X0 Z0\nX400 Z-400\nM30", &["X", "Z"]);
    assert!((trace.top_speed(1) - 100.0).abs() < 1e-9);
    assert!((trace.top_speed(0) - 100.0).abs() < 1e-9);
    assert_limits(MACHINE, &["X", "Z"], &trace);
}

#[test]
fn a_line_in_many_blocks_takes_the_time_of_one() {
    // R5.2: full look-ahead over any number of blocks, also beyond the queue.
    let whole = trace("G01 X0 Y0 F9000\nX300 Y150\nM30", &["X", "Y"]).seconds();
    let blocks = (1..=30_000).map(f64::from);
    let blocks: Vec<String> = blocks
        .map(|block| format!("X{:.2} Y{:.3}", block * 0.01, block * 0.005))
        .collect();
    let program = format!("G01 X0 Y0 F9000\n{}", blocks.join("\n"));
    let pieces = trace(&program, &["X", "Y"]);
    assert!(
        pieces.seconds() <= whole * 1.01,
        "{} of {whole}",
        pieces.seconds()
    );
    assert_eq!(pieces.end(), [300.0, 150.0]);
    assert_limits(MACHINE, &["X", "Y"], &pieces);
}

#[test]
fn a_queue_full_of_short_blocks_keeps_the_limits() {
    // R5.2: a circle in 12 000 chords; 10 mm in blocks of half a micrometre, too short to reach
    // the feed within half of the queue.
    let turns = (0..=12_000).map(|chord| f64::from(chord) * std::f64::consts::TAU / 12_000.0);
    let chords: Vec<String> = turns
        .map(|angle| format!("X{:.5} Y{:.5}", 20.0 * angle.cos(), 20.0 * angle.sin()))
        .collect();
    let circle = trace(
        &format!("G01 F1200\n{}\nM30", chords.join("\n")),
        &["X", "Y"],
    );
    assert_limits(MACHINE, &["X", "Y"], &circle);
    assert_eq!(
        (circle.begins.len(), circle.end()),
        (1, [20.0, 0.0].as_slice())
    );
    let steps: Vec<String> = (0..=20_000)
        .map(|step| format!("X{:.4}", f64::from(step) * 0.0005))
        .collect();
    let line = trace(&format!("G01 F12000\n{}\nM30", steps.join("\n")), &["X"]);
    assert_limits(MACHINE, &["X"], &line);
    assert_eq!(line.end(), [10.0]);
    let shortest = shortest(10.0, 200.0, 2000.0, 50_000.0);
    assert!(
        line.seconds() < 2.0 * shortest,
        "{} of {shortest}",
        line.seconds()
    );
}

#[test]
fn corners_stop_the_path_and_bends_slow_it_down() {
    // R5.2
    let slowest = |second: &str| {
        let program = format!("G01 X0 Y0 F3000\nX50\n{second}\nM30");
        let trace = trace(&program, &["X", "Y"]);
        assert_limits(MACHINE, &["X", "Y"], &trace);
        let speeds = trace.velocities.iter().map(|v| v[0].hypot(v[1]));
        let inner = speeds.skip(100).take(trace.positions.len() - 200);
        inner.fold(f64::INFINITY, f64::min)
    };
    assert!(slowest("Y50") < 0.5, "a square corner");
    assert!(slowest("X0") < 0.5, "a reversal");
    assert!(
        slowest("X100 Y1") > 0.5 && slowest("X100 Y1") < 50.0,
        "1.1°"
    );
    assert!((slowest("X100") - 50.0).abs() < 1e-9, "straight on");
    assert!(slowest("G04 0.1\nX100") < 1e-9, "a dwell");
    assert!(
        slowest("G60 X60\nX100") < 0.5,
        "an exact stop after the next block"
    );
}

#[test]
fn an_exact_stop_is_made_where_it_is_asked_for() {
    // R5.2: G60 for its block, G360 until G359.
    let at = |program: &str, x: f64| {
        let trace = trace(program, &["X"]);
        let near = trace
            .positions
            .iter()
            .position(|cycle| cycle[0] >= x - 1e-9);
        trace.velocities[near.expect("reached")][0]
    };
    assert!(at("G01 X0 F3000\nG60 X20\nX40\nM30", 20.0) < 0.1);
    assert!(at("G01 X0 F3000\nG60 X20\nX40\nX60\nM30", 40.0) > 49.0);
    assert!(at("G01 X0 F3000\nG360\nX20\nX40\nG359\nX60\nX80\nM30", 40.0) < 0.1);
    assert!(at("G01 X0 F3000\nG360\nX20\nG359 X40\nX60\nX80\nM30", 40.0) > 49.0);
}

/// Returns a block of a random program.
fn block() -> impl Strategy<Value = String> {
    let word = (-200_i32..200).prop_map(|value| f64::from(value) / 10.0);
    let step = (-40_i32..40).prop_map(|value| f64::from(value) / 100.0);
    prop_oneof![
        3 => (word.clone(), word.clone(), 60_u32..12000)
            .prop_map(|(x, y, f)| format!("G01 G90 X{x} Y{y} F{f}")),
        4 => (step.clone(), step.clone(), step.clone())
            .prop_map(|(x, y, z)| format!("G01 G91 X{x} Y{y} Z{z}")),
        // A little to the side of where the last one led.
        6 => (1_u32..50, -5_i32..5).prop_map(|(x, y)| format!(
            "G01 G91 X{} Y{}", f64::from(x) / 10.0, f64::from(y) / 1000.0)),
        2 => (word.clone(), word.clone(), 1_u32..30)
            .prop_map(|(x, y, turn)| format!("G0{} G90 I{x} J{y}", 2 + turn % 2)),
        2 => (1_u32..200, 0_u32..2).prop_map(|(r, turn)| {
            let r = f64::from(r) / 10.0;
            format!("G0{} G91 X{r} Y{r} R{}", 2 + turn, r * 1.2)
        }),
        1 => (1_u32..100, word.clone())
            .prop_map(|(i, z)| format!("G02 G91 I{} Z{z}", f64::from(i) / 10.0)),
        1 => (word.clone(), word.clone()).prop_map(|(x, c)| format!("G00 G90 X{x} C{c}")),
        1 => word.clone().prop_map(|c| format!("G01 G90 C{c} F3000")),
        1 => Just("G04 0.01".to_owned()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn every_cycle_keeps_the_limits_of_all_axes(blocks in prop::collection::vec(block(), 1..60)) {
        // R5.2 R5.3
        let program = format!("G01 X0 Y0 Z0 C0 F6000\n{}\nM30", blocks.join("\n"));
        let trace = trace(&program, &AXES);
        prop_assume!(!trace.positions.is_empty());
        assert_limits(MACHINE, &AXES, &trace);
    }
}
