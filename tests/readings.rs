//! Both readings of the questions that the documents leave open, in the dry run.

use std::ops::ControlFlow;

use frictcomp::comp::{CncBuild, Kind, State};
use frictcomp::readings::{Basis, Question};
use frictcomp::session::{NoFiles, Program, SessionOptions};
use frictcomp::{Code, Machine, Record, Session, SourceFile};

const AXES: &str = "[[axis]]\nname = \"X\"\nnumber = 1\nenable = true\n\
    [[axis]]\nname = \"Y\"\nnumber = 2\nfrict_comp = false\n\
    [[axis]]\nname = \"Z\"\nnumber = 3\nfrict_comp = true\n";

/// The event between two programs.
#[derive(Clone, Copy, PartialEq)]
enum Between {
    Nothing,
    Reset,
    Restart,
}

/// The final state and the messages of a session.
struct Left {
    session: Session,
    codes: Vec<Code>,
}

impl Left {
    fn state(&self, axis: &str) -> State {
        let machine = self.session.state().machine;
        let axis = machine.find(axis).expect("an axis");
        self.session.state().state(axis, Kind::Frict)
    }
}

fn machine(reading: &str) -> Machine {
    let text = format!("{AXES}[reading]\n{reading}\n");
    Machine::from_toml(&text).expect("a configuration")
}

fn play(machine: Machine, programs: &[&str], between: Between) -> Left {
    let mut session = Session::new(machine, SessionOptions::default());
    let mut codes = Vec::new();
    for (at, text) in programs.iter().enumerate() {
        match between {
            Between::Reset if at > 0 => session.reset(),
            Between::Restart if at > 0 => session.restart(),
            _ => {}
        }
        let mut sink = |record: &Record<'_>| {
            match record {
                Record::Block(row) => codes.extend(row.diagnostics.iter().map(|it| it.code)),
                Record::End(end) => codes.extend(end.notes.iter().map(|it| it.diagnostic.code)),
                _ => {}
            }
            ControlFlow::Continue(())
        };
        let program = Program::Whole(SourceFile::new("a.nc", *text));
        let _ = session.program("a.nc", program, &mut NoFiles, &mut sink);
    }
    Left { session, codes }
}

fn one(reading: &str, program: &str) -> Left {
    play(machine(reading), &[program], Between::Nothing)
}

/// R1.28, R15.2: a reset keeps the state, or reverts it.
#[test]
fn a_reset_follows_its_reading() {
    let off = ["X[COMP OFF FRICT]\nM30"];
    let left = |reading| play(machine(reading), &[off[0], "M30"], Between::Reset).state("X");
    assert_eq!(left(""), State::Inactive);
    assert_eq!(left("\"R1.28\" = \"kept\""), State::Inactive);
    assert_eq!(left("\"R1.28\" = \"start-up\""), State::Active);
}

/// R1.28, R2.84: only a reset ends a loop without an end.
#[test]
fn an_endless_loop_ends_as_a_reset_does() {
    let endless = "X[COMP OFF FRICT]\n$WHILE 1\nG04 1\n$ENDWHILE\nM30";
    let kept = one("", endless);
    assert_eq!(kept.state("X"), State::Inactive);
    assert!(kept.codes.contains(&Code::Fc401));
    let back = one("\"R1.28\" = \"start-up\"", endless);
    assert_eq!(back.state("X"), State::Active);
    assert!(!back.codes.contains(&Code::Fc401), "{:?}", back.codes);
}

/// R1.29, R15.2: a restart sets the state by P-AXIS-00522, or keeps it; the first state is then unknown.
#[test]
fn a_restart_follows_its_reading() {
    let programs = ["X[COMP OFF FRICT]\nM30", "M30"];
    let left = |reading| play(machine(reading), &programs, Between::Restart).state("X");
    assert_eq!(left(""), State::Active);
    assert_eq!(left("\"R1.29\" = \"kept\""), State::Inactive);
    assert_eq!(
        one("\"R1.29\" = \"kept\"", "M30").state("X"),
        State::Unknown
    );
    assert_eq!(
        one("\"R1.29\" = \"start-up\"", "M30").state("X"),
        State::Active
    );
}

