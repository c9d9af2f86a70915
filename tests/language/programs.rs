//! 2.2: programs.

use std::ops::ControlFlow;

use frictcomp::interpreter::Event;
use frictcomp::text::SourceFile;
use insta::assert_snapshot;

use crate::support::{Bench, MACHINE, SourceMode};

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
fn a_start_program_is_looked_for_beside_the_main_program() {
    // R2.15
    let machine = format!("[machine]\nstart_program = \"start.nc\"\n{MACHINE}");
    let session = Bench::on(&machine).session();
    let mut asked = Vec::new();
    let mut find = |_: &str, caller: &str| {
        asked.push(caller.to_owned());
        Some(SourceFile::new("start.nc", "M17"))
    };
    let mut run = session.interpreter().clone();
    let main = SourceFile::new("dir/main.nc", "M30");
    let _ = run.program(main, &mut find, &mut |_: Event<'_>| {
        ControlFlow::Continue(())
    });
    assert_eq!(asked, ["dir/main.nc"]);
}
