//! Variables that outlive programs, in an audit (R2.34, R10.9).

use super::{axis, bench, records, text};
use crate::folder::Bench;

/// A program that switches X off if a condition is true.
fn switches_if(before: &str, condition: &str) -> String {
    format!("{before}\n$IF {condition}\nX[COMP OFF FRICT]\n$ENDIF\nM30\n")
}

/// Declares a flag with a start value.
const DECLARED: &str = "#VAR\nV.S.FLAG : UNS32 = 0\n#ENDVAR";

/// The effect of `q.nc` on X among other programs.
fn effect(q: &str, others: &[&str]) -> String {
    let names = ["p.nc", "r.nc", "s.nc"];
    let others = names.iter().zip(others).map(|(name, text)| (*name, *text));
    let programs: Vec<(&str, &str)> = others.chain([("q.nc", q)]).collect();
    of(&bench(&programs))
}

fn of(bench: &Bench) -> String {
    let records = records(bench, &[]);
    let effect = &axis(&records, "q.nc", "X")["effect"];
    effect.as_str().expect("a word").to_owned()
}

#[test]
fn another_program_may_have_written_what_a_program_asks_for() {
    // R10.9, R10.11
    let writer = "V.S.FLAG = 1\nM30\n";
    for (before, condition) in [
        (DECLARED, "V.S.FLAG == 1"),
        ("", "V.S.FLAG == 1"),
        ("", "EXIST[V.S.FLAG]"),
        ("P1 = V.S.FLAG", "P1 == 1"),
        ("P1 = EXIST[V.S.FLAG]", "P1"),
        ("#VAR\nV.S.FLAG[2] = [0, 0]\n#ENDVAR", "V.S.FLAG[1] == 1"),
        ("", "V.S.FLAG[1] == 1"),
    ] {
        let q = switches_if(before, condition);
        let writer = if condition.contains("FLAG[") {
            "#VAR\nV.S.FLAG[2] = [0, 1]\n#ENDVAR\nM30\n"
        } else {
            writer
        };
        // One value that every program writes is known once the variable exists.
        let is_known = matches!(
            (before, condition),
            ("", "V.S.FLAG == 1") | ("P1 = V.S.FLAG", _)
        );
        let wanted = if is_known { "leaves off" } else { "depends" };
        assert_eq!(effect(&q, &[writer]), wanted, "{before} {condition}");
        let two = [writer, "V.S.FLAG = 0\nM30\n"];
        assert_eq!(effect(&q, &two), "depends", "{before} {condition}");
    }
}

#[test]
fn what_a_program_has_written_itself_is_known() {
    // R2.34
    let others = ["V.S.FLAG = 1\nM30\n", "V.S.FLAG = 5\nM30\n"];
    for (before, condition, wanted) in [
        ("V.S.FLAG = 0", "V.S.FLAG == 1", "keeps"),
        ("V.S.FLAG = 1", "V.S.FLAG == 1", "leaves off"),
        ("V.S.FLAG = 0", "EXIST[V.S.FLAG] == FALSE", "keeps"),
        ("#DELETE V.S.FLAG", "EXIST[V.S.FLAG]", "keeps"),
    ] {
        let q = switches_if(before, condition);
        assert_eq!(effect(&q, &others), wanted, "{before} {condition}");
    }
}

#[test]
fn a_variable_that_no_program_writes_is_not_there() {
    // R2.34: a declaration with one start value is the value; without one the control stops.
    assert_eq!(
        effect(&switches_if(DECLARED, "V.S.FLAG == 1"), &[]),
        "keeps"
    );
    assert_eq!(effect(&switches_if("", "V.S.FLAG == 1"), &[]), "unknown");
    assert_eq!(effect(&switches_if("", "EXIST[V.S.FLAG]"), &[]), "keeps");
}

#[test]
fn a_later_write_of_the_program_is_found_by_its_next_run() {
    // R2.34, R1.53
    let q =
        format!("{DECLARED}\n$IF V.S.FLAG == 1\nX[COMP OFF FRICT]\n$ENDIF\nV.S.FLAG = 1\nM30\n");
    assert_eq!(effect(&q, &[]), "depends");
    let q = "$IF EXIST[V.S.FLAG]\nX[COMP OFF FRICT]\n$ENDIF\nV.S.FLAG = 1\nM30\n";
    assert_eq!(effect(q, &[]), "depends");
}

#[test]
fn writes_behind_other_writes_are_found() {
    // R10.11: each program writes only after what another one wrote.
    let mode = "#VAR\nV.S.MODE = 0\n#ENDVAR\n$IF V.S.MODE == 1\nV.S.FLAG = 1\n$ENDIF\nM30\n";
    let q = switches_if(DECLARED, "V.S.FLAG == 1");
    assert_eq!(effect(&q, &[mode]), "keeps");
    assert_eq!(effect(&q, &[mode, "V.S.MODE = 1\nM30\n"]), "depends");
    // A called program that is not available may write anything.
    assert_eq!(effect(&q, &["L gone.nc\nM30\n"]), "depends");
    let unread = [
        "V.S.NAME[V.E.N] = 1\nM30\n",
        "$IF V.E.N == 1\nV.S.FLAG = 1\n$ENDIF\nM30\n",
    ];
    assert_eq!(effect(&q, &unread), "depends");
    assert_eq!(effect(&q, &unread[..1]), "keeps");
}

#[test]
fn the_user_decides_a_found_value() {
    // R2.34, R2.36
    let q = switches_if("", "V.S.FLAG == 1");
    let bench = bench(&[
        ("p.nc", "V.S.FLAG = 1\nM30\n"),
        ("r.nc", "V.S.FLAG = 0\nM30\n"),
        ("q.nc", &q),
    ]);
    assert_eq!(of(&bench), "depends");
    let records = records(&bench, &["--set", "V.S.FLAG=0"]);
    assert_eq!(axis(&records, "q.nc", "X")["effect"], "keeps");
    assert!(text(&bench, &["audit", "q.nc", "p.nc", "r.nc"]).contains("V.S.FLAG == 1"));
}

#[test]
fn kept_parameters_outlive_programs_too() {
    // R2.33, R10.11
    let q = switches_if("", "EXIST[P5] && P5 == 1");
    let programs = [
        ("p.nc", "P5 = 1\nM30\n"),
        ("r.nc", "P5 = 0\nM30\n"),
        ("q.nc", q.as_str()),
    ];
    let bench = bench(&programs);
    assert_eq!(of(&bench), "keeps");
    let machine = format!("[machine]\nkeep_parameters = true\n{}", super::MACHINE);
    bench.write("frictcomp.toml", &machine);
    assert_eq!(of(&bench), "depends");
}
