//! The lints if a state is not known offline.

use super::program::machine_text;
use crate::support::Bench;

fn said(programs: &[&str]) -> String {
    Bench::on(&machine_text())
        .keep_going()
        .said_in_session(programs)
}

#[test]
fn what_a_program_finds_counts_until_its_own_command() {
    // R1.52: a branch that may not be executed is not a command.
    let left = "X[COMP OFF FRICT]\nM30";
    let branch = "$IF V.E.A == 1\nX[COMP ON FRICT]\n$ENDIF\nX1\nM30";
    let both = said(&[left, branch]);
    assert!(
        both.contains(
            "FC403 4:1 axis `X` moves with friction compensation inactive if not V.E.A == 1 (line 1)"
        ),
        "{both}"
    );
    let alone = said(&[branch]);
    assert!(!alone.contains("FC403"), "{alone}");
    let set = said(&[
        left,
        "X[COMP ON FRICT]\n$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nX1\nM30",
    ]);
    assert!(!set.contains("FC403"), "{set}");
}

#[test]
fn what_may_be_left_is_said() {
    // R1.50, R14.5: at the last command that leaves it on some ways.
    let program =
        "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.E.B == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let said_of = said(&[program]);
    assert!(
        said_of.contains(
            "FC401 5:1 `FRICT` of axis `X` is left inactive after program end \
             if V.E.A == 1 (line 1), or if V.E.B == 1 (line 4)"
        ),
        "{said_of}"
    );
    let start_up = said(&["$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nX[COMP ON FRICT]\nM30"]);
    assert!(!start_up.contains("FC401"), "{start_up}");
}

#[test]
fn a_loop_without_an_end_is_left_by_a_reset() {
    // R1.28 R1.50 R2.84
    let program = "X[COMP OFF FRICT]\n$WHILE 1\nX1\n$ENDWHILE\nM30";
    let left = said(&[program]);
    assert!(
        left.contains(
            "FC401 1:1 `FRICT` of axis `X` is left inactive after the reset that ends it"
        ),
        "{left}"
    );
}

#[test]
fn a_program_that_never_ended_was_not_judged() {
    // R9.24: the comment may be useful once the error is corrected.
    let allow = "; frictcomp: allow FC401 FC407\nX[COMP OFF FRICT]\n";
    let stopped = Bench::on(&machine_text()).said(&format!("{allow}S[COMP ON FRICT]\nM30"));
    assert!(!stopped.contains("FC490"), "{stopped}");
    let ended = said(&[&format!("{allow}X[COMP ON FRICT]\nM30")]);
    assert!(ended.contains("FC490"), "{ended}");
}
