//! 2.11: variables that a program shares with the PLC.

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::diagnostic::Severity;

use crate::support::{Bench, MACHINE};

/// The state of X that is left, with the messages as `SEVERITY CODE MESSAGE`.
fn left(bench: &Bench, program: &str) -> (State, String) {
    let mut session = bench.session();
    let said = bench.run_in(&mut session, &[program]);
    let _ = said;
    (
        session.state().state(AxisIndex::new(0), Kind::Frict),
        bench.said(program),
    )
}

/// Programs that write `V.E.REQ`, with what may be between that and the condition.
fn between(block: &str) -> String {
    format!("V.E.REQ = 1\n{block}\n$IF V.E.REQ == 0\nX[COMP OFF FRICT]\n$ENDIF\nM30")
}

#[test]
fn the_plc_acts_by_design_in_some_blocks() {
    // R2.99
    let acts = [
        "M0",
        "M1",
        "M26",
        "M3 S100",
        "M=P1",
        "X1 M8",
        "H5",
        "G04 1",
        "G04 X1",
        "#TIME 0.1",
        "#WAIT [ID=1]",
        "#WAIT INDP [X]",
        "#WAIT FOR V.E.OTHER == 1",
        "#FLUSH WAIT",
        "#MSG ACK [\"A\"]",
        "#MSG SYN_ACK [\"A\"]",
        "S[M3 REV1000]",
        "#EXPL SYN",
        "$WHILE V.E.REQ == 1\n$ENDWHILE",
        "$REPEAT\n$UNTIL V.E.REQ != 1",
        "N10: $IF V.E.REQ == 1 $GOTO N10",
    ];
    for act in acts {
        let program = format!("P1 = 8\n{}", between(act));
        let (state, said) = left(&Bench::new(), &program);
        assert_eq!(state, State::Unknown, "{act}\n{said}");
        assert!(
            said.contains("which line 2 set to 1 and the PLC may have changed"),
            "{act}\n{said}"
        );
        assert!(!said.contains("only if"), "{act}\n{said}");
    }
    for none in [
        "X1",
        "T5",
        "#FLUSH",
        "#FLUSH CONTINUE",
        "#MSG [\"A\"]",
        "P1 = 3",
        "G60",
        "D1",
        "LL S",
    ] {
        let program = format!("%L S\nX2\nM17\n%MAIN\n{}", between(none));
        let (state, said) = left(&Bench::new(), &program);
        assert_eq!(state, State::Unknown, "{none}\n{said}");
        assert!(
            said.contains("only if V.E.REQ changes between lines 5 and 7"),
            "{none}\n{said}"
        );
        assert!(!said.contains("may have changed"), "{none}\n{said}");
    }
}

#[test]
fn a_channel_list_says_which_functions_are_not_acknowledged() {
    // R2.99
    let mut bench = Bench::new();
    bench.machine.channel.unacknowledged = [(b'M', 8), (b'H', 2), (b'M', 0)].into();
    for (block, acts) in [("M8", false), ("H2", false), ("M9", true), ("M0", true)] {
        let said = bench.said(&between(block));
        assert_eq!(said.contains("may have changed"), acts, "{block}\n{said}");
    }
}

#[test]
fn what_the_program_wrote_is_the_answer() {
    // R2.99: the other one is an info, whatever the form of the condition.
    let conditions = [
        ("V.E.REQ == 1", true),
        ("V.E.REQ", true),
        ("NOT [V.E.REQ == 0]", true),
        ("V.E.REQ + 1 > 1", true),
        ("V.E.REQ == 0 || P1 == 1", false),
        ("v.e.REQ == 2", false),
    ];
    for (condition, holds) in conditions {
        let program =
            format!("P1 = 0\nV.E.REQ = 1\n$IF {condition}\nX[COMP OFF FRICT]\n$ENDIF\nM30");
        let bench = Bench::new();
        let (state, said) = left(&bench, &program);
        assert_eq!(state, State::Unknown, "{condition}\n{said}");
        assert!(
            said.contains("V.E.REQ changes between lines 2 and 3"),
            "{said}"
        );
        let mut worst = Severity::Info;
        let mut session = bench.session();
        let source = frictcomp::session::Program::Whole(frictcomp::text::SourceFile::new(
            "a.nc",
            program.as_str(),
        ));
        let _ = session.program(
            "a.nc",
            source,
            &mut |_: &str, _: &str| None,
            &mut |record: &frictcomp::timeline::Record<'_>| {
                if let frictcomp::timeline::Record::End(end) = record {
                    worst = end
                        .notes
                        .iter()
                        .map(|note| note.diagnostic.severity)
                        .max()
                        .unwrap_or(worst);
                }
                std::ops::ControlFlow::Continue(())
            },
        );
        let expected = if holds {
            Severity::Warning
        } else {
            Severity::Info
        };
        assert_eq!(worst, expected, "{condition}\n{said}");
    }
    // What does not depend on it has one answer.
    let (state, said) = left(
        &Bench::new(),
        "P1 = 0\nV.E.REQ = 1\n$IF V.E.REQ == 0 && P1 == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30",
    );
    assert_eq!((state, said.as_str()), (State::Active, ""));
}

