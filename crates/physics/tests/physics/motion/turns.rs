//! Reversals of a smoothed path against a count on the programmed polyline (R11.29).

use std::fmt::Write as _;

use frictcomp_physics::motion::PlannerOptions;

use super::{Trace, trace_of};

const AXES: [&str; 3] = ["X", "Y", "Z"];

const FAST: &str = "\
[[axis]]
name = \"X\"
max_jerk = 200
[[axis]]
name = \"Y\"
max_jerk = 200
[[axis]]
name = \"Z\"
max_jerk = 200
";

/// The path modes, with the tolerance of each in mm.
const MODES: [(&str, f64); 8] = [
    ("", 0.0),
    ("#CONTOUR MODE ON", 1.0),
    ("#CONTOUR MODE ON [DEV PATH_DEV=0.02]", 0.02),
    ("G261", 1.0),
    ("#HSC ON", 0.1),
    ("#HSC ON [CONTERROR 0.005]", 0.005),
    ("#HSC ON [OPMODE 1 CONTERROR 0.05]", 0.05),
    ("#HSC ON [CONTERROR 0.001]", 0.001),
];

type Polyline = Vec<[f64; 3]>;

/// Returns the program that follows a polyline from its first point, which is approached at rest.
fn program(mode: &str, (points, decimals): (&Polyline, usize)) -> String {
    let [x, y, z] = points[0];
    let mut text =
        format!("G90 G01 X{x:.decimals$} Y{y:.decimals$} Z{z:.decimals$} F1500\nG04 0.1\n{mode}\n");
    for [x, y, z] in &points[1..] {
        let _ = writeln!(text, "X{x:.decimals$} Y{y:.decimals$} Z{z:.decimals$}");
    }
    text + "M30\n"
}

/// Returns the coordinates as the program has them.
fn rounded(points: &[[f64; 3]], decimals: usize) -> Polyline {
    let scale = 10_f64.powi(i32::try_from(decimals).expect("few"));
    let each = points.iter();
    each.map(|point| point.map(|x| (x * scale).round() / scale))
        .collect()
}

/// Returns the number of the changes of direction.
fn turns(steps: impl Iterator<Item = f64>) -> usize {
    let directions = steps.filter(|step| *step != 0.0).map(f64::signum);
    let (mut last, mut count) = (0.0, 0);
    for direction in directions {
        count += usize::from(direction * last < 0.0);
        last = direction;
    }
    count
}

fn turns_of_polyline(points: &Polyline, axis: usize) -> usize {
    turns(points.windows(2).map(|pair| pair[1][axis] - pair[0][axis]))
}

/// Returns the number of turns between strokes that are all longer than this.
fn large_turns(points: &Polyline, (axis, stroke): (usize, f64)) -> usize {
    let mut values = points.iter().map(|point| point[axis]);
    let first = values.next().expect("a point");
    let (mut low, mut high, mut direction, mut count) = (first, first, 0.0, 0_usize);
    for value in values {
        low = low.min(value);
        high = high.max(value);
        if direction >= 0.0 && high - value > stroke {
            count += usize::from(direction > 0.0);
            (direction, low) = (-1.0, value);
        } else if direction <= 0.0 && value - low > stroke {
            count += usize::from(direction < 0.0);
            (direction, high) = (1.0, value);
        }
    }
    count
}

fn turns_of_trace(trace: &Trace, axis: usize) -> usize {
    turns(trace.velocities.iter().map(|cycle| cycle[axis]))
}

/// Returns the greatest distance in mm of the followed path from the polyline, each place compared with the lines near
/// the one that was passed last.
fn off_polyline(points: &Polyline, trace: &Trace) -> f64 {
    const NEAR: usize = 12;
    let (mut most, mut passed) = (0.0_f64, 0_usize);
    for place in &trace.positions {
        let near = passed.saturating_sub(2)..(passed + NEAR).min(points.len() - 1);
        let distances = near.map(|at| (at, off_line(place, [&points[at], &points[at + 1]])));
        let nearest = distances.min_by(|one, other| one.1.total_cmp(&other.1));
        let (at, distance) = nearest.expect("a line");
        passed = at;
        most = most.max(distance);
    }
    most
}

/// Returns the distance of a place from the line between two points.
fn off_line(place: &[f64], [from, to]: [&[f64; 3]; 2]) -> f64 {
    let sum = |of: &dyn Fn(usize) -> f64| (0..AXES.len()).map(of).sum::<f64>();
    let length = sum(&|axis| (to[axis] - from[axis]).powi(2)).max(1e-12);
    let along = sum(&|axis| (place[axis] - from[axis]) * (to[axis] - from[axis]));
    let part = (along / length).clamp(0.0, 1.0);
    sum(&|axis| (place[axis] - from[axis] - part * (to[axis] - from[axis])).powi(2)).sqrt()
}

