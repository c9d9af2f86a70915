//! 2.2: programs.

use std::ops::ControlFlow;

use frictcomp::interpreter::Event;
use frictcomp::text::SourceFile;

use crate::support::{Bench, MACHINE, SourceMode};

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
