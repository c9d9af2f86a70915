//! R5.1 and R5.3: the forms of lines, arcs and dwells.

use super::{CYCLE, MACHINE, Trace, assert_limits, trace};

/// A nanometre, in mm.
const NANOMETRE: f64 = 1e-6;

/// Asserts that two columns stay on a circle to better than a nanometre.
fn assert_on_circle(trace: &Trace, cycles: std::ops::Range<usize>, centre: [f64; 2], radius: f64) {
    for cycle in &trace.positions[cycles] {
        let distance = (cycle[0] - centre[0]).hypot(cycle[1] - centre[1]);
        assert!((distance - radius).abs() < NANOMETRE, "{cycle:?}");
    }
}

/// Returns the cycles of the block on a line.
fn block(trace: &Trace, line: u32) -> std::ops::Range<usize> {
    let first = trace.lines.iter().position(|of| *of == line);
    let last = trace.lines.iter().rposition(|of| *of == line);
    first.expect("the block")..last.expect("the block") + 1
}

/// Returns the distance that the axes cover.
fn way(trace: &Trace) -> f64 {
    let steps = trace.positions.windows(2).map(|pair| {
        let squares = pair[0].iter().zip(&pair[1]).map(|(a, b)| (b - a) * (b - a));
        squares.sum::<f64>().sqrt()
    });
    steps.sum()
}

#[test]
fn full_circles_stay_on_the_arc_and_keep_the_feed() {
    // R5.3
    let axes = ["X", "Y"];
    let trace = trace("G01 X0 Y0 F600\nX100\nG03 I-100 F2000\nM30", &axes);
    let circle = block(&trace, 3);
    assert_on_circle(&trace, circle.clone(), [0.0, 0.0], 100.0);
    let middle = circle.start + 300..circle.end - 300;
    for cycle in &trace.velocities[middle] {
        assert!((cycle[0].hypot(cycle[1]) - 2000.0 / 60.0).abs() < 1e-9);
    }
    assert_eq!(trace.end(), [100.0, 0.0]);
    assert_limits(MACHINE, &axes, &trace);
}

#[test]
fn velocities_pass_through_zero_at_the_quadrants() {
    // R5.3: counter-clockwise from X+, X turns only at X-, Y at Y+ and Y-.
    let trace = trace("G01 X49 Y0 F1000\nX50\nG03 I-50\nM30", &["X", "Y"]);
    let circle = block(&trace, 3);
    for (axis, turns) in [(0, 1), (1, 2)] {
        let mut found = 0;
        let mut sign = 0.0;
        for at in circle.clone() {
            let v = trace.velocities[at][axis];
            if v * sign < 0.0 {
                found += 1;
                // It turns where it is farthest out, within the distance of a cycle.
                let other = trace.positions[at][1 - axis];
                assert!(other.abs() < 1000.0 / 60.0 * CYCLE * 1.01, "{other}");
                // The acceleration v²/r brings it through zero.
                assert!(v.abs() < (1000.0_f64 / 60.0).powi(2) / 50.0 * CYCLE * 1.01);
            }
            if v != 0.0 {
                sign = v.signum();
            }
        }
        assert_eq!(found, turns);
    }
}

#[test]
fn arcs_are_given_by_centres_and_by_radii() {
    // R5.1: (program, centre, radius) of arcs from (10, 0) to (0, 10) or around.
    for (program, centre, radius) in [
        ("G03 X0 Y10 I-10 J0", [0.0, 0.0], 10.0),
        ("G03 X0 Y10 I-10", [0.0, 0.0], 10.0),
        ("G161 G03 X0 Y10 I0 J0", [0.0, 0.0], 10.0),
        ("G02 X0 Y10 I0 J10", [10.0, 10.0], 10.0),
        ("G03 X0 Y10 R10", [0.0, 0.0], 10.0),
        ("G02 X0 Y10 R10", [10.0, 10.0], 10.0),
        ("G03 X0 Y10 R-10", [10.0, 10.0], 10.0),
        ("G91 G03 X-10 Y10 I-10", [0.0, 0.0], 10.0),
        ("G92 X5 Y5\nG161 G03 X-5 Y5 I-5 J-5", [0.0, 0.0], 10.0),
        ("G03 R10\nX0 Y10", [0.0, 0.0], 10.0),
        ("G03 X0 Y10 G163=10", [0.0, 0.0], 10.0),
        ("P1=-10\nG163=P1\nG03 X0 Y10", [10.0, 10.0], 10.0),
        ("G70 G03 X0 Y[10/25.4] I[-10/25.4]", [0.0, 0.0], 10.0),
        // A centre slightly off is moved to where both ends allow.
        (
            "G03 X0 Y10 I-10.01",
            [-0.005, -0.005],
            10.005_f64.hypot(0.005),
        ),
    ] {
        let axes = ["X", "Y"];
        let trace = trace(&format!("G01 X0 Y0 F900\nX10\n{program}\nM30"), &axes);
        let last = *trace.lines.last().expect("a trace");
        assert_on_circle(&trace, block(&trace, last), centre, radius);
        let end = trace.end();
        assert!(
            end[0].abs() < 1e-9 && (end[1] - 10.0).abs() < 1e-9,
            "{program}: {end:?}"
        );
        assert_limits(MACHINE, &axes, &trace);
        assert_eq!(trace.said, [("FC906".to_owned(), 1)], "{program}");
    }
}

