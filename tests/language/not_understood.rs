//! 2.10: text that is not understood, and forms of real programs.

use frictcomp::comp::{AxisIndex, Kind, State};

use crate::support::Bench;

fn run(program: &str) -> String {
    Bench::new().keep_going().run(&[program])
}

/// Returns the line of a block, its states and the codes below it.
fn block(program: &str, line: u32) -> String {
    let text = run(program);
    let head = format!(" line {line} ");
    let mut lines = text.lines().skip_while(|row| !row.contains(&head));
    let first = lines.next().unwrap_or_default().to_owned();
    let codes = lines.take_while(|row| row.starts_with("    "));
    codes.fold(first, |all, code| all + "|" + code.trim())
}

/// Returns the codes of a program, each as often as it is reported.
fn codes(program: &str) -> Vec<String> {
    let text = run(program);
    let words = text.lines().filter_map(|row| row.trim().split(' ').next());
    let codes = words.filter(|word| word.starts_with("FC") || word.starts_with("P-ERR"));
    codes.map(str::to_owned).collect()
}

#[test]
fn text_with_the_form_of_the_language_may_change_everything() {
    // R2.70
    for text in [
        "L[NAME]",
        "M[3]",
        "L10=5",
        "#SPECIAL MODE",
        "#SET SPECIAL",
        "$FLOW X",
        "P1000",
        "G54.1 X1",
        "GETREV[1]",
        "LOOK_UP[1, 2]",
        "M3 [LATER]",
        "L CYCLE [NAME=a.cyc @P1=3 SLOWLY]",
        "M3.5",
        "M-3",
        "T-1",
        "D-2",
        "G-3",
    ] {
        let found = block(&format!("{text}\nM30"), 1);
        assert!(found.contains("FC210"), "{text}: {found}");
        assert!(
            found.contains("X:active>unknown Y:active>unknown"),
            "{text}: {found}"
        );
        let values = Bench::new().values(
            &format!("P1=1 V.P.A=2 V.S.B=3\n{text}"),
            &["P1", "V.P.A", "V.S.B", "P77", "V.P.NEW"],
        );
        assert_eq!(values.matches("-> unknown").count(), 5, "{text}: {values}");
    }
}

#[test]
fn assignments_of_what_is_not_known_change_their_target() {
    // R2.70
    let values = Bench::new().values("P1=1 P2=2\nP1=FOO[3]\nV.P.A=V.x.+y", &["P1", "P2", "V.P.A"]);
    assert_eq!(
        values.trim(),
        "P1 -> unknown: FOO[3]\nP2 -> 2\nV.P.A -> unknown: V.x.+y"
    );
    // The target itself is unknown: it may be any parameter.
    for text in ["FOO[3]=5", "FOO[3] += 1", "R1=5", "V.P.-A=3"] {
        let values = Bench::new().values(&format!("P1=1\n{text}"), &["P1"]);
        assert!(values.contains("P1 -> unknown"), "{text}: {values}");
        assert_eq!(codes(&format!("{text}\nM30")), ["FC210"], "{text}");
    }
    assert_eq!(codes("X1\nX=FOO[1]\nM30"), ["FC210"]);
    assert!(
        Bench::new()
            .positions("X1\nX=FOO[1] Y2\nM30")
            .contains("X:?")
    );
    // A letter in lower case is not an axis.
    let found = Bench::new().positions("X1 Y1\nx5 Y2\nM30");
    assert!(found.contains("X:?"), "{found}");
}

#[test]
fn text_that_no_form_explains_is_an_error() {
    // R2.70
    for text in ["X1O", "X1 )", "$IFF P1", "X ! 3", "FOO", "P1=3 *"] {
        let found = block(&format!("{text}\nM30"), 1);
        assert!(
            found.contains("FC207") && !found.contains("unknown"),
            "{text}: {found}"
        );
    }
    let said = Bench::new().said("$WHIL 1\n$ENDWHILE\nM30");
    assert!(said.contains("did you mean `$WHILE`?"), "{said}");
}

