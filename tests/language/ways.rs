//! 2.7: ways that the control may take and the dry run does not.

use frictcomp::comp::{AxisIndex, Kind, State};

use crate::support::{Bench, SourceMode};

/// Programs that may take another way because of an unknown value, with the final state of X.
const PROGRAMS: [(&str, State); 24] = [
    // The program may end in a branch.
    (
        "X[COMP OFF FRICT]\n$IF V.E.A==1\nM30\n$ENDIF\nX[COMP ON FRICT]\nM30",
        State::Unknown,
    ),
    (
        "X[COMP OFF FRICT]\n$IF V.E.A==1\nX1\n$ELSE\nM02\n$ENDIF\nX[COMP ON FRICT]\nM30",
        State::Unknown,
    ),
    (
        "X[COMP OFF FRICT]\n$WHILE V.E.A==1\nM30\n$ENDWHILE\nX[COMP ON FRICT]\nM30",
        State::Unknown,
    ),
    (
        "$IF V.E.A==1\nM30\n$ENDIF\nX[COMP OFF FRICT]\nX1\nX[COMP ON FRICT]\nM30",
        State::Active,
    ),
    (
        "%L S\nM30\n%MAIN\nX[COMP OFF FRICT]\n$IF V.E.A==1\nLL S\n$ENDIF\nX[COMP ON FRICT]\nM30",
        State::Unknown,
    ),
    (
        "%L S\n$IF V.E.A==1\nM30\n$ENDIF\nM17\n%MAIN\nX[COMP OFF FRICT]\nLL S\nX[COMP ON FRICT]\nM30",
        State::Unknown,
    ),
    (
        "X[COMP OFF FRICT]\n\"OUT\" = \"M30\"\n$IF V.E.A==1\n\"OUT\"\n$ENDIF\nX[COMP ON FRICT]\nM30",
        State::Unknown,
    ),
    // The subprogram may be left.
    (
        "%L S\n$IF V.E.A==1\nM17\n$ENDIF\nX[COMP ON FRICT]\nM17\n%MAIN\nX[COMP OFF FRICT]\nLL S\nX1\nM30",
        State::Unknown,
    ),
    (
        "%L S\n$IF V.E.A==1\nM29\n$ENDIF\nP1=1\nM17\n%MAIN\nP1=0\nLL S\n$IF P1==1\nX[COMP OFF FRICT]\n$ENDIF\nM30",
        State::Unknown,
    ),
    (
        "%L T\n$IF V.E.A==1\nM17 [JUMPS=2]\n$ENDIF\nM17\n%L S\nLL T\nX[COMP ON FRICT]\nM17\n%MAIN\nX[COMP OFF FRICT]\nLL S\nM30",
        State::Unknown,
    ),
    // Jumps.
    (
        "X[COMP OFF FRICT]\n$IF V.E.A==1\n$GOTO N100\n$ENDIF\nX[COMP ON FRICT]\nN100: X1\nM30",
        State::Unknown,
    ),
    (
        "X[COMP OFF FRICT]\n$IF V.E.A==1 $GOTO N100\nX[COMP ON FRICT]\nN100: X1\nM30",
        State::Unknown,
    ),
    (
        "X[COMP OFF FRICT]\n$IF V.E.A==1 $GOTO [OUT]\nX[COMP ON FRICT]\n[OUT] X1\nM30",
        State::Unknown,
    ),
    (
        "$IF V.E.A==1 $GOTO N100\nX[COMP OFF FRICT]\nX1\nX[COMP ON FRICT]\nN100: X1\nM30",
        State::Active,
    ),
    (
        "X[COMP OFF FRICT]\n$GOTO V.E.A\nX[COMP ON FRICT]\nN1: X1\nN2: M30",
        State::Unknown,
    ),
    (
        "$IF V.E.A==1 $GOTO N100\n$GOTO N200\nN100: X[COMP OFF FRICT]\nN200: M30",
        State::Unknown,
    ),
    (
        "$IF V.E.A==1 $GOTO N100\nX1\nM30\nN100: X[COMP OFF FRICT]\nM30",
        State::Unknown,
    ),
    (
        "P1=0\n$IF V.E.A==1 $GOTO N100\nP1=1\nN100: $IF P1==1\nX[COMP OFF FRICT]\n$ENDIF\nM30",
        State::Unknown,
    ),
    (
        "P1=V.E.A\nN10: X[COMP OFF FRICT]\nX[COMP ON FRICT]\nP1=P1-1\n$IF P1>0 $GOTO N10\nX1\nM30",
        State::Unknown,
    ),
    // Jumps in the part that a jump back repeats may lead elsewhere, too.
    (
        "P1=V.E.A\nP2=0\nN10: $IF P2==1 $GOTO N90\nP2=1\n$IF P1==1 $GOTO N10\nM30\nN90: X[COMP OFF FRICT]\nM30",
        State::Unknown,
    ),
    // Loops.
    (
        "$FOR P1=1,3,1\nX[COMP OFF FRICT]\n$IF V.E.A==1\n$BREAK\n$ENDIF\nX[COMP ON FRICT]\n$ENDFOR\nM30",
        State::Unknown,
    ),
    (
        "$FOR P1=1,3,1\nX[COMP OFF FRICT]\n$IF V.E.A==1\n$CONTINUE\n$ENDIF\nX[COMP ON FRICT]\n$ENDFOR\nM30",
        State::Unknown,
    ),
    (
        "$FOR P1=1,3,1\n$IF V.E.A==1\n$BREAK\n$ENDIF\n$ENDFOR\n$IF P1>3\nX[COMP OFF FRICT]\n$ENDIF\nM30",
        State::Unknown,
    ),
    (
        "P1=0\n$REPEAT\nP1=P1+1\n$IF V.E.A==P1 $GOTO N10\nX[COMP OFF FRICT]\n$UNTIL P1>=3\nX[COMP ON FRICT]\nN10: M30",
        State::Unknown,
    ),
];