/// R1.8, R1.25, R1.26, R15.2: a command that the selected reading refuses stops the program.
#[test]
fn a_command_that_is_read_as_refused_stops_the_program() {
    let cases = [
        ("R1.8", "X[comp off frict]\nM30"),
        ("R1.25", "Y[COMP OFF FRICT]\nM30"),
        ("R1.25", "Y[COMP OFF_ALL]\nM30"),
        ("R1.26", "Z[COMP ON FRICT]\nM30"),
    ];
    for (rule, program) in cases {
        let taken = one("", program);
        assert!(!taken.session.is_stopped(), "{rule}: {:?}", taken.codes);
        let refused = one(&format!("\"{rule}\" = \"refused\""), program);
        assert!(refused.codes.contains(&Code::Fc306), "{rule}");
        assert!(refused.session.is_stopped(), "{rule}");
        assert_eq!(refused.state("X"), State::Active, "{rule}");
    }
    let upper = one("\"R1.8\" = \"refused\"", "X[COMP OFF FRICT]\nM30");
    assert_eq!(upper.state("X"), State::Inactive);
}

/// R1.31, R15.2: the last of two opposite commands wins, or the first.
#[test]
fn opposite_commands_follow_their_reading() {
    let both = "X[COMP OFF FRICT] X[COMP ON FRICT]\nM30";
    assert_eq!(one("", both).state("X"), State::Active);
    assert_eq!(
        one("\"R1.31\" = \"first\"", both).state("X"),
        State::Inactive
    );
    let all = "X[COMP ON FRICT] X[COMP OFF_ALL]\nM30";
    assert_eq!(one("", all).state("X"), State::Inactive);
    assert_eq!(one("\"R1.31\" = \"first\"", all).state("X"), State::Active);
}

/// R1.9, R1.36, R15.2: the motions that the monitor of P-AXIS-00465 checks.
#[test]
fn the_monitor_follows_its_readings() {
    let stops = |reading: &str, program: &str| {
        let axes = AXES.replace("number = 1\n", "number = 1\nrequired = [\"FRICT\"]\n");
        let text = format!("{axes}[reading]\n{reading}\n");
        let machine = Machine::from_toml(&text).expect("a configuration");
        let left = play(machine, &[program], Between::Nothing);
        left.codes.contains(&Code::PErr70435)
    };
    let shared = "G01 F1000 X[COMP OFF FRICT]\nX[COMP ON FRICT] X10\nM30";
    assert!(!stops("", shared));
    assert!(stops("\"R1.9\" = \"after\"", shared));
    let homing = "X[COMP OFF FRICT]\nG74 X1\nX[COMP ON FRICT]\nM30";
    assert!(!stops("", homing));
    assert!(stops("\"R1.36\" = \"monitored\"", homing));
}

/// R1.40, R15.2: a kind with manual activation at the start of the control.
#[test]
fn manual_activation_follows_its_reading() {
    let state = |reading: &str| {
        let text = format!(
            "[[axis]]\nname = \"X\"\ncompensations = [\"LEAD\"]\nmanual_activation = [\"LEAD\"]\n[reading]\n{reading}\n"
        );
        let machine = Machine::from_toml(&text).expect("a configuration");
        let axis = machine.find("X").expect("X");
        machine.compensation().state(axis, Kind::Lead)
    };
    assert_eq!(state(""), State::Inactive);
    assert_eq!(state("\"R1.40\" = \"on\""), State::Active);
}

/// R1.57, R15.2: a command that stops the path causes no jump.
#[test]
fn a_command_that_stops_the_path_makes_no_jump() {
    let program = "G90 G01 F1000 X0\nX10\nX[COMP OFF FRICT]\nX20\nX[COMP ON FRICT]\nM30";
    assert!(one("", program).codes.contains(&Code::Fc409));
    let stops = one("\"R1.57\" = \"stops\"", program);
    assert!(!stops.codes.contains(&Code::Fc409));
}

