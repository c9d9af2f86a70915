//! Chapter 1: the COMP command, rule by rule.

mod support;

use frictcomp::comp::{CompCommand, Kind, KindSet, Selection, State};
use frictcomp::machine::Machine;
use frictcomp::session::{Session, SessionOptions};
use frictcomp::syntax::parse_comp;
use frictcomp::text::SourceFile;
use insta::assert_snapshot;
use support::{Bench, MACHINE};

/// Every kind is configured.
const ALL_KINDS: &str = r#"
[[axis]]
name = "X"
type = "T"
frict_comp = true
compensations = ["BACKLASH", "CROSS", "PLANE", "LEAD", "TEMP", "FRICT", "CROSSTALK"]
value = { mode = 3, table = [[0, 12], [1800, 10]] }
"#;

#[test]
fn the_documented_example() {
    // R1.22 R1.23 R1.27 R1.30 R9.12 R9.13
    let program = "%FRICTION\n\
        N15 X[COMP ON FRICT] ;Activates X axis\n\
        N25 Y[COMP OFF FRICT] ;Deactivates Y axis\n\
        N35 X22 Y33 Z44\n\
        N45 X[COMP OFF FRICT] ;Deactivates X axis\n\
        N55 M30 ;Program end\n";
    assert_snapshot!(Bench::new().run(&[program, "X1\nM30\n"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc FRICTION
      1 line 2 N15
      2 line 3 N25 Y:active>inactive
      3 line 4 N35
      4 line 5 N45 X:active>inactive
      5 line 6 N55
        FC401 5:5-22
        FC401 3:5-22
      end 5 M30 X:inactive Y:inactive Z:unconfigured B:ineffective
    b.nc -
      1 line 1 -
      2 line 2 -
        FC403 1:1-3
      end 2 M30 X:inactive Y:inactive Z:unconfigured B:ineffective
    ");
}

#[test]
fn comp_is_the_first_keyword() {
    // R1.1: another word before COMP is another command, or none.
    let program =
        "X[FRICT COMP ON]\nX[ON COMP FRICT]\nX[COMP OFF FRICT]\nX[SYNC COMP ON FRICT]\nX[]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        P-ERR-21301 1:3-8
      2 line 2 -
        P-ERR-21301 2:3-5
      3 line 3 - X:active>inactive
      4 line 4 -
      5 line 5 -
        P-ERR-21301 5:1-4
      6 line 6 -
        FC401 3:1-18
      end 6 M30 X:inactive Y:active Z:unconfigured B:ineffective
    opaque {"X[SYNC]": 1}
    "#);
}

fn command(text: &str) -> CompCommand {
    let parsed = parse_comp(text).expect("no mistake");
    parsed.expect("a COMP command")
}

#[test]
fn what_is_no_comp_command_is_told_from_a_wrong_one() {
    // R1.1
    for text in [
        "X[INDP_ASYN G1 POS=5 FEED=100 SLOPE_TYPE=STEP]",
        "X[MC_MoveAbsolute POS=5",
        "V.E.OFFSET[2]",
        "V.E.COMP[2]",
        "[3+4]",
        "X[SIN[30]]",
        "G01 X10",
        "X10 (X[COMP",
        "",
        "[",
    ] {
        assert_eq!(parse_comp(text), Ok(None), "{text}");
    }
    for (text, code) in [
        ("X[COMP]", "FC201"),
        ("X[COMP ON FRIKT]", "FC202"),
        ("X[ comp on FRICT", "FC205"),
        ("X[KOMP ON FRICT]", "P-ERR-21301"),
        ("X[COMP ON FRICT] Y[COMP ON FRICT]", "FC207"),
        ("X[COMP ON FRICT] M30", "FC207"),
    ] {
        assert_eq!(parse_comp(text).unwrap_err().code.as_str(), code, "{text}");
    }
}

#[test]
fn one_selection_governs_all_kinds() {
    // R1.2
    let command = command("X[COMP OFF LEAD FRICT TEMP]");
    let kinds: KindSet = [Kind::Lead, Kind::Frict, Kind::Temp].into_iter().collect();
    assert_eq!(command.selection, Selection::Off(kinds));
    assert_eq!(
        parse_comp("X[COMP OFF]").unwrap_err().code.as_str(),
        "FC201"
    );
}

#[test]
fn off_all_takes_no_kind() {
    // R1.3
    assert_eq!(command("X[COMP OFF_ALL]").selection, Selection::OffAll);
    assert_eq!(
        parse_comp("X[COMP OFF_ALL FRICT]")
            .unwrap_err()
            .code
            .as_str(),
        "FC203"
    );
    let bench = Bench::on(ALL_KINDS).kinds(&Kind::ALL);
    assert_snapshot!(bench.run(&["X[COMP OFF_ALL]\nM30"]), @"
    start X.BACKLASH:active X.CROSS:active X.PLANE:active X.LEAD:active X.TEMP:active X.FRICT:active X.CROSSTALK:active
    a.nc -
      1 line 1 - XBACKLASH:active>inactive XCROSS:active>inactive XPLANE:active>inactive XLEAD:active>inactive XTEMP:active>inactive XFRICT:active>inactive XCROSSTALK:active>inactive
      2 line 2 -
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
      end 2 M30 X.BACKLASH:inactive X.CROSS:inactive X.PLANE:inactive X.LEAD:inactive X.TEMP:inactive X.FRICT:inactive X.CROSSTALK:inactive
    ");
}

#[test]
fn several_axes_in_one_block() {
    // R1.4
    let program = "N10 X[COMP OFF FRICT] Y[COMP ON FRICT LEAD]\nN20 X[COMP ON FRICT]Y[COMP OFF FRICT]\nN30 Y[COMP ON FRICT] M30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive
      2 line 2 N20 X:inactive>active Y:active>inactive
      3 line 3 N30 Y:inactive>active
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn commands_are_continued() {
    // R1.5: comments and blanks after the sign, block numbers, comment and blank lines between.
    let program = "N10 X[COMP OFF \\ ; comment\nN20 (comment) FRICT] \\ (more)  \n; a line of its own\n\nN30 Y[ \\\nCOMP OFF\\\n\tFRICT]\nN40 M30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive Y:active>inactive
      2 line 8 N40
        FC401 1:5-2:21
        FC401 5:5-7:8
      end 2 M30 X:inactive Y:inactive Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().run(&["N10 X[COMP OFF FRICT \\\nN20 M30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
        FC205 1:6-7
      end 1 error X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn no_move_changes_nothing_for_frict() {
    // R1.6
    let command = command("X[COMP OFF FRICT NO_MOVE]");
    assert!(command.no_move);
    let bench = Bench::new();
    let plain = bench.run(&["X[COMP OFF FRICT]\nX[COMP ON FRICT]\nY[COMP OFF_ALL]\nM30"]);
    let held = bench.run(&[
        "X[COMP OFF FRICT NO_MOVE]\nX[COMP ON FRICT NO_MOVE]\nY[COMP OFF_ALL NO_MOVE]\nM30",
    ]);
    assert_eq!(
        plain.replace("1-16", "").replace("1-18", ""),
        held.replace("1-24", "").replace("1-26", "")
    );
}

#[test]
fn blanks_and_tabs_are_free_a_comma_is_no_separator() {
    // R1.7
    let program = "X [\tCOMP  OFF\t FRICT ]\nX[ COMP ON FRICT]\nX[COMP OFF FRICT,LEAD]\nX[COMP,OFF FRICT]\nX[COMP OFF, FRICT]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>inactive
      2 line 2 - X:inactive>active
      3 line 3 -
        FC202 3:12-22
      4 line 4 -
        P-ERR-21301 4:3-11
      5 line 5 -
        FC202 5:8-12
      6 line 6 -
      end 6 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn case_counts_for_axes_only() {
    // R1.8
    let program = "X[comp off frict]\nX[COMP On FRICT]\nX[Comp OFF Frict]\nx[COMP ON FRICT]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>inactive
        FC404 1:3-7
      2 line 2 - X:inactive>active
        FC404 2:8-10
      3 line 3 - X:active>inactive
        FC404 3:3-7
      4 line 4 -
        P-ERR-21947 4:1-2
      5 line 5 -
        FC401 3:1-18
      end 5 M30 X:inactive Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn comp_is_not_exclusive() {
    // R1.9
    let program = "N10 G1 X10 F100 X[COMP OFF FRICT] Y5\nN20 Y[COMP OFF FRICT] S1000 M3\nN30 X[COMP ON FRICT] Y[COMP ON FRICT] M30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive
        FC405 1:17-34
      2 line 2 N20 Y:active>inactive
      3 line 3 N30 X:inactive>active Y:inactive>active
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn kinds_exist_since_a_build() {
    // R1.10
    let on = |build: &str| {
        let machine = format!("[machine]\ncnc_build = \"{build}\"\n{ALL_KINDS}");
        let program = "X[COMP OFF FRICT]\nX[COMP OFF LEAD]\nX[COMP OFF BACKLASH]\nX[COMP OFF CROSSTALK]\nX[COMP ON FRICT LEAD BACKLASH CROSSTALK]\nM30";
        Bench::on(&machine).run(&[program])
    };
    assert_snapshot!(on("2.11.2022.04"), @"
    start X:active
    a.nc -
      1 line 1 - X:active>inactive
        FC305 1:1-18
      2 line 2 -
      3 line 3 -
        FC305 3:1-21
      4 line 4 -
        FC305 4:1-22
      5 line 5 - X:inactive>active
        FC305 5:1-41
        FC305 5:1-41
        FC305 5:1-41
      6 line 6 -
      end 6 M30 X:active
    ");
    assert_snapshot!(on("V3.1.3079.32"), @"
    start X:active
    a.nc -
      1 line 1 - X:active>inactive
      2 line 2 -
      3 line 3 -
        FC305 3:1-21
      4 line 4 -
      5 line 5 - X:inactive>active
        FC305 5:1-41
      6 line 6 -
      end 6 M30 X:active
    ");
    assert!(!on("3.1.3081.05").contains("FC305"));
}

#[test]
fn malformed_commands() {
    // The table of 1.1: one diagnostic each, exact columns, no change by a refused command.
    let program = "X[COMP]\nX[COMP FRICT]\nX[COMP ON]\nX[COMP ON FRIKT]\nX[COMP OFF_ALL FRICT]\n\
        X[COMP ON FRICT OFF LEAD]\nX[KOMP ON FRICT]\nX[COMP ON FRICT\nX[COMP OFF FRICT FRICT]\n\
        X[COMP ON FRICT] X[COMP OFF FRICT]\nQ[COMP ON FRICT]\nS[COMP ON FRICT]\nS2[COMP ON FRICT]\n\
        N10 (c) X[COMP ON] Y[COMP OFF FRICT]\n#SET AX LINK [1, Y=X]\n#ENABLE AX LINK [1]\nY[COMP OFF FRICT]\n\
        #DISABLE AX LINK [1]\nY[COMP ON FRICT]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC201 1:1-8
      2 line 2 -
        FC201 2:1-14
      3 line 3 -
        FC201 3:1-11
      4 line 4 -
        FC202 4:11-16
      5 line 5 -
        FC203 5:16-21
      6 line 6 -
        FC204 6:17-20
      7 line 7 -
        P-ERR-21301 7:3-7
      8 line 8 -
        FC205 8:2-3
      9 line 9 - X:active>inactive
        FC406 9:18-23
      10 line 10 - X:inactive>active X:active>inactive
        FC301 10:18-35
      11 line 11 -
        P-ERR-21947 11:1-2
      12 line 12 -
        FC302 12:1-17
      13 line 13 -
        FC302 13:1-18
      14 line 14 N10 Y:active>inactive
        FC201 14:9-19
      15 line 15 -
      16 line 16 -
      17 line 17 -
        P-ERR-21403 17:1-18
      18 line 18 -
      19 line 19 - Y:inactive>active
      20 line 20 -
        FC401 10:18-35
      end 20 M30 X:inactive Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn near_misses_get_advice() {
    // 1.1: did you mean
    let advice = |text: &str| {
        let advice = parse_comp(text).unwrap_err().advice;
        let words: Vec<String> = advice.iter().map(ToString::to_string).collect();
        words.join(" / ")
    };
    assert_snapshot!(advice("X[COMP ON FRIKT]"), @"did you mean `FRICT`?");
    assert_snapshot!(advice("X[KOMP ON FRICT]"), @"did you mean `COMP`?");
    assert_snapshot!(advice("X[COMP OFFALL]"), @"did you mean `OFF_ALL`?");
    assert_snapshot!(advice("X[COMP ON BACKLASCH]"), @"did you mean `BACKLASH`?");
    assert_snapshot!(advice("X[COMP ON SOMETHING]"), @"the kinds are BACKLASH, CROSS, PLANE, LEAD, TEMP, FRICT, CROSSTALK");
}

#[test]
fn configured_and_parameterised() {
    // R1.20 R1.21: X has both, B no list, Z neither; a list with mode 0 is not an accepted list.
    let machine = format!(
        "{MACHINE}[[axis]]\nname = \"C\"\ntype = \"R\"\nfrict_comp = true\nvalue = {{ mode = 0, table = [[0, 1]] }}\n"
    );
    assert_snapshot!(Bench::on(&machine).run(&["M30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective C:ineffective
    a.nc -
      1 line 1 -
      end 1 M30 X:active Y:active Z:unconfigured B:ineffective C:ineffective
    ");
}

#[test]
fn on_without_configuration_stops_the_control() {
    // R1.20 R1.24 R9.20
    let program = "N10 X[COMP OFF FRICT] Z[COMP ON FRICT] Y[COMP OFF FRICT]\nN20 M30";
    assert_snapshot!(Bench::new().run(&[program, "M30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive
        P-ERR-70495 1:23-39
        FC401 1:5-22
      end 1 error X:inactive Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive Y:active>inactive
        P-ERR-70495 1:23-39
      2 line 2 N20
        FC401 1:5-22
        FC401 1:40-57
      end 2 M30 X:inactive Y:inactive Z:unconfigured B:ineffective
    ");
}

#[test]
fn a_refused_command_changes_none_of_its_kinds() {
    // R1.24
    let machine = ALL_KINDS
        .replace("frict_comp = true", "")
        .replace("\"FRICT\", ", "");
    let bench = Bench::on(&machine)
        .kinds(&[Kind::Lead, Kind::Frict])
        .keep_going();
    assert_snapshot!(bench.run(&["X[COMP OFF LEAD]\nX[COMP ON FRICT LEAD]\nX[COMP ON LEAD]\nM30"]), @"
    start X.LEAD:active X.FRICT:unconfigured
    a.nc -
      1 line 1 - XLEAD:active>inactive
      2 line 2 -
        P-ERR-70495 2:1-22
      3 line 3 - XLEAD:inactive>active
      4 line 4 -
      end 4 M30 X.LEAD:active X.FRICT:unconfigured
    ");
}

#[test]
fn off_without_configuration_is_no_error() {
    // R1.25
    assert_snapshot!(Bench::new().run(&["Z[COMP OFF FRICT]\nZ[COMP OFF_ALL]\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC402 1:1-18
      2 line 2 -
        FC402 2:1-16
      3 line 3 -
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn on_without_a_list_is_ineffective() {
    // R1.26
    assert_snapshot!(Bench::new().run(&["B[COMP OFF FRICT]\nB[COMP ON FRICT]\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - B:ineffective>inactive
      2 line 2 - B:inactive>ineffective
        FC303 2:1-17
      3 line 3 -
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn the_state_outlives_programs() {
    // R1.27 R1.22: M30, M02 and the file's end keep it.
    let programs = [
        "X[COMP OFF FRICT]\nM30",
        "Y[COMP OFF FRICT]\nM02",
        "X[COMP ON FRICT]",
        "M30",
    ];
    assert_snapshot!(Bench::new().run(&programs), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>inactive
      2 line 2 -
        FC401 1:1-18
      end 2 M30 X:inactive Y:active Z:unconfigured B:ineffective
    b.nc -
      1 line 1 - Y:active>inactive
      2 line 2 -
        FC401 1:1-18
      end 2 M02 X:inactive Y:inactive Z:unconfigured B:ineffective
    c.nc -
      1 line 1 - X:inactive>active
        FC310 1:1-17
      end 1 end-of-file X:active Y:inactive Z:unconfigured B:ineffective
    d.nc -
      1 line 1 -
      end 1 M30 X:active Y:inactive Z:unconfigured B:ineffective
    ");
}

#[test]
fn reset_keeps_the_state_a_restart_does_not() {
    // R1.28 R1.29
    let machine = Machine::from_toml(MACHINE).unwrap();
    let x = machine.find("X").unwrap();
    let mut state = machine.compensation();
    state.apply(&command("X[COMP OFF FRICT]")).unwrap();
    assert!(state.reset().is_empty());
    assert_eq!(state.state(x, Kind::Frict), State::Inactive);
    assert_eq!(machine.compensation().state(x, Kind::Frict), State::Active);
}

#[test]
fn commands_act_when_they_are_executed() {
    // R1.30: in loops each time, in branches that are not taken never.
    let program = "$FOR P1=1,2,1\nX[COMP OFF FRICT]\n$IF P1==2\nX[COMP ON FRICT]\n$ENDIF\n$ENDFOR\n$IF FALSE\nY[COMP OFF FRICT]\n$ENDIF\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 - X:active>inactive
      3 line 3 -
      4 line 5 -
      5 line 6 -
      6 line 2 -
        FC402 2:1-18
      7 line 3 -
      8 line 4 - X:inactive>active
      9 line 5 -
      10 line 6 -
      11 line 7 -
      12 line 9 -
      13 line 10 -
      end 13 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn commands_of_a_block_act_from_left_to_right() {
    // R1.31
    let program = "X[COMP OFF FRICT] X[COMP ON FRICT] X[COMP OFF FRICT] Y[COMP OFF FRICT]\nX[COMP ON FRICT] Y[COMP ON FRICT]\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>inactive X:inactive>active X:active>inactive Y:active>inactive
        FC301 1:19-35
        FC301 1:36-53
      2 line 2 - X:inactive>active Y:inactive>active
      3 line 3 -
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn the_unknown_state_ends_with_the_next_command() {
    // 1.2, the word `unknown`; R2.51
    let program =
        "$IF V.E.FINE\nX[COMP OFF FRICT]\nZ[COMP OFF FRICT]\n$ENDIF\nX[COMP ON FRICT]\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 - X:active>inactive
      3 line 3 -
        FC402 3:1-18
      4 line 4 -
        FC901 1:5-13
      5 line 5 - X:unknown>active
      6 line 6 -
      end 6 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn programs_read_the_state() {
    // R1.35
    let program = "N1 P1=V.A.FRICT_COMP_INIT.X P2=V.A.FRICT_COMP_INIT.B P3=V.A.FRICT_COMP_INIT.Z\n\
        N2 P4=V.A.FRICT_COMP_ACTIVE.X P5=V.A.FRICT_COMP_ACTIVE.B P6=V.A.FRICT_COMP_ACTIVE[2]\n\
        N3 X[COMP OFF FRICT]\n\
        N4 P7=V.A.FRICT_COMP_ACTIVE.X P8=V.A.FRICT_COMP_INIT[0]\n\
        N5 P9=V.A.LEAD_COMP_ACTIVE.X+V.A.LEAD_COMP_INIT.X+V.A.CROSS_COMP_INIT.X+V.A.PLANE_COMP_INIT.X+V.A.TEMP_COMP_INIT.X+V.A.CROSSTALK_COMP_INIT.X\n\
        $IF P1==1 && P2==0 && P3==0 && P4==1 && P5==0 && P6==0 && P7==0 && P8==1 && P9==0\nN100 X[COMP ON FRICT]\n$ENDIF\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N1
      2 line 2 N2
      3 line 3 N3 X:active>inactive
      4 line 4 N4
      5 line 5 N5
      6 line 6 -
      7 line 7 N100 X:inactive>active
      8 line 8 -
      9 line 9 -
      end 9 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    // If the state differs between ways, so do its consequences (R14.1).
    let program = "$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.A.FRICT_COMP_ACTIVE.X\nY[COMP OFF FRICT]\n$ENDIF\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 - X:active>inactive
      3 line 3 -
        FC901 1:5-10
      4 line 4 -
      5 line 5 - Y:active>inactive
      6 line 6 -
        FC901 1:5-10
      7 line 7 -
        FC401 2:1-18
        FC401 5:1-18
      end 7 M30 X:unknown Y:unknown Z:unconfigured B:ineffective
    ");
}

#[test]
fn motion_may_require_compensations() {
    // R1.36
    let machine = "[[axis]]\nname = \"X\"\nfrict_comp = true\nrequired = [\"FRICT\"]\nvalue = { mode = 3, table = [[0, 12]] }\n[[axis]]\nname = \"Y\"\n";
    let program = "G0 X1 Y1\nX[COMP OFF FRICT]\nY2\nG4 X1.5\nG92 X3\nG1 Y2 X10 F100\nX[COMP ON FRICT] X5\nM30";
    assert_snapshot!(Bench::on(machine).keep_going().run(&[program]), @"
    start X:active Y:unconfigured
    a.nc -
      1 line 1 -
      2 line 2 - X:active>inactive
      3 line 3 -
      4 line 4 -
      5 line 5 -
      6 line 6 -
        P-ERR-70435 6:7-10
      7 line 7 - X:inactive>active
        FC405 7:1-17
      8 line 8 -
      end 8 M30 X:active Y:unconfigured
    ");
    assert_snapshot!(Bench::on(machine).run(&[program]), @"
    start X:active Y:unconfigured
    a.nc -
      1 line 1 -
      2 line 2 - X:active>inactive
      3 line 3 -
      4 line 4 -
      5 line 5 -
      6 line 6 -
        P-ERR-70435 6:7-10
        FC407 2:1-18
      end 6 error X:inactive Y:unconfigured
    ");
}

#[test]
fn only_configured_kinds_are_monitored_and_not_while_homing() {
    // R1.36: the control checks kinds that its axis list selects, and never while homing.
    let machine = "[[axis]]\nname = \"X\"\nrequired = [\"FRICT\"]\n[[axis]]\nname = \"Y\"\n\
                   frict_comp = true\nrequired = [\"FRICT\"]\nvalue = { mode = 3, table = [[0, 12]] }\n";
    let program = "X1\nY[COMP OFF FRICT]\nG74 X1 Y2\nG01 X2 F100\nY[COMP ON FRICT]\nM30";
    assert_snapshot!(Bench::on(machine).run(&[program]), @"
    start X:unconfigured Y:active
    a.nc -
      1 line 1 -
      2 line 2 - Y:active>inactive
      3 line 3 -
      4 line 4 -
      5 line 5 - Y:inactive>active
      6 line 6 -
      end 6 M30 X:unconfigured Y:active
    opaque {\"G74\": 1}
    ");
}

/// X with an axis list of the control that selects FRICT and LEAD.
const LISTED: &str =
    "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nlr_param.ssfk 1\nEnde";

/// Returns a machine with X as [`LISTED`].
fn listed() -> Machine {
    struct Lists;
    impl frictcomp::machine::ListFiles for Lists {
        fn read(&mut self, _path: &str) -> Result<SourceFile, frictcomp::machine::NoList> {
            Ok(SourceFile::new("x.lis", LISTED))
        }
    }
    let startup = SourceFile::new("hochlauf.lis", "achs_mds[0] x.lis\nEnde");
    let mut found = frictcomp::machine::Configuration::from_startup(startup, &mut Lists);
    found.machine.enable("X");
    found.machine
}

#[test]
fn kinds_that_the_axis_list_does_not_select_are_refused() {
    // R1.41: each with its own number; FRICT and what the list selects are not.
    for (kind, code) in [
        ("TEMP", "P-ERR-70313"),
        ("CROSS", "P-ERR-70316"),
        ("PLANE", "P-ERR-70319"),
        ("CROSSTALK", "P-ERR-70631"),
        ("BACKLASH", "P-ERR-70637"),
    ] {
        let mut bench = Bench::new();
        bench.machine = listed();
        let on = bench.run(&[&format!("X[COMP ON FRICT LEAD {kind}]\nM30")]);
        assert!(on.contains(&format!("{code} 1:1")), "{kind}: {on}");
        let off = bench.run(&[&format!(
            "X[COMP OFF {kind}]\nX[COMP OFF_ALL]\nX[COMP ON FRICT LEAD]\nM30"
        )]);
        assert!(!off.contains("P-ERR"), "{kind}: {off}");
    }
    // frictcomp.toml alone does not prove that a kind is not selected.
    for kind in Kind::ALL {
        let run = Bench::new().run(&[&format!("X[COMP ON {kind}]\nM30")]);
        assert!(!run.contains("P-ERR"), "{kind}: {run}");
    }
    let lead = "[[axis]]\nname = \"X\"\n";
    assert!(
        Bench::on(lead)
            .run(&["X[COMP ON FRICT]"])
            .contains("P-ERR-70495")
    );
}

#[test]
fn comp_under_a_transformation_is_said() {
    // R1.42
    let program = "X[COMP OFF FRICT]\n#TRAFO ON\nX[COMP ON FRICT]\nY[COMP OFF LEAD]\n#TRAFO OFF\n\
                   X[COMP ON FRICT]\n#KIN ID[9]\n#CS ON [1]\nY[COMP OFF FRICT]\n#CS OFF\n\
                   G41 G01 X1 F100\nY[COMP ON FRICT]\nG40\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>inactive
      2 line 2 -
      3 line 3 - X:inactive>active
        FC411 3:1-17
      4 line 4 -
        FC411 4:1-17
      5 line 5 -
      6 line 6 -
        FC402 6:1-17
      7 line 7 -
      8 line 8 -
      9 line 9 - Y:active>inactive
        FC411 9:1-18
      10 line 10 -
      11 line 11 -
      12 line 12 - Y:inactive>active
      13 line 13 -
      14 line 14 -
      end 14 M30 X:active Y:active Z:unconfigured B:ineffective
    opaque {\"#CS\": 2, \"#KIN\": 1, \"#TRAFO\": 2}
    ");
}

#[test]
fn reading_the_state_flushes_the_channel() {
    // R1.42
    let program = "P1 = V.A.FRICT_COMP_ACTIVE.X\nG41 G01 X1 F100\n\
                   $IF V.A.FRICT_COMP_ACTIVE.X == 0\n$ENDIF\nP2 = V.A.LEAD_COMP_INIT.Y + V.A.ABS.X\n\
                   G40\nP3 = V.A.FRICT_COMP_INIT.X\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
        FC412 3:5-28
      4 line 4 -
      5 line 5 -
        FC412 5:6-26
      6 line 6 -
      7 line 7 -
      8 line 8 -
      end 8 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn all_kinds_and_program_end() {
    // R1.40: with manual activation a kind is off at start-up and switches off at program end,
    // never FRICT and BACKLASH.
    let machine = ALL_KINDS.to_owned()
        + "manual_activation = [\"CROSS\", \"PLANE\", \"LEAD\", \"TEMP\", \"CROSSTALK\"]\n";
    let bench = Bench::on(&machine).kinds(&Kind::ALL);
    let program = "X[COMP ON CROSS PLANE LEAD TEMP CROSSTALK]\nX[COMP OFF FRICT BACKLASH]\nM30";
    assert_snapshot!(bench.run(&[program, "M30"]), @"
    start X.BACKLASH:active X.CROSS:inactive X.PLANE:inactive X.LEAD:inactive X.TEMP:inactive X.FRICT:active X.CROSSTALK:inactive
    a.nc -
      1 line 1 - XCROSS:inactive>active XPLANE:inactive>active XLEAD:inactive>active XTEMP:inactive>active XCROSSTALK:inactive>active
      2 line 2 - XBACKLASH:active>inactive XFRICT:active>inactive
      3 line 3 -
        FC401 2:1-27
        FC401 2:1-27
      end 3 M30 X.BACKLASH:inactive X.CROSS:inactive X.PLANE:inactive X.LEAD:inactive X.TEMP:inactive X.FRICT:inactive X.CROSSTALK:inactive
    b.nc -
      1 line 1 -
      end 1 M30 X.BACKLASH:inactive X.CROSS:inactive X.PLANE:inactive X.LEAD:inactive X.TEMP:inactive X.FRICT:inactive X.CROSSTALK:inactive
    ");
}

#[test]
fn lints_on_use() {
    // 1.4: FC401 to FC406, each once per place however often it applied.
    let program = "$FOR P1=1,3,1\nX[COMP ON FRICT]\nX[COMP OFF FRICT FRICT] X5\n$ENDFOR\ny[comp off frict]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program, "G1 X5 F10\nY[COMP OFF FRICT] Y5\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 - X:active>inactive
        FC405 3:1-24
        FC406 3:18-23
      4 line 4 -
      5 line 2 - X:inactive>active
      6 line 3 - X:active>inactive
      7 line 4 -
      8 line 2 - X:inactive>active
      9 line 3 - X:active>inactive
      10 line 4 -
      11 line 5 -
        P-ERR-21947 5:1-2
        FC404 5:3-7
      12 line 6 -
        FC401 3:1-24
        FC405 line 3 3 times
        FC406 line 3 3 times
      end 12 M30 X:inactive Y:active Z:unconfigured B:ineffective
    b.nc -
      1 line 1 -
        FC403 1:4-6
      2 line 2 - Y:active>inactive
        FC405 2:1-18
      3 line 3 -
        FC401 2:1-18
      end 3 M30 X:inactive Y:inactive Z:unconfigured B:ineffective
    ");
}

#[test]
fn a_saved_state_is_what_the_next_session_starts_with() {
    // R1.27 R9.30
    let bench = Bench::new();
    let mut session = bench.session();
    bench.run_in(&mut session, &["X[COMP OFF FRICT]\nM30"]);
    let saved = serde_json::to_string(&session.save()).unwrap();
    let machine = Machine::from_toml(MACHINE).unwrap();
    let saved = serde_json::from_str(&saved).unwrap();
    let (mut session, said) = Session::resume(machine, SessionOptions::default(), saved).unwrap();
    assert!(said.is_empty());
    assert_snapshot!(bench.run_in(&mut session, &["X5\nM30"]), @"
    start X:inactive Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
        FC403 1:1-3
      end 2 M30 X:inactive Y:active Z:unconfigured B:ineffective
    ");
}
