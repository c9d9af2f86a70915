//! Budgets that users can wait for (R9.91): repetitions by loops and calls are charged with their cost.

use std::ops::ControlFlow;

use frictcomp::diagnostic::{Code, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::interpreter::{Limits, NoFiles, Options, StopPolicy};
use frictcomp::machine::Machine;
use frictcomp::session::{Findings, Program, Session, SessionOptions};
use frictcomp::text::SourceFile;

/// The result of a check.
struct Checked {
    by: EndedBy,
    blocks: u64,
    said: Vec<(Code, Severity)>,
}

fn session(limits: Limits, stop: StopPolicy) -> Session {
    let options = Options::default().with_stop(stop).with_limits(limits);
    Session::new(Machine::enabled(["X", "Y"]), SessionOptions::from(options))
}

fn run_in(mut session: Session, text: &str) -> Checked {
    let mut findings = Findings::default();
    let source = SourceFile::new("a.nc", text);
    let program = Program::Whole(source);
    let flow = session.program("a.nc", program, &mut NoFiles, &mut findings);
    let ControlFlow::Continue(by) = flow else {
        panic!("no sink stops it");
    };
    let said = findings.diagnostics();
    Checked {
        by,
        blocks: session.interpreter().blocks(),
        said: said.map(|said| (said.code, said.severity)).collect(),
    }
}

fn checked(text: &str, limits: Limits) -> Checked {
    run_in(session(limits, StopPolicy::CheckAll), text)
}

/// A loop that counts and may end.
const COUNTER: &str =
    "P1=0\n$WHILE 1\nP1=P1+1\n$IF P1<0\nP2=P1\n$ENDIF\n$ENDWHILE\nX[COMP OFF FRICT]\nM30";

#[test]
fn what_is_executed_once_is_never_cut_off() {
    // R9.91
    let none = Limits::default().with_repeats(0);
    let text = format!(
        "{}$IF 1\nX1\n$ENDIF\nM30",
        "X1 Y[COMP ON FRICT]\n".repeat(5000)
    );
    assert_eq!(checked(&text, none).by, EndedBy::M30);
    assert_eq!(checked(COUNTER, none).by, EndedBy::Budget);
}

#[test]
fn a_loop_of_three_million_blocks_is_run_to_its_end() {
    // R9.91: a hundredth of the budget within a hundredth of the bound.
    let limits = Limits::brief();
    let limits = limits.with_repeats(limits.repeats / 100);
    let text = "$FOR P1=1,10000,1\nG1 X1 Y2 F100\nX2 Y[COMP ON FRICT]\n$ENDFOR\nM30";
    let ran = checked(text, limits);
    assert_eq!((ran.by, ran.blocks), (EndedBy::M30, 30_002));
}

#[test]
fn a_program_that_may_end_is_an_error_where_a_budget_ends_it() {
    // R9.91 R2.84
    for limits in [
        Limits::default().with_blocks(5000),
        Limits::default().with_repeats(500_000),
    ] {
        let ran = checked(COUNTER, limits);
        assert_eq!(ran.by, EndedBy::Budget);
        assert!(
            ran.said.contains(&(Code::Fc910, Severity::Error)),
            "{:?}",
            ran.said
        );
        let endless = checked("$WHILE 1\nX1\n$ENDWHILE\nM30", limits);
        assert!(
            endless.said.contains(&(Code::Fc910, Severity::Warning)),
            "{:?}",
            endless.said
        );
    }
}

#[test]
fn what_was_not_looked_at_cannot_be_silenced() {
    // R9.91
    let limits = Limits::default().with_repeats(500_000);
    let text = COUNTER.replace('\n', " ; frictcomp: allow FC910\n");
    let mut options = SessionOptions::from(Options::default().with_limits(limits));
    options.levels.set(Code::Fc910, None);
    let session = Session::new(Machine::enabled(["X", "Y"]), options);
    let said = run_in(session, &text).said;
    assert!(said.contains(&(Code::Fc910, Severity::Error)), "{said:?}");
}

#[test]
fn the_first_call_that_is_nested_too_deeply_ends_the_run() {
    // R9.91
    let text = "%L B\nLL B\nLL B\nM17\n%MAIN\nLL B\nM30";
    let ran = checked(text, Limits::brief());
    assert_eq!(ran.by, EndedBy::Budget);
    assert!(ran.blocks < 100, "{}", ran.blocks);
    let deep = |ran: &Checked| {
        ran.said
            .iter()
            .filter(|(code, _)| *code == Code::Fc911)
            .count()
    };
    assert_eq!(deep(&ran), 1);
    let limits = Limits::default().with_blocks(5000);
    let on = run_in(session(limits, StopPolicy::KeepGoing), text);
    assert_eq!(on.blocks, 5000);
}

/// Lines of a program, numbered from 0.
fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(|number| line(number) + "\n").collect()
}

