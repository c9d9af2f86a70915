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

fn count(said: &str, code: &str) -> usize {
    said.lines().filter(|line| line.starts_with(code)).count()
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

#[test]
fn the_user_says_which_levels_are_on() {
    // R2.90
    let program = "X[COMP OFF FRICT]\n/2 X[COMP ON FRICT]\n/ Y[COMP OFF FRICT]\nM30";
    for (levels, x, y) in [
        ("none", State::Active, State::Inactive),
        ("all", State::Inactive, State::Active),
        ("1", State::Active, State::Active),
        ("2-10", State::Inactive, State::Inactive),
    ] {
        let (found_x, found_y, said) = left(&Bench::new().skip(levels), program);
        assert_eq!((found_x, found_y), (x, y), "{levels}\n{said}");
        assert!(!said.contains("FC901"), "{said}");
        let toml = match levels.parse::<u8>() {
            Ok(level) => format!("[machine]\nskip = [{level}]\n{}", crate::support::MACHINE),
            Err(_) => format!(
                "[machine]\nskip = \"{levels}\"\n{}",
                crate::support::MACHINE
            ),
        };
        let (found_x, found_y, _) = left(&Bench::on(&toml), program);
        assert_eq!((found_x, found_y), (x, y), "{toml}");
        // The option takes precedence over the configuration.
        let (found_x, found_y, _) = left(&Bench::on(&toml).skip("all"), program);
        assert_eq!(
            (found_x, found_y),
            (State::Inactive, State::Active),
            "{toml}"
        );
    }
}

#[test]
fn a_skip_level_is_spoken_of_once() {
    // R2.90
    let program = "X[COMP OFF FRICT]\n/X[COMP ON FRICT]\n/Y[COMP OFF FRICT]\nX1\n/X[COMP OFF FRICT]\n/3 Y[COMP ON FRICT]\nM30";
    let said = Bench::new().passing_branches().said(program);
    assert_eq!(count(&said, "FC901"), 2, "{said}");
    assert!(
        said.contains(
            "FC901 2:1 whether the control executes the blocks of skip level 1 depends on a switch of the machine; whatever they could change is unknown from here on, including `FRICT` of `X` `Y`"
        ),
        "{said}"
    );
    assert!(
        said.contains("`--skip 1`") && said.contains("`skip` in `[machine]`"),
        "{said}"
    );
    // A decision by a value that it leaves names the level and its origin.
    let program = "P1=0\nX1\n/P1=1\n$IF P1==1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let said = Bench::new().passing_branches().said(program);
    assert_eq!(count(&said, "FC901"), 1, "{said}");
    assert!(
        said.contains("FC901 4:1 this control block depends on skip level 1"),
        "{said}"
    );
    assert!(
        said.contains("3:1: the unknown value comes from here"),
        "{said}"
    );
}

#[test]
fn a_skipped_block_that_decides_nothing_says_nothing() {
    // R2.90
    for block in [
        "/M00",
        "/T5",
        "/M8",
        "/G0 X100",
        "/N20 G01 X10 F2000",
        "/2 X1 Y2",
        "/#MSG [\"X[COMP OFF FRICT]\"]",
        "/P1=3",
        "/V.P.A = 3",
        "/ ; only a comment",
        "/LL S",
        "/$IF V.E.A == 1\n/G0 X1\n/$ENDIF",
        "/$GOTO N50\nX1\nN50:",
    ] {
        let program = format!("%L S\nX5\nM17\n%MAIN\n{block}\nG90 X1 Y1\nM30");
        let (x, y, said) = left(&Bench::new(), &program);
        assert_eq!((x, y), (State::Active, State::Active), "{block}\n{said}");
        assert!(!said.contains("FC9"), "{block}\n{said}");
    }
}

#[test]
fn a_block_that_may_be_skipped_only_perhaps_moves() {
    // R2.90
    let said = Bench::new()
        .passing_branches()
        .positions("G90 X1\n/G0 X5\nY1\nX2\nM30");
    let rows: Vec<&str> = said.lines().collect();
    assert!(rows[1].contains("X:?") && rows[2].contains("X:?"), "{said}");
    assert!(rows[3].contains("X:2"), "{said}");
}

#[test]
fn what_the_control_refuses_in_a_block_that_may_be_skipped_is_said() {
    // R2.90
    for bench in [
        Bench::new().passing_branches(),
        Bench::new().passing_branches().check_all(),
    ] {
        let said = bench.said(
            "/Z[COMP ON FRICT]\n/X[COMP ONN FRICT]\nX[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30",
        );
        assert!(said.contains("P-ERR-70495 1:2"), "{said}");
        assert!(said.contains("FC202 2:"), "{said}");
        assert!(!said.contains("FC310"), "{said}");
    }
}

#[test]
fn a_modal_cycle_may_be_repeated_after_a_skipped_block() {
    // R2.13 R2.90
    let program =
        "%L S\nX[COMP OFF FRICT]\nM17\n%MAIN\nLL CYCLE [NAME=S MODAL_BLOCK]\nX[COMP ON FRICT]\nM30";
    let (x, _, said) = left(&Bench::new(), program);
    assert_eq!(x, State::Inactive, "{said}");
    let program = "%L S\nX[COMP OFF FRICT]\nM17\n%MAIN\nX[COMP ON FRICT]\nLL CYCLE [NAME=S MODAL_MOVE]\n#DISABLE MODAL CYCLE\nX[COMP ON FRICT]\nM30";
    let (x, _, said) = left(&Bench::new(), program);
    assert_eq!(x, State::Active, "{said}");
    let program = "%L S\nX[COMP OFF FRICT]\nM17\n%MAIN\nLL CYCLE [NAME=S MODAL_MOVE]\n/Y5\nM30";
    let (x, _, said) = left(&Bench::new(), program);
    assert_eq!(x, State::Unknown, "{said}");
}

#[test]
fn a_jump_beside_a_probe_may_be_taken() {
    // R2.91
    for jump in [
        "N20 G310 X10 $GOTO N50",
        "N20 G310 X10 F100 $GOTO [OUT]",
        "N20 G310X10$GOTO N50",
        "N20 $GOTO N50 G310 X10",
        "\"PROBE\" = \"G310 X10\"\n\"PROBE\" $GOTO N50",
        "P1 = 310\nN20 G P1 X10 $GOTO N50",
        "N20 $IF 1 $GOTO N50 G310 X10",
    ] {
        let program = format!("{jump}\nX[COMP OFF FRICT]\nN50:\n[OUT]\nM30");
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            let (x, _, said) = left(&Bench::new().passing_branches().handed(handed), &program);
            assert_eq!(x, State::Unknown, "{jump}\n{said}");
            assert!(said.contains("FC902"), "{jump}\n{said}");
        }
    }
    let said = Bench::new()
        .passing_branches()
        .said("G310 X10 $GOTO N50\nX[COMP OFF FRICT]\nN50: M30");
    assert!(said.contains("the signal of the probe"), "{said}");
    // The skipped blocks make no difference.
    let said = Bench::new()
        .passing_branches()
        .said("G310 X10 $GOTO N50\nX20\nN50: M30");
    assert_eq!(said, "");
    // Without a probe, the jump is taken.
    let (x, ..) = left(
        &Bench::new().passing_branches(),
        "G1 X10 F100 $GOTO N50\nX[COMP OFF FRICT]\nN50: M30",
    );
    assert_eq!(x, State::Active);
    // Only the probe knows where the axis stopped.
    let stands = Bench::new()
        .passing_branches()
        .positions("G90 G1 X1 F100\nG310 X10\nM30");
    assert!(
        stands.lines().nth(1).is_some_and(|row| row.contains("X:?")),
        "{stands}"
    );
}

