//! 2.10: blocks that a switch of the machine skips, jumps that wait for a probe, written machine
//! data, and the wording about unknown values.

use frictcomp::comp::{AxisIndex, Kind, State};

use crate::support::{Bench, SourceMode};

/// Returns the final states of X and Y, and the transcript.
fn left(bench: &Bench, program: &str) -> (State, State, String) {
    let mut session = bench.session();
    let said = bench.run_in(&mut session, &[program]);
    let state = |axis| session.state().state(AxisIndex::new(axis), Kind::Frict);
    (state(0), state(1), said)
}

#[test]
fn a_block_that_may_be_skipped_makes_unknown_what_it_switches() {
    // R2.90
    let programs = [
        "N10 X[COMP OFF FRICT]\nN20 G01 X10 F100\n/N30 X[COMP ON FRICT]\nN40 M30",
        "X[COMP OFF FRICT]\n/3 N30 X[COMP ON FRICT]\nM30",
        "X[COMP OFF FRICT]\r\n/10N30X[COMP ON FRICT]\r\nM30\r\n",
        "%L S\nX[COMP ON FRICT]\nM17\n%MAIN\nX[COMP OFF FRICT]\n/ LL S\nM30",
        "X[COMP OFF FRICT]\n\"ON\" = \"X[COMP ON FRICT]\"\n/ \"ON\"\nM30",
        "X[COMP OFF FRICT]\n/ $GOTO N50\nX[COMP ON FRICT]\nN50: M30",
        "X[COMP OFF FRICT]\n/M30\nX[COMP ON FRICT]\nM30",
        "%L S\n/M17\nX[COMP ON FRICT]\nM17\n%MAIN\nX[COMP OFF FRICT]\nLL S\nM30",
        "X[COMP OFF FRICT]\nP1=0\n/P1=1\n$IF P1==1\nX[COMP ON FRICT]\n$ENDIF\nM30",
        "X[COMP OFF FRICT]\n/$IF 0\n/X[COMP ON FRICT]\n/$ENDIF\nM30",
        "X[COMP OFF FRICT]\n$IF 0\nX[COMP ON FRICT]\n/$ENDIF\nM30",
        "X[COMP OFF FRICT]\n/$IF 0\nX[COMP ON FRICT]\n$ENDIF\nM30",
        "X[COMP OFF FRICT]\n$IF 0\n/$ELSE\nX[COMP ON FRICT]\n$ENDIF\nM30",
        "X[COMP OFF FRICT]\n$FOR P1=1,3,1\n/X[COMP ON FRICT]\n$ENDFOR\nM30",
        "X[COMP OFF FRICT]\n/ L missing.nc\nM30",
        "/#MACHINE DATA [AX=X P-AXIS-00522=0]\nM30",
    ];
    for program in programs {
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            for bench in [
                Bench::new().passing_branches(),
                Bench::new().passing_branches().check_all(),
            ] {
                let (x, y, said) = left(&bench.handed(handed), program);
                assert_eq!(x, State::Unknown, "{program}\n{said}");
                assert!(said.contains("FC901"), "{program}\n{said}");
                let all = program.contains("missing");
                assert_eq!(y == State::Unknown, all, "{program}\n{said}");
            }
        }
    }
}
