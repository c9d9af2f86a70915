//! Errors that end some of the ways through a program (R18.10, R2.100).

use frictcomp::comp::{AxisIndex, Kind, State};

use crate::support::Bench;

/// The machine of these programs: X is compensated, W is not.
const MACHINE: &str =
    "[[axis]]\nname = \"X\"\nenable = true\n[[axis]]\nname = \"W\"\nfrict_comp = false\n";

/// Returns the state of X at the end, in words.
fn left(bench: &Bench, program: &str) -> String {
    let mut session = bench.session();
    bench.run_in(&mut session, &[program]);
    let view = session.state();
    let state = view.state(AxisIndex::new(0), Kind::Frict);
    let possible = view.possible.first();
    match possible.filter(|_| state == State::Unknown) {
        Some(possible) => possible.in_words("a.nc"),
        None => state.as_str().to_owned(),
    }
}

#[test]
fn the_state_at_an_error_of_one_way_is_one_of_the_next_program() {
    // R18.10, R14.5
    let parts = "X[COMP OFF FRICT]\n@\nX[COMP ON FRICT]\nM30\n";
    for (part, words) in [
        (
            "$IF V.E.A\n#ERROR [ID=5 RC=2]\n$ENDIF",
            "inactive if V.E.A (line 2), else active",
        ),
        (
            "$IF V.E.A\nW[COMP ON FRICT]\n$ENDIF",
            "inactive if V.E.A (line 2), else active",
        ),
        (
            "$IF V.E.A\nL NIX.NC\n$ENDIF",
            "inactive if V.E.A (line 2), else active",
        ),
        // R2.110
        (
            "G1 X10",
            "inactive if error 20008 ends the program (line 2), else active",
        ),
        (
            "G1 X10 F0\nX20 F0",
            "inactive if error 20008 ends the program (line 2), else active",
        ),
        ("G1 X10 F100", "active"),
        ("G1 X10 F-1", "active"),
        (
            "/#ERROR [ID=5 RC=2]",
            "inactive if skip level 1 is off, else active",
        ),
        (
            "$IF V.E.A\nX1\n$ELSE\n#ERROR [RC=1]\n$ENDIF",
            "inactive if not V.E.A (line 2), else active",
        ),
        (
            "$IF V.E.A $GOTO N9\n#ERROR [RC=1]\nN9: X1",
            "inactive if not V.E.A (line 2), else active",
        ),
        (
            "\"E\" = \"#ERROR [RC=2]\"\n$IF V.E.A\n\"E\"\n$ENDIF",
            "inactive if V.E.A (line 3), else active",
        ),
        (
            "$FOR P1=1,3,1\n$IF V.E.A\n#ERROR [RC=2]\n$ENDIF\n$ENDFOR",
            "inactive if V.E.A (line 3), else active",
        ),
        (
            "#ERROR [RC=V.E.A]",
            "inactive if V.E.A != 0 (line 2) and the control is only reset after the error (line 2), else active",
        ),
        (
            "#ERROR [ID=1]",
            "inactive if `#ERROR` ends the program (line 2), else active",
        ),
        (
            "$IF V.E.A\n$WHILE 1\n$ENDWHILE\n$ENDIF",
            "inactive if V.E.A (line 2), else active",
        ),
        ("$IF V.E.A\n#ERROR [RC=0]\n$ENDIF", "active"),
    ] {
        let program = parts.replace('@', part);
        assert_eq!(left(&Bench::on(MACHINE), &program), words, "{program}");
    }
    let sub = "%L S\n$IF V.E.A\n#ERROR [RC=2]\n$ENDIF\nM17\n%MAIN\nX[COMP OFF FRICT]\nLL S\nX[COMP ON FRICT]\nM30\n";
    assert_eq!(
        left(&Bench::on(MACHINE), sub),
        "inactive if V.E.A (line 2), else active"
    );
}

#[test]
fn check_says_what_an_error_leaves_and_goes_on() {
    // R18.10, R9.20
    let program = "X[COMP OFF FRICT]\n$IF V.E.A\n#ERROR [ID=5 RC=2]\nW[COMP ON FRICT]\n$ENDIF\nX[COMP ON FRICT]\nM30\n";
    let said = Bench::on(MACHINE).check_all().said(program);
    assert!(
        said.contains("after the error in line 3 if V.E.A (line 2)"),
        "{said}"
    );
    assert!(said.contains("P-ERR-70495"), "{said}");
    let certain = "X[COMP OFF FRICT]\n#ERROR [RC=2]\nX[COMP ON FRICT]\nM30\n";
    let said = Bench::on(MACHINE).check_all().said(certain);
    assert!(
        said.contains("is left inactive after the error in line 2"),
        "{said}"
    );
    assert_eq!(left(&Bench::on(MACHINE).keep_going(), program), "active");
}

#[test]
fn check_marks_what_runs_only_after_an_error() {
    // R9.20
    let marks = |program: &str| {
        let said = Bench::on(MACHINE).check_all().said(program);
        said.matches("mend line 2 first: the control stops there")
            .count()
    };
    let after = "X[COMP OFF FRICT]\nW[COMP ON FRICT]\nG1 X1 F1\n";
    assert_eq!(marks(&format!("{after}G1 X1 X2\nM30\n")), 2, "FC313, FC401");
    assert_eq!(
        marks(&format!("{after}FOO BAR\nX[COMP ON FRICT]\nM30\n")),
        1,
        "FC207, and not FC401 at the error itself"
    );
    let of_one_way = "$IF V.E.A\nW[COMP ON FRICT]\n$ENDIF\nG1 X1 F1\nX[COMP OFF FRICT]\nM30\n";
    assert_eq!(marks(of_one_way), 0, "another way goes on");
    let both =
        "$IF V.E.A\nW[COMP ON FRICT]\n$ELSE\n#ERROR [RC=2]\n$ENDIF\nX[COMP OFF FRICT]\nM30\n";
    assert_eq!(marks(both), 1, "FC401");
    let kept = Bench::on(MACHINE)
        .keep_going()
        .said(&format!("{after}M30\n"));
    assert!(!kept.contains("mend line"), "{kept}");
}

#[test]
fn a_system_error_is_followed_by_a_reset_or_a_restart() {
    // R2.100, R1.28, R1.29
    let program = "X[COMP OFF FRICT]\n#ERROR [RC=7]\nX[COMP ON FRICT]\nM30\n";
    let words = "inactive if the control is only reset after the error (line 2), else active";
    assert_eq!(left(&Bench::on(MACHINE), program), words);
    for (reading, state) in [
        ("R1.28\" = \"start-up", "active"),
        ("R1.29\" = \"kept", "inactive"),
    ] {
        let machine = format!("{MACHINE}[reading]\n\"{reading}\"\n");
        assert_eq!(left(&Bench::on(&machine), program), state, "{reading}");
    }
    for (reading, state) in [("goes-on", "active"), ("stops", "inactive")] {
        let machine = format!("{MACHINE}[reading]\n\"R2.100\" = \"{reading}\"\n");
        let program = program.replace("RC=7", "ID=7");
        assert_eq!(left(&Bench::on(&machine), &program), state, "{reading}");
    }
}
