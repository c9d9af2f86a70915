//! Chapter 17 of the rules from outside: one finding per cause, one machine for both versions, axes for
//! the programs that have them; and what a session costs (R13.12).

use std::fs;

use crate::folder::{Bench, json};
use serde_json::Value;

const MAIN: &str =
    "N10 X[COMP ON FRICT]\nN11 X[COMP ON FRICT]\nN20 L toolchange.nc\nN30 G01 X10 F100\nN40 M30\n";
const CALLED: &str = "N1 Y[COMP OFF FRICT]\nN2 X[COMP ON FRCT]\nM17\n";
const PROGRAMS: [&str; 5] = ["a.nc", "b.nc", "c.nc", "d.nc", "e.nc"];

fn archive() -> Bench {
    let bench = Bench::new(&[("toolchange.nc", CALLED)]);
    for name in PROGRAMS {
        bench.write(name, MAIN);
    }
    bench
}

fn check(bench: &Bench, format: &str) -> String {
    bench.stdout(&["check", ".", "--format", format])
}

fn of_code(records: &[Value], code: &str) -> Vec<Value> {
    let of_code = records.iter().filter(|it| it["code"] == code);
    of_code.cloned().collect()
}

#[test]
fn every_format_names_the_programs_that_reach_a_message() {
    // R17.1
    let bench = archive();
    let reached = "reached from 5 programs: a.nc, b.nc, c.nc, d.nc, e.nc";
    for format in [
        "text", "concise", "json", "github", "gitlab", "sarif", "junit",
    ] {
        let shown = check(&bench, format);
        let expected = if format == "json" {
            "\"reached_from\":[\"a.nc\","
        } else {
            reached
        };
        assert_eq!(shown.matches(expected).count(), 2, "{shown}");
    }
    let sarif = json(&check(&bench, "sarif"));
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    let left = results.iter().find(|it| it["ruleId"] == "FC401");
    let related = left.expect("FC401")["relatedLocations"].as_array();
    let uris = related.expect("places").iter();
    let uris = uris.map(|it| &it["physicalLocation"]["artifactLocation"]["uri"]);
    assert!(uris.eq(PROGRAMS.map(Value::from).iter()), "{sarif}");
    assert_eq!(
        bench
            .stdout(&["check", ".", "--statistics"])
            .matches("      1  ")
            .count(),
        2
    );
}

#[test]
fn many_programs_are_counted() {
    // R17.1
    let bench = Bench::new(&[("toolchange.nc", CALLED)]);
    for number in 0..25 {
        bench.write(&format!("p{number:02}.nc"), MAIN);
    }
    let lines = check(&bench, "ndjson");
    let records: Vec<Value> = lines.lines().map(json).collect();
    let left = &of_code(&records, "FC401")[0];
    assert_eq!(left["reached_from"].as_array().map(Vec::len), Some(20));
    assert_eq!(left["reached_from_count"], 25);
    let text = check(&bench, "text");
    let named = "reached from 25 programs: p00.nc, p01.nc, p02.nc, p03.nc, p04.nc, …";
    assert!(text.contains(named), "{text}");
}

#[test]
fn a_message_about_the_end_names_its_main_program() {
    // R17.1
    let bench = Bench::new(&[("one.nc", MAIN), ("toolchange.nc", CALLED)]);
    let shown = bench.stdout(&["check", "one.nc", "--format", "concise"]);
    let left = shown.lines().find(|line| line.contains("FC401"));
    let left = left.expect("FC401");
    assert!(left.starts_with("toolchange.nc:1:"), "{left}");
    assert!(left.ends_with("(reached from one.nc)"), "{left}");
    // In the report of a run, too.
    let _ = bench.call(&["run", "--keep-going", "one.nc", "--html", "r.html"]);
    assert!(bench.read("r.html").contains("(reached from one.nc)"));
}

#[test]
fn a_file_that_is_no_program_is_named_before_its_axes() {
    // R9.74, R18.6
    let bench = Bench::new(&[]);
    fs::remove_file(bench.folder().join("frictcomp.toml")).expect("a configuration");
    bench.write("a.nc", "PK\u{3}\u{4}");
    for arguments in [
        &["check", "--enable", "X", "a.nc"][..],
        &["check", "--enable", "X", "."],
    ] {
        let (status, said) = crate::folder::said(&bench.call(arguments));
        assert!(status == Some(2) || status == Some(1), "{said}");
        assert!(said.contains("is a ZIP archive"), "{said}");
        assert!(!said.contains("axis"), "{said}");
    }
    bench.write("b.nc", "G0 Y1\nM30\n");
    let (status, said) = crate::folder::said(&bench.call(&["check", "--enable", "X", "."]));
    assert_eq!(status, Some(2), "{said}");
    assert!(said.contains("no program names an axis `X`"), "{said}");
}

#[test]
fn an_axis_that_a_program_only_reads_can_be_enabled() {
    // R17.7
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("p.nc");
    let text = "P1 = V.A.FRICT_COMP_ACTIVE.Y\nG0 X1\nM30\n";
    fs::write(&program, text).expect("written");
    let bench = Bench::new(&[]);
    let program = program.display().to_string();
    let status = |axes| bench.status(&["check", "--isolated", "--enable", axes, &program]);
    assert_eq!(status("X,Y"), Some(0));
    assert_eq!(status("X,Z"), Some(0));
    assert_eq!(status("Z,Q"), Some(2));
}