#[test]
fn values_that_ways_set_stay_apart_where_they_meet() {
    // R2.99
    let bench = Bench::on(MACHINE);
    let set = "$IF V.E.A == 1\nV.E.REQ = 1\n$ELSE\nV.E.REQ = 2\n$ENDIF\n";
    let ask = |value: u8, then: u8| {
        format!(
            "{set}$IF V.E.REQ == {value}\n$SWITCH V.E.REQ\n$CASE {then}\nX[COMP OFF FRICT]\n$ENDSWITCH\n$ENDIF\nM30"
        )
    };
    // The program set it to 2 on one way, and the PLC may change it between the two conditions.
    let (state, said) = left(&bench, &ask(2, 1));
    assert_eq!(state, State::Unknown);
    assert!(
        said.contains("only if V.E.REQ == 2 (line 6) and V.E.REQ changes between lines 4 and 7"),
        "{said}"
    );
    // No way sets it to 3, which the first condition tells until the PLC acts by design.
    let (state, said) = left(&bench, &ask(3, 1));
    assert_eq!(state, State::Active, "{said}");
}

#[test]
fn cases_jumps_elements_and_texts_are_conditions_too() {
    // R2.99
    let programs = [
        (
            "V.E.N = 2",
            "$SWITCH V.E.N\n$CASE 1\nX[COMP OFF FRICT]\n$BREAK\n$CASE 2\n$ENDSWITCH",
        ),
        (
            "V.E.N = 2",
            "$IF V.E.N == 2 $GOTO N10\nX[COMP OFF FRICT]\nN10: Y1",
        ),
        (
            "V.E.L[2] = 2",
            "$IF V.E.L[2] == 1\nX[COMP OFF FRICT]\n$ENDIF",
        ),
        (
            "V.E.L[P1].N = 2",
            "$IF V.E.L[3].N == 1\nX[COMP OFF FRICT]\n$ENDIF",
        ),
        (
            "V.E.T = \"A\"",
            "$IF V.E.T == \"B\"\nX[COMP OFF FRICT]\n$ENDIF",
        ),
        (
            "\"M\" = \"V.E.N == 1\"\nV.E.N = 2",
            "$IF \"M\"\nX[COMP OFF FRICT]\n$ENDIF",
        ),
        (
            "V.E.N = 1\nV.E.N = V.E.N + 1",
            "$IF V.E.N == 1\nX[COMP OFF FRICT]\n$ENDIF",
        ),
    ];
    for (wrote, asks) in programs {
        let program = |act: &str| format!("P1 = 3\n{wrote}\n{act}\n{asks}\nM30");
        let (state, said) = left(&Bench::new(), &program("Y2"));
        assert_eq!(state, State::Unknown, "{asks}\n{said}");
        assert!(said.contains("only if V.E."), "{asks}\n{said}");
        let (state, said) = left(&Bench::new(), &program("M0"));
        assert_eq!(state, State::Unknown, "{asks}\n{said}");
        assert!(
            said.contains("the PLC may have changed") && !said.contains("only if"),
            "{asks}\n{said}"
        );
    }
}

#[test]
fn a_handshake_is_no_endless_loop() {
    // R2.84, R2.99
    let loops = [
        "V.E.REQ = 1\n$WHILE V.E.REQ == 1\n#TIME 0.1\n$ENDWHILE",
        "$WHILE V.E.REQ == 1\n#TIME 0.1\n$ENDWHILE",
        "V.E.REQ = 1\n$WHILE V.E.REQ == 1\n$ENDWHILE",
        "V.E.REQ = 1\n$REPEAT\n$UNTIL V.E.REQ == 0",
        "V.E.REQ = 1\n$DO\n$ENDDO V.E.REQ == 1",
        "V.E.REQ = 1\nN10: Y1\n$IF V.E.REQ == 1 $GOTO N10",
        "V.E.REQ = 1\n$WHILE 1\n$IF V.E.REQ == 0\n$BREAK\n$ENDIF\n$ENDWHILE",
        "V.E.REQ = 1\nN10: $IF V.E.REQ == 0 $GOTO N20\n$GOTO N10\nN20: Y1",
        "V.E.REQ = 1\nP1 = 1\n$WHILE P1 == 1\nP1 = V.E.REQ\n$ENDWHILE",
        "V.E.REQ = 1\nP1 = 1\n$WHILE P1 == 1\n$IF V.E.REQ == 0\nP1 = 0\n$ENDIF\n$ENDWHILE",
    ];
    for text in loops {
        let (state, said) = left(&Bench::new(), &format!("{text}\nX[COMP OFF FRICT]\nM30"));
        assert_eq!(state, State::Inactive, "{text}\n{said}");
        assert!(!said.contains("FC910"), "{text}\n{said}");
        assert!(
            said.contains("FC401") && !said.contains("only if"),
            "{text}\n{said}"
        );
    }
    // Nothing that the machine may write is asked.
    let own = Bench::on(&format!("{MACHINE}[variables]\nown = [\"V.E.REQ\"]\n"));
    assert!(own.said(&format!("{}\nM30", loops[0])).contains("FC910"));
    let stable = Bench::on(&format!("{MACHINE}[variables]\nstable = [\"V.E.REQ\"]\n"));
    assert!(stable.said(&format!("{}\nM30", loops[0])).contains("FC910"));
}