#[test]
fn what_a_table_names_is_silent() {
    // R2.70
    for text in [
        "#HSC ON",
        "#MSG SYN [\"a\"]",
        "X[OSC ON]",
        "S[REV500]",
        "M77",
        "H3",
        "G66",
        "Q5",
    ] {
        let found = block(&format!("{text}\nM30"), 1);
        assert!(
            !found.contains("FC") && !found.contains('>'),
            "{text}: {found}"
        );
    }
    // A command that reads into a parameter makes it unknown.
    let values = Bench::new().values(
        "P1=1 P2=2 V.P.A=3\n#GET CMDPOS [P1, V.P.A]",
        &["P1", "P2", "V.P.A"],
    );
    assert_eq!(
        values.trim(),
        "P1 -> unknown: #GET CMDPOS\nP2 -> 2\nV.P.A -> unknown: #GET CMDPOS"
    );
}

#[test]
fn what_stands_beside_a_command_may_be_executed() {
    // R2.6 R2.47 R2.70
    for program in [
        "#HSC ON X[COMP ON FRICT]",
        "#HSC ON [BSPLINE] X[COMP OFF FRICT]",
        "#FF [80] X[COMP OFF FRICT]",
        "#TIME 2.5 $GOTO N10\nN10: X1",
        "#TIME 2.5 P1=3",
        "#MSG [\"a\"] \"MACRO\"",
        "#MSG [\"a\"] L sub.nc",
        "#SET AX [X, 1, 0] FAST M17",
        "#PSET X10 Y[COMP OFF FRICT]",
        "G1 X10 F100 #TIME 8.15",
        "[HERE] X[COMP ON FRICT] #FLUSH WAIT",
        "P1=3 #VAR\nV.P.A = 3\n#ENDVAR",
        "#COMMENT BEGIN X[COMP OFF FRICT]\nX1\n#COMMENT END",
        "#COMMENT BEGIN\nX1\n#COMMENT END X[COMP OFF FRICT]",
        "X10 #COMMENT BEGIN\n#COMMENT END",
        "#VAR\nV.P.A = 3\n#ENDVAR X[COMP OFF FRICT]",
        "#VAR\n#HSC ON X[COMP OFF FRICT]\n#ENDVAR M17",
        "#RT CYCLE [ID=1]\nV.E.A = 1\n#RT CYCLE END X[COMP OFF FRICT]",
    ] {
        let said = run(&format!("{program}\nM30"));
        assert!(said.contains("FC210"), "{program}: {said}");
        assert!(
            said.contains("X:active>unknown Y:active>unknown"),
            "{program}: {said}"
        );
    }
    assert_eq!(codes("#HSC ON [BSPLINE\nM30"), ["FC205"]);
}

#[test]
fn what_a_macro_holds_limits_what_is_in_its_block() {
    // R2.13 R2.35 R2.47
    let define = r##""CALL" = "L sub.nc"
"TIME" = "#TIME 1"
"OUTER" = "\"TIME\""
"BOTH" = "X1 \"TIME\""
"SET" = "#PSET X1"
"SPLINE" = "#SPLINE ON"
"REST" = "G1 ; a remark"
"OPEN" = "G1 (a remark"
"CLOSED" = "G1 (a remark)"
F100
"##;
    for block in [
        "X1 \"TIME\"",
        "\"TIME\" X[COMP OFF FRICT]",
        "X1 \"OUTER\"",
        "\"BOTH\"",
        "\"SET\" X[COMP OFF FRICT]",
        "\"REST\" X[COMP OFF FRICT]",
        "\"OPEN\" X[COMP OFF FRICT] (another)",
    ] {
        let said = run(&format!("{define}{block}\nM30"));
        assert!(said.contains("FC210"), "{block}: {said}");
        assert!(said.contains("X:active>unknown"), "{block}: {said}");
    }
    for block in [
        "\"TIME\"",
        "N10 \"OUTER\"",
        "[HERE] \"TIME\" (a remark)",
        "X1 \"SET\"",
        "X1 \"SPLINE\" Y2",
        "\"REST\"",
        "X1 \"OPEN\"",
        "\"CLOSED\" Y5",
    ] {
        let found = codes(&format!("{define}{block}\nM30"));
        assert!(found.is_empty(), "{block}: {found:?}");
    }
    let found = codes(&format!("{define}\"CALL\" X[COMP OFF FRICT]\nM30"));
    assert!(found.contains(&"FC207".to_owned()), "{found:?}");
    // In a region that may or may not be executed.
    let said = run(&format!(
        "{define}\"SKIP\" = \"$IF V.E.A == 1 $GOTO N90\"\n\"SKIP\"\nX1 \"TIME\"\nN90 M30"
    ));
    assert!(said.contains("X:active>unknown"), "{said}");
}

