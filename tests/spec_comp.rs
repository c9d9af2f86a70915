//! Chapter 1: the COMP command, rule by rule.

mod support;

use insta::assert_snapshot;
use support::Bench;

#[test]
fn the_documented_example() {
    // R1.22 R1.23 R1.27 R1.30 R9.12 R9.13
    let program = "%FRICTION\n\
        N15 X[COMP ON FRICT] ;Activates X axis\n\
        N25 Y[COMP OFF FRICT] ;Deactivates Y axis\n\
        N35 X22 Y33 Z44\n\
        N45 X[COMP OFF FRICT] ;Deactivates X axis\n\
        N55 M30 ;Program end\n";
    assert_snapshot!(Bench::new().run(&[program, "X1\nM30\n"]), @"");
}

#[test]
fn on_without_configuration_stops_the_control() {
    // R1.20 R1.24 R9.20
    assert_snapshot!(Bench::new().run(&["N10 X[COMP OFF FRICT] Z[COMP ON FRICT] Y[COMP OFF FRICT]\nN20 M30", "M30"]), @"");
    assert_snapshot!(Bench::new().keep_going().run(&["N10 X[COMP OFF FRICT] Z[COMP ON FRICT] Y[COMP OFF FRICT]\nN20 M30"]), @"");
}

#[test]
fn malformed_commands() {
    let program = "X[COMP]\nX[COMP FRICT]\nX[COMP ON]\nX[COMP ON FRIKT]\nX[COMP OFF_ALL FRICT]\n\
        X[COMP ON FRICT OFF LEAD]\nX[KOMP ON FRICT]\nX[COMP ON FRICT\nX[COMP OFF FRICT FRICT]\n\
        X[COMP ON FRICT] X[COMP OFF FRICT]\nQ[COMP ON FRICT]\nS[COMP ON FRICT]\nX[COMP ON FRICT,LEAD]\n\
        x[comp on frict]\nX[comp on frict]\nX[COMP ON \\\nN20 (c)\n FRICT]\nG1 X10 X[ COMP\tOFF FRICT NO_MOVE ]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"");
}

#[test]
fn flow_runs() {
    let program = "%L UP\nN1 X[COMP OFF FRICT]\nN2 M17\n%MAIN\nN10 P1=0\nN20 $FOR P1=1,3,1\nN30 $IF P1==2\nN40 Y[COMP OFF FRICT]\n\
    N50 $ELSE\nN60 Y[COMP ON FRICT]\nN70 $ENDIF\nN80 $ENDFOR\nN90 LL UP\nN95 $IF V.E.A > 1\nN96 X[COMP ON FRICT]\nN97 $ENDIF\nN100 $SWITCH P1\nN110 $CASE 4\nG1 X10 F100\n$BREAK\n$DEFAULT\nG1 Y2\n$ENDSWITCH\n$WHILE P1 < 6\nP1=P1+1\n$ENDWHILE\n$IF P1 >= 6 $GOTO N300\nX99\nN300: M30\n";
    assert_snapshot!(Bench::new().run(&[program]), @"");
}