/// Returns a program of control blocks inside each other.
fn nest(count: usize, open: impl Fn(usize) -> String, inner: &str, close: &str) -> String {
    let opened = lines(count, open);
    format!("{opened}{inner}\n{}M30", format!("{close}\n").repeat(count))
}

/// Returns a program of local subprograms, each of which calls the next one.
fn calls(count: usize, call: impl Fn(usize) -> String) -> String {
    let programs = lines(count, |n| format!("%L S{n}\n{}\nM17", call(n)));
    format!("{programs}%L S{count}\nX[COMP OFF FRICT]\nM17\n%MAIN\nLL S0\nM30")
}

fn while_q(_: usize) -> String {
    "$WHILE V.E.Q".to_owned()
}

/// Programs whose ways multiply, small as they are.
fn many_ways() -> Vec<(&'static str, String)> {
    [nested_ways(), called_ways(), jumping_ways()].concat()
}

/// Returns programs of nested loops.
fn nested_ways() -> Vec<(&'static str, String)> {
    vec![
        ("ten loops", nest(10, while_q, "X1", "$ENDWHILE")),
        ("a hundred loops", nest(100, while_q, "X1", "$ENDWHILE")),
        (
            "loops with conditions",
            nest(
                12,
                |n| format!("$FOR P{n}=0,V.E.N1,1\n$IF V.E.A{n}"),
                "X[COMP OFF FRICT]",
                "$ENDIF\n$ENDFOR",
            ),
        ),
        (
            "one counter",
            nest(
                12,
                |n| format!("$FOR P1=0,V.E.N1,1\n$IF V.E.A{n}\nX[COMP OFF FRICT]\n$ENDIF"),
                "Y[COMP OFF FRICT]",
                "$ENDFOR",
            ),
        ),
        (
            "repeated until",
            nest(
                15,
                |n| format!("$REPEAT\n$IF V.E.B{n}\nP{n}=P{n}+1\n$ENDIF"),
                "X1",
                "$UNTIL V.E.Q",
            ),
        ),
        (
            "done while",
            nest(
                15,
                |n| format!("$DO\n/{} Y[COMP OFF FRICT]", n % 10 + 1),
                "X1",
                "$ENDDO V.E.Q",
            ),
        ),
        (
            "counted loops with conditions",
            nest(
                6,
                |n| {
                    format!(
                        "$FOR P{n}=1,30,1\n$IF V.E.A{n} == P{n}\nX[COMP OFF FRICT]\n$ELSE\nX[COMP ON FRICT]\n$ENDIF"
                    )
                },
                "X1",
                "$ENDFOR",
            ),
        ),
    ]
}

/// Programs called on several ways.
fn called_ways() -> Vec<(&'static str, String)> {
    vec![
        (
            "calls on both sides",
            calls(40, |n| {
                format!("$IF V.E.A{n}\nLL S{0}\n$ELSE\nLL S{0}\n$ENDIF", n + 1)
            }),
        ),
        (
            "calls in loops",
            calls(20, |n| format!("$WHILE V.E.A{n}\nLL S{}\n$ENDWHILE", n + 1)),
        ),
        (
            "calls in cases",
            calls(30, |n| {
                let case = format!("LL S{}\n$BREAK", n + 1);
                format!(
                    "$SWITCH V.E.A{n}\n$CASE 1\n{case}\n$CASE 2\n{case}\n$DEFAULT\n{case}\n$ENDSWITCH"
                )
            }),
        ),
        (
            "macros that call",
            "\"A\"=\"LL S\"\n".to_owned()
                + &nest(9, while_q, "\"A\"\n\"A\"", "$ENDWHILE").replace(
                    "M30",
                    "M30\n%L S\n$IF V.E.A\nX[COMP OFF FRICT]\n$ENDIF\nM17",
                ),
        ),
    ]
}

