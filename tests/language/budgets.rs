//! 2.8 and 2.9: budgets bound the work of a program, and endless loops are recognised.

use std::ops::ControlFlow;

use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::interpreter::{Branches, EndedBy, Event, Interpreter, NoFiles, Options, StopPolicy};
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

use crate::support::MACHINE;

/// The result of a run.
#[derive(Debug)]
struct Ran {
    by: EndedBy,
    blocks: u64,
    work: u64,
    said: Vec<(String, String)>,
    states: Vec<(String, String)>,
}

impl Ran {
    fn codes(&self) -> Vec<&str> {
        self.said.iter().map(|(code, _)| code.as_str()).collect()
    }

    fn message(&self, code: &str) -> &str {
        let found = self.said.iter().find(|(said, _)| said == code);
        found.map_or("", |(_, message)| message)
    }
}

fn ran(text: &str, options: Options) -> Ran {
    let machine = Machine::from_toml(MACHINE).expect("the test's machine");
    let comp = machine.compensation();
    let mut run = Interpreter::new(machine, comp, options);
    let mut ended = None;
    let mut said = Vec::new();
    run.program(
        SourceFile::new("a.nc", text),
        &mut NoFiles,
        &mut |event: Event<'_>| {
            let diagnostics = match event {
                Event::Executed(block) => block.diagnostics,
                Event::Ended(end) => {
                    ended = Some(end.by);
                    end.diagnostics
                }
                Event::Started { .. } | Event::Joined(_) => &[],
            };
            let new = diagnostics
                .iter()
                .map(|said| (said.code.as_str().to_owned(), said.message.clone()));
            said.extend(new);
            ControlFlow::Continue(())
        },
    );
    let state = run.compensation().clone();
    let axes = run.machine().axes.iter().enumerate();
    let states = axes.map(|(at, axis)| {
        let at = frictcomp::comp::AxisIndex::new(at);
        let state = state.state(at, frictcomp::comp::Kind::Frict);
        (axis.name.clone(), state.as_str().to_owned())
    });
    Ran {
        by: ended.expect("the program ends"),
        blocks: run.blocks(),
        work: run.work(),
        states: states.collect(),
        said,
    }
}

fn run(text: &str) -> Ran {
    ran(text, Options::default().with_branches(Branches::Passed))
}

fn going_on() -> Options {
    Options::default()
        .with_stop(StopPolicy::KeepGoing)
        .with_branches(Branches::Passed)
}

#[test]
fn a_loop_whose_state_repeats_never_ends() {
    // R2.84
    for endless in [
        "$WHILE 1\nX1\nX2\n$ENDWHILE\nM30",
        "$WHILE TRUE\n$ENDWHILE\nM30",
        "$REPEAT\nX[COMP OFF FRICT]\nX[COMP ON FRICT]\n$UNTIL 0\nM30",
        "$DO\nX1\n$ENDDO 1\nM30",
        "$FOR P1=1,10,0\nX1\n$ENDFOR\nM30",
        "N10: X1\n$GOTO N10\nM30",
        "%L A\nX1\nM17\n%MAIN\n$WHILE 1\nLL A\n$ENDWHILE\nM30",
        // A period of two passes.
        "P1=0\n$WHILE 1\nP1 = 1-P1\n$IF P1\nX[COMP OFF FRICT]\n$ELSE\nX[COMP ON FRICT]\n$ENDIF\n$ENDWHILE\nM30",
        // An endless loop that contains loops that end.
        "$WHILE 1\n$FOR P1=1,100,1\nX=P1\n$ENDFOR\n$ENDWHILE\nM30",
    ] {
        let ran = run(endless);
        assert_eq!(ran.by, EndedBy::Budget, "{endless}");
        assert!(ran.blocks < 15_000, "{} blocks: {endless}", ran.blocks);
        let said = ran.message("FC910");
        assert!(
            said.contains("never ends") && said.contains("nothing changes any more"),
            "{ran:?}"
        );
    }
}

