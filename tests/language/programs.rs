//! 2.2: programs.

use insta::assert_snapshot;

use crate::support::{Bench, MACHINE, SourceMode};

#[test]
fn several_local_subprograms_of_one_name_are_called_by_none() {
    // R2.11
    let locals = "%L A\nX[COMP OFF FRICT]\nM17\n%L A\nX[COMP ON FRICT]\nM17\n%L B\nM17\n";
    let run = |call: &str| Bench::new().run(&[&format!("{call}\nM30\n{locals}")]);
    assert!(run("LL A").contains("FC320 1:1-5"));
    assert!(!run("LL B").contains("FC320"));
    let unknown = run("$IF V.E.A\nLL A\n$ENDIF");
    assert!(unknown.contains("FC320"), "{unknown}");
}

#[test]
fn program_lines() {
    // R2.10
    let name = |line: &str| {
        let transcript = Bench::new().run(&[&format!("{line}\nM30")]);
        transcript.lines().nth(1).unwrap_or_default().to_owned()
    };
    assert_eq!(name("%MAIN"), "a.nc MAIN");
    assert_eq!(name("% MAIN (comment)"), "a.nc MAIN");
    assert_eq!(name("%LOWER"), "a.nc LOWER");
    assert_eq!(name("%L10.nc;x"), "a.nc L10.nc");
    assert_eq!(name("%A\"B"), "a.nc A");
    assert_eq!(name("%A#B"), "a.nc A");
    assert_eq!(name("%A$B"), "a.nc A");
    assert_eq!(name("X1"), "a.nc -");
    // The rest of the line is not part of the program.
    assert_snapshot!(Bench::new().run(&["%MAIN X[COMP OFF FRICT]\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc MAIN
      1 line 2 -
      end 1 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn local_subprograms_before_and_behind() {
    // R2.10 R2.11
    let program = "%L FIRST\nN1 X[COMP OFF FRICT]\nM17\n%MAIN\nN10 LL FIRST\nN20 LL LAST\nN30 M30\n%L LAST\nN2 X[COMP ON FRICT]\nM29";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc MAIN
      1 line 5 N10
      2 line 2 N1 level 1 X:active>inactive
      3 line 3 - level 1
      4 line 6 N20
      5 line 9 N2 level 1 X:inactive>active
      6 line 10 - level 1
      7 line 7 N30
      end 7 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn ends_of_programs() {
    // R2.12
    let bench = Bench::new();
    // M17 may be missing; M02 in a subprogram ends the whole run.
    assert_snapshot!(bench.run(&["%L A\nX1\n%L B\nX2\nM02\nX3\n%MAIN\nLL A\nLL B\nX4\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc MAIN
      1 line 8 -
      2 line 2 - level 1
      3 line 9 -
      4 line 4 - level 1
      5 line 5 - level 1
        FC315 5:1-4
      end 5 M02 X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(bench.run(&["X1\nX2"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
        FC310 2:1-3
      end 2 end-of-file X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(bench.run(&["X1\nM17\nX2\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
        FC310 2:1-4
      end 2 end-of-file X:active Y:active Z:unconfigured B:ineffective
    ");
    // A subprogram that runs by itself ends correctly.
    for handed in [SourceMode::Whole, SourceMode::LineByLine] {
        let bench = Bench::new().handed(handed);
        for sub in [
            "X1\nM17",
            "M17\nX2",
            "%L S\nM17\n%MAIN\nX1\nM17\n%OTHER\nM30",
        ] {
            assert!(!bench.run(&[sub]).contains("FC310"), "{sub}");
        }
        let said = bench.run(&["M17\nX[COMP OFF FRICT]\nM30"]);
        assert!(said.contains("FC310 1:1-4"), "{said}");
        let said = bench.keep_going().run(&["X1\nM29\nX[COMP OFF FRICT]\nM30"]);
        assert!(said.contains("FC310 2:1-4"), "{said}");
    }
    let on_a_way = bench.run(&["$IF V.E.A\nM29\n$ENDIF\nM30"]);
    assert!(on_a_way.contains("FC310 2:1-4"), "{on_a_way}");
    assert_snapshot!(bench.run(&["M30\nX[COMP OFF FRICT"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      end 1 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().check_all().run(&["M30\nX[COMP OFF FRICT"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
        FC205 2:2-3
      end 1 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn global_calls() {
    // R2.13
    let bench = Bench::new()
        .file("sub.nc", "N1 X[COMP OFF FRICT]\nN2 L deeper.nc\nN3 M17")
        .file("deeper.nc", "%DEEPER\nN4 X[COMP ON FRICT]")
        .file("dir/other.nc", "N5 M29")
        .set_text("V.E.NAME", "sub.nc");
    let program = "N10 L sub.nc\nN20 L dir/other.nc\nN30 L \"dir/other.nc\"\nN40 L V.E.NAME\nN50 \"O\" = \"dir/other.nc\"\nN60 L \"O\" (comment)\nM30";
    assert_snapshot!(bench.run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 1 N1 level 1 X:active>inactive
      3 line 2 N2 level 1
      4 line 2 N4 level 2 X:inactive>active
      5 line 3 N3 level 1
      6 line 2 N20
      7 line 1 N5 level 1
      8 line 3 N30
      9 line 1 N5 level 1
      10 line 4 N40
      11 line 1 N1 level 1 X:active>inactive
      12 line 2 N2 level 1
      13 line 2 N4 level 2 X:inactive>active
      14 line 3 N3 level 1
      15 line 5 N50
      16 line 6 N60
      17 line 1 N5 level 1
      18 line 7 -
      end 18 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn own_locals_and_parameters() {
    // R2.13 R2.33 R2.34: @P of the call, V.L of the level and those below.
    let bench = Bench::new().file(
        "c.cyc",
        "#VAR\nV.L.A = 5\n#ENDVAR\nV.S.SEEN = V.L.A*100 + @P1*10 + @P2\nV.L.OUTER = 9\nP5 = @P1\n@P1 = 0\nM17",
    );
    let program = "#VAR\nV.L.A = 1\nV.L.OUTER = 2\n#ENDVAR\nP2 = 3\nL CYCLE [NAME=c.cyc @P1=2 @P2=P2]\nV.S.R = V.S.SEEN*1000 + V.L.A*100 + V.L.OUTER*10 + P5\nM30";
    let mut session = bench.session();
    assert_snapshot!(bench.run_in(&mut session, &[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 5 -
      3 line 6 -
      4 line 1 - level 1
      5 line 4 - level 1
      6 line 5 - level 1
      7 line 6 - level 1
      8 line 7 - level 1
      9 line 8 - level 1
      10 line 7 -
      11 line 8 -
      end 11 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(format!("{:?}", session.interpreter().shared_variables()), @r#"{"V.S.R": Number(523192.0), "V.S.SEEN": Number(523.0)}"#);
}

#[test]
fn modal_cycles() {
    // R2.13
    let bench = Bench::new().file("c.cyc", "N1 M17");
    let program = "N10 L CYCLE [NAME=c.cyc MODAL_MOVE @P1=1]\nN20 G0 X1\nN30 M3\nN40 G4 X1\nN50 #DISABLE MODAL CYCLE\nN60 X2\nM30";
    assert_snapshot!(bench.run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 1 N1 level 1
      3 line 2 N20
      4 line 1 N1 level 1
      5 line 3 N30
      6 line 4 N40
      7 line 5 N50
      8 line 6 N60
      9 line 7 -
      end 9 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
    let program = "N10 L CYCLE [NAME=c.cyc \\\nN11 MODAL_BLOCK]\nN20 M3\nN50 #DISABLE MODAL CYCLE\nN60 X2\nM30";
    assert_snapshot!(bench.run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 1 N1 level 1
      3 line 3 N20
      4 line 1 N1 level 1
      5 line 4 N50
      6 line 5 N60
      7 line 6 -
      end 7 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn a_cycle_gives_back_g_functions_and_feed() {
    // R2.13 R2.45: P-CHAN-00210 is 0 unless the program retains the changes.
    let bench = Bench::new()
        .file("c.cyc", "G91 X5\nM17")
        .file("keep.cyc", "#RETAIN CYCLE CHANGES\nG91 X5\nM17");
    let program =
        "X10\nL CYCLE [NAME=c.cyc]\nX10\nL c.cyc\nX10\nG90 X0\nL CYCLE [NAME=keep.cyc]\nX1\nM30";
    assert_snapshot!(bench.positions(program), @"
    X10 X:10 Y:? Z:? B:?
    L CYCLE [NAME=c.cyc] X:10 Y:? Z:? B:?
    G91 X5 X:15 Y:? Z:? B:?
    M17 X:15 Y:? Z:? B:?
    X10 X:10 Y:? Z:? B:?
    L c.cyc X:10 Y:? Z:? B:?
    G91 X5 X:15 Y:? Z:? B:?
    M17 X:15 Y:? Z:? B:?
    X10 X:25 Y:? Z:? B:?
    G90 X0 X:0 Y:? Z:? B:?
    L CYCLE [NAME=keep.cyc] X:0 Y:? Z:? B:?
    #RETAIN CYCLE CHANGES X:0 Y:? Z:? B:?
    G91 X5 X:5 Y:? Z:? B:?
    M17 X:5 Y:? Z:? B:?
    X1 X:6 Y:? Z:? B:?
    M30 X:6 Y:? Z:? B:?
    ");
}

#[test]
fn implicit_calls() {
    // R2.14
    let machine = format!(
        "[machine.programs]\nG80 = \"drill.nc\"\nG800 = \"drill.nc\"\nM6 = \"tool.nc\"\nT = \"tool.nc\"\n{MACHINE}"
    );
    let bench = Bench::on(&machine)
        .keep_going()
        .file(
            "drill.nc",
            "$IF EXIST[@P3]\nX[COMP OFF FRICT]\n$ELSE\nV.S.R = @P1*100 + @P2*10 + @P4\n$ENDIF\nM17",
        )
        .file("tool.nc", "Y[COMP OFF FRICT]\nY[COMP ON FRICT]\nM17");
    let program = "N10 G800[1, 2, , 4]\nN20 G80 X5\nN30 T5 M6\nN40 G81[1,2]\nN50 G82\nM30";
    let mut session = bench.session();
    assert_snapshot!(bench.run_in(&mut session, &[program]), @r#"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 1 - level 1
      3 line 3 - level 1
      4 line 4 - level 1
      5 line 5 - level 1
      6 line 6 - level 1
      7 line 2 N20
      8 line 1 - level 1
      9 line 3 - level 1
      10 line 4 - level 1
        FC311 4:9-12 in drill.nc
      11 line 5 - level 1
      12 line 6 - level 1
      13 line 3 N30
      14 line 1 - level 1 Y:active>inactive
      15 line 2 - level 1 Y:inactive>active
      16 line 3 - level 1
      17 line 1 - level 1 Y:active>inactive
      18 line 2 - level 1 Y:inactive>active
      19 line 3 - level 1
      20 line 4 N40 X:active>unknown Y:active>unknown B:ineffective>unknown
        FC325 4:5-13
      21 line 5 N50
        FC325 5:5-8
      22 line 6 -
      end 22 M30 X:unknown Y:unknown Z:unconfigured B:unknown
    opaque {"G81": 1, "G82": 1}
    "#);
    // G81 and G82 may have written it.
    assert_snapshot!(format!("{:?}", session.interpreter().shared_variables()), @r#"{"V.S.R": Unknown("program G82")}"#);
    let mut session = bench.session();
    let _ = bench.run_in(&mut session, &["N10 G800[1, 2, , 4]\nM30"]);
    assert_snapshot!(format!("{:?}", session.interpreter().shared_variables()), @r#"{"V.S.R": Number(124.0)}"#);
}

#[test]
fn configured_programs_at_start_and_end() {
    // R2.15
    let machine =
        format!("[machine]\nstart_program = \"start.nc\"\nend_program = \"end.nc\"\n{MACHINE}");
    let bench = Bench::on(&machine)
        .file("start.nc", "N1 X[COMP ON FRICT]\nM17")
        .file("end.nc", "N9 X[COMP ON FRICT]\nM30");
    let program = "N10 X[COMP OFF FRICT]\nN20 M30";
    assert_snapshot!(bench.run(&[program, "M02"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N1 level 1
      2 line 2 - level 1
      3 line 1 N10 X:active>inactive
      4 line 2 N20
      5 line 1 N9 level 1 X:inactive>active
      6 line 2 - level 1
      end 6 M30 X:active Y:active Z:unconfigured B:ineffective
    b.nc -
      1 line 1 N1 level 1
      2 line 2 - level 1
      3 line 1 -
      4 line 1 N9 level 1
        FC402 1:4-20 in end.nc
      5 line 2 - level 1
      end 5 M02 X:active Y:active Z:unconfigured B:ineffective
    ");
    let nothing = Bench::on(&machine);
    assert_snapshot!(nothing.run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
        FC320 1:1-1 in start.nc
      end 0 error X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn programs_that_come_line_by_line_call_the_same_programs() {
    // R2.15 R2.16 R9.40
    let machine =
        format!("[machine]\nstart_program = \"start.nc\"\nend_program = \"end.nc\"\n{MACHINE}");
    let bench = |handed| {
        Bench::on(&machine)
            .file("start.nc", "N1 X[COMP OFF FRICT]\nM17")
            .file("end.nc", "N9 X[COMP ON FRICT]\nM30")
            .file("sub.nc", "X1\nM17")
            .file("open.nc", "X1\n$IF 1\nM17")
            .file("other.nc", "%L D\nX9\nM17\n%MAIN\nY[COMP OFF FRICT]\nM17")
            .handed(handed)
    };
    for main in ["", "%MAIN\n", "%MAIN\n%NEXT\n", "(a)\n%MAIN\n(b)\n"] {
        for body in [
            "X1\nM30",
            "L sub.nc\nX1",
            "L open.nc\nM30",
            "L missing.nc\nM30",
            "L sub.nc\nL other.nc\n$IF 1\nL other.nc\nL sub.nc\n$ENDIF\nM30",
            "L CYCLE [NAME=other.nc MODAL_MOVE @P1=1]\nX1\nN1: X2\nX3\nM30",
            "",
        ] {
            let program = format!("{main}{body}");
            let whole = bench(SourceMode::Whole).run(&[&program, "M30"]);
            let lines = bench(SourceMode::LineByLine).run(&[&program, "M30"]);
            assert_eq!(lines, whole, "{program:?}");
            let whole = bench(SourceMode::Whole).keep_going().run(&[&program]);
            let lines = bench(SourceMode::LineByLine).keep_going().run(&[&program]);
            assert_eq!(lines, whole, "{program:?}");
        }
    }
}

#[test]
fn called_files_that_are_not_there() {
    // R2.16
    let program = "N10 L missing.nc\nN20 LL MISING\nN30 X1\nM30\n%L MISSING\nM17";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
        FC320 1:5-17
      end 1 error X:active Y:active Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
        FC320 1:5-17
      2 line 2 N20
        FC320 2:5-14
      3 line 3 N30
      4 line 4 -
      end 4 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn what_a_macro_does_is_said_where_it_is_used() {
    // R2.35
    let program = "\"CALL\" = \"X1 Y2 Z3 L missing.nc\"\n\"TWICE\" = \"(a) (b) \\\"CALL\\\"\"\n\"ARC\" = \"G02 X0 Y0 (here) R5\"\n\
                   N1 G90 X0 Y0\nN2 \"ARC\"\nN3 \"CALL\"\nN4 \"TWICE\"\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 -
      2 line 2 -
      3 line 3 -
      4 line 4 N1
      5 line 5 N2
        FC316 5:4-9
        FC327 5:4-9
      6 line 6 N3
        FC320 6:4-10
      7 line 7 N4
        FC320 7:4-11
      8 line 8 -
      end 8 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn faults_in_a_called_file_point_there() {
    // R2.16
    let bench = Bench::new().file("sub.nc", "X1\nX[COMP ON FRIKT]\nM17");
    assert_snapshot!(bench.run(&["N10 L sub.nc\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
      2 line 1 - level 1
      3 line 2 - level 1
        FC202 2:11-16 in sub.nc
      end 3 error X:active Y:active Z:unconfigured B:ineffective
    ");
    let bench = Bench::new().file("sub.nc", "X1\n$IF 1\nM17");
    assert_snapshot!(bench.run(&["N10 L sub.nc\nM30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
        FC208 2:1-6 in sub.nc
      end 1 error X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn a_file_without_a_program_of_its_own() {
    // R2.8 R2.16 R18.6
    let bench = Bench::new()
        .passing_branches()
        .file("lib.nc", "%L A\nX[COMP OFF FRICT]\nM17")
        .file("empty.nc", "")
        .file("notes.nc", "(only words)\n");
    let said = bench.said("L lib.nc\nM30");
    assert!(
        said.contains("FC320 1:1") && said.contains("nothing to call"),
        "{said}"
    );
    let said = bench.said("L empty.nc\nL notes.nc\nM30");
    assert!(!said.contains("FC320"), "{said}");
    assert_eq!(
        said.matches("FC103 1:1 the program has no block").count(),
        2,
        "{said}"
    );
    let bench = bench.file("settings.nc", "[machine]\nstartup = \"a.lis\"\n");
    let said = bench.said("L settings.nc\nM30");
    assert!(
        said.contains("`settings.nc` is TOML, not an NC program"),
        "{said}"
    );
    let region = bench.run(&["$IF V.E.X\nL empty.nc\n$ENDIF\nM30"]);
    assert!(region.contains("M30 X:active"), "{region}");
    let region = bench.run(&["$IF V.E.X\nL lib.nc\n$ENDIF\nM30"]);
    assert!(region.contains("M30 X:unknown"), "{region}");
}

struct Nothing;
impl frictcomp::timeline::Sink for Nothing {
    fn record(&mut self, _: &frictcomp::timeline::Record<'_>) -> std::ops::ControlFlow<()> {
        std::ops::ControlFlow::Continue(())
    }
}

#[test]
fn a_start_program_is_looked_for_beside_the_main_program() {
    // R2.15: and it does not run if it is refused
    let machine = format!("[machine]\nstart_program = \"start.nc\"\n{MACHINE}");
    for handed in [SourceMode::Whole, SourceMode::LineByLine] {
        let bench = Bench::on(&machine).handed(handed);
        let refused = bench
            .file("start.nc", "X[COMP OFF FRICT]\n$IF 1\nM17")
            .run(&["M30"]);
        assert!(
            refused.contains("FC208") && refused.contains("end 0 error"),
            "{refused}"
        );
        let mut asked = Vec::new();
        let machine = frictcomp::machine::Machine::from_toml(&machine).expect("a machine");
        let mut session = frictcomp::session::Session::new(
            machine,
            frictcomp::session::SessionOptions::default(),
        );
        let mut find = |_: &str, caller: &str| {
            asked.push(caller.to_owned());
            Some(frictcomp::text::SourceFile::new("start.nc", "M17"))
        };
        let mut lines = frictcomp::text::TextLines::new("M30");
        let program = match handed {
            SourceMode::Whole => frictcomp::session::Program::Whole(
                frictcomp::text::SourceFile::new("dir/main.nc", "M30"),
            ),
            SourceMode::LineByLine => frictcomp::session::Program::Lines(&mut lines),
        };
        let _ = session.program("dir/main.nc", program, &mut find, &mut Nothing);
        assert_eq!(asked, ["dir/main.nc"]);
    }
}