#[test]
fn an_unknown_jump_is_no_all_clear() {
    // R2.52 R2.91
    let program = "$IF V.E.A == 1 $GOTO N50\nX[COMP OFF FRICT]\nN50: M30";
    let said = Bench::new().passing_branches().said(program);
    assert!(!said.contains("assumes"), "{said}");
    assert!(
        said.contains("FC902 1:1 whether this jump is taken depends on `V.E.A`"),
        "{said}"
    );
    assert!(said.contains("FC401"), "{said}");
}

#[test]
fn written_machine_data_transfers_the_list_again() {
    // R2.92
    for write in [
        "#MACHINE DATA [AX=X P-AXIS-00522=0]",
        "#MACHINE DATA [AX=X P-AXIS-00522 0]",
        "#MACHINE DATA [SYN AX=X P-AXIS-00522=0]",
        "#MACHINE DATA SYN [AX=X P-AXIS-00522=0]",
        "#machine data [ ax = X  p-axis-00522 = 0 ]",
        "#MACHINE DATA[AX=X lr_param.frict_comp 0]",
        "#MACHINE DATA [AX=X AXPARAM \"lr_param.frict_comp 0\"]",
    ] {
        let program = format!("{write}\nM30");
        let (x, y, said) = left(&Bench::new().passing_branches(), &program);
        assert_eq!((x, y), (State::Unknown, State::Active), "{write}\n{said}");
        assert!(said.contains("FC314 1:1"), "{write}\n{said}");
    }
    // By axis number, which only lists give.
    let (x, y, said) = left(
        &Bench::new().passing_branches(),
        "#MACHINE DATA [AXNR=1 P-AXIS-00522=0]\nM30",
    );
    assert_eq!((x, y), (State::Unknown, State::Unknown), "{said}");
    let numbered = crate::support::MACHINE.replacen("name = \"X\"", "name = \"X\"\nnumber = 7", 1);
    let numbered = numbered.replacen("name = \"Y\"", "name = \"Y\"\nnumber = 8", 1);
    let program = "P1=6\n#MACHINE DATA [AXNR=[P1+1] P-AXIS-00522=0]\nM30";
    let (x, y, said) = left(&Bench::on(&numbered), program);
    assert_eq!((x, y), (State::Unknown, State::Active), "{said}");
    // Any other parameter discards only the settings made by NC commands.
    let other = "#MACHINE DATA [AX=X kenngr.swe_pos=100]";
    let (x, _, said) = left(&Bench::new().passing_branches(), &format!("{other}\nM30"));
    assert_eq!(x, State::Active, "{said}");
    assert!(!said.contains("FC314"), "{said}");
    let (x, _, said) = left(
        &Bench::new().passing_branches(),
        &format!("X[COMP OFF FRICT]\n{other}\nM30"),
    );
    assert_eq!(x, State::Unknown, "{said}");
    assert!(said.contains("FC314 2:1"), "{said}");
    let (x, _, said) = left(
        &Bench::new().passing_branches(),
        &format!("$IF V.E.A==1\n{other}\n$ENDIF\nM30"),
    );
    assert_eq!(x, State::Unknown, "{said}");
}

