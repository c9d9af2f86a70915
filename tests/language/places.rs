//! Commands after which positions are not those of the machine: R2.81, R2.82.

use insta::assert_snapshot;

use crate::support::{Bench, SourceMode};

/// Returns the positions of X and Y after each block.
fn positions(program: &str) -> String {
    let bench = Bench::on("[[axis]]\nname = \"X\"\n[[axis]]\nname = \"Y\"\n");
    bench.passing_branches().positions(program)
}

#[test]
fn machine_coordinates_take_offsets_away() {
    // R2.82
    assert_snapshot!(positions("G92 X10\nG0 X5\n#MCS ON\nG0 X5\nG92 X1\nX5\n#MCS OFF\nG0 X5 Y1\n#MCS ON EX TOOL\n#MCS OFF\nM30"), @"
    G92 X10 X:? Y:?
    G0 X5 X:15 Y:?
    #MCS ON X:?* Y:?*
    G0 X5 X:5* Y:?*
    G92 X1 X:5* Y:?*
    X5 X:6* Y:?*
    #MCS OFF X:?* Y:?*
    G0 X5 Y1 X:15* Y:1*
    #MCS ON EX TOOL X:?* Y:?*
    #MCS OFF X:?* Y:?*
    M30 X:?* Y:?*
    ");
    // Only the commands themselves have an effect.
    assert_snapshot!(positions("X5\n#MCS TO WCS [X1]\n#MSG [\"MCS\"]\nM30"), @r#"
    X5 X:5 Y:?
    #MCS TO WCS [X1] X:5 Y:?
    #MSG ["MCS"] X:5 Y:?
    M30 X:5 Y:?
    "#);
    assert_snapshot!(positions("G92 X10\nX5\n$IF V.E.X\n#MCS ON\n$ENDIF\nX5\nM30"), @"
    G92 X10 X:? Y:?
    X5 X:15 Y:?
    $IF V.E.X X:?* Y:?*
    X5 X:?* Y:?*
    M30 X:?* Y:?*
    ");
}

#[test]
fn a_spline_keeps_its_points() {
    // R2.82
    assert_snapshot!(positions("G1 X1 Y1 F100\n#SPLINE ON X10 Y20\nX30\nN5 G01 #SPLINE OFF X-5.5\n#SPLINE ON\n#SET SPLINE OFF\nX1\nG151 X3\nG150 X4\nM30"), @"
    G1 X1 Y1 F100 X:1 Y:1
    #SPLINE ON X10 Y20 X:10* Y:20*
    X30 X:30* Y:20*
    N5 G01 #SPLINE OFF X-5.5 X:-5.5 Y:20
    #SPLINE ON X:-5.5* Y:20*
    #SET SPLINE OFF X:-5.5 Y:20
    X1 X:1 Y:20
    G151 X3 X:3* Y:20*
    G150 X4 X:4 Y:20
    M30 X:4 Y:20
    ");
    assert_snapshot!(positions("X1 Y1\n$IF V.E.X\n#SPLINE ON X10 Y20\n$ENDIF\nX2\nM30"), @"
    X1 Y1 X:1 Y:1
    $IF V.E.X X:?* Y:?*
    X2 X:2* Y:?*
    M30 X:2* Y:?*
    ");
    let said = Bench::new()
        .passing_branches()
        .said("#SPLINE ON X10 ; Y20\n#SPLINE ON X1O\nM30");
    assert!(said.contains("FC207 2:"), "{said}");
    let known = Bench::new()
        .passing_branches()
        .positions("P1=7\n#SPLINE ON XP1 (Y3) Y[P1+1]\nM30");
    assert!(known.contains("X:7* Y:8*"), "{known}");
}

#[test]
fn an_implicit_call_that_is_passed_over_may_have_moved() {
    // R2.82
    assert_snapshot!(positions("X1 Y2\nG81\nX3\nG800 [1, 2]\nX4\nM30"), @"
    X1 Y2 X:1 Y:2
    G81 X:?* Y:?*
    X3 X:3* Y:?*
    G800 [1, 2] X:?* Y:?*
    X4 X:4* Y:?*
    M30 X:4* Y:?*
    ");
    assert_snapshot!(positions("X1 Y2\n$IF V.E.X\nG81 [1]\n$ENDIF\nX3\nM30"), @"
    X1 Y2 X:1 Y:2
    $IF V.E.X X:?* Y:?*
    X3 X:3* Y:?*
    M30 X:3* Y:?*
    ");
}

#[test]
fn functions_that_no_one_names() {
    // R2.82: functions of the language are known
    assert_snapshot!(positions("X1 Y2 M3 S1000\nM8\nG4 X1\nG64\nX2\nM30"), @"
    X1 Y2 M3 S1000 X:1 Y:2
    M8 X:1 Y:2
    G4 X1 X:1 Y:2
    G64 X:?* Y:?*
    X2 X:2* Y:?*
    M30 X:2* Y:?*
    ");
    assert_snapshot!(positions("X1 Y2\nM6 T5 D5\nM100\nX2\nM30"), @"
    X1 Y2 X:1 Y:2
    M6 T5 D5 X:1 Y:2
    M100 X:1* Y:2*
    X2 X:2* Y:2*
    M30 X:2* Y:2*
    ");
    let bench = Bench::on("[machine.programs]\nM100 = \"sub.nc\"\n[[axis]]\nname = \"X\"\n");
    let bench = bench.file("sub.nc", "M17");
    assert_snapshot!(bench.positions("X1\nM100\nX2\nM30"), @"
    X1 X:1
    M100 X:1
    M17 X:1
    X2 X:2
    M30 X:2
    ");
}

#[test]
fn a_measuring_motion_ends_where_the_probe_says() {
    // R2.82
    assert_snapshot!(positions("X1 Y2\nG100 X10\nX2\nM30"), @"
    X1 Y2 X:1 Y:2
    G100 X10 X:? Y:2
    X2 X:2 Y:2
    M30 X:2 Y:2
    ");
}

#[test]
fn a_contour_description_moves_nothing() {
    // R2.81
    let program = "G90 G0 X1 Y2 F500\n#CONTOUR BEGIN [ID1]\nG1 X125 Y25\nG91 X50 F2000\n#CONTOUR END\nX3\nG90 X4 Y5\nM30";
    assert_snapshot!(positions(program), @"
    G90 G0 X1 Y2 F500 X:1 Y:2
    #CONTOUR BEGIN [ID1] X:1 Y:2
    G1 X125 Y25 X:1 Y:2
    G91 X50 F2000 X:1 Y:2
    #CONTOUR END X:? Y:?
    X3 X:? Y:?
    G90 X4 Y5 X:4 Y:5
    M30 X:4 Y:5
    ");
    // No axis that requires its compensation moves, and no motion shares a block with a command.
    let toml = "[[axis]]\nname = \"X\"\nfrict_comp = true\nrequired = [\"FRICT\"]\nvalue = { mode = 3, table = [[0, 1]] }\n";
    let program =
        "X[COMP OFF FRICT]\n#CONTOUR BEGIN [ID1]\nG1 X1\n#CONTOUR END\nX[COMP ON FRICT]\nM30";
    let said = Bench::on(toml).said(program);
    assert!(!said.contains("70435"), "{said}");
}

#[test]
fn every_description_of_geometry_moves_nothing() {
    // R2.81
    for (begin, end) in [
        ("#CONTOUR BEGIN [ID1]", "#CONTOUR END"),
        ("#STROKE DEF BEGIN", "#STROKE DEF END"),
        ("#CONTROL AREA BEGIN [ID1 POLY EXCL]", "#CONTROL AREA END"),
    ] {
        let text = positions(&format!("X1\n{begin}\nX125\n{end}\nX2\nM30"));
        assert!(text.contains("X125 X:1"), "{text}");
        assert!(text.contains("X2 X:?") || text.contains("X2 X:2"), "{text}");
        // One that a program leaves open is reported where it opens, and ends with the program.
        let said = Bench::new().said_in_session(&[&format!("G1 X1\n{begin}\nX1\nM30"), "X1\nM30"]);
        let opener = begin.split(" [").next().unwrap();
        assert!(
            said.contains(&format!("FC208 2:1 `{opener}` has no `{end}`")),
            "{said}"
        );
        assert_eq!(said.matches("FC208").count(), 1, "{said}");
    }
    // The end of another description ends nothing.
    let text = positions("X1\n#STROKE DEF BEGIN\n#CONTOUR END\nX125\n#STROKE DEF END\nX2\nM30");
    assert!(text.contains("X125 X:1"), "{text}");
}

#[test]
fn a_circle_by_its_centre_moves_both_axes_of_its_plane() {
    // R2.46
    assert_snapshot!(positions("G1 X1 Y2 F100\nG2 I5\nX3 I1\nG18 G3 K5\nM30"), @"
    G1 X1 Y2 F100 X:1 Y:2
    G2 I5 X:1 Y:2
    X3 I1 X:3 Y:2
    G18 G3 K5 X:3 Y:2
    M30 X:3 Y:2
    ");
    let required = "[[axis]]\nname = \"X\"\nfrict_comp = true\nrequired = [\"FRICT\"]\nvalue = { mode = 3, table = [[0, 1]] }\n[[axis]]\nname = \"Y\"\nfrict_comp = true\nrequired = [\"FRICT\"]\nvalue = { mode = 3, table = [[0, 1]] }\n[[axis]]\nname = \"Z\"\n";
    let bench = Bench::on(required);
    let moved = |program: &str| {
        let said = bench.said(program);
        ["X", "Y", "Z"]
            .map(|axis| said.contains("70435") && said.contains(&format!("`{axis}` moves")))
    };
    for (program, axes) in [
        ("G2 I5", [true, true, false]),
        ("G3 J5", [true, true, false]),
        ("G2 X5 R5", [true, true, false]),
        ("G2 Z5 I5", [true, true, false]),
        ("G1 I5", [false; 3]),
        ("G4 X5", [false; 3]),
        ("G18 G2 K5", [true, false, false]),
        ("G2 G4 X5", [false; 3]),
        ("G2 F100", [false; 3]),
    ] {
        let whole = format!("X[COMP OFF FRICT] Y[COMP OFF FRICT]\n{program}\nM30");
        assert_eq!(moved(&whole), axes, "{program}");
    }
    // The motion lints take it into account.
    let said = Bench::new().said("G2 I5 F100\nX[COMP OFF FRICT]\nM30");
    assert!(said.contains("FC407 2:1"), "{said}");
    let said = Bench::new().said_in_session(&["Y[COMP OFF FRICT]\nM30", "G17 G2 I5 F100\nM30"]);
    assert!(said.contains("FC403 1:"), "{said}");
    let said = Bench::new().said("G2 I5 X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30");
    assert!(said.contains("FC405"), "{said}");
}

#[test]
fn cycles_of_real_time_are_one_region() {
    // R2.81
    let body = "  $IF ONCE V.RTA.ACS.ACT_POS.X > 200\n    M100 X5\n    #RT WHILE\n    V.RTG.LOOP.ENABLED = TRUE\n  $ENDIF\n  $IF ALWAYS V.E.A\n X[COMP OFF FRICT]\n  $ENDIF\n";
    for opener in [
        "#RT CYCLE DEF [ID = 17 SCOPE = PROG]",
        "N5 #RT CYCLE DEF [ID=17]",
        "#RT CYCLE [SCOPE=GLOBAL ID=3]",
        "#RT CYCLE",
    ] {
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            let program = format!(
                "X1\n{opener}\n{body}N9 #RT CYCLE END\n#RT CYCLE START [ID = 17]\n#RT CYCLE DELETE [ID=17]\nX2\nM30"
            );
            let transcript = Bench::new().handed(handed).run(&[&program]);
            assert!(
                transcript.contains("M30 X:active"),
                "{opener}: {transcript}"
            );
            assert!(!transcript.contains("FC"), "{opener}: {transcript}");
        }
    }
}

#[test]
fn a_loop_of_real_time_may_run_any_number_of_times() {
    // R2.51 R2.81
    let program = "X1\n#RT WHILE [MODULO]\nX2\nX[COMP OFF FRICT]\nP1=2\n#RT ENDWHILE\nM30";
    for handed in [SourceMode::Whole, SourceMode::LineByLine] {
        let transcript = Bench::new().handed(handed).run(&[program]);
        assert!(transcript.contains("FC901 2:1-19"), "{transcript}");
        assert!(
            transcript.contains("M30 X:unknown Y:active"),
            "{transcript}"
        );
    }
    let said = Bench::new().said("#RT WHILE\nM30");
    assert!(
        said.contains("FC208") && said.contains("#RT ENDWHILE"),
        "{said}"
    );
    let said = Bench::new().said("#RT ENDWHILE\nM30");
    assert!(said.contains("FC208"), "{said}");
}