#[test]
fn a_word_that_goes_on_a_command_is_known_or_may_do_anything() {
    // R2.70
    let said = block("#HSC ON SOFTLY [1]\nM30", 1);
    assert!(
        said.contains("X:active>unknown") && said.contains("FC210"),
        "{said}"
    );
    for program in [
        "#MSG SAVE EXCLUSIVE [\"X[COMP ON FRICT]\"]",
        "#SET AX [X, 1, 0][Y, 2, 1] FAST",
        "#PSET X10 Y-20",
        "#PSET [X=0 Y=10]",
        "#AX REQUEST NAM [X, 1, 0]",
        "#AKIMA STARTVECTOR [1, 0, 0]",
        "#CS DEF [P1+1][X, 20, 30, 0, 0, 45]",
        "#MCS ON EX TOOL",
        "#TIME P1",
        "#TIME 2*1.5",
        "#INIT V.E.",
        "#MEAS MODE 1",
        "#SLOPE [TYPE=HSC]  (a remark)",
        "#SPLINE ON X10 Y20",
        "X1 #PSET X10",
        "/2 N10 [HERE] #TIME 1",
        "#MCS OFF",
    ] {
        let found = codes(&format!("P1=1\n{program}\nM30"));
        assert!(found.is_empty(), "{program}: {found:?}");
    }
}

#[test]
fn commands_that_stand_among_words_leave_them_as_they_are() {
    // R2.47: PM/206123787, 206609163, 207256971
    let bench = Bench::new();
    for (program, found) in [
        ("G1 X10 #RND=3 Y5", "X:10 Y:5"),
        ("X10 #CHF 2 Y5 #FRC=100", "X:10 Y:5"),
        // The coordinate that the angle gives is not computed.
        ("G1 #ANG=60 X20", "X:20 Y:?"),
        ("Y3 #ANG=60 X20", "X:20 Y:3"),
        ("#ANG=10", "X:? Y:?"),
        ("#SPLINE ON X1 Y2", "X:1 Y:2"),
    ] {
        let said = bench.positions(&format!("X0 Y0\n{program}\nM30"));
        let row = said.lines().nth(1).unwrap_or_default();
        let row = row.replace('*', "");
        assert!(row.contains(found), "{program}: {said}");
    }
    for program in [
        "X1 #RND=3 X[COMP OFF FRICT]",
        "#SPLINE ON X[COMP OFF FRICT]",
    ] {
        let said = run(&format!("{program}\nM30"));
        assert!(said.contains("X:active>inactive"), "{program}: {said}");
    }
    // They also count on a way that may be taken.
    let said = run("$IF V.E.A\n#SPLINE ON X[COMP OFF FRICT] X1\n$ENDIF\nM30");
    assert!(
        said.contains("X:active>inactive") || said.contains("X:unknown"),
        "{said}"
    );
}