#[test]
fn planes_and_helices() {
    // R5.1: G18 turns from Z to X, G19 from Y to Z; the third axis moves along.
    let axes = ["X", "Y", "Z"];
    let quarter = std::f64::consts::PI * 5.0;
    for (program, end, length) in [
        ("G18 G03 Z0 X10 K-10 I0", [10.0, 0.0, 0.0], quarter),
        (
            "G17 G03 X-10 Y10 Z14 I-10",
            [-10.0, 10.0, 14.0],
            quarter.hypot(4.0),
        ),
        (
            "G17 G02 I10 Z30",
            [0.0, 0.0, 30.0],
            (4.0 * quarter).hypot(20.0),
        ),
    ] {
        let trace = trace(&format!("G01 X0 Y0 Z0 F1200\nZ10\n{program}\nM30"), &axes);
        assert_eq!(trace.end(), end, "{program}");
        assert_limits(MACHINE, &axes, &trace);
        let found = way(&trace) - 10.0;
        assert!(
            (found - length).abs() < 1e-3 * length,
            "{program}: {found} of {length}"
        );
    }
    let trace = trace(
        "G01 X0 Y0 Z0 F1200\nY10\nG19 G03 Y0 Z10 J-10 K0\nM30",
        &axes,
    );
    assert_eq!(trace.end(), [0.0, 0.0, 10.0]);
}

#[test]
fn no_motion_is_lost() {
    // R5.1: polylines, loops and subprograms; the lengths add up.
    let program = "%L SUB\nG91\nX3 Y4\nG90\nM17\n%MAIN\nG01 X0 Y0 F3000\n$FOR P1 = 1, 20, 1\nLL SUB\n$ENDFOR\nM30";
    let trace = trace(program, &["X", "Y"]);
    assert_eq!(trace.end(), [60.0, 80.0]);
    assert!((way(&trace) - 100.0).abs() < 1e-9);
}

#[test]
fn dwells_and_feeds_of_all_modes() {
    // R5.1
    let seconds = |program: &str| trace(program, &["X"]).seconds();
    let plain = seconds("G01 X0 F1000\nX10\nX0\nM30");
    for dwell in ["G04 0.5", "G04 X0.5", "#TIME 0.5", "P1=0.5\nG04 P1"] {
        let with = seconds(&format!("G01 X0 F1000\nX10\n{dwell}\nX0\nM30"));
        assert!((with - plain - 0.5).abs() < 2.0 * CYCLE, "{dwell}: {with}");
    }
    // G93 gives the seconds of the block; speeding up and slowing down are added.
    let timed = seconds("G01 X0 F1000\nG93 F2 X10\nM30");
    assert!((2.0..2.1).contains(&timed), "{timed}");
    // Axes other than the main ones follow; if they move alone, the feed is theirs.
    let follows = trace("G01 X0 C0 F600\nX10 C1\nM30", &["X", "C"]);
    assert!((follows.top_speed(0) - 10.0).abs() < 1e-9);
    let alone = trace("G01 C0 F600\nC50\nM30", &["C"]);
    assert!((alone.top_speed(0) - 10.0).abs() < 1e-9);
}

#[test]
fn short_blocks_and_blocks_without_a_way() {
    // R5.1: less than a cycle, and nothing at all.
    let trace = trace(
        "G01 X0 F12000\nX0.0001\nX0.0001\nX0.0002\nX0.0002 Y0\nM30",
        &["X"],
    );
    assert_eq!(trace.end(), [0.0002]);
    assert_limits(MACHINE, &["X"], &trace);
}

#[test]
fn rounding_of_positions_is_no_motion() {
    // R5.1 R5.2: 0.1 + 0.2 is not 0.3; the block in between must not turn the path round.
    let program = "G01 X0 F600\nG91 X0.1\nX0.2\nX10\nG90 X10.3\nX20\nM30";
    let whole = trace("G01 X0 F600\nX20\nM30", &["X"]);
    let parts = trace(program, &["X"]);
    assert_eq!(
        (parts.seconds(), parts.end()),
        (whole.seconds(), whole.end())
    );
}
