//! Chapter 11 of the rules: the places where a program needs compensation.

mod verdict;
mod versions;

use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::folder::{Bench, json, succeeded};
use crate::workspace::{agree, root};
use serde_json::Value;

/// Two axes whose lists are the friction curves of the plant, as in the circular test.
const MACHINE: &str = "\
[[axis]]
name = \"X\"
frict_comp = true
max_acceleration = 5.0
max_jerk = 1000.0
[[axis]]
name = \"Y\"
frict_comp = true
max_acceleration = 5.0
max_jerk = 1000.0
[[axis]]
name = \"Z\"
";

fn bench(program: &str) -> Bench {
    let bench = Bench::new(&[("part.nc", program)]);
    bench.write("frictcomp.toml", MACHINE);
    bench
}

fn contour(bench: &Bench, arguments: &[&str]) -> Value {
    let fixed = ["contour", "part.nc", "--format", "json", "--plant", "mid"];
    let output = bench.call(&[&fixed[..], arguments].concat());
    assert_ne!(output.status.code(), Some(2), "{output:?}");
    json(&String::from_utf8(output.stdout).expect("text"))
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

/// Circles of 25 mm at 3000 mm/min, with a tangent before and after; the second turn is line 5.
fn circle(turn: &str, compensation: &str) -> String {
    let side = if turn == "G03" { "-" } else { "" };
    let full = format!("{turn} X25 Y0 I-25 J0\n");
    format!(
        "X[COMP {compensation} FRICT] Y[COMP {compensation} FRICT]\nG01 X25 Y{side}20 F3000\nG01 Y0\n{full}{full}{full}M30\n"
    )
}

/// Returns the circle made of chords of 0.25°, which the axis jerk allows at full feed; its second turn is lines 1443
/// to 2882.
fn chords(turn: &str) -> String {
    let sense = if turn == "G03" { 1.0 } else { -1.0 };
    let mut text = format!(
        "X[COMP OFF FRICT] Y[COMP OFF FRICT]\nG01 X25 Y{} F3000\n",
        -20.0 * sense
    );
    for step in 0..3 * 1440 {
        let angle = f64::from(step) / 1440.0 * TAU;
        let (x, y) = (25.0 * angle.cos(), sense * 25.0 * angle.sin());
        let _ = writeln!(text, "X{x:.7} Y{y:.7}");
    }
    text + "M30\n"
}

/// Returns `F_max` and `F_min` of the circular test on the same plant.
fn figures(side: &str) -> [f64; 2] {
    let bench = bench("M30\n");
    let arguments = [
        "circle", "--radius", "25", "--feed", "3000", "--plant", "mid", "--format", "csv",
    ];
    let rows = bench.stdout(&arguments);
    let rows = rows.lines().filter(|row| row.starts_with(side));
    let deviations = rows.map(|row| {
        row.rsplit(',')
            .next()
            .expect("a column")
            .parse()
            .expect("a number")
    });
    deviations.fold([0.0_f64; 2], |[most, least], it: f64| {
        [most.max(it), least.min(it)]
    })
}

#[test]
fn a_circle_gives_what_the_circular_test_gives() {
    // R11.3, R11.4
    let [most, least] = figures("off,ccw");
    assert!(most > 10.0 && least < 0.0, "{most} {least}");
    for turn in ["G02", "G03"] {
        let found = contour(&bench(&circle(turn, "OFF")), &["--start", "X25,Y0"]);
        let second = found["blocks"].as_array().expect("blocks");
        let second = second
            .iter()
            .find(|it| it["line"] == 5)
            .expect("the second turn");
        let max = number(&second["max"]);
        assert!((max / most - 1.0).abs() < 0.02, "{turn}: {max} of {most}");
        assert_eq!(found["programmed"], found["all_off"]);
        let switched = contour(&bench(&circle(turn, "ON")), &["--start", "X25,Y0"]);
        assert_eq!(switched["programmed"], switched["all_on"]);
        assert_eq!(switched["all_off"], found["all_off"]);
        assert_eq!(switched["all_on"], found["all_on"]);
    }
}

#[test]
fn a_circle_of_chords_gives_it_too() {
    // R11.3
    let [most, _] = figures("off,ccw");
    for turn in ["G02", "G03"] {
        let found = contour(&bench(&chords(turn)), &["--start", "X25,Y0"]);
        let blocks = found["blocks"].as_array().expect("blocks");
        let second = blocks
            .iter()
            .filter(|it| (1443..=2882).contains(&it["line"].as_u64().expect("a line")));
        let max = second.map(|it| number(&it["max"])).fold(0.0, f64::max);
        assert!((max / most - 1.0).abs() < 0.02, "{turn}: {max} of {most}");
    }
}

#[test]
fn every_reversal_has_its_place_and_its_glitch() {
    // R11.2: the second turn reverses Y at the top, X on the left, Y below, X on the right.
    let found = contour(&bench(&circle("G03", "OFF")), &["--start", "X25,Y0"]);
    let reversals = found["reversals"].as_array().expect("reversals");
    let second: Vec<&Value> = reversals.iter().filter(|it| it["line"] == 5).collect();
    let axes: Vec<&str> = second.iter().filter_map(|it| it["axis"].as_str()).collect();
    assert_eq!(axes, ["X", "Y", "X", "Y"]);
    let radius_per_s2 = 50.0 * 50.0 / 25.0;
    for reversal in &second {
        let (x, y) = (
            number(&reversal["position"]["X"]),
            number(&reversal["position"]["Y"]),
        );
        assert!((x.hypot(y) - 25.0).abs() < 0.001, "{reversal}");
        assert!(
            (number(&reversal["feed"]) - 3000.0).abs() < 1.0,
            "{reversal}"
        );
        let acceleration = number(&reversal["acceleration"]).abs();
        assert!(
            (acceleration / radius_per_s2 - 1.0).abs() < 0.01,
            "{reversal}"
        );
        assert_eq!(reversal["state"], "inactive");
        assert_eq!(reversal["glitch"], reversal["glitch_off"]);
        assert!(
            number(&reversal["glitch"]) > 4.0 * number(&reversal["glitch_on"]),
            "{reversal}"
        );
    }
}

#[test]
fn rapid_motions_are_counted_apart_and_never_judged() {
    // R11.2, R11.3
    let program = "X[COMP OFF FRICT]\nG00 X50\nG00 X0\nG00 X50\nG01 X60 F500\nX50\nM30\n";
    let found = contour(&bench(program), &["--start", "X0,Y0"]);
    let x = &found["axes"][0];
    assert_eq!(
        (&x["axis"], &x["rapid"], &x["cutting"]),
        (&"X".into(), &2.into(), &1.into())
    );
    // On a straight line nothing deviates from the path.
    assert!(number(&found["programmed"]["max"]) < 0.01, "{found}");
}

#[test]
fn what_is_not_known_is_left_out_and_counted() {
    // R11.8
    let program =
        "G01 X10 Y5 F1000\n#ROTATION ON [ANGLE 30]\nX20 Y5\n#ROTATION OFF\nG90 X0 Y0\nX5 Y5\nM30\n";
    let bench = bench(program);
    let found = contour(&bench, &["--start", "X0,Y0"]);
    assert!(number(&found["time_not_of_the_machine"]) > 0.0 || number(&found["left_out"]) > 0.0);
    // It appears in the picture only if there is such a stretch.
    let picture = |bench: &Bench| {
        bench.call(&["contour", "part.nc", "--start", "X0,Y0", "--svg", "a.svg"]);
        bench.read("a.svg")
    };
    let turned =
        "G01 X10 Y5 F1000\n#ROTATION ON [ANGLE 30]\nX20 Y5\nX25\n#ROTATION OFF\nX30 Y5\nM30\n";
    assert!(picture(&self::bench(turned)).contains(">left out</text>"));
    assert!(!picture(&self::bench("G01 X10 Y5 F1000\nM30\n")).contains("left out"));
    let found = contour(&bench, &[]);
    assert!(number(&found["left_out"]) >= 1.0, "{found}");
    let said = bench.call(&["contour", "-v", "part.nc", "--plant", "mid"]);
    let said = String::from_utf8(said.stdout).expect("text");
    assert_eq!(said.matches("not modelled:").count(), 1, "{said}");
    assert!(said.contains("left out:"), "{said}");
}

#[test]
fn what_deviates_beside_the_plane_is_said() {
    // R11.3, R11.8
    let bench = bench("G18\nG01 X10 Z0 F2000\nG03 X10 Z0 I-10 K0\nM30\n");
    let said = |plane: &str| {
        bench.stdout(&[
            "contour", "part.nc", "--start", "X0,Y0,Z0", "--plane", plane,
        ])
    };
    assert!(said("XY").contains("in the plane XY; `--plane X,Z` shows those of Z"));
    assert!(!said("X,Z").contains("shows those of"));
}

#[test]
fn a_program_that_is_stopped_is_no_all_clear() {
    // R2.60, R11.6: what follows an endless loop is never driven, and both commands report it.
    let bench = bench("G00 X0 Y0\nG01 X10 F2000\n$WHILE 1 == 1\nG04 1\n$ENDWHILE\nX50\nM30\n");
    let contour = [
        "contour",
        "part.nc",
        "--fail-above",
        "500",
        "--format",
        "json",
    ];
    let call = bench.call(&contour);
    assert_eq!(call.status.code(), Some(1), "{call:?}");
    let document = json(&String::from_utf8_lossy(&call.stdout));
    assert_eq!(document["cut_short"], true);
    let current = bench.call(&["current", "--axis", "X", "part.nc"]);
    for call in [call, current] {
        let said = String::from_utf8_lossy(&call.stderr).into_owned();
        assert!(said.contains("FC910"), "{said}");
    }
}

#[test]
fn every_format_has_a_record_for_each_reversal() {
    // R11.6
    let bench = bench(&circle("G02", "OFF"));
    let run = |format: &str| {
        bench.stdout(&[
            "contour", "part.nc", "--start", "X25,Y0", "--format", format,
        ])
    };
    let document = json(&run("json"));
    let count = document["reversals"].as_array().expect("reversals").len();
    assert_eq!(document["schema"], 1);
    let ndjson = run("ndjson");
    let lines: Vec<Value> = ndjson.lines().map(json).collect();
    assert_eq!(lines.len(), count + 1);
    assert_eq!(lines[count]["record"], "summary");
    assert_eq!(lines[count]["programmed"], document["programmed"]);
    let table = run("csv");
    assert_eq!(table.lines().count(), count + 1);
    // R9.76: a negative number is no text.
    assert!(table.contains(",-") && !table.contains(",'-"), "{table}");
}

#[test]
fn the_list_of_each_axis_is_said() {
    // R11.1
    let bench = bench(&circle("G03", "OFF"));
    let said = bench.stdout(&["contour", "-v", "part.nc", "--start", "X25,Y0"]);
    assert!(
        said.contains("compensation of X: the friction curve of the plant"),
        "{said}"
    );
    // Z moves, so it is driven, too.
    let bench = self::bench("G01 X10 Y5 Z1 F1000\nX0 Y0 Z0\nM30\n");
    let found = contour(&bench, &["--start", "X0,Y0,Z0"]);
    let axes: Vec<&str> = found["axes"]
        .as_array()
        .expect("axes")
        .iter()
        .filter_map(|it| it["axis"].as_str())
        .collect();
    assert_eq!(axes, ["X", "Y", "Z"]);
}

#[test]
fn the_picture_rings_what_is_not_compensated() {
    // R11.5
    for (compensation, rings) in [("OFF", true), ("ON", false)] {
        let bench = bench(&circle("G03", compensation));
        let arguments = [
            "contour", "part.nc", "--start", "X25,Y0", "--svg", "a.svg", "--html", "a.html",
        ];
        assert_eq!(bench.call(&arguments).status.code(), Some(0));
        let picture = bench.read("a.svg");
        // One ring is in the legend.
        assert_eq!(picture.matches("fc-outline\" cx").count() > 1, rings);
        assert!(picture.contains(">line 5: "), "{picture}");
        let page = bench.read("a.html");
        assert!(page.contains("Reversals by line") && page.contains("part.nc:5"));
    }
}

#[test]
fn each_mark_leads_to_its_line_and_each_line_shows_its_reversals() {
    // R11.5
    let bench = bench(&circle("G03", "OFF"));
    let arguments = [
        "contour", "part.nc", "--start", "X25,Y0", "--svg", "a.svg", "--html", "a.html",
    ];
    assert_eq!(bench.call(&arguments).status.code(), Some(0));
    let page = bench.read("a.html");
    for line in [4, 5, 6] {
        assert!(page.contains(&format!("id=\"f0l{line}\"")), "line {line}");
        assert!(
            page.contains(&format!("href=\"#f0l{line}\"")),
            "line {line}"
        );
    }
    let from = page.find("id=\"f0l5\"").expect("line 5");
    let line = &page[from..page.len().min(from + 600)];
    assert!(line.contains("G03 X25 Y0 I-25 J0"), "{line}");
    assert!(
        line.contains("X: 2 reversals, ") && line.contains("2 without compensation"),
        "{line}"
    );
    // A picture on its own has no link targets.
    assert!(!bench.read("a.svg").contains("href="));
}

#[test]
fn ten_thousand_reversals_stay_readable() {
    // R11.5
    let zigzag = "X0.1 Y0.1\nX0 Y0\n".repeat(2500);
    let bench = bench(&format!("X[COMP OFF FRICT]\nG01 F12000\n{zigzag}M30\n"));
    let arguments = [
        "contour", "part.nc", "--start", "X0,Y0", "--svg", "a.svg", "--html", "a.html",
    ];
    assert_eq!(bench.call(&arguments).status.code(), Some(0));
    let picture = bench.read("a.svg");
    assert!(picture.matches("<circle").count() < 200);
    assert!(picture.contains("the worst of "));
    assert!(picture.len() < 500_000 && bench.read("a.html").len() < 6_000_000);
}

#[test]
fn the_picture_of_the_documents_is_what_the_tool_draws() {
    // R11.5; `UPDATE_DOCS=1` draws it again.
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = folder.path().join("contour.svg");
    let program = [
        "contour",
        "programs/demo/contour/plate.nc",
        "--start",
        "X0,Y0,Z10",
        "--svg",
    ];
    let picture = drawn.to_str().expect("a name in UTF-8");
    succeeded(root(), &[&program[..], &[picture]].concat());
    let drawn = std::fs::read_to_string(drawn).expect("a picture");
    agree(&root().join("docs/assets/contour.svg"), &drawn);
}

#[test]
fn a_long_program_makes_no_larger_picture() {
    // R11.7
    let size = |turns: usize| {
        let turns = "G03 X25 Y0 I-25 J0\n".repeat(turns);
        let program = format!("X[COMP OFF FRICT]\nG01 X25 Y0 F3000\n{turns}M30\n");
        let bench = bench(&program);
        let arguments = [
            "contour", "part.nc", "--start", "X25,Y-20", "--svg", "a.svg",
        ];
        assert_eq!(bench.call(&arguments).status.code(), Some(0));
        bench.read("a.svg").len()
    };
    let (short, long) = (size(8), size(16));
    assert!(long < short * 3 / 2, "{short} {long}");
}

/// Rows of a mould along X with a wave in Z, in which Y only grows.
fn mould(mode: &str) -> String {
    let mut text = format!("G90 G01 X0 Y0 Z0 F1500\n{mode}\n");
    for row in 0..4_u32 {
        for step in 0..=40 {
            let x = 2.0 * f64::from(if row % 2 == 0 { step } else { 40 - step });
            let (y, z) = (0.5 * f64::from(row), (x / 10.0).sin());
            let _ = writeln!(text, "X{x:.3} Y{y:.3} Z{z:.3}");
        }
    }
    text + "M30\n"
}

#[test]
fn rows_that_only_grow_have_no_reversals_across() {
    // R11.29: and a list without look-ahead, which adds at once after each reversal, does no harm.
    let counts = ["", "#CONTOUR MODE ON", "#HSC ON [CONTERROR 0.005]"].map(|mode| {
        let bench = bench(&mould(mode));
        bench.write(
            "frictcomp.toml",
            &MACHINE.replace("name = \"Z\"", "name = \"Z\"\nfrict_comp = true"),
        );
        let found = contour(&bench, &["--start", "X0,Y0,Z0"]);
        let of = |axis: &str| {
            let reversals = found["reversals"].as_array().expect("a list");
            reversals.iter().filter(|it| it["axis"] == axis).count()
        };
        assert_eq!(of("Y"), 0, "{mode}");
        let [on, off] = ["all_on", "all_off"].map(|run| number(&found[run]["rms"]));
        assert!(on < 0.8 * off, "{mode}: {on} {off}");
        (of("X"), of("Z"))
    });
    assert_eq!(counts[0], counts[1]);
    assert_eq!(counts[0], counts[2]);
    assert!(counts[0].0 >= 3 && counts[0].1 >= 8, "{counts:?}");
}