#[test]
fn an_unreadable_condition_opens_its_block_and_is_said_once() {
    // R2.71
    for (opener, closer) in [
        ("$IF P1 = 3", "$ENDIF"),
        ("$IF FOO[1] > 2", "$ENDIF"),
        ("$IF", "$ENDIF"),
        ("$IFF P1", "$ENDIF"),
        ("$WHILE P1 ==", "$ENDWHILE"),
        ("$FOR P1 = 1", "$ENDFOR"),
        ("$FOR P1 = 1, FOO[2], 1", "$ENDFOR"),
        ("$SWITCH ?\n$CASE 1", "$ENDSWITCH"),
        ("$DO ?", "$ENDDO"),
        ("#IF P1 = 3", "#ENDIF"),
        ("$REPEAT", "$UNTIL ?"),
        ("$IF P1 = 3 $GOTO N9", "N9: X1"),
        ("$IF GETREV[2] $GOTO N9", "N9: X1"),
    ] {
        let program = format!("P1=1\n{opener}\nX[COMP OFF FRICT] P1=2\n{closer}\nM30");
        let found = codes(&program);
        let said: Vec<_> = found
            .iter()
            .filter(|code| !code.starts_with("FC40"))
            .collect();
        assert_eq!(said.len(), 1, "{opener}: {found:?}");
        assert!(
            ["FC207", "FC210"].contains(&said[0].as_str()),
            "{opener}: {found:?}"
        );
        if !opener.contains("GOTO") && opener != "$REPEAT" {
            assert!(run(&program).contains("X:active>unknown"), "{opener}");
        }
    }
    // Later consequences are reported, in suitable words.
    let said = Bench::new().said("P1=FOO[1]\n$IF P1 == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30");
    assert!(
        said.contains("depends on `FOO[1]`, which frictcomp does not know"),
        "{said}"
    );
}

#[test]
fn parameters_with_computed_numbers() {
    // R2.72
    let values = Bench::new().values(
        "P[1+1]=5 P4=3\nP[P4]=P[2]*2\nP[P4] += 1\nP7=P[P[2]-1]",
        &["P2", "P3", "P7", "P[P4]", "P[1] + 0", "P[1.6]"],
    );
    assert_eq!(
        values.trim(),
        "P2 -> 5\nP3 -> 11\nP7 -> 3\nP[P4] -> 11\nP[1] + 0 -> FC311 5:9-13\nP[1.6] -> 5"
    );
    let values = Bench::new().values("P1=1\nP[V.E.I]=2", &["P1", "P2"]);
    assert_eq!(values.matches("-> unknown: V.E.I").count(), 2, "{values}");
}

#[test]
fn conditional_interpretation_is_executed() {
    // R2.73
    let off = "X[COMP OFF FRICT]";
    for (program, executed) in [
        (format!("#IF 1 == 2\n{off}\n#ENDIF"), false),
        (format!("#IF 1 == 2\n#ELSE\n{off}\n#ENDIF"), true),
        (
            format!("#IF FALSE\n#ELSEIF TRUE\n{off}\n#ELSE\nY[COMP OFF FRICT]\n#ENDIF"),
            true,
        ),
        (format!("#IF TRUE\n#IF FALSE\n{off}\n#ENDIF\n#ENDIF"), false),
        (format!("#IF TRUE\n$IF TRUE\n{off}\n$ENDIF\n#ENDIF"), true),
        (format!("$IF TRUE\n#IF FALSE\n{off}\n#ENDIF\n$ENDIF"), false),
        (format!("#if true\n{off}\n#endif"), true),
        (format!("#IF TRUE $GOTO N9\n{off}\nN9: X1"), false),
    ] {
        let text = run(&format!("{program}\nM30"));
        assert_eq!(
            text.contains("X:active>inactive"),
            executed,
            "{program}: {text}"
        );
        assert!(!text.contains("Y:active>"), "{program}: {text}");
    }
    for (statement, place) in [("N10 #IF TRUE", "1:1-8"), ("[HERE] #IF TRUE", "1:2-11")] {
        let said = run(&format!("{statement}\n#ENDIF\nM30"));
        assert!(said.contains(&format!("FC208 {place}\n")), "{said}");
    }
    let said = run("#IF TRUE\nN20 #ENDIF\nM30");
    assert!(said.contains("FC208 2:1-11\n"), "{said}");
    let marked = format!("/#IF TRUE\n{off}\n/#ENDIF\nM30");
    let text = Bench::new().skip("none").run(&[&marked]);
    assert!(text.contains("X:active>inactive"), "{text}");
    let said = Bench::new().said("X1\n#IF 1\nX2\nM30");
    assert!(
        said.contains("`#IF` has no `#ENDIF`") && said.contains(" 2:1"),
        "{said}"
    );
    assert_eq!(
        codes("#IF V.E.A\nX[COMP OFF FRICT]\n#ENDIF\nX[COMP ON FRICT]\nM30"),
        ["FC901"]
    );
    // A branch that is left out is not read; one under an unknown condition is.
    let check = |program: &str| Bench::new().check_all().run(&[program]);
    assert!(!check("#IF FALSE\nX[COMP ON FRIKT]\n#ENDIF\nM30").contains("FC202"));
    assert!(check("#IF V.E.A\nX[COMP ON FRIKT]\n#ENDIF\nM30").contains("FC202"));
    assert!(check("$IF FALSE\nX[COMP ON FRIKT]\n$ENDIF\nM30").contains("FC202"));
}

