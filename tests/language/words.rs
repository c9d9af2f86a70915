//! 2.3 and 2.6: axes, words, modal state and positions.

use insta::assert_snapshot;

use crate::support::{Bench, SourceMode};
use frictcomp::machine::Machine;

fn run(program: &str) -> String {
    Bench::new().keep_going().run(&[program])
}

#[test]
fn axis_names() {
    // R2.20
    let machine = "[[axis]]\nname = \"X\"\n[[axis]]\nname = \"X_LONG_NAME_1234\"\nfrict_comp = true\n[[axis]]\nname = \"Q1\"\n";
    let program = "X_LONG_NAME_1234=5 Q1=7 X1\nX_LONG_NAME_1234[COMP OFF FRICT]\nx_long_name_1234[COMP OFF FRICT]\nM30";
    assert_snapshot!(Bench::on(machine).keep_going().run(&[program]), @"
    start X:unconfigured X_LONG_NAME_1234:ineffective Q1:unconfigured
    a.nc -
      1 line 1 -
      2 line 2 - X_LONG_NAME_1234:ineffective>inactive
      3 line 3 -
        P-ERR-21947 3:1-17
      4 line 4 -
        FC407 2:1-33
      end 4 M30 X:unconfigured X_LONG_NAME_1234:inactive Q1:unconfigured
    ");
    let mut bench = Bench::new().keep_going();
    bench.machine = Machine::unconfigured();
    assert_snapshot!(bench.run(&["X1 W2\nB[COMP OFF FRICT]\nQ[COMP OFF FRICT]\nX1[COMP ON FRICT]\nM30"]), @"
    start 
    a.nc -
      1 line 1 -
      2 line 2 -
        FC408 2:1-18
      3 line 3 -
        P-ERR-21947 3:1-2
      4 line 4 -
        P-ERR-21947 4:1-3
      5 line 5 -
      end 5 M30 X:unconfigured B:unconfigured W:unconfigured
    ");
}

#[test]
fn what_goes_on_too_long_is_no_name() {
    // R2.20, R9.90
    for name in ["X".repeat(33), format!("X{}", "A9".repeat(40))] {
        for command in ["[COMP OFF FRICT]", "=5"] {
            let seen = run(&format!("{name}{command}\nM30"));
            assert!(
                seen.contains("FC2") && !seen.contains(">inactive"),
                "{seen}"
            );
        }
    }
}

#[test]
fn long_names_need_an_equals_sign() {
    // R2.21
    let machine = "[[axis]]\nname = \"X\"\n[[axis]]\nname = \"X1\"\n[[axis]]\nname = \"X50P1\"\n";
    let program = "P1=2\nX1=100\nX50P1=7\nX50 P1=9\nX=5\nX1 = P1\nX50P1 = 8 X1 = 4\nM30";
    assert_snapshot!(Bench::on(machine).positions(program), @"
    P1=2 X:? X1:? X50P1:?
    X1=100 X:? X1:100 X50P1:?
    X50P1=7 X:? X1:100 X50P1:7
    X50 P1=9 X:50 X1:100 X50P1:7
    X=5 X:5 X1:100 X50P1:7
    X1 = P1 X:5 X1:9 X50P1:7
    X50P1 = 8 X1 = 4 X:5 X1:4 X50P1:8
    M30 X:5 X1:4 X50P1:8
    ");
}

#[test]
fn values_of_words() {
    // R2.22 R2.24
    let machine = "[[axis]]\nname = \"X\"\n[[axis]]\nname = \"V\"\n";
    let program = "P1=2 P2=30 P100=3\n#VAR\nV.L.A = 4\nV.L.B[2] = [5, 6]\n#ENDVAR\nX100\nX-P100\nXP1*SIN[P2]\nX[P1+10]\nX SIN[30]\nX-SIN[30]*2\nXV.L.A V7\nXV.L.B[1]\nX=V.L.B[0]+1\nV-1 X.5\nVV.L.A\nX'16#FF'\nXABS[-3]V2\nX[[P1]]V[P1]\nM30";
    assert_snapshot!(Bench::on(machine).positions(program), @"
    P1=2 P2=30 P100=3 X:? V:?
    #VAR X:? V:?
    X100 X:100 V:?
    X-P100 X:-3 V:?
    XP1*SIN[P2] X:0.9999999999999999 V:?
    X[P1+10] X:12 V:?
    X SIN[30] X:0.49999999999999994 V:?
    X-SIN[30]*2 X:-0.9999999999999999 V:?
    XV.L.A V7 X:4 V:7
    XV.L.B[1] X:6 V:7
    X=V.L.B[0]+1 X:6 V:7
    V-1 X.5 X:0.5 V:-1
    VV.L.A X:0.5 V:4
    X'16#FF' X:255 V:4
    XABS[-3]V2 X:3 V:2
    X[[P1]]V[P1] X:2 V:2
    M30 X:2 V:2
    ");
}

#[test]
fn brackets_of_axes() {
    // R2.23
    let program = "X[INDP_SYN POS=5 G01 FEED=10]\nX[OSC ON]\nX[LIFT_START DOWN=1]\nX[M3]\nX[H56]\nX[MC_MoveAbsolute Position=1]\nX[DYNAMIC]\nX[OVERRIDE 50]\nX[POLY [1,2]]\nX[10] Y[-P1]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[&format!("P1=1\n{program}")]), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
      6 line 6 -
      7 line 7 -
      8 line 8 -
      9 line 9 -
      10 line 10 -
      11 line 11 -
      12 line 12 -
      end 12 M30 X:active Y:active Z:unconfigured B:ineffective
    opaque {"X[DYNAMIC]": 1, "X[H56]": 1, "X[INDP_SYN]": 1, "X[LIFT_START]": 1, "X[M3]": 1, "X[MC_MoveAbsolute]": 1, "X[OSC]": 1, "X[OVERRIDE]": 1, "X[POLY]": 1}
    "#);
    assert_snapshot!(run("X[FOO]\nX[SOMETHING 1]\nX[ ]\nM30"), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        P-ERR-21301 1:3-6
      2 line 2 -
        P-ERR-21301 2:3-12
      3 line 3 -
        P-ERR-21301 3:1-5
      4 line 4 -
      end 4 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn spindles_tools_and_other_words() {
    // R2.25
    let program = "S1000 M3\nS[M4 REV500]\nS2[M3 REV1000]\nM5 M19\nT5 D5\nH7 E3\nM200=1200 M77\nS2=500\nS1.5\nM30";
    assert_snapshot!(Bench::new().run(&[program]), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
      6 line 6 -
      7 line 7 -
      8 line 8 -
      9 line 9 -
      10 line 10 -
      end 10 M30 X:active Y:active Z:unconfigured B:ineffective
    opaque {"S2[M3]": 1, "S[M4]": 1}
    "#);
}

#[test]
fn groups_of_g_functions() {
    // R2.45
    let refused = |block: &str| run(&format!("{block}\nM30")).contains("FC313");
    for pair in [
        "G0 G1",
        "G17 G18",
        "G70 G71",
        "G90 G91",
        "G93 G94",
        "G53 G54",
        "G40 G41",
        "G161 G162",
        "G02 G3",
        "G59 G159",
        "G1 G01",
        "G25 G26",
        "G51 X8 G51",
        "G9 G900",
        "G60 G61",
        "G360 X1 G60",
        "G100 X1 G102",
        "G115=2 G116",
        "G138 G41 G139",
        "G165 G164",
        "X1 N20 N30",
        "N20 X1 N30",
        "N20 N30 X1",
        "F100 G1 X1 F200",
        "F100 F=200",
        "S1000 M3 S1500",
        "G2 I1 I2 X0",
        "G2 K=1 K2 X0",
        "M10 M10",
        "M10 M=10",
    ] {
        assert!(refused(pair), "{pair}");
    }
    for pair in [
        "G1 G90",
        "G4 G1",
        "G20 G21",
        "G92 G1",
        "G60 G9",
        "G5 G138",
        "G2 I1 J1",
        "M3 M10",
        "F1 E1",
        "X1 N20",
        "N10 G115 N5",
    ] {
        assert!(!refused(pair), "{pair}");
    }
    assert_snapshot!(run("G00 X1 G01\nG60 G91 G999\nM30"), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC313 1:8-11
      2 line 2 -
        FC210 2:9-13
      3 line 3 -
      end 3 M30 X:active Y:active Z:unconfigured B:ineffective
    opaque {"G999": 1}
    "#);
}

#[test]
fn absolute_incremental_inch() {
    // R2.45
    let program = "X10\nG91 X5\nX-2 G90\nG91\nX1 Y1\nG90 Y2\nG91 Y1\nG70 G90 X1\nG71 X1\nG4 X9\n#TIME 3\nG04 2.5\nG74 X1\nX\nM30";
    assert_snapshot!(Bench::new().positions(program), @"
    X10 X:10 Y:? Z:? B:?
    G91 X5 X:15 Y:? Z:? B:?
    X-2 G90 X:-2 Y:? Z:? B:?
    G91 X:-2 Y:? Z:? B:?
    X1 Y1 X:-1 Y:? Z:? B:?
    G90 Y2 X:-1 Y:2 Z:? B:?
    G91 Y1 X:-1 Y:3 Z:? B:?
    G70 G90 X1 X:25.4 Y:3 Z:? B:?
    G71 X1 X:1 Y:3 Z:? B:?
    G4 X9 X:1 Y:3 Z:? B:?
    #TIME 3 X:1 Y:3 Z:? B:?
    G04 2.5 X:1 Y:3 Z:? B:?
    G74 X1 X:? Y:3 Z:? B:?
    X X:? Y:3 Z:? B:?
    M30 X:? Y:3 Z:? B:?
    ");
}

#[test]
fn reference_offsets() {
    // R2.45: G92 shifts the absolute coordinates that follow; it moves nothing.
    let program = "X10 Y10\nG92 X5\nX0\nG91 X1\nG92 X2\nG90 X0\nP1=V.A.PROG.X P2=V.A.ABS.X\nXP2 YP1\nG92 X0\nX1\nM30";
    assert_snapshot!(Bench::new().positions(program), @"
    X10 Y10 X:10 Y:10 Z:? B:?
    G92 X5 X:10 Y:10 Z:? B:?
    X0 X:5 Y:10 Z:? B:?
    G91 X1 X:6 Y:10 Z:? B:?
    G92 X2 X:6 Y:10 Z:? B:?
    G90 X0 X:7 Y:10 Z:? B:?
    P1=V.A.PROG.X P2=V.A.ABS.X X:7 Y:10 Z:? B:?
    XP2 YP1 X:14 Y:0 Z:? B:?
    G92 X0 X:14 Y:0 Z:? B:?
    X1 X:1 Y:0 Z:? B:?
    M30 X:1 Y:0 Z:? B:?
    ");
    let both = format!("{program}\nX2");
    assert!(
        Bench::new()
            .positions(&both)
            .ends_with("M30 X:1 Y:0 Z:? B:?\n")
    );
}

#[test]
fn offsets_forget_positions() {
    // R2.45: only the machine knows the values of G54 to G59.
    assert_snapshot!(Bench::new().positions("X1 Y2\nG54\nX1\nG54 Y2\nG159=3 X3\nG53\nM30"), @"
    X1 Y2 X:1 Y:2 Z:? B:?
    G54 X:? Y:? Z:? B:?
    X1 X:1 Y:? Z:? B:?
    G54 Y2 X:1 Y:2 Z:? B:?
    G159=3 X3 X:3 Y:? Z:? B:?
    G53 X:? Y:? Z:? B:?
    M30 X:? Y:? Z:? B:?
    ");
}

#[test]
fn circles_feed_and_dwell() {
    // R2.46
    let program = "G17 G1 X0 Y0 F1000\nG2 X10 Y0 I5 J0\nG3 X0 Y0 R5 Z-1\nG161 G2 X5 I1 J2\nG163 R7\nG93 F2\nG95 F0.1\nG94\nG18 G2 Z5 X1 I1 K2\nM30";
    assert_snapshot!(Bench::new().positions(program), @"
    G17 G1 X0 Y0 F1000 X:0 Y:0 Z:? B:?
    G2 X10 Y0 I5 J0 X:10 Y:0 Z:? B:?
    G3 X0 Y0 R5 Z-1 X:0 Y:0 Z:-1 B:?
    G161 G2 X5 I1 J2 X:5 Y:0 Z:-1 B:?
    G163 R7 X:5 Y:0 Z:-1 B:?
    G93 F2 X:5 Y:0 Z:-1 B:?
    G95 F0.1 X:5 Y:0 Z:-1 B:?
    G94 X:5 Y:0 Z:-1 B:?
    G18 G2 Z5 X1 I1 K2 X:1 Y:0 Z:5 B:?
    M30 X:1 Y:0 Z:5 B:?
    ");
    // R cannot make a full circle; if the start is unknown, nothing is reported.
    let circles = "G2 X1 Y1 R5 F1000\nG2 X1 Y1 R5\nG2 X2 Y1 R5\nG2 X2 Y1 I5 J0\nM30";
    assert_snapshot!(Bench::new().run(&[circles]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
        FC316 2:10-12
      3 line 3 -
      4 line 4 -
      5 line 5 -
      end 5 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(run(program), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
      6 line 6 -
      7 line 7 -
      8 line 8 -
      9 line 9 -
      10 line 10 -
      end 10 M30 X:active Y:active Z:unconfigured B:ineffective
    opaque {"G163": 1}
    "#);
}

#[test]
fn hash_commands() {
    // R2.47
    let program = "#HSC ON [BSPLINE]\n#HSC OFF\n#MSG [\"text ; (\"]\n#MSG SAVE EXCLUSIVE [\"X[COMP OFF FRICT]\"]\n#FOO BAR BAZ\n#TIME 2.5\n#RT CYCLE [ID=1]\nV.RTA.X = V.A.Y\nX[COMP OFF FRICT]\n#RT CYCLE END\n#SLOPE [TYPE=STEP]\nM30";
    assert_snapshot!(run(program), @r##"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 - X:active>unknown Y:active>unknown B:ineffective>unknown
        FC210 5:1-13
      6 line 6 -
      7 line 7 -
      8 line 11 -
      9 line 12 -
      end 9 M30 X:unknown Y:unknown Z:unconfigured B:unknown
    opaque {"#HSC": 2, "#MSG": 1, "#MSG SAVE EXCLUSIVE": 1, "#RT CYCLE": 1, "#SLOPE": 1}
    "##);
    assert_snapshot!(run("#MACHINE DATA [AX=X lr_param.frict_comp 0]\n#MACHINE DATA [AX=X frict_comp.mode 0]\n#MACHINE DATA [AX=X other 1]\nM30"), @r##"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>unknown
        FC314 1:1-43
      2 line 2 -
        FC314 2:1-39
      3 line 3 -
      4 line 4 -
        FC401 2:1-39
      end 4 M30 X:unknown Y:active Z:unconfigured B:ineffective
    opaque {"#MACHINE DATA": 3}
    "##);
}

#[test]
fn transformations_mark_positions() {
    // R2.47
    let program = "X1\n#TRAFO ON\nX2\nP1=V.A.PROG.X\n#TRAFO OFF\nX3\n#CS ON [0,0,0,0,0,45]\n#CS OFF\nX4\nG41\nG40\nG21\nG20\n#ROTATION ON [ANGLE 5]\n#ROTATION OFF\n#SCALE ON [X2]\n#SCALE OFF\n#KIN ID [9]\nM30";
    assert_snapshot!(Bench::new().positions(program), @"
    X1 X:1 Y:? Z:? B:?
    #TRAFO ON X:?* Y:?* Z:?* B:?*
    X2 X:2* Y:?* Z:?* B:?*
    P1=V.A.PROG.X X:2* Y:?* Z:?* B:?*
    #TRAFO OFF X:? Y:? Z:? B:?
    X3 X:3 Y:? Z:? B:?
    #CS ON [0,0,0,0,0,45] X:?* Y:?* Z:?* B:?*
    #CS OFF X:? Y:? Z:? B:?
    X4 X:4 Y:? Z:? B:?
    G41 X:4* Y:?* Z:?* B:?*
    G40 X:4 Y:? Z:? B:?
    G21 X:?* Y:?* Z:?* B:?*
    G20 X:? Y:? Z:? B:?
    #ROTATION ON [ANGLE 5] X:?* Y:?* Z:?* B:?*
    #ROTATION OFF X:? Y:? Z:? B:?
    #SCALE ON [X2] X:?* Y:?* Z:?* B:?*
    #SCALE OFF X:? Y:? Z:? B:?
    #KIN ID [9] X:?* Y:?* Z:?* B:?*
    M30 X:?* Y:?* Z:?* B:?*
    ");
}

#[test]
fn comments_name_no_axes_and_no_programs() {
    // R2.6 R2.75
    for program in [
        "#SET AX LINK [1, Y=B (not X)]\n#ENABLE AX LINK [(the first) 1]",
        "#SET AX LINK [1, \\\nY=B] ; X\n#ENABLE AX LINK [\\\nN20 1]",
        "#FILE NAME [G80=\"a.nc\" (M6=\"b.nc\") \\\nN30 T=\"\" ; D\n]",
        "X[MC_GearIn Master=2 (not 1)]",
    ] {
        let said = run(&format!("{program}\nX[COMP OFF FRICT]\nM6\nM30"));
        assert!(said.contains("X:active>inactive"), "{program}: {said}");
        assert!(
            !said.contains("FC9") && !said.contains("P-ERR"),
            "{program}: {said}"
        );
    }
}

#[test]
fn a_tool_word_that_gives_data_counts_as_one() {
    // R2.45 R2.75
    let mut bench = Bench::new().keep_going();
    let said = |bench: &Bench, block: &str| bench.run(&[&format!("{block}\nM30")]);
    assert!(said(&bench, "D1 D2").contains("FC313 1:4-"));
    assert!(!said(&bench, "T1 D1").contains("FC313"));
    bench.machine.programs.data_with_tool = true;
    assert!(said(&bench, "T1 D1").contains("FC313 1:4-"));
    assert!(!said(&bench, "T1\nD1").contains("FC313"));
}

#[test]
fn couplings() {
    // 2.6 and P-ERR-21403
    let program = "#SET AX LINK [1, Y=X]\n#AX LINK [P1+1, Z=X]\n#ENABLE AX LINK [1]\nX[COMP OFF FRICT]\nY[COMP OFF FRICT]\n\
        #AX LINK ON [2]\n#AX LINK OFF [1]\nY[COMP OFF FRICT]\nX[COMP OFF FRICT]\n#DISABLE AX LINK\nX[COMP OFF FRICT]\n\
        #ENABLE AX LINK [1]\n#ENABLE AX LINK [2]\n#AX LINK OFF ALL\nX[COMP ON FRICT]\n#ENABLE AX LINK [7]\n#ENABLE AX LINK [1]\nM30";
    let program = format!("P1=1\n{program}");
    assert_snapshot!(Bench::new().keep_going().run(&[&program, "X[COMP OFF FRICT]\n#ENABLE AX LINK [1]\nX[COMP ON FRICT]\nM30"]), @r##"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
        P-ERR-21403 5:1-18
      6 line 6 -
        P-ERR-21403 6:1-18
      7 line 7 -
      8 line 8 -
      9 line 9 - Y:active>inactive
      10 line 10 -
        P-ERR-21403 10:1-18
      11 line 11 -
      12 line 12 - X:active>inactive
      13 line 13 -
      14 line 14 -
      15 line 15 -
      16 line 16 - X:inactive>active
      17 line 17 -
      18 line 18 -
      19 line 19 -
        FC401 9:1-18
      end 19 M30 X:active Y:inactive Z:unconfigured B:ineffective
    b.nc -
      1 line 1 - X:active>inactive
      2 line 2 -
      3 line 3 -
        P-ERR-21403 3:1-17
      4 line 4 -
        FC401 1:1-18
      end 4 M30 X:inactive Y:inactive Z:unconfigured B:ineffective
    "##);
}

#[test]
fn a_group_of_the_channel_parameters_may_couple_any_axis() {
    // R1.9 R2.70
    for (program, may_be_refused) in [
        ("#ENABLE AX LINK [1]\nX[COMP ON FRICT]", true),
        ("#AX LINK ON [1]\nX[COMP ON FRICT]", true),
        (
            "#ENABLE AX LINK [1]\n#DISABLE AX LINK [1]\nX[COMP ON FRICT]",
            false,
        ),
        (
            "#ENABLE AX LINK [1]\n#DISABLE AX LINK\nX[COMP ON FRICT]",
            false,
        ),
        (
            "#ENABLE AX LINK [1]\n#DISABLE AX LINK [2]\nX[COMP ON FRICT]",
            true,
        ),
        (
            "#ENABLE AX LINK [1]\n#DISABLE AX LINK ALL\nX[COMP ON FRICT]",
            false,
        ),
    ] {
        let said = Bench::new().run(&[&format!("{program}\nM30")]);
        assert_eq!(said.contains("FC902"), may_be_refused, "{program}: {said}");
    }
}

#[test]
fn main_axes_of_a_cycle() {
    // R2.13: @X, @Y, @Z are the main axes of the active plane.
    let bench = Bench::new().file("c.cyc", "G1 @X1 @Y2 @Z3 @I5 @S100\nM17");
    assert_snapshot!(bench.positions("L CYCLE [NAME=c.cyc]\nG18\nL CYCLE [NAME=c.cyc]\nG19\nL CYCLE [NAME=c.cyc]\nM30"), @"
    L CYCLE [NAME=c.cyc] X:? Y:? Z:? B:?
    G1 @X1 @Y2 @Z3 @I5 @S100 X:1 Y:2 Z:3 B:?
    M17 X:1 Y:2 Z:3 B:?
    G18 X:1 Y:2 Z:3 B:?
    L CYCLE [NAME=c.cyc] X:1 Y:2 Z:3 B:?
    G1 @X1 @Y2 @Z3 @I5 @S100 X:2 Y:3 Z:1 B:?
    M17 X:2 Y:3 Z:1 B:?
    G19 X:2 Y:3 Z:1 B:?
    L CYCLE [NAME=c.cyc] X:2 Y:3 Z:1 B:?
    G1 @X1 @Y2 @Z3 @I5 @S100 X:3 Y:1 Z:2 B:?
    M17 X:3 Y:1 Z:2 B:?
    M30 X:3 Y:1 Z:2 B:?
    ");
}

/// Returns the messages about a program, for each way to pass it.
fn said_in_every_way(program: &str) -> [String; 2] {
    [SourceMode::Whole, SourceMode::LineByLine].map(|handed| {
        let bench = Bench::new().keep_going().handed(handed);
        bench.run(&[program])
    })
}

#[test]
fn a_number_that_is_too_large_is_one_nowhere() {
    // R2.37
    let large = "9".repeat(400);
    for form in [
        "G1 X#",
        "X-#",
        "X+# Y1",
        "X1 Y#.5",
        "Y2X#",
        "X#(a (b))",
        "/X#",
        "X=#",
        "X[#]",
        "X[-#+1]",
        "G1 X1 F#",
        "G04 #",
        "G04 X#",
        "G#",
        "M#",
        "S#",
        "S.POS#",
        "T#",
        "Z1 N#",
        "A1=#",
        "P1=#",
        "P1=1 X[P1*#]",
        "V.S.A=#",
        "\"M\"=\"X#\"\n\"M\"",
        "\"E\"=\"#\"\nX[\"E\"]",
        "$IF #\n$ENDIF",
        "@X#",
        "#TIME #",
        "L CYCLE [NAME=a.cyc @P1=#]",
        "X#\\\nY1",
    ] {
        let program = format!(
            "{}\nM30\n",
            form.replace('#', &large)
                .replace(&format!("{large}TIME"), "#TIME")
        );
        for said in said_in_every_way(&program) {
            assert_eq!(said.matches("FC312").count(), 1, "{form}: {said}");
        }
    }
}

#[test]
fn axis_words_of_weights_and_modes_are_no_coordinates() {
    // R2.45: PM/206590731, 206596619, 206639371, 206266379
    for mode in [
        "G130 X70 Y60",
        "G230 X50",
        "G132 X75 Y75",
        "G333 X80",
        "G338 X80 Y80",
        "G136 X80 Y95",
        "G131=50",
        "G233=90",
        "G339=85",
        "G131 50",
        "G201 X1",
        "G202 X1 Y1",
        "G200 X0",
        "G351 X-1",
    ] {
        let positions = Bench::new().positions(&format!("X10 Y20\n{mode}\nM30"));
        let after = positions.lines().nth(1).unwrap_or_default();
        assert!(after.contains("X:10") && after.contains("Y:20"), "{after}");
    }
    // Mirroring by axis: from here on, the axis does not move to the programmed positions.
    let mirrored = Bench::new().positions("X10\nG351 X-1\nX20\nM30");
    assert!(mirrored.contains("X20 X:20*"), "{mirrored}");
}
