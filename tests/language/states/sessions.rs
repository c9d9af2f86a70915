//! Random sessions: the lints against the model, one session against several with a state file.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use frictcomp::comp::KindSet;
use frictcomp::interpreter::{NoFiles, Options, StopPolicy};
use frictcomp::machine::Machine;
use frictcomp::session::{Program as Text, SavedState, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};
use frictcomp_report::{Ndjson, Report, View};
use frictcomp_testing::generator::Choices;

use super::model::{Model, Said};
use super::program::{AXES, Program, machine};

const LINTS: [&str; 4] = ["FC401", "FC402", "FC403", "FC407"];

pub(crate) fn options() -> SessionOptions {
    SessionOptions::from(Options::default().with_stop(StopPolicy::KeepGoing))
}

/// Keeps the lints.
#[derive(Default)]
struct Lints {
    program: usize,
    said: Vec<Said>,
}

impl Lints {
    fn add(&mut self, seq: u64, diagnostic: &frictcomp::diagnostic::Diagnostic) {
        let code = diagnostic.code.as_str();
        if let Some(code) = LINTS.into_iter().find(|lint| *lint == code) {
            let axis = diagnostic.axis.as_deref().expect("an axis");
            let axis = AXES.iter().copied().find(|name| *name == axis);
            let line = diagnostic.place.start().line;
            self.said
                .push((self.program, seq, line, code, axis.expect("known")));
        }
    }
}

impl Sink for Lints {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Program { .. } => self.program += 1,
            Record::Block(row) => row
                .diagnostics
                .iter()
                .for_each(|said| self.add(row.seq, said)),
            Record::End(end) => {
                let notes = end.notes.iter();
                notes.for_each(|note| self.add(note.seq, &note.diagnostic));
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

pub(crate) fn play(session: &mut Session, (name, text): (&str, &str), sink: &mut dyn Sink) {
    let source = SourceFile::new(name, text.to_owned());
    let _ = session.program(name, Text::Whole(source), &mut NoFiles, sink);
}

#[test]
fn random_sessions_say_what_the_rules_say() {
    // R1.50 R1.51 R1.52 R1.53 R9.24
    let mut choices = Choices::of_seed(11);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for round in 0..1500 {
        let programs: Vec<Program> = (0..3).map(|_| Program::random(&mut choices)).collect();
        let mut session = Session::new(machine(), options());
        let (mut lints, mut model) = (Lints::default(), Model::new());
        for program in &programs {
            play(&mut session, ("a.nc", &program.text), &mut lints);
            model.run(program);
        }
        let mut expected = model.said;
        // Within a block the tool sorts by column.
        expected.sort_unstable();
        lints.said.sort_unstable();
        let texts: Vec<&str> = programs
            .iter()
            .map(|program| program.text.as_str())
            .collect();
        assert_eq!(
            lints.said,
            expected,
            "round {round}\n{}",
            texts.join("---\n")
        );
        for said in &expected {
            *counts.entry(said.3).or_default() += 1;
        }
    }
    for lint in LINTS {
        assert!(
            counts.get(lint).is_some_and(|count| *count > 250),
            "{counts:?}"
        );
    }
}

/// Returns the records of the last program as bytes, without its number.
fn last_records(session: &mut Session, program: (&str, &str)) -> String {
    let mut bytes = Vec::new();
    let view = View::default().with_kinds(KindSet::ALL);
    let mut report = Ndjson::new(&mut bytes, view);
    play(session, program, &mut report);
    report.finish().expect("written");
    drop(report);
    let text = String::from_utf8(bytes).expect("text");
    (1..4).fold(text, |text, number| {
        text.replace(&format!("\"program\":{number},"), "")
    })
}

/// Continues where a session ended, through the text of a state file.
pub(crate) fn resumed(machine: Machine, session: &Session) -> Session {
    let text = serde_json::to_string_pretty(&session.save()).expect("JSON");
    let saved: SavedState = serde_json::from_str(&text).expect("a state");
    let (session, said) = Session::resume(machine, options(), saved).expect("the same machine");
    assert!(said.is_empty());
    session
}

/// Statements whose effect outlives a program.
const OUTLIVING: [&str; 12] = [
    "V.S.A = V.S.A + 1",
    "V.S.T = \"part\"",
    "V.S.U = V.E.UNKNOWN",
    "V.E.OUT = 7",
    "#VAR\nV.S.F[3]\n#ENDVAR",
    "V.S.F[1] = 5",
    "X=V.S.F[2] Y=V.S.F[1]",
    "\"OFF\" = \"Y[COMP OFF FRICT]\"",
    "\"OFF\"",
    "$IF V.E.UNKNOWN\nB[COMP OFF FRICT]\n$ENDIF",
    "$IF V.E.OUT == 7\nX[COMP OFF FRICT]\n$ENDIF",
    "$IF V.S.A > 1\nY[COMP OFF_ALL]\n$ENDIF",
];

#[test]
fn a_state_file_carries_a_session_on_to_the_byte() {
    // R9.32 R1.52 R14.7
    let mut choices = Choices::of_seed(12);
    let (mut depends, mut unknown) = (0, 0);
    for round in 0..400 {
        let mut texts: Vec<String> = Vec::new();
        for _ in 0..3 {
            let mut text = Program::random(&mut choices).text;
            for _ in 0..choices.below(4) {
                let at = text.rfind("M30").expect("an end");
                let line = choices.one_of(&OUTLIVING);
                text.insert_str(at, &format!("{line}\n"));
            }
            texts.push(text);
        }
        let mut together = Session::new(machine(), options());
        let mut apart = Session::new(machine(), options());
        for (name, text) in ["a.nc", "b.nc", "c.nc"].iter().zip(&texts) {
            let expected = last_records(&mut together, (name, text));
            let found = last_records(&mut apart, (name, text));
            for (found, expected) in found.lines().zip(expected.lines()) {
                let texts = texts.join("---\n");
                assert_eq!(found, expected, "round {round}, {name}\n{texts}");
            }
            assert_eq!(found.len(), expected.len());
            depends += expected.matches("FC403").count();
            unknown += usize::from(expected.contains("unknown"));
            apart = resumed(machine(), &apart);
        }
    }
    assert!(depends > 100 && unknown > 100, "{depends} {unknown}");
}

#[test]
fn the_recommended_style_is_silent_in_every_order() {
    // R1.50 R1.51 R1.52 R1.53: required states are set first, and states away from start-up are restored.
    let mut choices = Choices::of_seed(13);
    let mut style = || {
        let (mut first, mut last) = (String::from("%PART\n"), String::new());
        for axis in ["X", "Y", "B"] {
            match choices.below(3) {
                0 => first.extend([axis, "[COMP ON FRICT]\n"]),
                1 => {
                    first.extend([axis, "[COMP OFF FRICT]\n"]);
                    last.extend([axis, "[COMP ON FRICT]\n"]);
                }
                _ => {}
            }
        }
        format!("{first}G01 F1000 X1 Y1 B1 Z1\n{last}M30\n")
    };
    for _ in 0..300 {
        let mut session = Session::new(machine(), SessionOptions::default());
        let mut lints = Lints::default();
        for _ in 0..4 {
            play(&mut session, ("a.nc", &style()), &mut lints);
        }
        assert!(lints.said.is_empty(), "{:?}", lints.said);
    }
}