#[test]
fn an_unknown_value_is_spoken_of_once_with_its_root() {
    // R2.95
    let program = "$IF V.E.A == 1\nP1 = 3\n$ELSE\nP1 = 4\n$ENDIF\n$IF P1 == 3\nX[COMP OFF FRICT]\n$ENDIF\n$IF P1 == 4\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let said = Bench::new().passing_branches().said(program);
    assert_eq!(count(&said, "FC901"), 1, "{said}");
    assert!(
        said.contains("FC901 6:1 this control block depends on `V.E.A`"),
        "{said}"
    );
    assert!(said.contains("including `FRICT` of `X`"), "{said}");
    assert!(
        said.contains("1:1: the unknown value comes from here"),
        "{said}"
    );
    // Another axis is a separate message.
    let program =
        "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.E.A == 2\nY[COMP OFF FRICT]\n$ENDIF\nM30";
    assert_eq!(
        count(&Bench::new().passing_branches().said(program), "FC901"),
        2
    );
    // Many equal calls.
    let said = Bench::new()
        .passing_branches()
        .said("L V.E.NAME\nL V.E.NAME\nX[COMP ON FRICT]\nL V.E.NAME\nM30");
    assert_eq!(count(&said, "FC902"), 1, "{said}");
    let external = format!(
        "[machine]\nexternal = [\"*.ecy\"]\n{}",
        crate::support::MACHINE
    );
    let program =
        "L meas.ecy\nL meas.ecy\nL other.ecy\n$IF V.P.RESULT > 3\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let said = Bench::on(&external).said(program);
    assert_eq!(count(&said, "FC902"), 2, "{said}");
    assert!(!said.contains("FC311"), "{said}");
}