/// Asserts that no axis turns where the polyline does not, and that it turns wherever the polyline
/// does by more than the tolerance, which the path keeps everywhere.
fn assert_turns(what: &str, points: &Polyline, decimals: usize) {
    let points = rounded(points, decimals);
    for (mode, tolerance) in MODES {
        let text = program(mode, (&points, decimals));
        let trace = trace_of(FAST, &text, &AXES, PlannerOptions::default());
        // Only the approach, whose start is not known.
        assert!(trace.left_out.len() <= 1, "{what}, {mode}");
        for (axis, name) in AXES.iter().enumerate() {
            let found = turns_of_trace(&trace, axis);
            let most = turns_of_polyline(&points, axis);
            let least = large_turns(&points, (axis, tolerance.max(1e-9)));
            let said = format!("{what}, {mode}, {name}: {found}, not {least} to {most}");
            assert!(found <= most, "{said}");
            assert!(found >= least, "{said}");
        }
        let off = off_polyline(&points, &trace);
        assert!(off <= tolerance + 0.001, "{what}, {mode}: {off} mm off");
    }
}

/// Rows of a mould along X with a wave in Z; `slant` is the way of Y along a row.
fn rows(random: &mut fastrand::Rng, (count, slant): (u32, f64)) -> Polyline {
    let chord = [0.05, 0.1, 0.4, 1.0, 2.0][random.usize(..5)];
    let steps = random.u32(30..60);
    let [height, waves, phase, feed] = [
        0.02 + 1.5 * random.f64(),
        0.5 + 2.5 * random.f64(),
        random.f64(),
        0.1 + 0.5 * random.f64(),
    ];
    let mut points = Polyline::new();
    for row in 0..count {
        for step in 0..=steps {
            let along = f64::from(if row % 2 == 0 { step } else { steps - step });
            let part = along / f64::from(steps);
            let z = height * (std::f64::consts::TAU * (waves * part + phase)).sin();
            points.push([chord * along, feed * f64::from(row) + slant * part, z]);
        }
    }
    points
}

#[test]
fn rows_of_a_mould_turn_only_where_the_program_does() {
    // R11.29: Y only grows, in rows of 40 points of 2 mm with a wave in Z.
    let mut points = Polyline::new();
    for row in 0..8_u32 {
        for step in 0..=40 {
            let x = 2.0 * f64::from(if row % 2 == 0 { step } else { 40 - step });
            let z = 1.5 * (x / 20.0 + 0.3 * f64::from(row)).sin();
            points.push([x, 0.5 * f64::from(row), z]);
        }
    }
    assert_eq!(turns_of_polyline(&rounded(&points, 3), 1), 0);
    assert_turns("rows", &points, 3);
}

#[test]
fn random_rows_turn_only_where_the_program_does() {
    // R11.29
    for seed in 0..12 {
        let mut random = fastrand::Rng::with_seed(seed);
        let slant = [0.0, 0.004, -0.03, 0.3][random.usize(..4)];
        let points = rows(&mut random, (3, slant));
        assert_turns(&format!("rows {seed}"), &points, random.usize(3..5));
    }
}

#[test]
fn short_lines_that_creep_on_an_axis_turn_only_where_the_program_does() {
    // R11.29: an axis that moves by the last decimal once in many blocks.
    for (seed, slope) in [(0, 0.0004), (1, 0.00013), (2, 0.002), (3, 0.011)] {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut points = Polyline::new();
        let mut y = 0.0;
        for step in 0..160 {
            y += slope * random.f64();
            let x = 0.1 * f64::from(step);
            points.push([x, y, 0.3 * (x / 2.0).sin()]);
        }
        assert_turns(&format!("creep {slope}"), &points, 3);
    }
}

#[test]
fn zigzags_turn_at_every_stroke_beyond_the_tolerance() {
    // R11.29
    for seed in 0..12 {
        let mut random = fastrand::Rng::with_seed(100 + seed);
        let size = [0.0008, 0.004, 0.02, 0.1, 1.5, 3.0][usize::try_from(seed % 6).expect("few")];
        let mut points = Polyline::new();
        let (mut x, mut y) = (0.0, 0.0);
        for _ in 0..120 {
            x += 0.02 + random.f64() * (0.1 + size);
            y += size * (random.f64() - 0.5 + 0.2 * (x / 3.0).sin());
            points.push([x, y, 0.0]);
        }
        assert_turns(&format!("zigzag {size}"), &points, 4);
    }
}

#[test]
fn circles_of_chords_turn_at_their_quadrants() {
    // R11.29
    // Chords of 1.3 turns.
    for (radius, chord, count, decimals) in [
        (5.0, 0.02, 2_042, 3),
        (25.0, 0.04, 5_105, 3),
        (10.0, 0.3, 272, 4),
        (25.0, 0.6, 340, 3),
    ] {
        let point = |step: u32| {
            let (sine, cosine) = (f64::from(step) * chord / radius + 0.7).sin_cos();
            [radius * cosine, radius * sine, 0.0]
        };
        let points: Polyline = (0..count).map(point).collect();
        assert_turns(&format!("circle {radius} {chord}"), &points, decimals);
    }
}
