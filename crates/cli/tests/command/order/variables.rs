//! Variables that outlive programs, in an audit (R2.34, R10.9).

use super::{axis, bench, records};
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
