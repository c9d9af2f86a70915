//! Every command that writes.

use std::fs;

use super::calls::{Range, survives};
use crate::folder::Bench;

const ON: &str = "X[COMP ON FRICT]\nG01 X10 F1000\nM30\n";
const OFF: &str = "X[COMP OFF FRICT]\nG01 X10 F1000\nM30\n";

/// Calls a command in a folder with programs, after other calls there.
#[track_caller]
fn survives_after(first: &[&[&str]], range: Range, call: &[&str]) {
    let bench = Bench::new(&[("a.nc", OFF), ("b.nc", ON)]);
    for call in first {
        let status = bench.status(call);
        assert!(status.is_some_and(|status| status < 2), "{call:?}");
    }
    survives(&bench, range, call);
}

/// Returns a folder of the demonstration.
fn demo(folder: &str) -> Bench {
    let bench = Bench::new(&[]);
    let from = crate::workspace::root().join("programs/demo");
    for entry in fs::read_dir(from.join(folder)).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_file() {
            let name = path.file_name().expect("a name");
            fs::copy(&path, bench.folder().join(name)).expect("copied");
        }
    }
    bench
}

#[test]
fn a_state() {
    // R9.95
    let first = ["run", "--state", "s.json", "a.nc"];
    survives_after(&[], Range::Whole, &first);
    let second = ["run", "--state", "s.json", "b.nc"];
    survives_after(&[&first], Range::Whole, &second);
}

#[test]
fn several_results_of_a_run() {
    // R9.95
    let call = |program| {
        [
            "run", "--state", "s.json", "--html", "r.html", "--format", "csv", "-o", "r.csv",
            program,
        ]
    };
    survives_after(&[&call("a.nc")], Range::FullDisk, &call("b.nc"));
}

#[test]
fn results_on_standard_output() {
    // R9.95
    for (format, range) in [("csv", Range::Whole), ("json", Range::FullDisk)] {
        let call = ["run", "--state", "s.json", "--format", format, "b.nc"];
        survives_after(&[], range, &call);
    }
}

#[test]
fn fixes() {
    // R9.95
    let lower = "x[comp on frict]\ng01 x10 f1000\nm30\n";
    let bench = Bench::new(&[("a.nc", lower), ("b.nc", lower)]);
    survives(&bench, Range::Whole, &["check", "--fix", "a.nc", "b.nc"]);
}

#[test]
fn mended_archives() {
    // R9.95
    let moving = "G01 X10 F1000\nM30\n";
    let bench = Bench::new(&[("a.nc", OFF), ("b.nc", OFF), ("c.nc", moving)]);
    let call = ["audit", "--fix=leavers", "."];
    survives(&bench, Range::Whole, &call);
}

#[test]
fn what_was_agreed_on() {
    // R9.95
    let bench = Bench::new(&[("a.nc", OFF), ("b.nc", ON)]);
    bench.write("a.nc.timeline", "old\n");
    survives(&bench, Range::Whole, &["golden", "--update", "."]);
}

#[test]
fn results_of_programs() {
    // R9.95
    for call in [
        &["check", "-o", "r.sarif", "--format", "sarif", "."][..],
        &["audit", "-o", "r.txt", "--html", "r.html", "."],
        &["diff", "-o", "r.txt", "--html", "r.html", "a.nc", "b.nc"],
        &[
            "current", "a.nc", "--axis", "X", "--start", "X0", "-o", "r.csv", "--svg", "r.svg",
        ],
    ] {
        survives_after(&[], Range::FullDisk, call);
    }
}

#[test]
fn results_of_lists() {
    // R9.95
    let bench = demo("drive");
    let call = ["lists", "hochlauf.lis", "-o", "r.txt", "--svg", "r.svg"];
    survives(&bench, Range::FullDisk, &call);
    let call = ["drive", "hochlauf.lis", "-o", "r.txt"];
    survives(&bench, Range::FullDisk, &call);
    fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
    survives(&bench, Range::Whole, &["init", "."]);
}

#[test]
fn results_of_recordings() {
    // R9.95
    let files = ["-o", "r.txt", "--svg", "r.svg", "--html", "r.html"];
    let bench = demo("recordings");
    let identify = [
        "identify",
        "friction_x.csv",
        "--velocity",
        "SetVelo",
        "--torque",
        "ActTorque",
    ];
    for call in [&["trace", "friction_x.csv"][..], &identify] {
        survives(&bench, Range::FullDisk, &[call, &files].concat());
    }
}

#[test]
#[ignore = "minutes: `scripts/full`"]
fn results_of_contours() {
    // R9.95
    let bench = demo("contour");
    let contour = [
        "contour", "plate.nc", "--start", "X0,Y0,Z0", "--html", "r.html", "-o", "r.txt", "--svg",
        "r.svg",
    ];
    survives(&bench, Range::FullDisk, &contour);
    let agreed = ["golden", "--contour", "--update", "plate.nc"];
    survives(&bench, Range::FullDisk, &agreed);
}

#[test]
#[ignore = "minutes: `scripts/full`"]
fn results_of_circles() {
    // R9.95
    let bench = demo("contour");
    let files = ["-o", "r.txt", "--svg", "r.svg"];
    let circle = [
        "circle", "--radius", "5", "--feed", "5000", "--html", "r.html",
    ];
    survives(&bench, Range::FullDisk, &[&circle[..], &files].concat());
    let tune = [
        "tune",
        "--accelerations",
        "70",
        "--no-shaping",
        "--write-list",
        "r.lis",
    ];
    survives(&bench, Range::FullDisk, &[&tune[..], &files].concat());
    let call = [&tune[..], &["--into", "lists"]].concat();
    survives(&bench, Range::FullDisk, &call);
}

#[test]
#[ignore = "minutes: `scripts/full`"]
fn manual_pages() {
    // R9.95
    let bench = Bench::new(&[]);
    survives(&bench, Range::FullDisk, &["man", "--into", "pages"]);
}
