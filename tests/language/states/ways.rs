//! The ways in messages: those to which they apply (R14.5), and whether only a value that changes in between
//! leads to them (R14.1).

use std::fmt::Write as _;
use std::ops::ControlFlow;

use frictcomp::comp::{Kind, State};
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::session::Program;
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};

use crate::support::{Bench, MACHINE};

#[derive(Default)]
struct Messages(Vec<Diagnostic>);

impl Sink for Messages {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => self.0.extend(row.diagnostics.iter().cloned()),
            Record::End(end) => {
                let notes = end.notes.iter();
                self.0.extend(notes.map(|note| note.diagnostic.clone()));
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

/// Returns the messages of programs that run one after another, `warning FC401 2 …`.
fn said(bench: &Bench, programs: &[&str]) -> String {
    let mut session = bench.session();
    let files = bench.files.clone();
    let mut find = move |name: &str, _: &str| {
        let text = files.get(name)?;
        Some(SourceFile::new(name, text.as_str()))
    };
    let mut messages = Messages::default();
    for (name, program) in ["a.nc", "b.nc"].into_iter().zip(programs) {
        let source = Program::Whole(SourceFile::new(name, *program));
        let _ = session.program(name, source, &mut find, &mut messages);
    }
    let mut text = String::new();
    for said in messages.0 {
        let (severity, code, line) = (said.severity, said.code, said.place.start().line);
        writeln!(text, "{severity} {code} {line} {}", said.message).expect("text");
    }
    text
}

fn of_code(said: &str, code: Code) -> Vec<&str> {
    let word = format!(" {code} ");
    said.lines().filter(|line| line.contains(&word)).collect()
}

#[test]
fn a_possible_state_stays_in_the_set_and_in_what_the_next_program_finds() {
    // R14.1 R14.7
    let program =
        "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.E.A == 1\nX[COMP ON FRICT]\n$ENDIF\nM30";
    let bench = Bench::new();
    let mut session = bench.session();
    let source = Program::Whole(SourceFile::new("a.nc", program));
    let _ = session.program(
        "a.nc",
        source,
        &mut |_: &str, _: &str| None,
        &mut Messages::default(),
    );
    let possible = session.interpreter().possible();
    assert_eq!(
        possible[0].in_words("a.nc"),
        "inactive only if V.E.A changes between lines 1 and 4, else active"
    );
    assert!(possible[0].has(State::Inactive) && possible[0].needs_change(State::Inactive));
    assert_eq!(
        serde_json::to_value(&possible[0]).expect("data")[0]["ways"][0][1],
        serde_json::json!({
            "kind": "condition", "file": "a.nc", "line": 4, "text": "V.E.A == 1", "holds": false,
            "changed": { "name": "V.E.A", "file": "a.nc", "line": 1 },
        })
    );
    let next = said(&bench, &[program, "G01 X1 F100\nM30"]);
    let moved =
        "moves with friction compensation inactive only if V.E.A changes between a.nc:1 and a.nc:4";
    assert!(next.contains(moved), "{next}");
}

#[test]
fn no_setting_raises_what_needs_a_change_and_errors_stay_errors() {
    // R14.1 R14.5 R9.28
    let program =
        "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.E.A == 1\nX[COMP ON FRICT]\n$ENDIF\nM30";
    let mut bench = Bench::new();
    bench.options.levels.set(Code::Fc401, Some(Severity::Error));
    let left = said(&bench, &[program]);
    assert!(of_code(&left, Code::Fc401)[0].starts_with("info"), "{left}");
    let nested = "$IF V.E.A < 1\n$IF NOT [V.E.A < 1]\nZ[COMP ON FRICT]\n$ENDIF\n$ENDIF\nM30";
    let refused = said(&Bench::new(), &[nested]);
    let refused = of_code(&refused, Code::PErr70495)[0];
    assert!(refused.starts_with("error"), "{refused}");
}

#[test]
fn a_case_says_what_a_value_is_only_where_it_is_asked_for_by_itself() {
    // R14.1: P1 is not 3 where P1 + 1 is.
    let program = "P1 = V.E.A\n$SWITCH P1 + 1\n$CASE 3\n$IF P1 == 3\nX[COMP OFF FRICT]\n$ENDIF\n$BREAK\n$ENDSWITCH\nM30";
    let mut session = Bench::new().session();
    let source = Program::Whole(SourceFile::new("a.nc", program));
    let _ = session.program(
        "a.nc",
        source,
        &mut |_: &str, _: &str| None,
        &mut Messages::default(),
    );
    let x = session.interpreter().machine().find("X").expect("X");
    let state = session.interpreter().compensation().state(x, Kind::Frict);
    assert_eq!(state, State::Unknown);
}

#[test]
fn a_state_on_too_many_ways_is_named_without_them() {
    // R14.2
    let mut program = String::new();
    for number in 0..60 {
        let word = ["ON", "OFF"][number % 2];
        let _ = writeln!(
            program,
            "$IF V.E.A{number} == 1\nX[COMP {word} FRICT]\n$ENDIF"
        );
    }
    program.push_str("M30\n");
    let mut session = Bench::on(MACHINE).session();
    let source = Program::Whole(SourceFile::new("a.nc", program.as_str()));
    let nothing = &mut |_: &str, _: &str| None;
    let _ = session.program("a.nc", source, nothing, &mut Messages::default());
    let [x] = session.interpreter().possible() else {
        panic!("X is unknown");
    };
    assert_eq!(
        x.in_words("a.nc"),
        "inactive or active, on more ways than can be named"
    );
}

/// Returns a machine that alone has the programs `*.ecy`.
fn with_external() -> Bench {
    Bench::on(&format!("[machine]\nexternal = [\"*.ecy\"]\n{MACHINE}"))
}

#[test]
fn what_a_program_of_the_machine_leaves_is_a_way() {
    // R14.1 R14.2 R2.83
    let mut session = with_external().session();
    let program = "X[COMP OFF FRICT]\nL probe.ecy\n$IF V.A.FRICT_COMP_ACTIVE.Y == 0\nY[COMP ON FRICT]\n$ENDIF\nM30";
    let source = Program::Whole(SourceFile::new("a.nc", program));
    let nothing = &mut |_: &str, _: &str| None;
    let _ = session.program("a.nc", source, nothing, &mut Messages::default());
    let run = session.interpreter();
    let [x, _of_b] = run.possible() else {
        panic!("Y is repaired: {:?}", run.possible());
    };
    assert_eq!(
        x.in_words("a.nc"),
        "inactive if `probe.ecy` leaves X off (line 2), else active"
    );
    assert_eq!(
        serde_json::to_value(x).expect("data")[0]["ways"][0][0],
        serde_json::json!({
            "kind": "call", "file": "a.nc", "line": 2, "text": "probe.ecy",
            "axis": "X", "compensation": "FRICT", "on": false,
        })
    );
}