#[test]
fn calls_need_no_blank() {
    // R2.74
    let off = "X[COMP OFF FRICT]\nM17";
    let bench = || {
        let bench = Bench::new().keep_going();
        bench
            .file("4712", off)
            .file("UP1.nc", off)
            .file("a b.nc", off)
    };
    for call in [
        "L4712",
        "LUP1.nc",
        "N10LUP1.nc",
        "L 4712",
        "L\"a b.nc\"",
        "X1 LUP1.nc",
        "l4712",
        "LV.E.NAME",
    ] {
        let text = bench()
            .set_text("V.E.NAME", "4712")
            .run(&[&format!("{call}\nX[COMP ON FRICT]\nM30")]);
        assert!(text.contains("X:active>inactive"), "{call}: {text}");
    }
    let local = Bench::new()
        .run(&["%L UP\nX[COMP OFF FRICT]\nM17\n%M\nLL UP\nLLUP\nX[COMP ON FRICT]\nM30"]);
    assert_eq!(local.matches("line 2").count(), 2, "{local}");
    assert_eq!(codes("L4713\nM30"), ["FC320"]);
    assert_eq!(codes("LOOK\nM30"), ["FC320"]);
}

#[test]
fn words_of_spindles() {
    // R2.76
    for text in [
        "S.POS180",
        "S.POS=180",
        "S.OFFSET=10",
        "S1000 S.POS314",
        "S2.POS180",
        "S.POS P1",
        "S.POS[P1+1]",
    ] {
        let found = block(&format!("P1=1\n{text}\nM30"), 2);
        let known = !text.contains('[');
        assert_eq!(!found.contains("FC"), known, "{text}: {found}");
    }
    let found = block("S.TURN3\nM30", 1);
    assert!(found.contains("FC210") && !found.contains('>'), "{found}");
}

#[test]
fn what_a_call_gave() {
    // R2.79
    let cycle = "$IF V.G.@P[1].VALID\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.G.@P[2].VALID == TRUE\nY[COMP OFF FRICT]\n$ENDIF\nM17";
    let bench = || Bench::new().file("a.cyc", cycle);
    let text = bench().run(&["L CYCLE [NAME=a.cyc @P1=3 @X=10 @S=100]\nX[COMP ON FRICT]\nM30"]);
    assert!(
        text.contains("X:active>inactive") && !text.contains("Y:active>"),
        "{text}"
    );
    // If the cycle runs by itself, the value is unknown, unless the user gives the call's value.
    let alone = Bench::new().run(&[cycle]);
    assert_eq!(alone.matches("FC901").count(), 2, "{alone}");
    let told = Bench::new().set("@P1", 4.0).run(&[
        "$IF @P1 == 4 && V.G.@P[1].VALID\nX[COMP OFF FRICT]\n$ENDIF\nX[COMP ON FRICT]\nM30",
    ]);
    assert!(told.contains("X:active>inactive"), "{told}");
    let values = Bench::new().values(
        "@P2=1 V.P.T=\"a\"",
        &[
            "@P4",
            "@P2",
            "@X",
            "IS_STRING[V.P.T]",
            "IS_NUMBER[V.P.T]",
            "IS_NUMBER[3]",
            "IS_STRING[V.E.A]",
        ],
    );
    assert_eq!(
        values.trim(),
        "@P4 -> unknown: @P4\n@P2 -> 1\n@X -> unknown: @X\nIS_STRING[V.P.T] -> 1\nIS_NUMBER[V.P.T] -> 0\nIS_NUMBER[3] -> 1\nIS_STRING[V.E.A] -> unknown: V.E.A"
    );
}