#[test]
fn what_a_program_waits_for_holds_after_it() {
    // R2.99
    let asks = "$IF V.E.REQ == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let (_, said) = left(&Bench::new(), &format!("#WAIT FOR V.E.REQ == 0\n{asks}"));
    assert!(
        said.contains("only if V.E.REQ changes between lines 1 and 2"),
        "{said}"
    );
    let (_, said) = left(
        &Bench::new(),
        &format!("V.E.REQ = 1\n#WAIT FOR V.E.REQ == 0\nM0\n{asks}"),
    );
    assert!(
        said.contains("which line 2 set to 0 and the PLC may have changed"),
        "{said}"
    );
    for never in ["P1 == 1", "V.P.A > 2", "0"] {
        let program = format!("P1 = 0\nV.P.A = 0\n#WAIT FOR {never}\nX[COMP OFF FRICT]\nM30");
        let (state, said) = left(&Bench::new(), &program);
        assert!(
            state == State::Active && said.contains("FC909 3:1 "),
            "{never}\n{said}"
        );
    }
    for may in [
        "P1 == 0",
        "V.E.A == 1 && P1 == 1",
        "V.G.A == 1",
        "V.E.REQ",
        "1",
    ] {
        let program = format!("P1 = 0\nV.E.REQ = 0\n#WAIT FOR {may}\nX[COMP OFF FRICT]\nM30");
        let (state, said) = left(&Bench::new(), &program);
        assert!(
            state == State::Inactive && !said.contains("FC909"),
            "{may}\n{said}"
        );
    }
}

#[test]
fn init_writes_zero() {
    // R2.99
    for init in ["#INIT V.E.", "#INIT V.E.REQ", "#INIT V.E.REQ, V.E.A"] {
        let program = |act: &str| {
            format!("V.E.REQ = 1\n{init}\n{act}\n$IF V.E.REQ == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30")
        };
        let said = Bench::new().said(&program("Y1"));
        assert!(
            said.contains("only if V.E.REQ changes between lines 2 and 4"),
            "{init}\n{said}"
        );
        let said = Bench::new().said(&program("M0"));
        assert!(said.contains("depends on `V.E.REQ`"), "{init}\n{said}");
    }
}

#[test]
fn the_end_of_a_program_lets_the_plc_act() {
    // R2.99: unless only programs write the variable, which is 0 after a start of the control.
    let first = "V.E.PART = 1\nM30";
    let second = "$IF V.E.PART == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30";
    let said = Bench::new().said_in_session(&[first, second]);
    assert!(
        said.contains("which a.nc:1 set to 1 and the PLC may have changed"),
        "{said}"
    );
    let own = Bench::on(&format!("{MACHINE}[variables]\nown = [\"V.E.PART\"]\n"));
    let state = |programs: &[&str]| {
        let mut session = own.session();
        let said = own.run_in(&mut session, programs);
        (session.state().state(AxisIndex::new(0), Kind::Frict), said)
    };
    assert_eq!(state(&[first, second]).0, State::Inactive);
    let (unwritten, said) = state(&[second]);
    assert_eq!(unwritten, State::Active, "{said}");
    let (counted, said) = state(&["V.E.PART = V.E.PART + 1\nM0\nM30", second]);
    assert_eq!(counted, State::Inactive, "{said}");
}

#[test]
fn a_value_from_the_user_is_what_the_plc_writes() {
    // R2.99, R14.7
    let waits = between("M0");
    assert_eq!(
        left(&Bench::new().set("V.E.REQ", 0.0), &waits).0,
        State::Inactive
    );
    assert_eq!(
        left(&Bench::new().set("V.E.REQ", 1.0), &waits).0,
        State::Active
    );
    assert_eq!(
        left(&Bench::new().set("V.E.REQ", 0.0), &between("Y1")).0,
        State::Active
    );
    let counts = "$WHILE V.E.REQ > 0\nV.E.REQ = V.E.REQ - 1\n$ENDWHILE\nX[COMP OFF FRICT]\nM30";
    assert_eq!(
        left(&Bench::new().set("V.E.REQ", 3.0), counts).0,
        State::Inactive
    );
}

#[test]
fn what_a_condition_says_ends_where_the_plc_acts() {
    // R14.1, R2.99
    let nested = |act: &str| {
        format!("$IF V.E.A == 2\n{act}\n$IF V.E.A == 3\nX[COMP OFF FRICT]\n$ENDIF\n$ENDIF\nM30")
    };
    assert_eq!(left(&Bench::new(), &nested("Y1")).0, State::Active);
    let (state, said) = left(&Bench::new(), &nested("M0"));
    assert!(
        state == State::Unknown && said.contains("only if V.E.A changes between lines 1 and 3"),
        "{said}"
    );
}