/// Jumps, skip levels and ends on several ways.
fn jumping_ways() -> Vec<(&'static str, String)> {
    vec![
        (
            "jumps back",
            lines(60, |n| format!("N{n} X[COMP OFF FRICT]"))
                + &lines(60, |n| format!("$IF V.E.A{n} $GOTO N{n}"))
                + "M30",
        ),
        (
            "jumps forward",
            lines(2000, |n| format!("$IF V.E.A{n} $GOTO N9000\nX{n}"))
                + "N9000 X[COMP OFF FRICT]\nM30",
        ),
        (
            "skip levels in loops",
            nest(
                10,
                while_q,
                &lines(10, |n| format!("/{} P{n}=P{n}+1 X1", n + 1)),
                "$ENDWHILE",
            ),
        ),
        (
            "ends in loops",
            nest(
                10,
                |n| format!("$FOR P{n}=0,50,1\n$IF V.E.A{n}\nM30\n$ENDIF"),
                "X1",
                "$ENDFOR",
            ),
        ),
    ]
}

#[test]
fn ways_that_multiply_are_widened() {
    // R9.91, R14.4: a tenth of the budget.
    let limits = Limits::brief().with_work(1_000_000);
    for (what, text) in many_ways() {
        let ran = checked(&text, limits.with_nesting(200));
        assert_ne!(ran.by, EndedBy::Budget, "{what}: {:?}", ran.said);
        let errors = ran.said.iter().filter(|(code, _)| code.is_budget());
        assert_eq!(errors.count(), 0, "{what}: {:?}", ran.said);
        assert!(ran.blocks < 40_000, "{what}: {}", ran.blocks);
        let warned = ran.said.contains(&(Code::Fc908, Severity::Warning));
        assert!(warned || ran.blocks < 15_000, "{what}: {}", ran.blocks);
    }
}

/// Programs that keep running, whatever they repeat.
#[cfg(unix)]
mod measured {
    use std::time::Duration;

    use super::*;
    use crate::measure::of_thread;

    /// The most by which one takes longer than a plain loop with as many units.
    const DEARER: f64 = 5.0;

    /// A small part of the units granted if no user is waiting.
    const UNITS: u64 = 6_000_000;

    fn looped(body: &str) -> String {
        format!("$FOR P1=1,99999999,1\n{body}\n$ENDFOR\nM30")
    }

    fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
        (0..count).map(|number| line(number) + "\n").collect()
    }

    fn programs() -> Vec<(&'static str, String)> {
        let calls = "%L S\nX1\nM17\n%MAIN\n".to_owned();
        let cases = lines(300, |n| format!("$CASE -{n}\nX1\n$BREAK"));
        let branches = lines(300, |n| format!("$ELSEIF P1==-{n}\nX1"));
        let groups = lines(150, |n| {
            format!("#SET AX LINK [{n}, Y=X]\n#ENABLE AX LINK [{n}]")
        });
        vec![
            ("a counter", COUNTER.to_owned()),
            (
                "loops in loops",
                format!(
                    "{}X1\n{}M30",
                    lines(9, |n| format!("$FOR P{n}=1,9,1")),
                    "$ENDFOR\n".repeat(9)
                ),
            ),
            ("calls", calls + &looped("LL S")),
            (
                "calls that call",
                format!(
                    "{}%L S19\nX1\nM17\n%MAIN\nLL S0\nM30",
                    lines(19, |n| format!("%L S{n}\nLL S{0}\nLL S{0}\nM17", n + 1))
                ),
            ),
            (
                "long expressions",
                looped(&format!("P2=1{}", "+P1*2".repeat(600))),
            ),
            (
                "long blocks",
                looped(&format!("X1 {}", "F100 ".repeat(700))),
            ),
            (
                "commands",
                looped("X[COMP OFF FRICT]\nX1\nX[COMP ON FRICT]"),
            ),
            ("commands that are not known", looped("X[COMP OFF FRIKT]")),
            (
                "words that are not understood",
                looped(&format!("X1{}", " ?1".repeat(900))),
            ),
            ("unknown values", looped("P2=P9+V.P.Z")),
            ("macros", format!("\"A\"=\"P2=P1+1\"\n{}", looped("\"A\""))),
            (
                "strings",
                format!(
                    "P2=\"{}b\"\n{}",
                    "a".repeat(300),
                    looped("P4=FIND[P2,\"ab\"]")
                ),
            ),
            (
                "unknown regions",
                looped(&format!("$IF V.E.X\n{}$ENDIF", "X1 P3=1\n".repeat(300))),
            ),
            ("cases", looped(&format!("$SWITCH P1\n{cases}$ENDSWITCH"))),
            ("branches", looped(&format!("$IF P1==-1\n{branches}$ENDIF"))),
            ("calls of nothing", looped("L foo.nc\nLL T")),
            ("variables", looped("V.P.A=P1\nV.P.B=V.P.A*2")),
            ("couplings", groups + &looped("X1\n#ENABLE AX LINK [V.E.X]")),
            (
                "exchanged axes",
                looped(&lines(300, |n| format!("#CALL AX [X{n}, {n}, {n}]"))),
            ),
            ("comments", looped(&format!("X1 ({})", "c".repeat(3900)))),
            (
                "allow comments",
                looped("X[COMP ON FRICT] ; frictcomp: allow FC402"),
            ),
            ("arcs", looped("G2 X10 Y10 I5 J5 F100")),
        ]
    }

    /// Returns the processor time of a check, and whether a budget ended it.
    fn taken(text: &str, limits: Limits) -> (Duration, EndedBy) {
        let before = of_thread();
        let by = checked(text, limits).by;
        (of_thread().saturating_sub(before), by)
    }

    #[test]
    #[allow(clippy::print_stdout, reason = "the table is shown with `--nocapture`")]
    fn a_unit_of_ways_takes_no_longer() {
        // R9.91
        let plain = looped("G1 X1 Y2 F100\nX2 Y3\nX3 Y4\nX1 Y2");
        let limits = Limits::default().with_nesting(200);
        let mut dear = Vec::new();
        for (what, text) in many_ways() {
            let mut least = f64::MAX;
            for _ in 0..6 {
                let (plain, _) = taken(&plain, Limits::default().with_repeats(3 * UNITS));
                let (took, _) = taken(&text, limits.with_ways(3 * UNITS).with_repeats(3 * UNITS));
                least = least.min(took.div_duration_f64(plain));
                if least <= DEARER {
                    break;
                }
            }
            println!("{what:<30} {least:.2}");
            if least > DEARER {
                dear.push(format!("{what}: {least:.1}"));
            }
        }
        assert!(dear.is_empty(), "{dear:?}");
    }

    #[test]
    #[allow(clippy::print_stdout, reason = "the table is shown with `--nocapture`")]
    fn a_unit_takes_about_the_same_whatever_is_repeated() {
        // R9.91
        let plain = looped("G1 X1 Y2 F100\nX2 Y3\nX3 Y4\nX1 Y2");
        let mut dear = Vec::new();
        for (what, text) in programs() {
            let mut least = f64::MAX;
            for _ in 0..6 {
                let limits = Limits::default().with_repeats(UNITS);
                let (plain, _) = taken(&plain, limits);
                let (took, by) = taken(&text, limits);
                assert_eq!(by, EndedBy::Budget, "{what}");
                least = least.min(took.div_duration_f64(plain));
                if least <= DEARER {
                    break;
                }
            }
            println!("{what:<30} {least:.2}");
            if least > DEARER {
                dear.push(format!("{what}: {least:.1}"));
            }
        }
        assert!(dear.is_empty(), "{dear:?}");
    }
}