#[test]
fn axes_are_enabled_where_only_some_programs_are_described() {
    // R17.7
    let bench = Bench::new(&[("p.nc", "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n")]);
    let bare = tempfile::tempdir().expect("a folder");
    let other = bare.path().join("q.nc");
    fs::write(&other, "G0 C5\nC[COMP OFF FRICT]\nC[COMP ON FRICT]\nM30\n").expect("written");
    let other = other.display().to_string();
    assert_eq!(
        bench.status(&["check", "--enable", "X,C", "p.nc", &other]),
        Some(0)
    );
    assert_eq!(bench.status(&["check", "--enable", "X,C", "p.nc"]), Some(0));
    assert_eq!(bench.status(&["check", "--enable", "C", "p.nc"]), Some(2));
    assert_eq!(
        bench.status(&["check", "--enable", "W", "p.nc", &other]),
        Some(2)
    );
}

const OLD: &str = "N10 L sub.nc\nN20 X[COMP ON FRICT]\nN30 M30\n";
const SUB: &str = "N1 X[COMP OFF FRICT]\nN2 M17\n";

#[test]
fn both_versions_run_on_one_machine() {
    // R17.4
    let bench = Bench::new(&[("p.nc", OLD), ("sub.nc", SUB)]);
    let elsewhere = tempfile::tempdir().expect("a folder");
    let copy = elsewhere.path().join("p.nc");
    fs::write(&copy, OLD).expect("written");
    let copy = copy.display().to_string();
    for (old, new) in [(copy.as_str(), "p.nc"), ("p.nc", copy.as_str())] {
        for machine in [
            &[][..],
            &["--isolated", "--enable", "X"],
            &["--config", "frictcomp.toml"],
        ] {
            let output = bench.call(&[&["diff", old, new], machine].concat());
            let shown = String::from_utf8_lossy(&output.stdout);
            assert_eq!(
                output.status.code(),
                Some(0),
                "{old} {new} {machine:?}: {shown}"
            );
            assert!(shown.contains("no difference: 2 changes"), "{shown}");
        }
    }
}

const CUTS: &str = "N10 X[COMP OFF FRICT]\nN20 G01 X10 F100\nN30 X22.5 Z1\nN40 G00 X99\n\
                    N50 G02 X5 Y5 I3\nN60 G01 X5\nN70 X[COMP ON FRICT] X10\nN80 M30\n";

#[test]
fn feed_moves_without_compensation_are_counted() {
    // R13.12: rapid motion and words without motion do not count, nor does an axis without
    // P-AXIS-00522; commands act before the motion of their block.
    let bench = Bench::new(&[("p.nc", CUTS), ("q.nc", "N10 G01 X10 F100\nN20 M30\n")]);
    let shown = bench.stdout(&["run", "p.nc"]);
    let cost = "X off during 3 feed moves, the longest known 12.5 mm";
    assert!(shown.contains(cost), "{shown}");
    assert!(!shown.contains("nothing to do"), "{shown}");
    assert!(bench.stdout(&["run", "q.nc"]).contains("nothing to do"));
    let records = bench.records(&["p.nc"]);
    let summary = json(records.last().expect("a summary"));
    let x = &summary["uncompensated"]["X"];
    assert_eq!(
        (&x["off"], &x["longest"], &x["unmeasured"]),
        (&3.into(), &12.5.into(), &2.into())
    );
    let statistics = bench.stdout(&["check", ".", "--statistics"]);
    assert!(
        statistics.contains("X off during 3 feed moves, the longest known 12.5 mm, in 1 program\n"),
        "{statistics}"
    );
    let _ = bench.call(&["run", "p.nc", "--html", "r.html"]);
    assert!(bench.read("r.html").contains(cost));
    let html = bench.read("r.html");
    assert!(!html.contains("nothing to do"));
}

#[test]
fn the_longest_move_counts_arcs() {
    // R11.31: forth and back along the arc, by either form of its centre, in a plane of its own, and with
    // the depth of a helix; a shift of the origin that only the machine knows changes no length.
    let off = "N10 X[COMP OFF FRICT] Y[COMP OFF FRICT] Z[COMP OFF FRICT]\nN20 G00 X10 Y0 Z0\n";
    for (blocks, lengths) in [
        ("G03 X10 Y0 I-10 J0 F500", [Some(40.0), Some(40.0), None]),
        ("G02 X0 Y-10 I-10 J0 F500", [Some(10.0), Some(10.0), None]),
        ("G03 X0 Y-10 I-10 J0 F500", [Some(30.0), Some(30.0), None]),
        ("G02 X-10 Y0 R10 F500", [Some(20.0), Some(20.0), None]),
        (
            "G02 X10 Y0 Z-3 I-10 J0 F500",
            [Some(40.0), Some(40.0), Some(3.0)],
        ),
        (
            "G01 X12 F500\nG03 X12 Y0 I1 J0",
            [Some(4.0), Some(4.0), None],
        ),
    ] {
        let program = format!("{off}{blocks}\nN90 M30\n");
        let bench = Bench::new(&[("p.nc", &program)]);
        let machine =
            ["X", "Y", "Z"].map(|name| format!("[[axis]]\nname = \"{name}\"\nfrict_comp = true\n"));
        bench.write("frictcomp.toml", &machine.concat());
        let records = bench.records(&["p.nc"]);
        let summary = json(records.last().expect("a summary"));
        for (axis, length) in ["X", "Y", "Z"].iter().zip(lengths) {
            let found = &summary["uncompensated"][axis];
            assert_eq!(
                found["longest"].as_f64(),
                length,
                "{blocks} {axis}: {found}"
            );
            assert!(
                found["unmeasured"].as_u64().unwrap_or(0) == 0,
                "{blocks} {axis}: {found}"
            );
        }
    }
}
