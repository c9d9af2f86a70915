//! 2.7: values and states that cannot be known offline.

use insta::assert_snapshot;

use crate::support::{Bench, MACHINE};

fn run(program: &str) -> String {
    Bench::new().passing_branches().run(&[program])
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
