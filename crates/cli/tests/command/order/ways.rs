//! The effects of programs on some ways only (R14.6).

use serde_json::{Value, json};

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

#[test]
fn records_have_the_ways_as_data() {
    // R14.6
    let text = "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 $ELSE\nN40 G01 X10 F100\nN50 $ENDIF\nN60 M30\n";
    let bench = bench(&[("a.nc", text)]);
    let condition = |holds: bool| json!({ "kind": "condition", "file": "a.nc", "line": 1, "text": "V.E.A == 1", "holds": holds });
    let found = of_x(&bench, "a.nc", &[]);
    assert_eq!(
        found["possible"],
        json!([
            { "state": "inactive", "ways": [[condition(true)]], "more": 0 },
            { "state": "ineffective", "ways": null },
        ])
    );
    assert_eq!(
        found["inherits"],
        json!({ "file": "a.nc", "line": 4, "motion": "feed", "perhaps": true, "ways": [[condition(false)]] })
    );
    for (value, effect) in [("1", "leaves off"), ("2", "keeps")] {
        let set = format!("V.E.A={value}");
        assert_eq!(of_x(&bench, "a.nc", &["--set", &set])["effect"], effect);
    }
}

#[test]
fn sides_that_agree_leave_nothing_open() {
    // R14.6 R10.9
    let both = "N10 $IF V.E.A == 1\nN20 X[COMP ON FRICT]\nN30 $ELSE\nN40 X[COMP ON FRICT]\nN50 $ENDIF\nN60 G01 X1 F100\nN70 M30\n";
    let bench = bench(&[("a.nc", both)]);
    let found = of_x(&bench, "a.nc", &[]);
    assert_eq!(
        (&found["effect"], &found["inherits"]),
        (&json!("leaves on"), &json!("no"))
    );
}

#[test]
fn a_side_that_moves_before_the_command_of_the_other_side_inherits() {
    // R14.6
    let other = "N10 $IF V.E.A == 1\nN20 X[COMP ON FRICT]\nN30 $ELSE\nN40 G01 X10 F100\nN50 X[COMP ON FRICT]\nN60 $ENDIF\nN70 M30\n";
    let behind =
        "N10 $IF V.E.A == 1\nN20 X[COMP ON FRICT]\nN30 $ENDIF\nN40 G01 X10 F100\nN70 M30\n";
    for text in [other, behind] {
        let bench = bench(&[("a.nc", text)]);
        let found = of_x(&bench, "a.nc", &[]);
        assert_eq!(found["inherits"]["line"], 4, "{found}");
        assert_eq!(found["inherits"]["ways"][0][0]["holds"], false, "{found}");
    }
}

#[test]
fn a_block_before_the_end_takes_a_program_out_of_the_hazards_on_every_way() {
    // R14.6 R10.3
    let early = "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 M30\nN40 $ENDIF\nN50 M30\n";
    let late = "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 G01 X1 F100\nN50 M30\n";
    for text in [early, late] {
        let bench = bench(&[("a.nc", text), MOVER]);
        let mended = bench.call(&["audit", "--fix=leavers", "."]);
        assert_eq!(mended.status.code(), Some(0));
        let found = of_x(&bench, "a.nc", &[]);
        let now = bench.read("a.nc");
        assert_eq!(found["possible"], Value::Null, "{now}");
        // The cut on the other way keeps its state.
        assert!(
            now.find("G01")
                .is_none_or(|cut| cut < now.find("COMP ON").expect("a mend")),
            "{now}"
        );
    }
}

#[test]
fn an_order_says_when_an_axis_is_left_off() {
    // R14.6 R10.6
    let off = "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 M30\n";
    let bench = bench(&[("a.nc", off), MOVER, ("order.txt", "a.nc\nmoves.nc\n")]);
    let shown = text(&bench, &["audit", "--sequence", "order.txt"]);
    let lines: Vec<&str> = shown.lines().collect();
    assert_eq!(
        lines[0],
        "a.nc: X on → unknown at line 2 (inactive if V.E.A == 1 (line 1), else ineffective)"
    );
    assert!(
        lines[1].starts_with("moves.nc: X stays unknown (inactive if V.E.A == 1 (a.nc:1)"),
        "{shown}"
    );
}