#[test]
fn signs_in_names_and_assignments() {
    // R2.80
    let values = Bench::new().values(
        "P1=10\nP1 += 1\nP1 -= 3\nP1*=2\nP1 /= 4\nV.P.A=2 V.P.A+=3\n#VAR\nV.P.L[2]=[1,2]\n#ENDVAR\nV.P.L[1]*=5\nP2=1 P[P2+2]=7 P[P2+2]-=2",
        &["P1", "V.P.A", "V.P.L[1]", "P3", "MIN[4,2,9]", "MAX[4,2,9,10]", "MIN[1]", "V.A.+SWE.X-1", "V.A.-SWE_MDS.X"],
    );
    assert_eq!(
        values.trim(),
        "P1 -> 4\nV.P.A -> 5\nV.P.L[1] -> 10\nP3 -> 5\nMIN[4,2,9] -> 2\nMAX[4,2,9,10] -> 10\nMIN[1] -> FC312 12:9-15\nV.A.+SWE.X-1 -> unknown: V.A.+SWE.X\nV.A.-SWE_MDS.X -> unknown: V.A.-SWE_MDS.X"
    );
    assert_eq!(codes("P1 += 1\nM30"), ["FC311"]);
}

#[test]
fn an_axis_has_one_coordinate_a_block() {
    // R2.82
    let found = Bench::new().positions("G90 X5 Y1\nG91 X1 X2 Y1\nM30");
    assert!(found.contains("X1 X2 Y1 X:8 Y:2"), "{found}");
    assert_eq!(codes("G90 X5 Y1 X=7 X8\nM30"), ["FC313"]);
    assert!(codes("G91 X5 X7\nG04 X1\nM30").is_empty());
    assert!(codes("G90 G92 X5\nX1 G91 X2\nM30").is_empty());
}

#[test]
fn what_only_the_machine_numbers_ends_no_program() {
    // R2.52
    assert_eq!(codes("MV.E.CODE\nX1\nM30"), ["FC902"]);
    assert_eq!(codes("TV.E.TOOL\nX1\nM30"), Vec::<String>::new());
}

#[test]
fn arrays_go_on_over_lines_of_a_declaration() {
    // R2.34
    let program = "#VAR\nV.P.A[2][3] = [1, 2,\n\n 3, 4, 5, 6]\nV.P.B = 7\n#ENDVAR";
    let values = Bench::new().values(program, &["V.P.A[1][2]", "V.P.B"]);
    assert_eq!(values.trim(), "V.P.A[1][2] -> 6\nV.P.B -> 7");
    let open = codes("#VAR\nV.P.A[2] = [1, 2\nV.P.B = 7\n#ENDVAR\nP1=V.P.B\nM30");
    assert_eq!(open, ["FC207"]);
}

#[test]
fn labels_beyond_any_block_number_are_refused() {
    // R2.42
    let label = "N99999999999999999999: X1\nN0: X2\nM30";
    assert_eq!(codes(label), ["FC209"]);
    let said = Bench::new().said("$GOTO N99999999999999999999\nN0: X1\nM30");
    assert!(
        said.contains("does not exist") && !said.contains("`N0`"),
        "{said}"
    );
}

#[test]
fn what_the_user_says_stands_for_what_no_program_wrote() {
    // R2.36
    let bench = Bench::new()
        .set("P1", 3.0)
        .set("V.P.A", 4.0)
        .set("v.e.b", 5.0)
        .set("V.S.C", 6.0);
    let values = bench.values(
        "P2=P1+V.P.A",
        &["P1", "V.P.A", "V.E.b", "v.e.b", "V.S.C", "P2"],
    );
    assert_eq!(
        values.trim(),
        "P1 -> 3\nV.P.A -> 4\nV.E.b -> 5\nv.e.b -> 5\nV.S.C -> 6\nP2 -> 7"
    );
    assert_eq!(bench.values("P1=8", &["P1"]).trim(), "P1 -> 8");
}