#[test]
fn a_missing_program_is_the_root_of_what_it_would_have_written() {
    // R2.95
    let program = "L meas.ecy\n$IF V.P.RESULT > 3\nX[COMP OFF FRICT]\n$ENDIF\n$IF P10 > 3\nG0 X10\n$ENDIF\nM30";
    let said = Bench::new().passing_branches().check_all().said(program);
    assert_eq!(count(&said, "FC320"), 1, "{said}");
    assert_eq!(count(&said, "FC311"), 0, "{said}");
    assert_eq!(count(&said, "FC901"), 1, "{said}");
    assert!(
        said.contains("the program `meas.ecy`, which is missing"),
        "{said}"
    );
    assert!(
        said.contains("1:1: the unknown value comes from here"),
        "{said}"
    );
}

#[test]
fn nothing_is_said_where_nothing_can_differ() {
    // R2.95
    for program in [
        "$IF V.E.A == 1\nG0 X10\n$ENDIF\nM30",
        "$IF V.E.A == 1\n#MSG [\"measured\"]\n$ENDIF\nM30",
        "$IF V.E.A == 1\nP1 = 2\nV.P.B = 2\n$ENDIF\nM30",
        "$IF V.E.A == 1\nM8\nT3\n$ENDIF\nM30",
        "$WHILE V.E.A == 1\nX1\n$ENDWHILE\nM30",
        "$IF V.E.A == 1 $GOTO N50\nX10\nN50: M30",
        "%L S\nX1\nM17\n%MAIN\n$IF V.E.A == 1\nLL S\n$ENDIF\nM30",
    ] {
        assert_eq!(
            Bench::new().passing_branches().said(program),
            "",
            "{program}"
        );
        // An `allow` that is unused because of this remains.
        let allowed = program.replacen("V.E.A == 1", "V.E.A == 1 ; frictcomp: allow FC901", 1);
        if !program.contains("$GOTO") {
            assert_eq!(
                Bench::new().passing_branches().said(&allowed),
                "",
                "{allowed}"
            );
        }
    }
    for program in [
        "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30",
        "$IF V.E.A == 1\nV.S.B = 2\n$ENDIF\nM30",
        "$IF V.E.A == 1\nV.E.B = 2\n$ENDIF\nM30",
        "$IF V.E.A == 1\nG91\n$ENDIF\nM30",
        "$IF V.E.A == 1\n#ERROR [ID=1 RC=2]\n$ENDIF\nM30",
        "$IF V.E.A == 1\nM30\n$ENDIF\nX1\nM30",
        "%L S\nX[COMP OFF FRICT]\nM17\n%MAIN\n$IF V.E.A == 1\nLL S\n$ENDIF\nM30",
    ] {
        let said = Bench::new().passing_branches().said(program);
        assert!(said.contains("FC901"), "{program}\n{said}");
    }
}

