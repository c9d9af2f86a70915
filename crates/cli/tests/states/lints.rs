//! The lints on use, rule by rule.

use insta::assert_snapshot;

use super::program::machine_text;
use crate::support::{Bench, SourceMode};

/// The messages under each program of a session: code, place, message, advice.
fn said(programs: &[&str]) -> String {
    Bench::on(&machine_text())
        .keep_going()
        .said_in_session(programs)
}

#[test]
fn what_is_left_away_from_home_is_said_at_the_last_command() {
    // R1.50: also where that command changed nothing.
    assert_snapshot!(said(&["X[COMP OFF FRICT]\nX1\nX[COMP OFF FRICT]\nM30"]), @"
    FC402 3:1 this command repeats an earlier one: `FRICT` of axis `X` is already off
      1:1: the earlier one
    FC401 3:1 `FRICT` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 4: `X[COMP ON FRICT]`
    ");
    // A state that a program found and did not touch, or brought back to its start-up state, does not concern it.
    let left = "X[COMP OFF FRICT]\nM30";
    assert_snapshot!(said(&[left, "G90\nM30", "X[COMP OFF FRICT]\nX1\nX[COMP ON FRICT]\nM30"]), @"
    FC401 1:1 `FRICT` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 2: `X[COMP ON FRICT]`
    b.nc
    c.nc
    ");
    // Set to its current state, and left.
    assert_snapshot!(said(&[left, "X[COMP OFF FRICT]\nX1\nM30"]), @"
    FC401 1:1 `FRICT` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 2: `X[COMP ON FRICT]`
    b.nc
    FC401 1:1 `FRICT` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 3: `X[COMP ON FRICT]`
    ");
}

#[test]
fn every_kind_counts_by_itself() {
    // R1.50 R1.53: CROSS of X is switched off at program end and is in its start-up state there.
    assert_snapshot!(said(&["X[COMP OFF FRICT LEAD]\nX1\nX[COMP ON FRICT CROSS]\nM30"]), @"
    FC401 1:1 `LEAD` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 4: `X[COMP ON LEAD]`
    ");
    assert_snapshot!(said(&["X[COMP OFF LEAD]\nX1\nX[COMP OFF_ALL]\nM30"]), @"
    FC401 3:1 `LEAD` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 4: `X[COMP ON LEAD]`
    FC407 3:1 the second run differs from the first: line 2 moves axis `X` before the program sets `FRICT`, and line 3 leaves it inactive
      help: set it before the first motion, and restore it before M30 in line 4: `X[COMP ON FRICT]`
      2:1: the axis moves here first
    ");
}

#[test]
fn a_repeat_is_one_of_the_same_program() {
    // R1.51
    assert_snapshot!(said(&[
        "X[COMP ON FRICT]\nX[COMP ON FRICT LEAD]\nX[COMP ON LEAD]\nX[COMP ON LEAD FRICT]\nM30",
        "X[COMP ON FRICT]\nM30",
    ]), @"
    FC402 3:1 this command repeats an earlier one: `LEAD` of axis `X` is already on
      2:1: the earlier one
    FC402 4:1 this command repeats an earlier one: `LEAD FRICT` of axis `X` is already on
      3:1: the earlier one
    b.nc
    ");
    // R18.3: switching off an axis without friction compensation, also with the first command.
    assert_snapshot!(said(&["Z[COMP OFF FRICT]\nZ[COMP OFF_ALL]\nZ[COMP ON LEAD]\nZ[COMP OFF CROSS]\nM30"]), @"
    FC402 1:1 this command changes nothing: `FRICT` of axis `Z` is not configured
      help: P-AXIS-00522 (lr_param.frict_comp) of axis `Z` is 0 (frictcomp.toml:15); set it to 1 if the axis is to be compensated
    FC402 4:1 this command changes nothing: `CROSS` of axis `Z` is not configured
    ");
    // A refused command counts as absent; something unknown is in between.
    assert_snapshot!(said(&[
        "Z[COMP ON FRICT]\nZ[COMP OFF FRICT]\nX[COMP ON FRICT]\n$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\nX[COMP ON FRICT]\nM30",
    ]), @"
    P-ERR-70495 1:1 friction compensation of axis `Z` is switched on, but P-AXIS-00522 is not set
      help: frictcomp.toml:15 sets P-AXIS-00522 (lr_param.frict_comp) to 0; set it to 1 and restart the control
      help: to continue as if it were set, run with `--enable Z`
    FC402 2:1 this command changes nothing: `FRICT` of axis `Z` is not configured
      help: P-AXIS-00522 (lr_param.frict_comp) of axis `Z` is 0 (frictcomp.toml:15); set it to 1 if the axis is to be compensated
    FC901 4:5 this condition depends on `V.E.A`, which only the machine knows; every way is followed, and where they meet what differs is unknown: `FRICT` of `X`
      help: give it with `--set V.E.A=VALUE` or in `[variables]` of frictcomp.toml
    ");
    // In a loop and from a subprogram.
    assert_snapshot!(said(&[
        "%L S\nY[COMP ON FRICT]\nM17\n%M\n$FOR P1=1,2,1\nX[COMP ON FRICT]\n$ENDFOR\nY[COMP ON FRICT]\nLL S\nM30",
    ]), @"
    FC402 6:1 this command repeats an earlier one: `FRICT` of axis `X` is already on
    FC402 2:1 this command repeats an earlier one: `FRICT` of axis `Y` is already on
      8:1: the earlier one
    ");
}

#[test]
fn who_made_it_so_is_named() {
    // R1.52: the last command that left it away from its start-up state, of whichever program.
    assert_snapshot!(said(&[
        "%FIRST\nN10 X[COMP OFF FRICT] (off) ; measured\nM30",
        "%SECOND\nX[COMP OFF FRICT NO_MOVE] (measured) ; again\nX1\nM30",
        "G01 Y1 F100\nX1\nX[COMP ON FRICT]\nM30",
        "X1\nM30",
    ]), @"
    FC401 2:5 `FRICT` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 3: `X[COMP ON FRICT]`
    b.nc
    FC401 2:1 `FRICT` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 4: `X[COMP ON FRICT]`
    c.nc
    FC403 2:1 axis `X` moves with friction compensation inactive, left so by `X[COMP OFF FRICT NO_MOVE]` at b.nc:2 of program `SECOND`
      help: set it at program start, `X[COMP ON FRICT]` or `X[COMP OFF FRICT]`
    d.nc
    ");
    // The state that a region may have changed is not known.
    assert_snapshot!(said(&["$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\nX1\nM30", "X1\nM30"]), @"
    FC901 1:5 this condition depends on `V.E.A`, which only the machine knows; every way is followed, and where they meet what differs is unknown: `FRICT` of `X`
      help: give it with `--set V.E.A=VALUE` or in `[variables]` of frictcomp.toml
    FC401 2:1 `FRICT` of axis `X` is left inactive after program end if V.E.A (line 1); the control starts with it active
      help: restore it before M30 in line 5: `X[COMP ON FRICT]`
    b.nc
    FC403 1:1 axis `X` moves with friction compensation inactive if V.E.A (a.nc:1), else active, left so by `X[COMP OFF FRICT]` at a.nc:2
      help: set it at program start, `X[COMP ON FRICT]` or `X[COMP OFF FRICT]`
    ");
}

#[test]
fn motion_before_the_first_command_makes_the_second_run_differ() {
    // R1.53: also where the axis was found away from its start-up state; FC403 is given with it.
    let program = "X1\nX[COMP OFF FRICT]\nX2\nM30";
    assert_snapshot!(said(&[program, program]), @"
    FC407 2:1 the second run differs from the first: line 1 moves axis `X` before the program sets `FRICT`, and line 2 leaves it inactive
      help: set it before the first motion, and restore it before M30 in line 4: `X[COMP ON FRICT]`
      1:1: the axis moves here first
    b.nc
    FC403 1:1 axis `X` moves with friction compensation inactive, left so by `X[COMP OFF FRICT]` at a.nc:2
      help: set it at program start, `X[COMP ON FRICT]` or `X[COMP OFF FRICT]`
    FC407 2:1 the second run differs from the first: line 1 moves axis `X` before the program sets `FRICT`, and line 2 leaves it inactive
      help: set it before the first motion, and restore it before M30 in line 4: `X[COMP ON FRICT]`
      1:1: the axis moves here first
    ");
    // In one block the command comes first.
    assert_snapshot!(said(&["X1 X[COMP OFF FRICT]\nX2\nM30"]), @"
    FC405 1:4 COMP and motion share a block; the command takes effect before the motion
      help: write the command in a separate block
    FC401 1:4 `FRICT` of axis `X` is left inactive after program end; the control starts with it active
      help: restore it before M30 in line 3: `X[COMP ON FRICT]`
    ");
    // At start_up in the end: no difference.
    assert_snapshot!(said(&["X1\nX[COMP OFF FRICT]\nX2\nX[COMP ON FRICT]\nM30"]), @"");
}

#[test]
fn remarks_on_the_text_of_a_command() {
    // R1.54 R1.55 R1.56
    assert_snapshot!(said(&["x[COMP ON FRICT]\nX[comp ON FRICT FRICT] Y1\nM30"]), @r#"
    P-ERR-21947 1:1 the machine has no axis `x`
      help: did you mean `X`?
      help: the configuration lists all axes: X, Y, Z, B
      help: if the machine has axis `x`, add it: `[[axis]]` with `name = "x"` in `frictcomp.toml`
    FC405 2:1 COMP and motion share a block; the command takes effect before the motion
      help: write the command in a separate block
    FC404 2:3 keyword `comp` is not in upper case
      help: write `COMP`
    FC406 2:17 kind `FRICT` is named twice in this bracket; it counts once
    "#);
}

#[test]
fn an_error_leaves_the_state_that_is_there() {
    // R18.10 R1.53: the program is not blamed for blocks that it did not reach.
    let bench = Bench::on(&machine_text());
    assert_snapshot!(bench.said_in_session(&["X1\nX[COMP OFF FRICT]\nZ[COMP ON FRICT]\nM30"]), @"
    P-ERR-70495 3:1 friction compensation of axis `Z` is switched on, but P-AXIS-00522 is not set
      help: frictcomp.toml:15 sets P-AXIS-00522 (lr_param.frict_comp) to 0; set it to 1 and restart the control
      help: to continue as if it were set, run with `--enable Z`
    FC407 2:1 the second run differs from the first: line 1 moves axis `X` before the program sets `FRICT`, and line 2 leaves it inactive
      help: set it before the first motion, and restore it before the error in line 3: `X[COMP ON FRICT]`
      1:1: the axis moves here first
      3:1: an error ends the program here
    ");
}

#[test]
fn an_allow_comment_that_stands_above_no_block_is_said() {
    // R9.24
    let off = "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n";
    for (program, unused) in [
        // Any number of lines directly above each other apply to one block.
        (
            "X[COMP ON FRICT]\n; frictcomp: allow FC402\n; frictcomp: allow FC401\nX[COMP ON FRICT]\n",
            "3:",
        ),
        ("; frictcomp: allow FC402 here\n\nX1\n", "1:1"),
        ("; frictcomp: allow FC402\n; a word\nX1\n", "1:1"),
        ("; frictcomp: allow FC402\n%MAIN\nX1\n", "1:1"),
        ("X1\nM30\n; frictcomp: allow FC402", "3:1"),
        (
            "(frictcomp: allow FC402)\n#COMMENT BEGIN\n#COMMENT END\nX1\n",
            "1:1",
        ),
    ] {
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            let rest = if program.contains("M30") { "" } else { off };
            let text = format!("{program}{rest}");
            let bench = Bench::new().check_all().handed(handed);
            let said = bench.said(&text);
            let known = said.lines().filter(|line| line.starts_with("FC490"));
            let places: Vec<&str> = known.filter_map(|line| line.split(' ').nth(1)).collect();
            if unused == "3:" {
                assert_eq!(places, ["3:1"], "{text}\n{said}");
                assert!(!said.contains("FC402 4:"), "{text}\n{said}");
            } else {
                assert_eq!(places, [unused], "{text}\n{said}");
            }
        }
    }
    let misspelt = Bench::new()
        .check_all()
        .said("; frictcomp: alow FC402\n\nX1\nM30\n");
    assert!(misspelt.contains("FC491 1:14"), "{misspelt}");
    // Other lines may contain anything.
    let other = Bench::new()
        .check_all()
        .said("; frictcomp: hall 2\n\nX1\nM30\n");
    assert!(!other.contains("FC49"), "{other}");
}

#[test]
fn the_command_is_named_that_leaves_a_state_on_the_way_that_has_it() {
    // R1.50 R1.53 R14.5: the way through line 4 ends with the initial state of the control.
    let program = "X[COMP OFF FRICT]\n$IF V.E.A == 1\nX[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n\
                   $ELSE\nX10\n$ENDIF\nM30";
    let left = said(&[program]);
    assert!(
        left.contains("FC401 1:1 `FRICT` of axis `X` is left inactive"),
        "{left}"
    );
    // The other way ends before, on or off.
    let program = "X[COMP OFF FRICT]\n$IF V.E.A == 1\nX[COMP ON FRICT]\n$IF V.E.B == 1\nX[COMP OFF FRICT]\n\
                   M30\n$ENDIF\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let left = said(&[program, "X1\nM30"]);
    assert!(
        left.contains("FC401 8:1 `FRICT` of axis `X` is left inactive after"),
        "{left}"
    );
    assert!(
        left.contains("left so by `X[COMP OFF FRICT]` at a.nc:8"),
        "{left}"
    );
    let program = "X1\n$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let second = "FC407 3:1 the second run differs from the first: line 1 moves axis `X` before the program sets \
                  `FRICT`, and line 3 leaves it inactive if V.E.A == 1 (line 2)";
    let left = said(&[program]);
    assert!(left.contains(second), "{left}");
}

#[test]
fn what_a_loop_without_an_end_leaves_is_restored_in_it() {
    // R1.50
    let left = said(&["X[COMP OFF FRICT]\n$WHILE 1\nG4 1\n$ENDWHILE\nM30"]);
    let advice = "help: restore it in the loop, which only a reset ends: `X[COMP ON FRICT]`";
    assert!(
        left.contains(advice) && !left.contains("before M30"),
        "{left}"
    );
}
