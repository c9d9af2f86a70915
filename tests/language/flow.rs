//! 2.5 and 2.8: flow and budgets.

use frictcomp::session::Limits;
use insta::assert_snapshot;

use crate::support::Bench;

/// Returns the executed lines.
fn lines(program: &str) -> String {
    let transcript = Bench::new().keep_going().run(&[program]);
    let said: Vec<&str> = transcript
        .lines()
        .filter_map(|line| {
            let said = line.strip_prefix("    ");
            said.or_else(|| {
                line.strip_prefix("  ")?
                    .split(" line ")
                    .nth(1)?
                    .split(' ')
                    .next()
            })
        })
        .collect();
    said.join(" ")
}

#[test]
fn branches() {
    // R2.40
    let program = |p: i32| {
        format!(
            "P1={p}\n$IF P1==1\nX1\n$ELSEIF P1==2\nX2\n$ELSEIF P1==3\nX3\n$ELSE\nX4\n$ENDIF\nM30"
        )
    };
    assert_snapshot!(lines(&program(1)), @"1 2 3 4 11");
    assert_snapshot!(lines(&program(2)), @"1 2 4 5 6 11");
    assert_snapshot!(lines(&program(3)), @"1 2 4 6 7 8 11");
    assert_snapshot!(lines(&program(4)), @"1 2 4 6 8 9 10 11");
    assert_snapshot!(lines("$IF 0\nX1\n$ENDIF\n$if 1\nX2\n$endif\nN10 $IF 1 $GOTO N30\nX3\nN30: $IF 0 $GOTO N99\nX4\nN99:\nM30"), @"1 3 4 FC404 4:1-4 5 6 FC404 6:1-7 7 9 10 11 12");
}

#[test]
fn switches() {
    // R2.40: equality within 0.001, `$BREAK`, fall-through, `$DEFAULT`.
    let program = |value: &str| {
        format!(
            "$SWITCH {value}\n$CASE 1\nX1\n$BREAK\n$CASE 2\nX2\n$CASE 3\nX3\n$BREAK\n$DEFAULT\nX4\n$ENDSWITCH\nM30"
        )
    };
    assert_snapshot!(lines(&program("1")), @"1 2 3 4 13");
    assert_snapshot!(lines(&program("2")), @"1 2 5 6 7 8 9 13");
    assert_snapshot!(lines(&program("3.0009")), @"1 2 5 7 8 9 13");
    assert_snapshot!(lines(&program("3.002")), @"1 2 5 7 10 11 12 13");
    assert_snapshot!(lines(&program("P1=1+1")), @"1 2 5 6 7 8 9 13");
    assert_snapshot!(lines("$SWITCH \"b\"\n$CASE \"a\"\nX1\n$CASE \"b\"\nX2\n$ENDSWITCH\n$SWITCH 5\n$CASE 1\nX3\n$ENDSWITCH\nM30"), @"1 2 4 5 6 7 8 10 11");
}

