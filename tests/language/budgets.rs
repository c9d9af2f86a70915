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
    ran(
        text,
        Options::default().with_branches(Branches::OneFollowed),
    )
}

fn going_on() -> Options {
    Options::default()
        .with_stop(StopPolicy::KeepGoing)
        .with_branches(Branches::OneFollowed)
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
fn macros_that_use_each_other_on_some_ways_end_the_run() {
    // R2.60
    let uses = |name: &str| format!("\\\"{name}\\\" ").repeat(4);
    let text = format!(
        "\"A\"=\"{}\"\n\"B\"=\"{} X[COMP OFF FRICT]\"\n$IF V.E.X\n\"A\"\n$ENDIF\nM30",
        uses("B"),
        uses("A")
    );
    let ran = run(&text);
    assert_eq!(ran.by, EndedBy::Budget);
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
fn a_branch_in_a_loop_costs_its_text() {
    // R14.3, R2.60: values written in between are unknown all the same.
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
        run(&asks).codes().contains(&"FC901"),
        "P5 is unknown after each pass"
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
            .with_branches(Branches::OneFollowed),
    );
    let mut session = Session::new(machine, options);
    let mut heard = Heard::default();
    let program = Program::Whole(SourceFile::new("a.nc", text));
    let _ = session.program("a.nc", program, &mut NoFiles, &mut heard);
    let _ = session.finish(&mut heard);
    heard
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