#[test]
fn what_the_control_refuses_where_ways_cannot_part_is_said() {
    // R2.51 R2.90
    let programs = [
        "$IF V.E.B == 1\nX1\n/2 $ELSE\nZ[COMP ON FRICT]\n$ENDIF\nM30",
        "$IF V.E.B == 1\nZ[COMP ON FRICT]\n/ $ENDIF\nM30",
        "%L S\nZ[COMP ON FRICT]\nM17\n%MAIN\n$IF V.E.B == 1\nLL S\n/$ELSE\n$ENDIF\nM30",
        "%L C\nM17\n%MAIN\nLL CYCLE [NAME=C MODAL_MOVE]\n$IF V.E.B == 1\nZ[COMP ON FRICT]\n$ENDIF\n#DISABLE MODAL CYCLE\nM30",
        "$SWITCH V.E.B\n$CASE 1\nZ[COMP ON FRICT]\n$BREAK\n/3 $DEFAULT\n$BREAK\n$ENDSWITCH\nM30",
        "$WHILE V.E.B == 1\nZ[COMP ON FRICT]\n/ $ENDWHILE\nM30",
    ];
    for program in programs {
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            for bench in [Bench::new(), Bench::new().check_all()] {
                let said = bench.handed(handed).said(program);
                assert!(said.contains("P-ERR-70495"), "{program}\n{said}");
            }
        }
    }
    let said = Bench::new()
        .check_all()
        .said("P1 = 2\n$IF V.E.B == 1\nG0 G1 X5\nP3 = 4\n/ $ELSE\nX=P3 Y=P1\nX=P7\n$ENDIF\nM30");
    assert!(
        said.contains("FC313 3:") && said.contains("FC311 7:"),
        "{said}"
    );
    assert_eq!(count(&said, "FC311"), 1, "{said}");
}

#[test]
fn what_the_control_refuses_where_only_the_machine_knows_the_way_is_said() {
    // R2.51 R2.52
    let programs = [
        "N10 $GOTO N[V.E.T]\nN20 M30\nN100: Z[COMP ON FRICT]\nM30",
        "P1 = V.E.T\n$GOTO N[P1]\n$GOTO N30\nN20: X1\nZ[COMP ON FRICT]\nN30: M30",
        "%L S\n$GOTO N[V.E.T]\nM17\nN20: Z[COMP ON FRICT]\nM17\n%MAIN\nLL S\nX1\nM30",
        "%L S\nZ[COMP ON FRICT]\nM17\n%MAIN\nX1\n$GOTO N[V.E.T]\nM30\nN20: LL S\nM30",
        "%L S\nZ[COMP ON FRICT]\nM17\n%MAIN\nLL V.E.NAME\nM30",
        "%L S\nLL T\nM17\n%L T\nZ[COMP ON FRICT]\nM17\n%MAIN\nLL V.E.NAME\nM30",
        "%L S\nZ[COMP ON FRICT]\nM17\n%MAIN\n$IF V.E.B == 1\nLL V.E.NAME\n/2 $ELSE\n$ENDIF\nM30",
        "%L S\n\"A\"\nM17\n%MAIN\n\"A\" = \"Z[COMP ON FRICT] X=P99\"\n$IF V.E.B == 1\nLL S\n/2 $ELSE\n$ENDIF\nM30",
        "L SEQUENCE [N[V.E.A] N30]\nM30\nN20 Z[COMP ON FRICT]\nN30 M30",
        "L SEQUENCE [N20 N30 REPEAT=V.E.A]\nM30\nN20 Z[COMP ON FRICT]\nN30 M30",
        "%L S\nM17 [MAIN N[V.E.A]]\n%MAIN\nLL S\nM30\nN20: Z[COMP ON FRICT]\nM30",
        "#FILE NAME [M6=\"tool.nc\"]\nM=V.E.A\nM30",
        "#FILE NAME [G80=\"tool.nc\"]\nG=V.E.A\nM30",
        "#FILE NAME [G80=\"tool.nc\"]\n$IF V.E.B == 1\nG=V.E.A\n/2 $ELSE\n$ENDIF\nM30",
    ];
    for program in programs {
        for handed in [SourceMode::Whole, SourceMode::LineByLine] {
            let bench = Bench::new()
                .check_all()
                .file("tool.nc", "Z[COMP ON FRICT]\nM17\n");
            let said = bench.handed(handed).said(program);
            assert_eq!(count(&said, "P-ERR-70495"), 1, "{program}\n{said}");
        }
    }
    let shown = Bench::new()
        .check_all()
        .said("N10 $GOTO N[V.E.T]\nN20 M30\nN100: Z[COMP ON FRICT]\nM30");
    assert!(
        shown.contains("whether the block is executed depends on `V.E.T`"),
        "{shown}"
    );
}

