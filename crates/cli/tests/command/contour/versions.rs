//! `diff --contour` and `golden --contour`.

use super::MACHINE;
use crate::folder::{Bench, json};

const OLD: &str = "\
N10 X[COMP ON FRICT] Y[COMP ON FRICT]
N20 G01 X25 Y0 F3000
N30 G03 X25 Y0 I-25 J0
N40 G03 X25 Y0 I-25 J0
N50 G01 Y10
N60 M30
";

fn bench(new: &str) -> Bench {
    let bench = Bench::new(&[("old.nc", OLD), ("new.nc", new)]);
    bench.write("frictcomp.toml", MACHINE);
    bench
}

const START: [&str; 2] = ["--start", "X25,Y-20"];

fn diff(bench: &Bench, arguments: &[&str]) -> (Option<i32>, String) {
    let fixed = ["diff", "old.nc", "new.nc", "--contour"];
    let output = bench.call(&[&fixed[..], arguments].concat());
    let text = String::from_utf8(output.stdout).expect("text");
    (output.status.code(), text)
}

#[test]
fn a_block_that_deviates_more_is_named_with_its_worst_place() {
    // R9.83: X is off in the second turn, which is two lines lower in the new version.
    let new = OLD.replace(
        "N40 G03",
        "; a comment\n; another\nN35 X[COMP OFF FRICT]\nN40 G03",
    );
    let bench = bench(&new);
    let (status, text) = diff(&bench, &[&START[..], &["--format", "json"]].concat());
    assert_eq!(status, Some(1));
    let found = &json(&text)["contour"];
    assert_eq!(found["verdict"], "more");
    let more = found["more"].as_array().expect("blocks");
    let turn = more
        .iter()
        .find(|it| it["n"] == 40)
        .unwrap_or_else(|| panic!("{found:#}"));
    assert_eq!((&turn["line"], &turn["old_line"]), (&7.into(), &4.into()));
    let um = |value: &serde_json::Value| value.as_f64().expect("a number");
    assert!(um(&turn["new"]) > um(&turn["old"]) + 10.0, "{turn}");
    // X reverses at the left.
    let place = turn["position"].as_array().expect("a place");
    assert!(um(&place[0]) < -24.0 && um(&place[1]).abs() < 3.0, "{turn}");
    assert!(more.iter().all(|it| it["n"] != 30), "{found:#}");
    let (_, text) = diff(&bench, &START);
    assert!(
        text.contains("more by more than 0.5 µm, line 7 of new.nc most"),
        "{text}"
    );
    let page = [&START[..], &["--html", "d.html"]].concat();
    assert_eq!(diff(&bench, &page).0, Some(1));
    let page = bench.read("d.html");
    assert!(
        page.contains("line 7 of new.nc") && page.contains("deviates more"),
        "{page}"
    );
}

#[test]
fn a_peak_is_not_hidden_by_another_one_that_both_versions_have() {
    // R9.83: the overshoot at the sharp corner is larger than what the reversal costs.
    let text = |compensation: &str| {
        format!(
            "N10 X[COMP {compensation} FRICT]\nN20 G01 X30 F9000\nN30 G03 X30 Y0 I0 J20 F3000\nN40 M30\n"
        )
    };
    let bench = bench(&text("OFF"));
    bench.write("old.nc", &text("ON"));
    let arguments = ["--start", "X0,Y0", "--format", "json"];
    let found = json(&diff(&bench, &arguments).1);
    let more = found["contour"]["more"].as_array().expect("blocks");
    assert!(more.iter().any(|it| it["n"] == 30), "{found:#}");
}

#[test]
fn contours_that_do_not_deviate_more_are_clean() {
    // R9.83: lines that moved, and less deviation, are not a difference.
    let bench = bench(&OLD.replace("N20", "; moved\n\nN20"));
    let (status, text) = diff(&bench, &START);
    assert_eq!(status, Some(0), "{text}");
    assert!(text.contains("no block deviates more"), "{text}");
    // The feed costs some µm, and no switch differs.
    bench.write("new.nc", &OLD.replace("F3000", "F6000"));
    let (status, text) = diff(&bench, &START);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("no difference:"), "{text}");
    let (status, text) = diff(&bench, &[&START[..], &["--tolerance", "500"]].concat());
    assert_eq!(status, Some(0), "{text}");
    // A new version that cuts nothing is not judged, unless the old one cut nothing either.
    let moves = "G00 X0 Y0\nM30\n";
    bench.write("new.nc", moves);
    let (status, text) = diff(&bench, &START);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("no feed move is driven"), "{text}");
    bench.write("old.nc", moves);
    bench.write("new.nc", &moves.replace("X0", "X10"));
    let (status, text) = diff(&bench, &START);
    assert_eq!(status, Some(0), "{text}");
}

