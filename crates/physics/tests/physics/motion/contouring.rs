//! Block transitions, rounded as by the control.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

use frictcomp_physics::motion::PlannerOptions;

use super::{Trace, assert_limits, trace, trace_of};

/// Axes with nothing known about them.
const DEFAULTS: &str = "[[axis]]\nname = \"X\"\n[[axis]]\nname = \"Y\"\n[[axis]]\nname = \"Z\"\n";

/// Returns a circle of 100 mm in chords, entered and left by a tangent.
fn chords(mode: &str, feed: u32, (degrees, decimals): (f64, usize)) -> String {
    let mut text = format!("{mode}\nG90 G01 X100 Y-20 Z0 F{feed}\nX100 Y0\n");
    let count = (360.0 / degrees).round();
    let mut step = 1.0;
    while step <= count {
        let (sine, cosine) = (step / count * TAU).sin_cos();
        let _ = writeln!(
            text,
            "X{:.decimals$} Y{:.decimals$}",
            100.0 * cosine,
            100.0 * sine
        );
        step += 1.0;
    }
    text + "Y20\nM30\n"
}

fn arc(feed: u32) -> String {
    format!("G90 G01 X100 Y-20 Z0 F{feed}\nX100 Y0\nG03 X100 Y0 I-100 J0\nG01 Y20\nM30\n")
}

fn follow(program: &str) -> Trace {
    trace_of(DEFAULTS, program, &["X", "Y"], PlannerOptions::default())
}

/// Returns the distance of the trace from the circle, in µm, without its ends.
fn off_circle(trace: &Trace) -> f64 {
    let on = trace.positions.iter().filter(|place| place[0] < 99.0);
    let off = on.map(|place| (place[0].hypot(place[1]) - 100.0).abs() * 1000.0);
    off.fold(0.0, f64::max)
}

#[test]
fn short_chords_take_the_time_of_the_arc() {
    // R11.22
    let hsc = "#HSC ON [OPMODE 1 CONTERROR 0.01]";
    for (mode, feed, chord) in [
        ("#CONTOUR MODE ON", 500, (0.2, 3)),
        ("G261", 2000, (0.05, 4)),
        ("G261", 5000, (0.05, 4)),
        (hsc, 5000, (0.1, 3)),
    ] {
        let arc = follow(&arc(feed)).seconds();
        let found = follow(&chords(mode, feed, chord));
        let longer = found.seconds() / arc - 1.0;
        let what = format!("{mode} F{feed} {chord:?}: {longer}");
        assert!(longer < 0.1, "{what}");
        assert!(off_circle(&found) < 1.0, "{what}: {}", off_circle(&found));
        assert_limits(DEFAULTS, &["X", "Y"], &found);
        assert_eq!(found.transitions.slow, 0, "{what}");
    }
}

/// Chords and feeds of the table in `docs/contour.md`, and all of them.
const SHOWN: (&[f64], &[u32]) = (&[0.1], &[2000]);
const ALL: (&[f64], &[u32]) = (&[0.05, 0.1, 0.2], &[500, 2000, 5000]);

/// Returns a circle in chords against the arc, over jerk and contour mode; with a mode the time is that of the arc
/// (R11.22).
fn chords_against_arc((lengths, feeds): (&[f64], &[u32])) -> String {
    let mut table = String::from(
        "| jerk m/s³ | mode | chord | F | arc s | chords s | off the circle µm |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for jerk in [5.0, 20.0, 100.0] {
        let axis = |name: &str| format!("[[axis]]\nname = \"{name}\"\nmax_jerk = {jerk:.1}\n");
        let machine = ["X", "Y", "Z"].map(axis).concat();
        let follow =
            |program: &str| trace_of(&machine, program, &["X", "Y"], PlannerOptions::default());
        for (name, mode) in [
            ("none", ""),
            ("`#CONTOUR MODE`", "#CONTOUR MODE ON"),
            ("G261", "G261"),
            ("`#HSC`", "#HSC ON [OPMODE 1 CONTERROR 0.01]"),
        ] {
            for (&chord, &feed) in lengths
                .iter()
                .flat_map(|it| feeds.iter().map(move |feed| (it, feed)))
            {
                let arc = follow(&arc(feed)).seconds();
                let found = follow(&chords(mode, feed, (chord, 4)));
                let seconds = found.seconds();
                let off = off_circle(&found);
                let is_as_fast = seconds < 1.1 * arc;
                assert!(
                    mode.is_empty() || is_as_fast,
                    "{name} {chord} F{feed}: {seconds} s"
                );
                let _ = writeln!(
                    table,
                    "| {jerk} | {name} | {chord}° | {feed} | {arc:.1} | {seconds:.1} | {off:.2} |"
                );
            }
        }
    }
    table
}

