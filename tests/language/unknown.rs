//! 2.7: values and states that cannot be known offline.

use insta::assert_snapshot;

use crate::support::{Bench, MACHINE};

fn run(program: &str) -> String {
    Bench::new().passing_branches().run(&[program])
}

#[test]
fn unknown_values_flow() {
    // R2.50
    let bench = Bench::new();
    let preparation = "P1=V.E.A\nP2=P1*2+1\nV.P.B=P2\nP3=5\nPV.E.I=7\nV.P.L[V.E.I]=3";
    assert_snapshot!(bench.values("P1=V.E.A P2=P1*2+1\nV.P.B=P2", &[
        "P2", "V.P.B", "SIN[P1]", "P1 && 0", "P1 || 1", "P1 && 1", "-P1", "P1==P1", "LEFT[P1, 1]", "[P1]", "P1*0", "V.P.C[P1]",
    ]), @"
    P2 -> unknown: V.E.A
    V.P.B -> unknown: V.E.A
    SIN[P1] -> unknown: V.E.A
    P1 && 0 -> 0
    P1 || 1 -> 1
    P1 && 1 -> unknown: V.E.A
    -P1 -> unknown: V.E.A
    P1==P1 -> unknown: V.E.A
    LEFT[P1, 1] -> unknown: V.E.A
    [P1] -> unknown: V.E.A
    P1*0 -> unknown: V.E.A
    V.P.C[P1] -> unknown: V.E.A
    ");
    // Written to an unknown index: the earlier values are no longer known.
    assert_snapshot!(bench.values(preparation, &["P3"]), @"P3 -> unknown: PV.E.I=7");
    assert_snapshot!(bench.values("#VAR\nV.P.L[3]\n#ENDVAR\nV.P.L[1]=4\nV.P.L[V.E.I]=3", &["V.P.L[1]", "V.P.L[2]"]), @"
    V.P.L[1] -> unknown: V.E.I
    V.P.L[2] -> unknown: V.E.I
    ");
}

#[test]
fn an_array_of_unknown_size_has_unknown_elements() {
    // R2.34, R2.50
    let bench = Bench::new();
    let declared = "#VAR\nV.P.A[V.E.N] = [1, 2]\nV.P.B[2][V.E.N] = [[1, 2], [3, 4]]\nV.P.C[V.E.N][2] = [[1, 2], [3, 4]]\nP100[V.E.N]\n#ENDVAR\nV.P.A[7] = 4";
    assert_snapshot!(bench.values(declared, &[
        "V.P.A[1]", "V.P.A[5]", "V.P.A[7]", "V.P.B[0][0]", "V.P.B[2][0]", "V.P.C[1][0]", "V.P.C[1][2]", "V.P.C[9][1]", "P100[3]",
        "SIZEOF[V.P.A]", "SIZEOF[V.P.B]", "SIZEOF[V.P.B, 2]", "EXIST[V.P.A[1]]", "EXIST[V.P.A[5]]",
    ]), @"
    V.P.A[1] -> 2
    V.P.A[5] -> unknown: V.E.N
    V.P.A[7] -> 4
    V.P.B[0][0] -> unknown: V.E.N
    V.P.B[2][0] -> FC311 8:9-20
    V.P.C[1][0] -> 3
    V.P.C[1][2] -> FC311 8:9-20
    V.P.C[9][1] -> unknown: V.E.N
    P100[3] -> unknown: V.E.N
    SIZEOF[V.P.A] -> unknown: V.E.N
    SIZEOF[V.P.B] -> 2
    SIZEOF[V.P.B, 2] -> unknown: V.E.N
    EXIST[V.P.A[1]] -> 1
    EXIST[V.P.A[5]] -> unknown: V.E.N
    ");
    let branch = "#VAR\nV.P.A[V.E.N]\n#ENDVAR\n$IF V.P.A[3] == 0\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    assert_snapshot!(bench.run(&[branch]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 4 -
      3 line 5 - X:active>inactive
      4 line 6 -
        FC901 4:5-18
      5 line 7 -
        FC401 5:1-18
      end 5 M30 X:unknown Y:active Z:unconfigured B:ineffective
    ");
    // An impossible array size is refused at its place.
    for size in ["-1", "99999999999", "P9"] {
        let refused = format!("#VAR\nV.P.A[{size}]\n#ENDVAR\nM30");
        let said = run(&refused);
        assert!(said.contains("FC31"), "{said}");
    }
}

#[test]
fn unknown_branches_are_not_executed() {
    // R2.51
    let program = "P1=1 P2=1\nX1 Y1 Z1\n$IF V.E.A > 1\nX[COMP OFF FRICT]\nP1=2\n$ELSE\nY[COMP OFF LEAD]\nG91 X5\n$ENDIF\nN10 X2\nG90 Y[COMP OFF FRICT]\nN20 P3=P1\nN30 X[COMP ON FRICT] P1=1\n$IF P1==1\nY[COMP ON FRICT]\n$ENDIF\n$IF P3==1\n$ENDIF\nM30";
    assert_snapshot!(run(program), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 - X:active>unknown
        FC901 3:1-14
      4 line 10 N10
      5 line 11 - Y:active>inactive
      6 line 12 N20
      7 line 13 N30 X:unknown>active
      8 line 14 -
      9 line 15 - Y:inactive>active
      10 line 16 -
      11 line 17 -
      12 line 19 -
      end 12 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().passing_branches().positions(program), @"
    P1=1 P2=1 X:? Y:? Z:? B:?
    X1 Y1 Z1 X:1 Y:1 Z:1 B:?
    $IF V.E.A > 1 X:? Y:1 Z:1 B:?
    N10 X2 X:? Y:1 Z:1 B:?
    G90 Y[COMP OFF FRICT] X:? Y:1 Z:1 B:?
    N20 P3=P1 X:? Y:1 Z:1 B:?
    N30 X[COMP ON FRICT] P1=1 X:? Y:1 Z:1 B:?
    $IF P1==1 X:? Y:1 Z:1 B:?
    Y[COMP ON FRICT] X:? Y:1 Z:1 B:?
    $ENDIF X:? Y:1 Z:1 B:?
    $IF P3==1 X:? Y:1 Z:1 B:?
    M30 X:? Y:1 Z:1 B:?
    ");
}

#[test]
fn unknown_switches_and_loops() {
    // R2.51
    for (open, close) in [
        ("$SWITCH V.E.A\n$CASE 1", "$ENDSWITCH"),
        ("$SWITCH 1\n$CASE V.E.A", "$ENDSWITCH"),
        ("$FOR P1=1,V.E.A,1", "$ENDFOR"),
        ("$FOR P1=V.E.A,1,1", "$ENDFOR"),
        ("$WHILE V.E.A", "$ENDWHILE"),
        ("$DO V.E.A", "$ENDDO"),
    ] {
        let said = run(&format!(
            "{open}\nX[COMP OFF FRICT]\n{close}\nX[COMP ON FRICT]\nM30"
        ));
        assert!(
            said.contains("FC901") && said.contains("X:active>unknown"),
            "{said}"
        );
        assert!(said.contains("X:unknown>active"), "{said}");
    }
    // These run at least once.
    for (open, close) in [("$DO", "$ENDDO V.E.A"), ("$REPEAT", "$UNTIL V.E.A")] {
        let said = run(&format!("{open}\nX[COMP OFF FRICT]\n{close}\nM30"));
        assert!(
            said.contains("FC901") && said.contains("X:inactive>unknown"),
            "{said}"
        );
    }
    // A loop whose end becomes unknown while it runs.
    assert_snapshot!(run("P2=3\n$FOR P1=1,P2,1\nX[COMP OFF FRICT]\nP2=V.E.A\n$ENDFOR\nV.S.R=P1\nM30"), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 - X:active>inactive
      4 line 4 -
      5 line 5 - X:inactive>unknown
        FC901 2:1-8
      6 line 6 -
      7 line 7 -
        FC401 5:1-8
      end 7 M30 X:unknown Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn unknown_regions_reach_through_calls() {
    // R2.51: calls by name, local calls of called files, cycles, configured words, macros.
    let machine = format!("[machine.programs]\nG80 = \"g80.nc\"\n{MACHINE}");
    let bench = Bench::on(&machine)
        .passing_branches()
        .file(
            "sub.nc",
            "%L IN\nX[COMP OFF FRICT]\nM17\n%SUB\nLL IN\nL sub.nc\nM17",
        )
        .file("g80.nc", "Y[COMP OFF FRICT]\nM17")
        .file("c.cyc", "B[COMP OFF FRICT] P5=1\nM17");
    let program = "P5=2\n\"M\" = \"P6=1\"\nP6=2\n$IF V.E.A\nL sub.nc\nG80\nL CYCLE [NAME=c.cyc]\n\"M\"\n$ENDIF\nV.S.R=P5\nV.S.Q=P6\nM30";
    let mut session = bench.session();
    assert_snapshot!(bench.run_in(&mut session, &[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 - B:ineffective>unknown X:active>unknown Y:active>unknown
        FC901 4:1-10
      5 line 10 -
      6 line 11 -
      7 line 12 -
        FC401 4:1-10
        FC401 4:1-10
        FC401 4:1-10
      end 7 M30 X:unknown Y:unknown Z:unconfigured B:unknown
    ");
    assert_snapshot!(format!("{:?}", session.interpreter().shared_variables()), @r#"{"V.S.Q": Unknown("V.E.A"), "V.S.R": Unknown("V.E.A")}"#);
    // A call by an unknown name could do anything.
    assert_snapshot!(run("$IF V.E.A\nL V.E.NAME\n$ENDIF\nM30"), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>unknown Y:active>unknown B:ineffective>unknown
        FC901 1:1-10
      2 line 4 -
      end 2 M30 X:unknown Y:unknown Z:unconfigured B:unknown
    ");
}

#[test]
fn unknown_modal_words() {
    // R2.51
    let program = "X1 Y1\n$IF V.E.A\nG91\n#TRAFO ON\n$ENDIF\nX1\nG90 X1\n$IF V.E.A\n#TRAFO OFF\n$ENDIF\n#TRAFO OFF\n$IF V.E.A\nG92 X5\n$ENDIF\nX5\nG92 X0\nX6\n$IF V.E.A\n#VAR\nV.L.N = 1\n#ENDVAR\n$ENDIF\nYV.L.N\nM30";
    assert_snapshot!(Bench::new().passing_branches().positions(program), @"
    X1 Y1 X:1 Y:1 Z:? B:?
    $IF V.E.A X:?* Y:?* Z:?* B:?*
    X1 X:?* Y:?* Z:?* B:?*
    G90 X1 X:1* Y:?* Z:?* B:?*
    $IF V.E.A X:?* Y:?* Z:?* B:?*
    #TRAFO OFF X:? Y:? Z:? B:?
    $IF V.E.A X:? Y:? Z:? B:?
    X5 X:? Y:? Z:? B:?
    G92 X0 X:? Y:? Z:? B:?
    X6 X:6 Y:? Z:? B:?
    $IF V.E.A X:6 Y:? Z:? B:?
    YV.L.N X:6 Y:? Z:? B:?
    M30 X:6 Y:? Z:? B:?
    ");
}

#[test]
fn unknown_jumps_and_calls() {
    // R2.52
    assert_snapshot!(run("$IF V.E.A $GOTO N90\nX[COMP OFF FRICT]\n$GOTO V.E.B\n$GOTO N[V.E.C]\nL V.E.D\nX[COMP ON FRICT]\nN90: M30"), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC902 1:1-10
      2 line 2 - X:active>inactive
      3 line 3 -
        FC902 3:1-12
      4 line 4 -
        FC902 4:1-15
      5 line 5 - X:inactive>unknown Y:active>unknown B:ineffective>unknown
        FC902 5:1-8
      6 line 6 - X:unknown>active
      7 line 7 N90 X:active>unknown
        FC401 7:1-9
      end 7 M30 X:unknown Y:unknown Z:unconfigured B:unknown
    ");
}

#[test]
fn values_that_the_user_gives_are_known() {
    // R2.36 R2.51
    let bench = Bench::new().set("V.E.A", 2.0);
    assert_snapshot!(bench.run(&["$IF V.E.A > 1\nX[COMP OFF FRICT]\n$ENDIF\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 - X:active>inactive
      3 line 3 -
      4 line 4 -
        FC401 2:1-18
      end 4 M30 X:inactive Y:active Z:unconfigured B:ineffective
    ");
}

/// Returns whether X and Y are away from their start-up state after a program.
fn at_the_end(files: &[&str]) -> [bool; 2] {
    let said = Bench::new().passing_branches().run(files);
    ["X", "Y"].map(|axis| said.contains(&format!("{axis}:active>unknown")))
}

#[test]
fn a_macro_that_may_have_been_defined_anew_may_do_anything() {
    // R2.51
    let define = "\"A\"=\"X[COMP ON FRICT]\"\n";
    let again = "\"A\"=\"Y[COMP OFF FRICT]\"\n";
    let unknown = |body: &str| format!("$IF V.E.A\n{body}$ENDIF\n");
    // Defined in the region, used after it, in it, or in a program that it calls.
    for program in [
        format!("{define}{}\"A\"\nM30", unknown(again)),
        format!("{define}{}M30", unknown(&format!("{again}\"A\"\n"))),
        format!("{define}{}M30", unknown(&format!("\"A\"\n{again}"))),
        format!(
            "%L D\n{again}M17\n%MAIN\n{define}{}M30",
            unknown("LL D\n\"A\"\n")
        ),
        format!(
            "%L D\n\"A\"\nM17\n%MAIN\n{define}{}M30",
            unknown(&format!("LL D\n{again}"))
        ),
        format!("{define}{}\"A\"\nM30", unknown("#INIT MACRO TAB\n")),
        format!("{}\"A\"\nM30", unknown(again)),
    ] {
        assert_eq!(at_the_end(&[&program]), [true; 2], "{program}");
    }
    // Redefined, it is known again; one that is only used was known all along.
    let known = format!("{define}{}{define}\"A\"\nM30", unknown(again));
    assert_eq!(at_the_end(&[&known]), [false; 2]);
    let used = format!("{define}{}\"A\"\nM30", unknown("\"A\"\n"));
    assert_eq!(at_the_end(&[&used]), [true, false]);
    let cleared = format!(
        "{define}{}#INIT MACRO TAB\n{define}\"A\"\nM30",
        unknown(again)
    );
    assert_eq!(at_the_end(&[&cleared]), [false; 2]);
}

#[test]
fn a_macro_that_is_not_known_has_no_value_and_names_no_program() {
    // R2.51
    let bench = Bench::new();
    let before = "\"A\"=\"P2+1\"\nP2=1\n$IF V.E.A\n\"A\"=\"7\"\n$ENDIF\n";
    assert_eq!(
        bench.values(before, &["\"A\""]),
        "\"A\" -> unknown: V.E.A\n"
    );
    let called = format!("{before}L \"A\"\nM30");
    assert_eq!(at_the_end(&[&called]), [true; 2]);
}

#[test]
fn a_region_is_looked_through_anew_where_its_macros_do_something_else() {
    // R2.51: the second pass may write P1, which was written before the first one.
    let program = "P1=1 P2=0\n\"A\"=\"P2=1\"\n$FOR P3=1,2,1\n$IF V.E.A\n\"A\"\n$ENDIF\n\"A\"=\"P1=2\"\n$ENDFOR\n$IF P1==1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    assert_eq!(at_the_end(&[program]), [true, false]);
}

#[test]
fn what_may_be_called_comes_after_the_words_of_its_block() {
    // R2.52, R2.70
    for call in [
        "L SEQUENCE [N[V.E.A] N20]",
        "FOO[1]",
        "M[V.E.A]",
        "MV.E.A",
        "GV.E.A",
    ] {
        let program = format!(
            "{call} X[COMP ON FRICT] P1=1\nN20: $IF P1 == 2\nX[COMP OFF FRICT]\n$ENDIF\nM30"
        );
        let said = Bench::new().run(&[&program]);
        assert!(said.contains("FC901"), "{call}: {said}");
        assert!(said.contains("M30 X:unknown"), "{call}: {said}");
    }
}

#[test]
fn nothing_follows_a_call_in_its_block() {
    // R2.13
    for (call, place) in [
        ("L SUB.NC X[COMP ON FRICT]", "4:10-26"),
        ("X1 L \"SUB.NC\" M30", "4:15-18"),
        ("LL SUB $GOTO N9", "4:8-16"),
        ("L CYCLE [NAME=SUB.NC] Y1", "4:23-25"),
        ("L V.E.NAME P1=1", "4:12-16"),
        ("L SUB.NC #FLUSH WAIT", "4:10-21"),
        ("L SUB.NC FOO[1]", "4:10-16"),
    ] {
        let program = format!("%L SUB\nM17\n%MAIN\n{call}\nN9: M30");
        let said = Bench::new().file("SUB.NC", "M17").run(&[&program]);
        assert!(said.contains(&format!("FC207 {place}\n")), "{call}: {said}");
        assert!(said.contains("end 1 error"), "{call}: {said}");
    }
}

#[test]
fn a_call_in_the_block_of_a_jump_or_an_end_may_be_made() {
    // R2.13
    for block in [
        "M30 L SUB.NC",
        "M2 LL SUB",
        "$GOTO N9 L SUB.NC",
        "M17 L CYCLE [NAME=SUB.NC]",
    ] {
        let program = format!("%MAIN\n{block}\nX1\nN9: M30");
        let said = Bench::new()
            .file("SUB.NC", "X[COMP OFF FRICT]\nM17")
            .run(&[&program]);
        assert!(said.contains("FC210 2:"), "{block}: {said}");
        assert!(said.contains(" X:unknown"), "{block}: {said}");
    }
}

#[test]
fn what_other_channels_and_drives_send_is_unknown() {
    // R2.50, R2.70: PM/207421579, 913718283, 208525707
    for (command, is_written) in [
        ("#WAIT [ID=1 P[0]=V.P.A CH=2]", true),
        ("#WAIT SYN [ID1 P[0] = V.P.A]", true),
        ("#SIGNAL READ [ID=1 P[3]=V.P.A]", true),
        ("#WCS TO MCS [V.P.A=X]", true),
        ("#DRIVE RD SYN [AX=X ID=S-0-0047 P=V.P.A]", true),
        // A value that is sent is unchanged, and so is one that a channel only waits for.
        ("#SIGNAL [ID=1 P[0]=V.P.A CH=2]", false),
        ("#WAIT INDP [X]", false),
        ("#WAIT [ID=1 CH=2]", false),
    ] {
        let program =
            format!("#VAR\nV.P.A=0\n#ENDVAR\n{command}\n$IF V.P.A\nX[COMP OFF FRICT]\n$ENDIF\nM30");
        let said = Bench::new().run(&[&program]);
        assert_eq!(said.contains("FC901"), is_written, "{command}: {said}");
        assert_eq!(said.contains("X:unknown"), is_written, "{command}: {said}");
    }
}

#[test]
fn a_command_may_give_its_value_with_an_equals_sign() {
    // R2.70: PM/206609163
    for command in [
        "#FRC=30",
        "#FRC = 30",
        "X10 #CHF=2.5",
        "X10 #RND = 3",
        "#CHR=1",
        "#ANG=45",
    ] {
        let said = Bench::new().run(&[&format!("{command}\nM30")]);
        assert!(!said.contains("FC"), "{command}: {said}");
    }
    let said = Bench::new().run(&["#FRX=30\nM30"]);
    assert!(said.contains("FC210"), "{said}");
}

#[test]
fn a_coupling_that_may_have_been_made_makes_comp_unknown() {
    // R1.9 R2.51 R2.52
    let enable = "#SET AX LINK [1, Y=X]\n#ENABLE AX LINK [1]\n";
    let off = "X[COMP OFF FRICT]\n";
    for (program, unknown) in [
        (format!("$IF V.E.A\n{enable}$ENDIF\n{off}M30"), true),
        (
            format!("$IF V.E.A\n#SET AX LINK [1, Y=X]\n$ENDIF\n#ENABLE AX LINK [1]\n{off}M30"),
            true,
        ),
        (
            format!("#SET AX LINK [1, Y=X]\n$IF V.E.A\n#AX LINK ON [1]\n$ENDIF\n{off}M30"),
            true,
        ),
        (
            format!("{enable}$IF V.E.A\n#DISABLE AX LINK\n$ENDIF\n{off}M30"),
            true,
        ),
        (
            format!("{enable}$IF V.E.A\n#AX LINK OFF ALL\n$ENDIF\n{off}M30"),
            true,
        ),
        (
            format!("{enable}$IF V.E.A\n#DISABLE AX LINK [1]\n$ENDIF\n{off}M30"),
            true,
        ),
        // A bypass, and an unknown program.
        (format!("$IF V.E.A $GOTO N10\n{enable}N10: {off}M30"), true),
        (
            format!("{enable}L V.E.NAME\nX[COMP ON FRICT]\n{off}M30"),
            true,
        ),
        // In a loop that may be left, and in a called program.
        (
            format!("$WHILE 1\n$IF V.E.A\n$BREAK\n$ENDIF\n{enable}$ENDWHILE\n{off}M30"),
            true,
        ),
        (
            format!("%L S\n{enable}M17\n%MAIN\n$IF V.E.A\nLL S\n$ENDIF\n{off}M30"),
            true,
        ),
        // It becomes known again.
        (
            format!("$IF V.E.A\n{enable}$ENDIF\n#AX LINK OFF ALL\n{off}M30"),
            false,
        ),
        (
            format!(
                "$IF V.E.A\n#SET AX LINK [1, Y=X]\n$ENDIF\n#SET AX LINK [1, Y=Z]\n#ENABLE AX LINK [1]\n{off}M30"
            ),
            false,
        ),
        // Another axis.
        (
            format!("$IF V.E.A\n#SET AX LINK [1, Y=B]\n#ENABLE AX LINK [1]\n$ENDIF\n{off}M30"),
            false,
        ),
    ] {
        let bench = Bench::new().passing_branches().keep_going();
        let said = bench.run(&[&program]);
        let left = if unknown {
            "M30 X:unknown"
        } else {
            "M30 X:inactive"
        };
        assert!(said.contains(left), "{program}\n{said}");
        assert_eq!(
            bench.said(&program).contains("in an active coupling"),
            unknown,
            "{program}"
        );
    }
    // A state that already matches the command stays known either way.
    let program = format!("$IF V.E.A\n{enable}$ENDIF\nX[COMP ON FRICT]\nM30");
    assert!(
        Bench::new()
            .passing_branches()
            .run(&[&program])
            .contains("M30 X:active")
    );
    // The groups are as unknown to the next program.
    let next = format!("#ENABLE AX LINK [1]\n{off}M30");
    let first = "$IF V.E.A\n#SET AX LINK [1, Y=X]\n$ENDIF\nM30";
    assert!(
        Bench::new()
            .passing_branches()
            .run(&[first, &next])
            .contains("M30 X:unknown")
    );
}

#[test]
fn commands_that_may_have_been_executed_make_unknown_what_they_change() {
    // R2.51
    let unknown = |body: &str| format!("$IF V.E.A\n{body}\n$ENDIF\n");
    let then = "X[COMP OFF FRICT]\n$ENDIF\nM30";
    for program in [
        format!(
            "V.P.B=1\n{}$IF EXIST[V.P.B]==0\n{then}",
            unknown("#DELETE V.P.B")
        ),
        format!("P5=1\n{}$IF EXIST[P5]==0\n{then}", unknown("#DELETE P5")),
        format!(
            "#VAR\nV.P.C[2]=[1,2]\n#ENDVAR\n{}$IF EXIST[V.P.C[1]]==0\n{then}",
            unknown("#DELETE V.P.C")
        ),
    ] {
        let said = Bench::new().keep_going().run(&[&program]);
        assert!(said.contains("M30 X:unknown"), "{program}\n{said}");
    }
    // One of two modal cycles may be in force, or none.
    let one = "X[COMP OFF FRICT]\nM17";
    let other = "Y[COMP OFF FRICT]\nM17";
    let call = |name: &str| format!("L CYCLE [NAME={name} MODAL_MOVE]\n");
    for program in [
        format!("{}{}Z1\nM30", call("one.nc"), unknown(&call("other.nc"))),
        format!(
            "X[COMP ON FRICT] Y[COMP ON FRICT]\n{}$IF V.E.A $GOTO N10\n{}N10: Z1\nM30",
            call("one.nc"),
            call("other.nc")
        ),
        format!(
            "{}{}Z1\nM30",
            call("one.nc"),
            unknown("#DISABLE MODAL CYCLE")
        ),
    ] {
        let bench = Bench::new().file("one.nc", one).file("other.nc", other);
        let program = program.replace("Z1", "X[COMP ON FRICT] Y[COMP ON FRICT]\nZ1");
        let said = bench.run(&[&program]);
        assert!(said.contains("M30 X:unknown"), "{program}\n{said}");
        let both = program.contains("other");
        assert_eq!(said.contains("Y:unknown Z"), both, "{program}\n{said}");
    }
}

#[test]
fn an_m_function_that_nobody_knows_may_end_the_program() {
    // R2.52 R2.82
    let states = |program: &str| {
        let text = run(program);
        let end = text.lines().rfind(|line| line.trim().starts_with("end "));
        end.unwrap_or_default().trim().to_owned()
    };
    // The blocks after the word may not be executed at all.
    let whole = states("MV.E.A\nX[COMP ON FRICT] Y[COMP ON FRICT]\nM30");
    assert!(
        whole.ends_with("X:unknown Y:unknown Z:unconfigured B:unknown"),
        "{whole}"
    );
    let subprogram =
        states("%L S\nMV.E.A\nX[COMP ON FRICT]\nM17\n%MAIN\nLL S\nY[COMP ON FRICT]\nM30");
    assert!(subprogram.contains("X:unknown Y:unknown"), "{subprogram}");
    // The same applies if it may have been executed.
    let region = states("$IF V.E.B\nMV.E.A\n$ENDIF\nX[COMP ON FRICT]\nM30");
    assert!(region.contains("X:unknown"), "{region}");
    // A T or D word ends nothing.
    let tool = states("TV.E.A DV.E.A\nX[COMP OFF FRICT]\nM30");
    assert!(tool.contains("X:inactive Y:active"), "{tool}");
}