fn left(bench: &Bench, program: &str) -> (State, String) {
    let mut session = bench.session();
    let said = bench.run_in(&mut session, &[program]);
    (session.state().state(AxisIndex::new(0), Kind::Frict), said)
}

#[test]
fn what_another_way_leaves_otherwise_is_unknown() {
    // R2.51 R2.52
    for (program, expected) in PROGRAMS {
        let bench = || Bench::new().passing_branches().keep_going();
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            let (claimed, said) = left(&bench().handed(handed), program);
            assert_eq!(claimed, expected, "{program}\n{said}");
            assert!(said.contains("FC90"), "{program}\n{said}");
        }
        for value in [0.0, 1.0, 2.0] {
            let (left, said) = left(&bench().set("V.E.A", value), program);
            // Without an end, the state that a run would have left is unknown.
            let never_ends = said.contains("FC910");
            assert!(
                never_ends || expected == State::Unknown || left == expected,
                "{program}\n{value}: {said}"
            );
        }
    }
}

#[test]
fn a_way_changes_what_later_programs_find() {
    // R2.52: the program may have ended before it wrote the variable.
    let first = "#VAR\nV.S.N\n#ENDVAR\nV.S.N=0\n$IF V.E.A==1\nM30\n$ENDIF\nV.S.N=1\nM30";
    let second = "$IF V.S.N==1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let bench = Bench::new();
    let mut session = bench.session();
    let said = bench.run_in(&mut session, &[first, second]);
    let state = session.state().state(AxisIndex::new(0), Kind::Frict);
    assert_eq!(state, State::Unknown, "{said}");
}

#[test]
fn a_condition_that_cannot_be_computed_is_unknown() {
    // R2.51 R2.71: one message, and no branch is taken for true.
    for head in ["$IF P1 == 1", "$IF 1/0", "$WHILE P1", "$IF \"TEXT\""] {
        let tail = if head.starts_with("$WHILE") {
            "$ENDWHILE"
        } else {
            "$ENDIF"
        };
        let program = format!("X[COMP OFF FRICT]\n{head}\nX[COMP ON FRICT]\n{tail}\nM30");
        let (left, said) = left(&Bench::new().keep_going(), &program);
        assert_eq!(left, State::Unknown, "{said}");
        assert!(!said.contains("FC901"), "{said}");
    }
    let program = "X[COMP OFF FRICT]\n$IF P1==1 $GOTO N10\nX[COMP ON FRICT]\nN10: M30";
    let (left, said) = left(&Bench::new().keep_going(), program);
    assert_eq!(left, State::Unknown, "{said}");
}

#[test]
fn skipped_blocks_change_nothing_in_a_branch_either() {
    // R2.3 R2.51
    let program = "$IF V.E.A==1\n/X[COMP OFF FRICT]\n$ENDIF\nM30";
    assert_eq!(left(&Bench::new().skip("1"), program).0, State::Active);
    assert_eq!(left(&Bench::new(), program).0, State::Unknown);
}

#[test]
fn a_control_block_names_what_it_makes_unknown() {
    // R2.51: including the programs that it calls.
    let program =
        "%L S\nY[COMP OFF FRICT]\nM17\n%MAIN\n$IF V.E.A==1\nX[COMP OFF FRICT]\nLL S\n$ENDIF\nM30";
    let said = Bench::new().said(program);
    assert!(said.contains("`FRICT` of `X` `Y`"), "{said}");
}

#[test]
fn a_required_compensation_that_is_unknown_is_said() {
    // R1.36 R2.51 R2.52: where ways are known, those without it end (R14.5).
    let machine = "[[axis]]\nname = \"X\"\nfrict_comp = true\nrequired = [\"FRICT\"]\n\
                   value = { mode = 3, table = [[0, 12], [1800, 10]] }\n";
    let program = "X1\n$IF V.E.A==1\nX[COMP OFF FRICT]\n$ENDIF\nX2\nM30";
    let passed = Bench::on(machine).passing_branches().said(program);
    assert!(
        passed.contains("FC902 5:1 whether axis `X` moves"),
        "{passed}"
    );
    let followed = Bench::on(machine).said(program);
    assert!(followed.contains("P-ERR-70435 5:1 "), "{followed}");
}

#[test]
fn a_refused_command_wins_nothing() {
    // R1.24 R1.31
    let said = Bench::new()
        .keep_going()
        .said("Z[COMP OFF FRICT] Z[COMP ON FRICT]\nM30");
    assert!(
        said.contains("P-ERR-70495") && !said.contains("FC301"),
        "{said}"
    );
}