#[test]
fn the_document_compares_chords_with_the_arc() {
    // R11.22
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/contour.md");
    let text = fs::read_to_string(path).expect("the document");
    let (begin, end) = ("<!-- chords -->\n", "<!-- end of chords -->\n");
    let from = text.find(begin).expect("its beginning") + begin.len();
    let to = text.find(end).expect("its end");
    let table = chords_against_arc(SHOWN);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        let written = [&text[..from], &table, &text[to..]].concat();
        fs::write(path, written).expect("written");
    } else {
        assert_eq!(&text[from..to], table);
    }
}

#[test]
#[ignore = "minutes without optimization"]
#[allow(clippy::print_stdout, reason = "the table is shown with `--nocapture`")]
fn every_chord_against_the_arc() {
    // R11.22
    println!("{}", chords_against_arc(ALL));
}

#[test]
fn without_a_mode_every_kink_slows_the_path_down() {
    // R11.22: the stop and go of short lines is shown, and counted.
    let found = follow(&chords("", 2000, (0.2, 4)));
    assert!(found.seconds() > 60.0, "{}", found.seconds());
    assert!(found.transitions.slow > 1700, "{:?}", found.transitions);
    assert_eq!(found.transitions.joined, 0);
}

#[test]
fn a_corner_is_rounded_within_its_tolerance() {
    // R11.21
    let corner = |mode: &str| {
        let program = format!("{mode}\nG90 G01 X0 Y0 F3000\nX40\nY40\nX80 Y80\nM30\n");
        let found = trace(&program, &["X", "Y"]);
        assert_limits(super::MACHINE, &["X", "Y"], &found);
        let distance = |place: &Vec<f64>| (place[0] - 40.0).hypot(place[1]);
        let nearest = found
            .positions
            .iter()
            .map(distance)
            .fold(f64::MAX, f64::min);
        (nearest, found.seconds())
    };
    let (exact, slow) = corner("G60");
    let (_, stops) = corner("G260");
    assert!(exact < 0.05);
    for (mode, tolerance) in [
        ("G261", 1.0),
        ("#CONTOUR MODE ON [DEV PATH_DEV=0.2]", 0.2),
        ("#CONTOUR MODE [DEV PATH_DEV=0.5]\nG261", 0.5),
        ("#contour mode on [dev path_dev = 0.2]", 0.2),
    ] {
        let (nearest, seconds) = corner(mode);
        assert!(nearest <= tolerance + 1e-4, "{mode}: {nearest}");
        assert!(nearest > 0.9 * tolerance, "{mode}: {nearest}");
        assert!(
            seconds < 1.01 * stops.min(slow),
            "{mode}: {seconds} {stops}"
        );
    }
    let (nearest, _) = corner("#CONTOUR MODE ON [DIST PRE_DIST=2 POST_DIST=3]");
    assert!(nearest < 2.0, "{nearest}");
    // An unknown tolerance rounds nothing, and a block function rounds its own end.
    let (nearest, _) = corner("#CONTOUR MODE ON [DEV PATH_DEV=V.E.A]");
    assert!(nearest < 0.05, "{nearest}");
}

#[test]
fn a_long_run_of_short_lines_is_one_curve() {
    // R11.28: three times the look-ahead, without a stop between.
    let mut text = String::from("G261\nG90 G01 X0 Y0 F6000\n");
    let (mut x, mut y, mut angle) = (0.0, 0.0, 0.0_f64);
    for _ in 0..12_000 {
        angle += 0.0005;
        x += 0.1 * angle.cos();
        y += 0.1 * angle.sin();
        let _ = writeln!(text, "X{x:.4} Y{y:.4}");
    }
    let found = follow(&(text + "M30\n"));
    assert_eq!(found.transitions.joined, 11_999);
    assert!(found.seconds() < 12.5, "{}", found.seconds());
}

#[test]
fn a_block_function_rounds_the_end_of_its_block() {
    // R11.21
    let program = "G90 G01 X0 Y0 F3000\nG61 X40\nY40\nX0\nM30\n";
    let found = trace(program, &["X", "Y"]);
    let nearest = |corner: [f64; 2]| {
        let distances = found.positions.iter();
        let distances = distances.map(|place| (place[0] - corner[0]).hypot(place[1] - corner[1]));
        distances.fold(f64::MAX, f64::min)
    };
    assert!(nearest([40.0, 0.0]) > 0.9);
    assert!(nearest([40.0, 40.0]) < 0.05);
    assert_eq!(found.transitions.rounded, 1);
}