/// R2.70, R15.2: an axis that comes back from an exchange.
#[test]
fn an_exchanged_axis_follows_its_reading() {
    let program = "X[COMP OFF FRICT]\n#PUT AX [X]\n#CALL AX [X, 1, 0]\nM30";
    assert_eq!(one("", program).state("X"), State::Inactive);
    assert_eq!(
        one("\"R2.70\" = \"start-up\"", program).state("X"),
        State::Active
    );
    let asked_twice = "X[COMP OFF FRICT]\n#CALL AX [X, 1, 0]\nM30";
    assert_eq!(
        one("\"R2.70\" = \"start-up\"", asked_twice).state("X"),
        State::Inactive
    );
}

/// R2.92, R15.2: a write to the machine data leaves the state open, reverts it, or keeps it.
#[test]
fn machine_data_follow_their_reading() {
    let program = "X[COMP OFF FRICT]\n#MACHINE DATA [AX=X P-AXIS-00522=1]\nM30";
    assert_eq!(one("", program).state("X"), State::Unknown);
    assert_eq!(
        one("\"R2.92\" = \"start-up\"", program).state("X"),
        State::Active
    );
    assert_eq!(
        one("\"R2.92\" = \"kept\"", program).state("X"),
        State::Inactive
    );
    let away = "X[COMP OFF FRICT]\n#MACHINE DATA [AX=X P-AXIS-00522=0]\nM30";
    assert_eq!(one("\"R2.92\" = \"kept\"", away).state("X"), State::Unknown);
}

/// R2.90, R15.2: levels that are read at the start are the same in the whole run.
#[test]
fn skip_levels_follow_their_reading() {
    let program = "/2 X[COMP OFF FRICT]\nG04 1\n/2 X[COMP ON FRICT]\nM30";
    let open = one("", program);
    assert_eq!(open.state("X"), State::Unknown);
    assert_eq!(
        one("\"R2.90\" = \"at-start\"", program).state("X"),
        State::Active
    );
}

/// R2.96: the dry run begins at the first block; the effect of a block search is one of the questions.
#[test]
fn block_search_is_a_question() {
    let facts = Question::BlockSearch.facts();
    assert_eq!((facts.rule, facts.assumed_name()), ("R2.96", "unknown"));
}

/// R15.2: an unknown rule or reading in the configuration is reported with its place.
#[test]
fn a_configuration_with_an_unknown_question_is_refused() {
    let refused = |text: &str| {
        let error = Machine::from_toml(text).expect_err("refused");
        let said = error.diagnostic;
        (said.message.clone(), said.help().join("; "))
    };
    let (message, help) = refused("[reading]\n\"R1.99\" = \"kept\"\n");
    assert_eq!(message, "no open question belongs to `R1.99`");
    assert!(help.contains("R1.28"), "{help}");
    let (message, help) = refused("[reading]\nR1.28 = \"kept\"\n");
    assert_eq!(message, "the rule `R1.28` has no quotes");
    assert!(help.contains("write `\"R1.28\" ="), "{help}");
    let (message, help) = refused("[reading]\n\"R1.28\" = \"keept\"\n");
    assert_eq!(message, "`keept` is not a reading of R1.28");
    assert!(help.contains("did you mean `kept`"), "{help}");
    let (message, _) = refused("[confirmed]\n\"R1.28\" = { build = \"3.1.3081.5\" }\n");
    assert_eq!(message, "`date` is missing");
    let (message, _) =
        refused("[confirmed]\n\"R1.28\" = { build = \"new\", date = \"2026-01-31\" }\n");
    assert!(message.contains("is not a CNC build"), "{message}");
}

/// R15.2: `[confirmed]` applies to its build.
#[test]
fn a_confirmation_is_read() {
    let text = "[reading]\n\"R1.28\" = \"start-up\"\n[confirmed]\n\
        \"R1.28\" = { build = \"V3.1.3081.5\", date = \"2026-01-31\" }\n";
    let readings = Machine::from_toml(text).expect("a configuration").readings;
    let build: CncBuild = "3.1.3081.5".parse().expect("a build");
    let standing = readings.basis(Question::Reset, Some(build));
    assert!(matches!(standing, Basis::Confirmed(it) if it.date == "2026-01-31"));
    assert_eq!(readings.basis(Question::Reset, None), Basis::Selected);
    assert_eq!(readings.basis(Question::Restart, None), Basis::Assumed);
}
