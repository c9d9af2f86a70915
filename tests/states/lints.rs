//! The lints on use, rule by rule.

use insta::assert_snapshot;

use super::program::MACHINE;
use crate::support::Bench;

/// What is said under each program of a session: code, place, message, advice.
fn said(programs: &[&str]) -> String {
    Bench::on(MACHINE).keep_going().said_in_session(programs)
}

#[test]
fn what_is_left_away_from_home_is_said_at_the_last_command() {
    // R1.50: also where that command changed nothing.
    assert_snapshot!(said(&["X[COMP OFF FRICT]\nX1\nX[COMP OFF FRICT]\nM30"]), @"");
    // What a program found and did not touch, or brought home, is none of its business.
    let left = "X[COMP OFF FRICT]\nM30";
    assert_snapshot!(said(&[left, "G90\nM30", "X[COMP OFF FRICT]\nX1\nX[COMP ON FRICT]\nM30"]), @"");
    // Set to what it is already, and left.
    assert_snapshot!(said(&[left, "X[COMP OFF FRICT]\nX1\nM30"]), @"");
}

#[test]
fn every_kind_counts_by_itself() {
    // R1.50 R1.53: CROSS of X falls off at program end and is at home there.
    assert_snapshot!(said(&["X[COMP OFF FRICT LEAD]\nX1\nX[COMP ON FRICT CROSS]\nM30"]), @"");
    assert_snapshot!(said(&["X[COMP OFF LEAD]\nX1\nX[COMP OFF_ALL]\nM30"]), @"");
}

#[test]
fn a_repeat_is_one_of_the_same_program() {
    // R1.51
    assert_snapshot!(said(&[
        "X[COMP ON FRICT]\nX[COMP ON FRICT LEAD]\nX[COMP ON LEAD]\nX[COMP ON LEAD FRICT]\nM30",
        "X[COMP ON FRICT]\nM30",
    ]), @"");
    // Off what is not configured, but never the first command on an axis.
    assert_snapshot!(said(&["Z[COMP OFF FRICT]\nZ[COMP OFF_ALL]\nZ[COMP ON LEAD]\nZ[COMP OFF CROSS]\nM30"]), @"");
    // A refused command is as if it were not there; something unknown lies between.
    assert_snapshot!(said(&[
        "Z[COMP ON FRICT]\nZ[COMP OFF FRICT]\nX[COMP ON FRICT]\n$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\nX[COMP ON FRICT]\nM30",
    ]), @"");
    // In a loop and from a subprogram.
    assert_snapshot!(said(&[
        "%L S\nY[COMP ON FRICT]\nM17\n%M\n$FOR P1=1,2,1\nX[COMP ON FRICT]\n$ENDFOR\nY[COMP ON FRICT]\nLL S\nM30",
    ]), @"");
}

#[test]
fn who_made_it_so_is_named() {
    // R1.52: the last command that left it away from home, of whichever program.
    assert_snapshot!(said(&[
        "%FIRST\nN10 X[COMP OFF FRICT] (off) ; measured\nM30",
        "%SECOND\nX[COMP OFF FRICT NO_MOVE]\nX1\nM30",
        "G01 Y1 F100\nX1\nX[COMP ON FRICT]\nM30",
        "X1\nM30",
    ]), @"");
    // The state that a region may have changed is not known.
    assert_snapshot!(said(&["$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\nX1\nM30", "X1\nM30"]), @"");
}

#[test]
fn motion_before_the_first_command_makes_the_second_run_differ() {
    // R1.53: also where the axis was found away from home; FC403 stands beside it.
    let program = "X1\nX[COMP OFF FRICT]\nX2\nM30";
    assert_snapshot!(said(&[program, program]), @"");
    // In one block the command comes first.
    assert_snapshot!(said(&["X1 X[COMP OFF FRICT]\nX2\nM30"]), @"");
    // At home in the end: no difference.
    assert_snapshot!(said(&["X1\nX[COMP OFF FRICT]\nX2\nX[COMP ON FRICT]\nM30"]), @"");
}

#[test]
fn remarks_on_the_text_of_a_command() {
    // R1.54 R1.55 R1.56
    assert_snapshot!(said(&["x[COMP ON FRICT]\nX[comp ON FRICT FRICT] Y1\nM30"]), @"");
}

#[test]
fn an_error_ends_without_blame() {
    // R1.50 R1.53: the program is not blamed for what it did not come to; who made it so is known.
    let bench = Bench::on(MACHINE);
    assert_snapshot!(bench.said_in_session(&["X1\nX[COMP OFF FRICT]\nZ[COMP ON FRICT]\nM30"]), @"");
}