#[test]
fn values_are_named_as_the_program_writes_them_and_given_by_that_name() {
    // R2.36
    for (written, given) in [
        ("v.e.Part", "v.e.Part"),
        ("v.e.Part", "V.E.Part"),
        ("V.E.LIST[P1]", "V.E.LIST[P1]"),
        ("V.E.LIST[P1]", "V.E.LIST[2]"),
        ("V.E.LIST[P1+1,3].X", "v.e.LIST[P1+1, 3].X"),
        ("V.E.LIST[P1+1,3].X", "V.E.LIST[3][3].X"),
        ("V.E.LIST[V.E.I]", "V.E.LIST[V.E.I]"),
    ] {
        let program = format!("P1=2\n$IF {written} > 1\nX[COMP OFF FRICT]\n$ENDIF\nM30");
        let said = Bench::new().said(&program);
        let name = if written.contains("V.E.I]") {
            "V.E.I"
        } else {
            written
        };
        assert!(said.contains(&format!("`{name}`")), "{written}: {said}");
        let known = Bench::new().set(given, 2.0).run(&[&program]);
        assert!(
            known.contains("M30 X:inactive"),
            "{written} {given}: {known}"
        );
    }
    // The name itself is case-sensitive (P-EXTV-00001).
    let other = Bench::new()
        .set("V.E.PART", 2.0)
        .said("$IF V.E.Part > 1\nX[COMP OFF FRICT]\n$ENDIF\nM30");
    assert!(other.contains("FC901"), "{other}");
    // The same applies to parameters and program variables.
    let bench = Bench::new().set("p5", 3.0).set("v.p.a", 4.0);
    assert_eq!(
        bench.values("", &["P5+V.P.a", "v.p.a"]).trim(),
        "P5+V.P.a -> 7\nv.p.a -> 4"
    );
}

#[test]
fn what_the_user_declares_harmless_is_passed_over() {
    // R2.70
    let machine = "[machine]\nharmless = [\"#mycmd\", \"#SHOP  LAMP\", \"M100\"]\n[[axis]]\nname = \"X\"\nfrict_comp = true\nvalue = { mode = 3, table = [[0, 1]] }\n";
    let bench = Bench::on(machine);
    for (line, silent) in [
        ("#MYCMD", true),
        ("#MYCMD ON [ID=1]", true),
        ("#MyCmd [X]", true),
        ("#SHOP LAMP ON", true),
        ("#MYCMDS", false),
        ("#SHOP", false),
        ("#OTHER", false),
    ] {
        let program =
            format!("P1=1\n{line}\n$IF P1==1\nX[COMP OFF FRICT]\n$ENDIF\nX[COMP ON FRICT]\nM30");
        let said = bench.said(&program);
        assert_eq!(!said.contains("FC210"), silent, "{line}: {said}");
        assert_eq!(!said.contains("FC901"), silent, "{line}: {said}");
        let region = format!("$IF V.E.A\n{line}\n$ENDIF\nX1\nM30");
        let known = bench.run(&[&region]).contains("M30 X:active");
        assert_eq!(known, silent, "{line}");
    }
    let positions = bench.positions("X1\nM100\nM101\nM30");
    assert!(positions.contains("M100 X:1\nM101 X:1*"), "{positions}");
    // Nothing else can be declared harmless.
    for wrong in ["COMP", "M", "#", "X[COMP ON FRICT]", "#MYCMD [1]", "G54"] {
        let text = format!("[machine]\nharmless = [\"{wrong}\"]\n");
        let refused = frictcomp::machine::Machine::from_toml(&text);
        assert!(refused.is_err(), "{wrong}");
    }
}

