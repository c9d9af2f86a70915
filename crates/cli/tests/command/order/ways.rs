//! The effects of programs on some ways only (R14.6).

use serde_json::Value;

use super::{bench, text};
use crate::folder::Bench;

const MOVER: (&str, &str) = ("moves.nc", "N10 G01 X1 F100\nN20 M30\n");

/// The entry of `X` in the record of a program.
fn of_x(bench: &Bench, file: &str, arguments: &[&str]) -> Value {
    let format = ["audit", "--format", "ndjson"];
    let shown = text(bench, &[&format, arguments, &["."]].concat());
    let records = shown.lines().map(serde_json::from_str::<Value>);
    let mut records = records.map(|record| record.expect("a record"));
    let record = records.find(|it| it["file"] == file && it["record"] == "program");
    record.expect("the program")["axes"]["X"].clone()
}

#[test]
fn a_program_that_leaves_an_axis_off_on_some_ways_is_a_hazard_that_says_when() {
    // R14.6
    let off_if_even = "N10 X[COMP ON FRICT]\n/1 N20 X[COMP OFF FRICT]\nN30 M30\n";
    let otherwise = "N10 $SWITCH V.E.M\nN20 $CASE 1\nN30 X[COMP ON FRICT]\nN40 $BREAK\nN50 $DEFAULT\nN60 X[COMP OFF FRICT]\nN70 $ENDSWITCH\nN80 M30\n";
    let called = "N10 L sub.nc\nN20 M30\n";
    let sub = "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 M17\n";
    let asks = "N10 $IF V.A.FRICT_COMP_ACTIVE.Y == 0 && V.E.A == 2\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 M30\n";
    for (main, says) in [
        (off_if_even, "a.nc:2, if skip level 1 is off"),
        (otherwise, "a.nc:6, if not V.E.M == 1 (line 1)"),
        (called, "a.nc (at sub.nc:2), if V.E.A == 1 (sub.nc:1)"),
        (asks, "a.nc:2, if Y is inactive at the start"),
    ] {
        let bench = bench(&[("a.nc", main), ("sub.nc", sub), MOVER]);
        let shown = text(&bench, &["audit", "a.nc", "moves.nc"]);
        assert!(shown.contains(&format!("    {says}")), "{shown}");
        assert!(
            shown.contains("1 program leaves X off, 1 runs with it off"),
            "{shown}"
        );
        assert_eq!(of_x(&bench, "a.nc", &[])["effect"], "depends");
        let strict = bench.call(&["audit", "--fail-on", "warning", "a.nc", "moves.nc"]);
        assert_eq!(strict.status.code(), Some(1));
    }
}