#[test]
fn what_no_way_reaches_or_was_executed_is_not_said_again() {
    // R2.52
    let programs = [
        ("N10 M30\nN100: Z[COMP ON FRICT]\nM30", 0),
        ("Z[COMP ON FRICT]\n$GOTO N[V.E.T]\nN20: X1\nM30", 1),
        (
            "%L S\nZ[COMP ON FRICT]\nM17\n%MAIN\nLL S\n$GOTO N[V.E.T]\nN20: LL S\nM30",
            1,
        ),
        (
            "%L S\nZ[COMP ON FRICT]\nM17\n%MAIN\nLL V.E.NAME\nLL S\nM30",
            1,
        ),
        (
            "L SEQUENCE [N[V.E.A] N30]\nN20 Z[COMP ON FRICT]\nN30 M30",
            1,
        ),
        ("%L S\nZ[COMP ON FRICT]\nM17\n%MAIN\nL V.E.NAME\nM30", 0),
        ("/2 $ENDIF\n$IF V.E.B == 1\n/ $ENDIF\nM30", 0),
    ];
    for (program, expected) in programs {
        let said = Bench::new().check_all().said(program);
        assert_eq!(count(&said, "P-ERR-70495"), expected, "{program}\n{said}");
    }
}

#[test]
fn a_branch_behind_a_skipped_part_is_not_entered() {
    // R2.3 R2.90
    let program = "X[COMP OFF FRICT]\nP1 = 0\n$IF P1 == 1\nY[COMP OFF FRICT]\n/2 $ELSE\nX[COMP ON FRICT]\n$ENDIF\nM30";
    for (levels, expected) in [("2", State::Inactive), ("none", State::Active)] {
        let (x, y, said) = left(&Bench::new().skip(levels), program);
        assert_eq!((x, y), (expected, State::Active), "{said}");
    }
    let program = "X[COMP OFF FRICT]\n$SWITCH 3\n$CASE 1\n$BREAK\n/ $CASE 3\nX[COMP ON FRICT]\n$BREAK\n/2 $DEFAULT\nX[COMP ON FRICT]\n$ENDSWITCH\nM30";
    let (x, _, said) = left(&Bench::new().skip("all"), program);
    assert_eq!(x, State::Inactive, "{said}");
}

#[test]
fn trying_blocks_that_are_passed_over_changes_nothing() {
    // R2.51
    let region = "$IF V.E.B == 1\n#RT CYCLE [ID = 1]\n#RT CYCLE END\n\"A\" = \"$GOTO N90\"\n\"A\"\nG310 X5 $GOTO N90\n#IF V.E.C == 1\nX[COMP OFF FRICT]\n#ENDIF\nL missing.nc\n/2 $ELSE\nX2\n$ENDIF\n";
    let program = format!("{region}Y[COMP OFF FRICT]\nX[COMP ON FRICT]\nN90: M30");
    let (x, y, said) = left(&Bench::new().check_all(), &program);
    let passed = left(&Bench::new().check_all().passing_branches(), &program);
    assert_eq!((x, y), (passed.0, passed.1), "{said}\n{}", passed.2);
}

#[test]
fn a_level_that_does_not_exist_skips_nothing() {
    // R2.3: regardless of the switches.
    for mark in ["/11", "/0", "/12", "/100", "/ 11", "/01"] {
        let program = format!("{mark} N10 X[COMP OFF FRICT]\nM30");
        for bench in [
            Bench::new().skip("all"),
            Bench::new().skip("none"),
            Bench::new(),
        ] {
            let said = bench.said(&program);
            assert_eq!(count(&said, "FC207"), 1, "{mark}: {said}");
            assert!(said.contains("there is no skip level"), "{mark}: {said}");
        }
    }
}