#[test]
fn an_error_of_the_program_stops_it() {
    // R2.100
    let left = |command: &str| {
        let program = format!("P1=1\nX[COMP OFF FRICT]\n{command}\nX[COMP ON FRICT]\nM30");
        let bench = Bench::new();
        let mut session = bench.session();
        let said = bench.run_in(&mut session, &[&program]);
        let state = session.state().state(AxisIndex::new(0), Kind::Frict);
        (state == State::Inactive, said.contains("FC318"))
    };
    for (command, stops) in [
        ("#ERROR [ID=455 RC=2]", true),
        ("#ERROR [ID455 RC5 PV1=5]", true),
        ("#ERROR [ID=1, RC=P1+1, MID=2]", true),
        ("#ERROR [ID=1 RC=0]", false),
        ("#ERROR [ID=1 RC=P1-1]", false),
        ("#ERROR [ID=1 PV1=\"RC=2\"]", false),
        ("#ERROR [ID455 RC 1+1]", true),
        ("#ERROR [RC[2], ID=1]", true),
        ("#ERROR [PV1=\"RC=0\" RC=[1+1]]", true),
        ("#ERROR [RC P1]", true),
        ("#error [id=1 rc=2]", true),
        ("#ERROR [RC[0] ID=2]", false),
        ("#ERROR [ID=1 RC 0]", false),
        ("$IF P1==2\n#ERROR [RC=2]\n$ENDIF", false),
    ] {
        assert_eq!(left(command), (stops, stops), "{command}");
    }
    // R14.5: on one way it does, and the other continues.
    let one_way = left("$IF V.E.A==2\n#ERROR [RC=2]\n$ENDIF");
    assert_eq!(one_way, (false, true));
    let program = "X[COMP OFF FRICT]\n#ERROR [RC=2]\nX[COMP ON FRICT]\nM30";
    let said = Bench::new().keep_going().said(program);
    assert!(said.contains("FC318") && !said.contains("FC401"), "{said}");
}

#[test]
fn an_assignment_to_what_shows_a_state_is_said_and_makes_it_unknown() {
    // R1.35 R2.36
    let off = "X[COMP OFF FRICT]\n";
    for text in [
        "V.A.FRICT_COMP_ACTIVE.X = 1",
        "V.A.FRICT_COMP_ACTIVE[0] = 1",
        "V.A.FRICT_COMP_INIT.X = 0",
        "$FOR V.A.FRICT_COMP_ACTIVE.X = 1, 1, 1\n$ENDFOR",
    ] {
        let program = format!("{off}{text}\nM30");
        let found = block(&program, 2);
        assert!(found.contains("X:inactive>unknown"), "{found}");
        assert!(found.contains("FC322"), "{found}");
        assert!(run(&program).contains("X:unknown Y:active"), "{text}");
    }
    // The value read afterwards is not the one written.
    let values = Bench::new().values(
        &format!("{off}V.A.FRICT_COMP_ACTIVE.X = 1"),
        &["V.A.FRICT_COMP_ACTIVE.X"],
    );
    assert!(values.contains("unknown"), "{values}");
    // If it may have been executed, it is unknown as well.
    let region = format!("{off}$IF V.E.A\nV.A.FRICT_COMP_ACTIVE.X = 1\n$ENDIF\nM30");
    assert!(run(&region).contains("X:unknown"), "{}", run(&region));
    let position = Bench::new().positions("X1\nV.A.ABS.X = 3\nM30");
    assert!(position.contains("X:?"), "{position}");
    // Programs may write other variables.
    assert_eq!(codes("V.A.MERF.X = 1\nM30"), [] as [&str; 0]);
}

#[test]
fn a_block_number_that_cannot_be_computed_is_said() {
    // R2.51 R9.20
    assert_eq!(codes("N[1/0] Z1\nM30"), ["FC312"]);
    assert_eq!(codes("N[P9] Z1\nM30"), ["FC311"]);
    // As on the control, nothing of the block is executed.
    let program = "N[1/0] X[COMP OFF FRICT]\nM30";
    let stopped = Bench::new().run(&[program]);
    assert!(
        stopped.contains("FC312") && !stopped.contains('>'),
        "{stopped}"
    );
    assert!(
        run(program).contains("X:active>inactive"),
        "{}",
        run(program)
    );
}

#[test]
fn an_error_of_the_program_is_passed_over_only_where_the_program_goes_on() {
    // R2.70
    let opaque = |class: &str| {
        let program = format!("#ERROR [ID=455 RC={class}]\nM30");
        let bench = Bench::new().keep_going();
        let mut session = bench.session();
        bench.run_in(&mut session, &[&program]);
        session.interpreter().opaque().len()
    };
    assert_eq!((opaque("0"), opaque("2")), (1, 0));
}