#[test]
fn what_is_not_driven_is_not_comparable() {
    // R9.83
    let bench = bench(OLD);
    let (status, text) = diff(&bench, &[]);
    assert_eq!(status, Some(1), "{text}");
    assert!(
        text.contains("not comparable: the contour of the old version: 1 motion"),
        "{text}"
    );
    let (status, text) = diff(&bench, &[&START[..], &["--max-cycles", "200"]].concat());
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("it ends before the program does"), "{text}");
    for wrong in [
        &["--plane", "XY"][..],
        &["--tolerance", "1"],
        &["--start", "X0"],
    ] {
        let arguments = [&["diff", "old.nc", "new.nc"][..], wrong].concat();
        assert_eq!(bench.status(&arguments), Some(2), "{wrong:?}");
    }
    for wrong in ["-1", "x", "nan"] {
        let wrong = format!("--tolerance={wrong}");
        assert_eq!(diff(&bench, &[&wrong]).0, Some(2));
    }
}

#[test]
fn an_agreed_contour_has_a_tolerance() {
    // R9.84
    let bench = Bench::new(&[("a.nc", OLD)]);
    bench.write("frictcomp.toml", MACHINE);
    let golden = |arguments: &[&str]| {
        let fixed = ["golden", "--contour", "a.nc", "--start", "X25,Y-20"];
        let output = bench.call(&[&fixed[..], arguments].concat());
        let text = String::from_utf8(output.stdout).expect("text");
        (output.status.code(), text)
    };
    assert_eq!(golden(&[]).0, Some(1), "missing");
    assert_eq!(golden(&["--update"]).0, Some(0));
    assert_eq!(golden(&[]), (Some(0), "1 contour as agreed\n".to_owned()));
    let agreed = bench.read("a.nc.contour");
    assert!(agreed.contains(" µm  N40 G03 X25 Y0 I-25 J0\n"), "{agreed}");
    // 0.2 µm are within the tolerance, and --update leaves them as agreed.
    let turned = agreed.replace(".0 µm", ".2 µm").replace(".1 µm", ".3 µm");
    assert_ne!(turned, agreed);
    bench.write("a.nc.contour", &turned);
    assert_eq!(golden(&[]).0, Some(0));
    assert_eq!(golden(&["--update"]).0, Some(0));
    assert_eq!(bench.read("a.nc.contour"), turned);
    assert_eq!(golden(&["--tolerance", "0"]).0, Some(1));
    // A change that costs some µm shows in its block only.
    bench.write("a.nc.contour", &agreed);
    bench.write("a.nc", &OLD.replace("N40", "N35 X[COMP OFF FRICT]\nN40"));
    let (status, text) = golden(&[]);
    assert_eq!(status, Some(1));
    let removed: Vec<&str> = text.lines().filter(|it| it.starts_with("-  ")).collect();
    assert!(removed.iter().any(|it| it.contains("N40")), "{text}");
    assert!(removed.iter().all(|it| !it.contains("N30")), "{text}");
    assert_eq!(bench.status(&["golden", "a.nc", "--plant", "mid"]), Some(2));
}

#[test]
fn an_agreed_contour_has_no_figure_where_there_is_none() {
    // R9.84, R11.26: X turns back at a corner, then on the path on which it came.
    let corners =
        "N10 X[COMP ON FRICT]\nN20 G01 X25 Y0 F3000\nN30 X40\nN40 X20 Y30\nN50 X30\nN60 M30\n";
    let bench = Bench::new(&[("a.nc", corners)]);
    bench.write("frictcomp.toml", MACHINE);
    let update = [
        "golden",
        "--contour",
        "--start",
        "X0,Y-20",
        "--update",
        "a.nc",
    ];
    assert_eq!(bench.status(&update), Some(0));
    let agreed = bench.read("a.nc.contour");
    for words in [
        "N40 X20 Y30\n           reversals: X without a figure\n",
        "N50 X30\n           reversals: X along the path\n",
    ] {
        assert!(agreed.contains(words), "{agreed}");
    }
}