#[test]
fn counting_loops() {
    // R2.41
    assert_snapshot!(lines("$FOR P1=1,3,1\nX1\n$ENDFOR\nM30"), @"1 2 3 2 3 2 3 4");
    assert_snapshot!(lines("$FOR P1=3,1,-1\nX1\n$ENDFOR\nM30"), @"1 2 3 2 3 2 3 4");
    assert_snapshot!(lines("$FOR P1=1,0,1\nX1\n$ENDFOR\nX2\nM30"), @"1 4 5");
    assert_snapshot!(lines("$FOR V.P.I = 0, 1, 0.5\nX1\n$ENDFOR\nM30"), @"1 2 3 2 3 2 3 4");
    // The body may change the counter and the end.
    assert_snapshot!(lines("P2=10\n$FOR P1=1,P2,1\nP1=P1+3\nP2=6\n$ENDFOR\nV.S.R=P1\nM30"), @"1 2 3 4 5 3 4 5 6 7");
    // Step 0 is endless.
    let limits = Limits::default().with_blocks(7);
    assert_snapshot!(Bench::new().limits(limits).run(&["$FOR P1=1,3,0\nX1\n$ENDFOR\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 2 -
      5 line 3 -
      6 line 2 -
      7 line 3 -
        FC910 2:1-3
      end 7 budget X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn condition_loops() {
    // R2.41
    assert_snapshot!(lines("P1=0\n$WHILE P1<2\nP1=P1+1\n$ENDWHILE\nM30"), @"1 2 3 4 2 3 4 2 5");
    assert_snapshot!(lines("P1=0\n$DO\nP1=P1+1\n$ENDDO P1<2\nM30"), @"1 2 3 4 2 3 4 5");
    assert_snapshot!(lines("P1=0\n$DO P1<2\nP1=P1+1\n$ENDDO\nM30"), @"1 2 3 4 2 3 4 2 5");
    assert_snapshot!(lines("P1=0\n$DO\nP1=P1+1\n$IF P1==2\n$BREAK\n$ENDIF\n$ENDDO\nM30"), @"1 2 3 4 6 7 2 3 4 5 8");
    assert_snapshot!(lines("P1=0\n$REPEAT\nP1=P1+1\n$UNTIL P1>=2\nM30"), @"1 2 3 4 2 3 4 5");
}

#[test]
fn break_and_continue() {
    // R2.41
    assert_snapshot!(lines("$FOR P1=1,5,1\n$IF P1==2\n$CONTINUE\n$ENDIF\n$IF P1==3\n$BREAK\n$ENDIF\nX1\n$ENDFOR\nM30"), @"1 2 4 5 7 8 9 2 3 9 2 4 5 6 10");
    assert_snapshot!(lines("P1=0\n$WHILE 1\nP1=P1+1\n$SWITCH P1\n$CASE 2\n$BREAK\n$DEFAULT\n$CONTINUE\n$ENDSWITCH\n$BREAK\n$ENDWHILE\nM30"), @"1 2 3 4 5 7 8 11 2 3 4 5 6 10 12");
    assert_snapshot!(lines("P1=0\n$REPEAT\nP1=P1+1\n$CONTINUE\nX1\n$UNTIL P1>=2\nM30"), @"1 2 3 4 6 2 3 4 6 7");
}

#[test]
fn jumps() {
    // R2.42
    assert_snapshot!(lines("P1=0\nN10:\nP1=P1+1\n$IF P1<2\n$GOTO N10\n$ENDIF\n$GOTO [END]\nX1\n[END] X2\nM30"), @"1 2 3 4 5 2 3 4 6 7 9 10");
    // Into branches and loops.
    assert_snapshot!(lines("P1=2\n$GOTO N20\n$IF 0\nX1\nN20: X2\n$ELSE\nX3\n$ENDIF\nM30"), @"1 2 5 6 9");
    assert_snapshot!(lines("P1=2\n$GOTO [IN]\n$FOR P1=1,3,1\nX1\n[IN]\n$ENDFOR\nM30"), @"1 2 5 6 4 5 6 7");
    assert_snapshot!(lines("$FOR P1=1,3,1\n$IF P1==2 $GOTO N99\n$ENDFOR\nX1\nN99: M30"), @"1 2 3 2 5");
    // By expression and by variable, with a colon too.
    let bench = Bench::new().set_text("V.E.S", "TWO").set("V.E.N", 30.0);
    assert_snapshot!(bench.run(&["P1=10\n$GOTO N[P1+10]\nX1\nN20: $GOTO N30:\nX2\nN30: $GOTO V.E.S\nX3\n[TWO] $GOTO NV.E.N+10\nN40:\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 4 N20
      4 line 6 N30
      5 line 8 -
      6 line 9 N40
      7 line 10 -
      end 7 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    // Labels belong to their program level.
    assert_snapshot!(lines("%L S\nN10: X1\nM17\n%M\n$GOTO N10\nX2\nN10: LL S\nM30"), @"5 7 2 3 8");
    // The jump is the last action of its block.
    assert_snapshot!(Bench::new().run(&["$GOTO N9 X[COMP OFF FRICT]\nX1\nN9: M30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>inactive
      2 line 3 N9
        FC401 1:10-27
      end 2 M30 X:inactive Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn labels_that_are_wrong() {
    // R2.42: reported before anything runs.
    assert_snapshot!(Bench::new().run(&["X[COMP OFF FRICT]\nN10: X1\n$GOTO N10\nN10: X2\n[A]\n[A]\n$GOTO N20\n$GOTO [B]\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC209 4:1-5
        FC209 6:2-3
        FC209 7:1-10
        FC209 8:1-10
      end 0 error X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().run(&["P1=1\n$GOTO N[P1]\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
        FC209 2:1-12
      end 2 error X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn a_label_in_the_other_form_is_named() {
    // R2.42
    for (program, cure) in [
        (
            "$GOTO [N40]\nN40: M30",
            "the label `N40`: write `$GOTO N40`",
        ),
        (
            "$GOTO N40\n[N40]\nM30",
            "the label `[N40]`: write `$GOTO [N40]`",
        ),
        ("$GOTO N40\nN40 M30", "write the label with a colon, `N40:`"),
        ("$GOTO [N4X]\nN4: M30", "write `[N4X]` at the start"),
    ] {
        let said = Bench::new().said(program);
        assert!(said.contains(cure), "{program}: {said}");
    }
}

#[test]
fn unbalanced_blocks() {
    // R2.43
    assert_snapshot!(Bench::new().run(&["X1\nN10 $IF 1\n$FOR P1=1,2,1\n$ENDIF\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC208 3:1-14
      end 0 error X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().run(&["$WHILE 1\nX1\n%L S\n$ENDWHILE\nM17"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC208 1:1-9
        FC208 4:1-10
      end 0 error X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().run(&["$ENDIF\n$ELSE\n$CASE 1\n$UNTIL 1\n$BREAK\n$CONTINUE\n$SWITCH 1\n$CASE 1\n$CONTINUE\n$ENDSWITCH\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC208 1:1-7
        FC208 2:1-6
        FC208 3:1-8
        FC208 4:1-9
        FC208 5:1-7
        FC208 6:1-10
        FC208 9:1-10
      end 0 error X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().run(&["$FOO 1\n$IFF 1\n$FOR P1\n$GOTO 5\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC208 3:1-8
      end 0 error X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn branches_that_no_value_leads_to_are_refused() {
    // R2.43
    for (program, lines) in [
        ("$IF 1\nX1\n$ELSE\nX2\n$ELSEIF 1\nX3\n$ELSE\n$ENDIF", "5 7"),
        ("$SWITCH 2\n$CASE 1\n$DEFAULT\nX1\n$CASE 2\n$ENDSWITCH", "5"),
        ("$SWITCH 2\nX[COMP OFF FRICT]\nX1\n$CASE 2\n$ENDSWITCH", "2"),
        ("$SWITCH 2\n$IF 1\n$CASE 2\n$ENDIF\n$ENDSWITCH", "2 3"),
        ("$SWITCH 2\n; no block\n\n[HERE] $CASE 2\n$ENDSWITCH", ""),
        ("$SWITCH 2\n$ENDSWITCH", ""),
    ] {
        let said = Bench::new().keep_going().run(&[&format!("{program}\nM30")]);
        let rows = said
            .lines()
            .filter_map(|row| row.trim().strip_prefix("FC208 "));
        let found: Vec<&str> = rows.filter_map(|row| row.split(':').next()).collect();
        assert_eq!(found.join(" "), lines, "{program}: {said}");
    }
}

#[test]
fn a_control_statement_is_alone_in_its_block() {
    // R2.43
    let refused = |program: &str, place: &str| {
        let said = Bench::new().run(&[&format!("{program}\nN9: M30")]);
        assert!(
            said.contains(&format!("FC208 {place}\n")),
            "{program}: {said}"
        );
        assert!(said.contains("end 0 error"), "{program}: {said}");
    };
    for (program, place) in [
        ("$IF 0\n$ELSE X[COMP OFF FRICT]\n$ENDIF", "2:7-24"),
        ("$IF 0\n$ENDIF X1", "2:8-10"),
        ("X1 $IF 0\n$ENDIF", "1:1-3"),
        ("$IF 0 $ENDIF", "1:7-13"),
        ("$IF 1 $IF 0\n$ENDIF\n$ENDIF", "1:7-12"),
        ("$SWITCH 1 $CASE 1\n$ENDSWITCH", "1:11-18"),
        ("$SWITCH 1\n$CASE 1 X1\n$ENDSWITCH", "2:9-11"),
        ("$WHILE 0\n$ENDWHILE #FLUSH WAIT", "2:11-22"),
        ("$FOR P1=0,1,1\n$BREAK P2=1\n$ENDFOR", "2:8-12"),
        ("$REPEAT \"M\"\n$UNTIL 1", "1:9-12"),
        ("$REPEAT\nL a.nc $UNTIL 1", "2:1-7"),
        ("#IF 0\n#ELSE X1\n#ENDIF", "2:7-9"),
        ("X1 $IF 0 $GOTO N9", "1:1-3"),
        ("$IF V.E.A $IF 1 $GOTO N9", "1:11-16"),
        ("$GOTO N9 $GOTO N9", "1:10-18"),
        ("$GOTO N9 $IF 1", "1:1-9"),
    ] {
        refused(program, place);
    }
    for statement in ["$ELSE", "$BREAK", "$IF 0", "$ENDIF"] {
        let program =
            format!("\"A\" = \"{statement}\"\n$IF 1\n\"A\"\nX[COMP OFF FRICT]\n$ENDIF\nM30");
        let said = Bench::new().run(&[&program]);
        assert!(said.contains("FC208 3:1-4\n"), "{program}: {said}");
    }
    for program in [
        "/2 N10 $IF 0 ; X1\nN20 $ENDIF (X1)",
        "[HERE] $IF 0\n$ENDIF",
        "$IF 0 $GOTO N9 X1",
        "X1 $GOTO N9 Y1",
    ] {
        let said = Bench::new().run(&[&format!("{program}\nN9: M30")]);
        assert!(!said.contains("FC208"), "{program}: {said}");
    }
}

#[test]
fn budgets() {
    // R2.60
    let limits = |limits: Limits| Bench::new().limits(limits);
    let bench = limits(Limits::default().with_blocks(5));
    assert_snapshot!(bench.run(&["X1\n$WHILE 1\n$IF 1\nX2\n$ENDIF\n$ENDWHILE\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
        FC910 6:1-10
      end 5 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(bench.run(&["X1\nX2\nX3\nX4\nX5\nX6\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
        FC910 6:1-3
      end 5 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let bench = limits(Limits::default().with_calls(3));
    assert_snapshot!(bench.run(&["%L S\nLL S\nM17\n%M\nLL S\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc M
      1 line 5 -
      2 line 2 - level 1
      3 line 2 - level 2
      4 line 2 - level 3
        FC911 2:1-5
      end 4 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let bench = limits(Limits::default().with_nesting(2));
    assert_snapshot!(bench.run(&["$IF 1\n$IF 1\n$IF 1\n$ENDIF\n$ENDIF\n$ENDIF\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC912 3:1-6
      end 0 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let deep = format!("P1={}1{}\nM30", "[".repeat(65), "]".repeat(65));
    assert_snapshot!(Bench::new().run(&[&deep]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC913 1:68-69
      end 1 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    let fits = format!("P1={}1{}\nM30", "[".repeat(64), "]".repeat(64));
    assert!(!Bench::new().run(&[&fits]).contains("FC913"));
    let bench = limits(Limits::default().with_macros(2));
    let chain = "\"A\"=\"\\\"B\\\"\"\n\"B\"=\"\\\"C\\\"\"\n\"C\"=\"X1\"\n\"B\"\n\"A\"\nM30";
    assert_snapshot!(bench.run(&[chain]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 -
      5 line 5 -
        FC914 5:1-4
      end 5 budget X:active Y:active Z:unconfigured B:ineffective
    ");
    // A macro that uses itself many times does not cause a hang.
    for program in [
        "\"A\"=\"\\\"A\\\" \\\"A\\\" \\\"A\\\" \\\"A\\\"\"\n\"A\"\nM30",
        "\"A\"=\"\\\"A\\\"+\\\"A\\\"+\\\"A\\\"\"\nP1=\"A\"\nM30",
    ] {
        let said = Bench::new().keep_going().run(&[program]);
        assert!(said.contains("FC914"), "{program}\n{said}");
    }
}

#[test]
fn budgets_name_the_loop_that_used_them_up() {
    // R2.60
    let limits = Limits::default().with_blocks(5);
    let said = Bench::new()
        .limits(limits)
        .said("X1\n$WHILE 1\n$IF 1\nX2\n$ENDIF\n$ENDWHILE\nM30");
    assert_snapshot!(said, @"
    FC910 6:1 more than 5 blocks were executed; the dry run ends here
      help: look for a loop that does not end, or raise the budget with `--max-blocks`
      2:1: in this loop
    ");
}

#[test]
fn a_loop_without_its_end_is_left_by_nothing() {
    // R2.40 R2.84: `$BREAK` and `$CONTINUE` in it have no effect, and nothing is repeated.
    for word in ["$BREAK", "$CONTINUE"] {
        let ran = lines(&format!("$FOR P1=1,3,1\n{word}\nX1\nM30"));
        assert!(ran.ends_with("2 3 4 FC208 1:1-14"), "{ran}");
    }
}