/// Loops that nothing known ends; the blocks after them are run, and X has the state given here.
const MAYBE_ENDLESS: [(&str, &str); 18] = [
    (
        "$WHILE 1\n$IF V.E.STOP\n$BREAK\n$ENDIF\nX1\n$ENDWHILE\nX[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "$WHILE 1\nX[COMP OFF FRICT]\n$IF V.E.STOP\n$BREAK\n$ENDIF\nX1\n$ENDWHILE\nM30",
        "inactive",
    ),
    (
        "$WHILE 1\nX[COMP OFF FRICT]\n$IF V.E.STOP\n$BREAK\n$ENDIF\nX[COMP ON FRICT]\n$IF V.E.STOP\n$BREAK\n$ENDIF\n$ENDWHILE\nM30",
        "unknown",
    ),
    (
        "$WHILE 1\n$IF V.E.STOP $GOTO N99\nX1\n$ENDWHILE\nX[COMP ON FRICT]\nN99: X[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "$WHILE 1\n$IF V.E.STOP $GOTO N99\nX1\n$ENDWHILE\nX[COMP OFF FRICT]\nN99: M30",
        "active",
    ),
    (
        "$DO\n$IF V.E.STOP\n$GOTO N99\n$ENDIF\nX1\n$ENDDO\nN99: X[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "$REPEAT\n$IF V.E.STOP\n$BREAK\n$ENDIF\nX1\n$UNTIL 0\nX[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "$FOR P1=1,10,0\n$SWITCH V.E.STOP\n$CASE 1\n$GOTO [OUT]\n$ENDSWITCH\nX1\n$ENDFOR\n[OUT] X[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "N10: X1\n$IF V.E.STOP $GOTO N20\n$GOTO N10\nN20: X[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "N10: X1\n$GOTO V.E.WHERE\n$GOTO N10\nN20: X[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "X[COMP OFF FRICT]\n$WHILE 1\n$IF V.E.STOP\nM30\n$ENDIF\nX1\n$ENDWHILE\nX[COMP ON FRICT]\nM30",
        "inactive",
    ),
    (
        "%L S\nX[COMP OFF FRICT]\n$WHILE 1\n$IF V.E.STOP\nM17\n$ENDIF\nX1\n$ENDWHILE\nM17\n%MAIN\nLL S\nY[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "%L T\n$IF V.E.STOP\nM17 [JUMPS=2]\n$ENDIF\nM17\n%L S\n$WHILE 1\nLL T\n$ENDWHILE\nM17\n%MAIN\nLL S\nX[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "%L T\n$IF V.E.STOP\nM30\n$ENDIF\nM17\n%MAIN\nX[COMP OFF FRICT]\n$WHILE 1\nLL T\n$ENDWHILE\nM30",
        "inactive",
    ),
    // Nested loops, and one that is repeated in a loop that ends.
    (
        "$WHILE 1\n$WHILE 1\n$IF V.E.STOP\n$BREAK\n$ENDIF\n$ENDWHILE\n$IF V.E.STOP\n$BREAK\n$ENDIF\n$ENDWHILE\nX[COMP OFF FRICT]\nM30",
        "inactive",
    ),
    (
        "$FOR P1=1,3,1\n$WHILE 1\n$IF V.E.STOP\n$BREAK\n$ENDIF\n$ENDWHILE\n$ENDFOR\n$IF P1==4\nX[COMP OFF FRICT]\n$ENDIF\nM30",
        "inactive",
    ),
    // The value of a mere counter is unknown afterwards.
    (
        "P1=0\n$WHILE 1\n$IF V.E.STOP\n$BREAK\n$ENDIF\nP1=P1+1\n$ENDWHILE\n$IF P1==0\nX[COMP OFF FRICT]\n$ENDIF\nM30",
        "unknown",
    ),
    // The state never repeats.
    (
        "G91\n$WHILE 1\n$IF V.E.STOP\n$BREAK\n$ENDIF\nX1 Y[COMP OFF FRICT]\n$ENDWHILE\n$IF V.A.ABS.X > 5\nX[COMP OFF FRICT]\n$ENDIF\nM30",
        "unknown",
    ),
];

#[test]
fn a_loop_that_the_machine_may_end_is_left_and_what_follows_runs() {
    // R2.84 R2.51 R2.52
    for (text, state) in MAYBE_ENDLESS {
        let ran = run(text);
        assert_eq!(ran.by, EndedBy::M30, "{text}: {ran:?}");
        assert!(!ran.codes().contains(&"FC910"), "{text}: {ran:?}");
        assert_eq!(ran.states[0].1, state, "{text}: {ran:?}");
        let said = ran
            .said
            .iter()
            .any(|(code, said)| code == "FC902" && said.contains("this loop"));
        assert!(said, "{text}: {ran:?}");
    }
}

#[test]
fn loops_in_each_other_that_may_be_left_do_not_multiply() {
    // R2.60 R2.84
    let opener = "$WHILE 1\n$IF V.E.STOP\n$BREAK\n$ENDIF\n".repeat(12);
    let ran = run(&format!("{opener}{}M30", "$ENDWHILE\n".repeat(12)));
    assert_eq!(ran.by, EndedBy::M30);
    assert!(ran.blocks < 50_000, "{}", ran.blocks);
}

#[test]
fn what_only_counts_does_not_keep_a_loop_from_repeating() {
    // R2.84
    let ran_through =
        run("P1=0\nV.P.N=5\n$WHILE 1\nP1 = P1 + 1\nV.P.N = V.P.N - 2\nX1\n$ENDWHILE\nM30");
    let said = ran_through.message("FC910");
    assert!(
        said.contains("except `P1`, `V.P.N`, which nothing reads"),
        "{said}"
    );
    assert!(ran_through.blocks < 500);
}

#[test]
fn a_loop_that_may_end_is_run_to_its_end() {
    // R2.84: the counter is read in various places, late or indirectly.
    for ends in [
        "P1=0\n$WHILE 1\nP1=P1+1\n$IF P1>5000 $GOTO N99\n$ENDWHILE\nN99: M30",
        "P1=0\n$WHILE P1<5000\nP1=P1+1\n$ENDWHILE\nM30",
        "P1=0\nP2=0\n$WHILE 1\nP1=P1+1\nP2=P1*2\n$IF P2>9000\n$BREAK\n$ENDIF\n$ENDWHILE\nM30",
        // Read only if another parameter, which counts for a long time, permits it.
        "P1=0\nP3=0\n$WHILE 1\nP1=P1+1\n$IF P3>50\n$IF P1>4000 $GOTO N99\n$ENDIF\nP3=P3+0.01\n$ENDWHILE\nN99: M30",
        "$FOR P1=1,5000,1\nX1\n$ENDFOR\nM30",
        "G91\n$WHILE 1\nX1\n$IF V.A.ABS.X > 3000 $GOTO N99\n$ENDWHILE\nN99: M30",
        "V.P.A=\"\"\n$WHILE LEN[V.P.A]<3000\nV.P.A=V.P.A+\"x\"\n$ENDWHILE\nM30",
        "P1=1\n$WHILE 1\nP1=P1*1.01\n$IF EXIST[V.P.B]\n$BREAK\n$ENDIF\n$IF P1>1000\nV.P.B=1\n$ENDIF\n$ENDWHILE\nM30",
        "\"N\"=\"P1\"\nP1=0\n$WHILE \"N\"<5000\nP1=P1+1\n$ENDWHILE\nM30",
        "P1=0\nP2=1000\n$WHILE 1\nP1=P1+1\nPP2=1\nP2=P2+1\n$IF P2>4000\n$BREAK\n$ENDIF\n$ENDWHILE\nM30",
    ] {
        let ran = run(&format!("G1 F100 X0\n{ends}"));
        assert!(!ran.codes().contains(&"FC910"), "{ends}: {ran:?}");
        assert_eq!(ran.by, EndedBy::M30, "{ends}: {ran:?}");
    }
}

#[test]
fn a_loop_beyond_the_budget_of_blocks_is_named_with_its_passes() {
    // R2.60, R2.84
    let mut options = Options::default();
    options.limits.blocks = 1000;
    let ran = ran(
        "P1=1\n$WHILE P1>0\nP1=P1*1.0001+P1\n$ENDWHILE\nM30",
        options,
    );
    assert_eq!((ran.by, ran.blocks), (EndedBy::Budget, 1000));
    assert!(
        ran.message("FC910").contains("more than 1000 blocks"),
        "{ran:?}"
    );
}

#[test]
fn macros_that_use_each_other_are_looked_through_once() {
    // R2.60
    let uses = |name: &str| format!("\\\"{name}\\\" ").repeat(4);
    let text = format!(
        "\"A\"=\"{}\"\n\"B\"=\"{} X[COMP OFF FRICT]\"\n$IF V.E.X\n\"A\"\n$ENDIF\nM30",
        uses("B"),
        uses("A")
    );
    let ran = run(&text);
    assert_eq!(ran.by, EndedBy::M30);
    assert!(ran.work < 1000, "{ran:?}");
    assert_eq!(ran.states[0], ("X".to_owned(), "unknown".to_owned()));
}

#[test]
fn work_beyond_what_is_written_ends_the_run() {
    // R2.60
    let mut options = going_on();
    options.limits.work = 10_000;
    let long = "X1 ".repeat(300);
    let eight = |name: &str| format!("\\\"{name}\\\" ").repeat(8);
    let text = format!(
        "V.S.A=1\n\"A\"=\"{long}\"\n\"B\"=\"{}\"\n\"C\"=\"{}\"\n$FOR P1=1,100,1\n\"C\"\n$ENDFOR\nM30",
        eight("A"),
        eight("B")
    );
    let ran = ran(&text, options);
    assert_eq!(ran.by, EndedBy::Budget);
    assert_eq!(
        ran.codes().iter().filter(|code| **code == "FC919").count(),
        1
    );
    assert!(
        ran.states
            .iter()
            .all(|(_, state)| state == "unknown" || state == "unconfigured"),
        "{ran:?}"
    );
}

#[test]
fn a_loop_on_purpose_never_comes_near_the_budget_of_work() {
    // R2.60
    let mut options = Options::default();
    options.limits.work = 1000;
    let text = "P2=0\n$FOR P1=1,20000,1\nP2 = [P2 + P1 * 2 - [P1 + 1] / 3] * 0.5\n$ENDFOR\nM30";
    let ran = ran(text, options);
    assert_eq!(ran.by, EndedBy::M30, "{ran:?}");
    assert!(ran.work > 100_000);
}

#[test]
fn texts_have_a_length() {
    // R2.60
    let text = "P1=\"ab\"\n$WHILE 1\nP1=P1+P1\n$ENDWHILE\nM30";
    let stopped = run(text);
    assert_eq!(stopped.by, EndedBy::Error);
    assert_eq!(
        stopped.message("FC312"),
        "the string has more than 4000 characters"
    );
    let went_on = ran(text, going_on());
    assert_eq!(went_on.by, EndedBy::Budget);
    assert!(went_on.blocks < 500, "{}", went_on.blocks);
    for grows in [
        "INSERT[V.S.A, V.S.A, 1]",
        "REPLACE[V.S.A, V.S.A, 1, 1]",
        "V.S.A + V.S.A",
    ] {
        let text = format!("V.S.A=\"ab\"\n$FOR P1=1,40,1\nV.S.A={grows}\n$ENDFOR\nM30");
        let ran = run(&text);
        assert_eq!(
            ran.message("FC312"),
            "the string has more than 4000 characters",
            "{grows}"
        );
    }
}

#[test]
fn values_are_counted() {
    // R2.60
    let mut options = going_on();
    options.limits.values = 2000;
    for grows in [
        "PP1=1",
        "V.P.A[P1]=1",
        "V.S.A[P1]=1",
        "P7[P1]=1",
        "V.P.T[P1]=\"a text of some length that counts once more for every 32 bytes\"",
        "#SET AX LINK [P1, Y=X]",
    ] {
        let text = format!("P1=2000\n$WHILE P1>0\n{grows}\nP1=P1+1\n$ENDWHILE\nM30");
        let ran = ran(&text, options);
        assert_eq!(ran.by, EndedBy::Budget, "{grows}");
        assert_eq!(
            ran.codes().last(),
            Some(&"FC918"),
            "{grows}: {:?}",
            ran.codes()
        );
        assert!(ran.blocks < 9000, "{grows}: {}", ran.blocks);
    }
    let written_over = "$FOR P1=1,3000,1\nV.P.A[1]=P1\nP2000=P1\nV.S.B=\"x\"\n#VAR\nV.P.C[5]=[1,2]\n#ENDVAR\n#DELETE V.P.C\n$ENDFOR\nM30";
    let ran = ran(written_over, options);
    assert_eq!(ran.by, EndedBy::M30, "{:?}", ran.said.last());
}

#[test]
fn a_number_that_is_none_is_said_where_it_arises() {
    // R2.60, R2.37
    for text in [
        "$FOR V.S.A=17*10**307,1,10**308\nX1\n$ENDFOR\nM30",
        "$FOR V.S.A=17*10**307,18*10**307,10**307\nX1\n$ENDFOR\nM30",
        "P1=10**308\nP1=P1*10\nM30",
        "P1=10**308+10**308\nM30",
        "P1=EXP[1000]\nM30",
    ] {
        let ran = run(text);
        assert!(
            ran.codes().contains(&"FC312") || ran.by == EndedBy::M30,
            "{text}: {ran:?}"
        );
    }
    let counted = run("$FOR V.S.A=17*10**307,18*10**307,10**307\nX1\n$ENDFOR\nM30");
    assert_eq!(counted.message("FC312"), "the result is not a number");
}

#[test]
fn a_region_in_a_loop_is_looked_through_once() {
    // R2.51, R2.60: values written in between are forgotten all the same.
    let body = "P5=1\nV.P.B=2\nX[COMP OFF FRICT]\n".repeat(50);
    let program = |passes: u32| {
        format!(
            "$FOR P1=1,{passes},1\nP5=3\nX[COMP ON FRICT]\n$IF V.E.X\n{body}$ENDIF\n$ENDFOR\nP6=P5\nM30"
        )
    };
    let (once, often) = (run(&program(1)), run(&program(1001)));
    let a_pass = (often.work - once.work) / 1000;
    assert!(a_pass < 400, "{a_pass}");
    assert_eq!(often.states[0], ("X".to_owned(), "unknown".to_owned()));
    let asks = format!(
        "{}$IF P5==3 $GOTO N99\nY[COMP OFF FRICT]\nN99: M30",
        program(3).replace("M30", "")
    );
    assert!(
        run(&asks).codes().contains(&"FC902"),
        "P5 is unknown after each pass"
    );
}

#[test]
fn a_computed_target_in_a_region_may_be_any() {
    // R2.51
    let text = "P3=1\nP4=1\nP2=3\n$WHILE V.E.X\nPP2=5\nP2=P2+1\n$ENDWHILE\n$IF P4==1 $GOTO N9\nX[COMP OFF FRICT]\nN9: M30";
    assert!(
        run(text).codes().contains(&"FC902"),
        "P4 may have been written"
    );
    let text = "V.P.A[1]=1\nV.P.A[2]=1\nP2=1\n$WHILE V.E.X\nV.P.A[P2]=5\nP2=P2+1\n$ENDWHILE\n$IF V.P.A[2]==1 $GOTO N9\nX[COMP OFF FRICT]\nN9: M30";
    assert!(
        run(text).codes().contains(&"FC902"),
        "V.P.A[2] may have been written"
    );
}

/// The output of a session: messages with the bytes of source that each holds, how often each
/// applied, and the counts by severity.
#[derive(Debug, Default)]
struct Heard {
    said: Vec<(String, String, usize)>,
    repeated: Vec<(String, u32, u64)>,
    opaque: Vec<(String, u64)>,
    errors: u64,
}

impl Sink for Heard {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        let hear = |said: &Diagnostic| {
            let held = said.place.text.len();
            (said.code.as_str().to_owned(), said.message.clone(), held)
        };
        match record {
            Record::Block(row) => self.said.extend(row.diagnostics.iter().map(hear)),
            Record::End(end) => {
                self.said
                    .extend(end.notes.iter().map(|note| hear(&note.diagnostic)));
                let repeated = end.repeated.iter();
                self.repeated
                    .extend(repeated.map(|it| (it.code.as_str().to_owned(), it.line, it.times)));
            }
            Record::Summary(summary) => {
                self.errors = summary.count(Severity::Error);
                self.opaque = summary.opaque.clone().into_iter().collect();
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

impl Heard {
    fn count(&self, code: &str) -> usize {
        self.said.iter().filter(|(said, ..)| said == code).count()
    }

    fn message(&self, code: &str) -> &str {
        let found = self.said.iter().find(|(said, ..)| said == code);
        found.map_or("", |(_, message, _)| message)
    }
}

fn heard(text: &str, stop: StopPolicy) -> Heard {
    let machine = Machine::from_toml(MACHINE).expect("the test's machine");
    let options = SessionOptions::from(
        Options::default()
            .with_stop(stop)
            .with_branches(Branches::Passed),
    );
    let mut session = Session::new(machine, options);
    let mut heard = Heard::default();
    let program = Program::Whole(SourceFile::new("a.nc", text));
    let _ = session.program("a.nc", program, &mut NoFiles, &mut heard);
    let _ = session.finish(&mut heard);
    heard
}

#[test]
fn a_message_in_a_loop_or_a_macro_is_said_once() {
    // R2.85
    let heard = heard(
        "\"A\"=\"P2=P7\"\n$FOR P1=1,500,1\nP2=P9\n\"A\"\nX[COMP ON FRICT]\n$IF V.E.X $GOTO N9\n$ENDFOR\nN9: M30",
        StopPolicy::KeepGoing,
    );
    assert_eq!(
        (
            heard.count("FC311"),
            heard.count("FC402"),
            heard.count("FC902")
        ),
        (2, 1, 1)
    );
    let counts: Vec<(&str, u32, u64)> = heard
        .repeated
        .iter()
        .map(|(code, line, times)| (code.as_str(), *line, *times))
        .collect();
    let expected = [
        ("FC311", 3, 500),
        ("FC311", 4, 500),
        ("FC402", 5, 499),
        ("FC902", 6, 500),
    ];
    assert_eq!(counts, expected);
    assert_eq!(heard.errors, 2);
}

#[test]
fn different_messages_at_one_place_are_each_said() {
    // R2.85
    let heard = heard(
        "$FOR P1=1,3,1\n$IF P1==1\nP2=1\n$ELSE\nP2=\"x\"\n$ENDIF\nP3=[P2+P9]*[P2+P8]\n$ENDFOR\nM30",
        StopPolicy::KeepGoing,
    );
    assert_eq!(
        heard.count("FC311") + heard.count("FC312"),
        heard.said.len()
    );
    assert!(
        heard
            .said
            .iter()
            .any(|(_, message, _)| message.contains("P9")),
        "{heard:?}"
    );
}

#[test]
fn a_file_says_ten_thousand_messages_and_counts_the_rest() {
    // R2.85
    let executed = (0..12_000)
        .map(|n| format!("P1=P{}\n", n + 10))
        .collect::<Vec<_>>()
        .concat();
    let heard_of = heard(&format!("{executed}M30"), StopPolicy::KeepGoing);
    assert_eq!(
        (heard_of.count("FC311"), heard_of.count("FC905")),
        (10_000, 1)
    );
    assert_eq!(heard_of.errors, 12_000);
    assert_eq!(
        heard_of.message("FC905"),
        "10000 messages about this file are shown; 2000 more messages, from here on, are only counted"
    );
    let never_run = (0..12_000)
        .map(|n| format!("X1 ?{n}\n"))
        .collect::<Vec<_>>()
        .concat();
    let heard_of = heard(&format!("M30\n{never_run}"), StopPolicy::CheckAll);
    assert_eq!((heard_of.said.len(), heard_of.errors), (10_001, 12_000));
    let labels = (0..12_000)
        .map(|n| format!("$GOTO N{n}\n"))
        .collect::<Vec<_>>()
        .concat();
    let heard_of = heard(&format!("{labels}M30"), StopPolicy::CheckAll);
    assert_eq!((heard_of.said.len(), heard_of.errors), (10_001, 12_000));
}

#[test]
fn messages_about_a_continued_block_hold_their_lines_only() {
    // R2.85
    let text = format!(
        "V.P.T[9] = [1,\\\n{}1]\nM30",
        "1,2,3,4,5,6,7,8,9,0,\\\n".repeat(1600)
    );
    let heard = heard(&text, StopPolicy::CheckAll);
    assert!(
        heard.said.len() > 1000 && heard.said.len() <= 2002,
        "{}",
        heard.said.len()
    );
    assert!(heard.count("FC905") > 0);
    assert!(heard.said.iter().all(|(.., held)| *held < 100));
}

#[test]
fn a_region_of_declarations_is_read_to_its_end() {
    // R2.60
    let values = |count: u32| -> String {
        let lines: Vec<String> = (0..count).map(|value| value.to_string()).collect();
        lines.join(",\\\n")
    };
    let text = format!(
        "#VAR\nV.P.T[20000] = [{}]\n#ENDVAR\nX=V.P.T[19999]\nM30",
        values(20_000)
    );
    let whole = heard(&text, StopPolicy::CheckAll);
    assert_eq!(whole.said, []);
    let text = format!(
        "#VAR\nV.P.T[200000] = [{}]\n#ENDVAR\nX1 P1=P2\nM30",
        values(200_000)
    );
    let beyond = heard(&text, StopPolicy::CheckAll);
    let codes: Vec<&str> = beyond.said.iter().map(|(code, ..)| code.as_str()).collect();
    assert_eq!(
        codes,
        ["FC206", "FC311"],
        "the blocks after the region are run"
    );
    let open = heard(
        &format!("#VAR\nV.P.T[3] = [{}]\nM30", values(3)),
        StopPolicy::CheckAll,
    );
    assert_eq!(open.count("FC208"), 1);
}

#[test]
fn words_that_were_passed_over_are_counted_together_beyond_a_thousand() {
    // R2.85
    let text = (0..1500)
        .map(|word| format!("Q{word}=1\n"))
        .collect::<Vec<_>>()
        .concat();
    let heard = heard(&format!("{text}M30"), StopPolicy::KeepGoing);
    assert_eq!(heard.opaque.len(), 1001);
    let others = heard.opaque.iter().find(|(word, _)| word == "other words");
    assert_eq!(others.map(|(_, times)| *times), Some(500));
}
