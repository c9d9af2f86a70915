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

/// The messages of programs that run one after another, `warning FC401 2 …`.
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

/// Two commands under conditions, and the FC401 of the axis.
fn left_by(between: &str, [first, second]: [&str; 2]) -> String {
    let off = format!("$IF {first}\nX[COMP OFF FRICT]\n$ENDIF\n");
    let on = format!("$IF {second}\nX[COMP ON FRICT]\n$ENDIF\n");
    let program = format!("{off}{between}{on}M30\n");
    let said = said(&Bench::new(), &[&program]);
    of_code(&said, Code::Fc401).join("\n")
}

#[test]
fn a_way_that_contradicts_itself_is_possible_only_if_a_value_changes() {
    // R14.1
    for (first, second) in [
        ("V.E.A == 1", "V.E.A == 1"),
        ("V.E.A == 1", "NOT [V.E.A != 1]"),
        ("V.E.A == 1", "V.E.A != 2"),
        ("V.E.A < 3", "v.e.A < 3"),
        ("V.E.A == 1 && V.E.B > 2", "V.E.A == 1"),
    ] {
        let left = left_by("X5\nM8\n", [first, second]);
        let when = "after program end only if V.E.A changes between lines 1 and 6;";
        let is_info = left.starts_with("info FC401 2 ") && left.contains(when);
        assert!(is_info, "{first}, {second}: {left}");
    }
}

#[test]
fn a_way_that_some_value_gives_stays_a_warning() {
    // R14.1
    for (between, first, second) in [
        ("", "V.E.A == 1", "V.E.B == 1"),
        ("", "V.E.A == 1", "V.E.A == 2"),
        ("", "V.E.A < 3", "V.E.A < 2"),
        ("", "V.E.A == 1", "V.E.A == 1 && V.E.B == 2"),
        // The program, or a command that may wait, gives another value.
        ("V.E.A = V.E.C\n", "V.E.A == 1", "V.E.A == 1"),
        ("#WAIT FOR [V.E.A == 0]\n", "V.E.A == 1", "V.E.A == 1"),
        (
            "$WHILE V.E.A == 1\nG4 1\n$ENDWHILE\n",
            "V.E.A == 1",
            "V.E.A == 1",
        ),
        // The actions of the control change the values that it is asked for.
        ("G01 X5 F100\n", "V.G.TX == 1", "V.G.TX == 1"),
    ] {
        let left = left_by(between, [first, second]);
        let is_plain = left.starts_with("warning FC401 2 ") && !left.contains("only if");
        assert!(is_plain, "{between}{first}, {second}: {left}");
    }
}

#[test]
fn a_stable_value_and_a_given_one_leave_no_such_way() {
    // R14.1 R14.7
    let program =
        "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n$IF V.E.A == 1\nX[COMP ON FRICT]\n$ENDIF\nM30";
    let stable = Bench::on(&format!("{MACHINE}\n[variables]\nstable = [\"V.E.A\"]\n"));
    for bench in [
        stable,
        Bench::new().set("V.E.A", 1.0),
        Bench::new().set("V.E.A", 2.0),
    ] {
        let said = said(&bench, &[program]);
        assert!(of_code(&said, Code::Fc401).is_empty(), "{said}");
    }
}

#[test]
fn skip_levels_and_cases_contradict_each_other_as_well() {
    // R14.1
    let skips = "/1 X[COMP OFF FRICT]\n/1 X[COMP ON FRICT]\nM30";
    let skips_apart = "/1 X[COMP OFF FRICT]\nG01 X5 F100\n/1 X[COMP ON FRICT]\nM30";
    let cases = "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ELSEIF V.E.A == 2\nX[COMP OFF FRICT]\n$ENDIF\n\
                 $SWITCH V.E.A\n$CASE 1\nX[COMP ON FRICT]\n$BREAK\n$CASE 2\nX[COMP ON FRICT]\n$ENDSWITCH\nM30";
    for (program, says) in [
        (skips, None),
        (
            skips_apart,
            Some("only if skip level 1 changes between lines 1 and 3;"),
        ),
        (
            cases,
            Some(
                "only if V.E.A changes between lines 1 and 6, or if V.E.A changes between lines 3 and 6;",
            ),
        ),
    ] {
        let said = said(&Bench::new(), &[program]);
        let left = of_code(&said, Code::Fc401);
        let Some(says) = says else {
            assert!(left.is_empty(), "{said}");
            continue;
        };
        assert!(
            left.len() == 1 && left[0].starts_with("info") && left[0].contains(says),
            "{said}"
        );
    }
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

/// The block of a message with a code, and the text before it on all ways.
const IN_A_BRANCH: [(Code, &str, &str); 22] = [
    (Code::PErr21301, "", "X[COMPP ON FRICT]"),
    (
        Code::PErr21403,
        "#AX LINK [1, X = Y]\n#AX LINK ON [1]\n",
        "X[COMP OFF FRICT]",
    ),
    (Code::PErr70495, "", "Z[COMP ON FRICT]"),
    (Code::Fc201, "", "X[COMP ON]"),
    (Code::Fc202, "", "X[COMP ON FRIC]"),
    (Code::Fc203, "", "X[COMP OFF_ALL FRICT]"),
    (Code::Fc204, "", "X[COMP ON OFF FRICT]"),
    (Code::Fc205, "", "X[COMP ON FRICT"),
    (Code::Fc207, "", "X5 = = 7"),
    (Code::Fc301, "", "X[COMP ON FRICT] X[COMP OFF FRICT]"),
    (Code::Fc302, "", "S[COMP ON FRICT]"),
    (Code::Fc303, "", "B[COMP ON FRICT]"),
    (Code::Fc311, "", "V.P.Q = P99"),
    (Code::Fc312, "", "P1 = 1 / 0"),
    (Code::Fc313, "", "G00 G01 X5"),
    (Code::Fc316, "G17 G01 X0 Y0 F100\n", "G02 X0 Y0 R5"),
    (Code::Fc320, "", "L missing.nc"),
    (Code::Fc402, "X[COMP OFF FRICT]\n", "X[COMP OFF FRICT]"),
    (Code::Fc405, "", "X[COMP OFF FRICT] G01 X5 F100"),
    (Code::Fc409, "", "G01 X0 F100\nX5\nX[COMP OFF FRICT]\nX9"),
    (Code::Fc902, "", "L V.E.NAME"),
    (Code::Fc901, "", "$IF V.E.B == 1\nY[COMP OFF FRICT]\n$ENDIF"),
];

#[test]
fn a_message_in_a_branch_says_on_which_ways_and_one_outside_does_not() {
    // R14.5
    for (code, before, block) in IN_A_BRANCH {
        let line = before.lines().count() + 1;
        let branch = format!("{before}$IF V.E.A == 1\n{block}\n$ENDIF\nM30\n");
        let inside = said(&Bench::new(), &[&branch]);
        let says = format!(", if V.E.A == 1 (line {line})");
        let all = of_code(&inside, code);
        let of_block = all.iter().filter(|said| !said.contains("`V.E.A`, which"));
        let of_block: Vec<_> = of_block.collect();
        let is_said = !of_block.is_empty() && of_block.iter().all(|said| said.ends_with(&says));
        assert!(is_said, "{code}: {inside}");
        assert!(
            of_block
                .iter()
                .all(|said| said.matches(" if V.E.A").count() == 1),
            "{inside}"
        );
        let outside = said(&Bench::new(), &[&format!("{before}{block}\nM30\n")]);
        let all = of_code(&outside, code);
        assert!(
            !all.is_empty() && all.iter().all(|said| !said.contains(", if ")),
            "{code}: {outside}"
        );
    }
}

#[test]
fn what_is_wrong_with_a_text_is_so_on_every_way() {
    // R14.5
    for (code, block) in [
        (Code::Fc210, "G987"),
        (Code::Fc404, "X[comp off FRICT]"),
        (Code::Fc406, "X[COMP OFF FRICT FRICT]"),
        (Code::Fc490, "X5 ; frictcomp: allow FC402"),
    ] {
        let said = said(
            &Bench::new(),
            &[&format!("$IF V.E.A == 1\n{block}\n$ENDIF\nM30\n")],
        );
        let all = of_code(&said, code);
        assert!(
            !all.is_empty() && all.iter().all(|it| !it.contains("if V.E.A")),
            "{code}: {said}"
        );
    }
}

#[test]
fn a_second_run_that_differs_on_some_ways_says_on_which() {
    // R14.5 R1.53
    let mover = |before: &str, after: &str| {
        format!("{before}G01 X1 F100\n{after}X[COMP OFF FRICT]\nG01 X2\nM30\n")
    };
    let on_some = said(&Bench::new(), &[&mover("$IF V.E.A == 1\n", "$ENDIF\n")]);
    let found = of_code(&on_some, Code::Fc407);
    assert!(
        found[0].ends_with("leaves it inactive, if V.E.A == 1 (line 1)"),
        "{on_some}"
    );
    let on_all = said(
        &Bench::new(),
        &[&mover("$IF V.E.A == 1\n", "$ELSE\nG01 X3 F100\n$ENDIF\n")],
    );
    let found = of_code(&on_all, Code::Fc407);
    assert!(found[0].ends_with("leaves it inactive"), "{on_all}");
}

#[test]
fn a_command_repeats_none_of_another_way() {
    // R1.51 R14.5
    let branches = "$IF V.E.A == 1\nX[COMP ON FRICT]\n$ELSE\nX[COMP ON FRICT]\n$ENDIF\nM30";
    let nested =
        "$IF V.E.A == 1\nX[COMP ON FRICT]\n$IF V.E.B == 1\nX[COMP ON FRICT]\n$ENDIF\n$ENDIF\nM30";
    let counts = [branches, nested].map(|program| {
        let said = said(&Bench::new(), &[program]);
        of_code(&said, Code::Fc402).len()
    });
    assert_eq!(counts, [0, 1]);
}

#[test]
fn cases_that_leave_the_same_say_nothing() {
    // R14.1 R2.95
    let switch = "$SWITCH V.E.A\n$CASE 1\nG01 X1 F100\n$BREAK\n$CASE 2\nG01 X1 F100\n$BREAK\n$ENDSWITCH\nM30";
    let said = said(&Bench::new(), &[switch]);
    assert!(of_code(&said, Code::Fc901).is_empty(), "{said}");
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

/// A machine that alone has the programs `*.ecy`.
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

#[test]
fn what_a_call_leaves_is_said_once_and_what_it_may_not_touch_besides() {
    // R14.5 R2.83 R1.50
    let always = said(&with_external(), &["X[COMP OFF FRICT]\nL probe.ecy\nM30"]);
    assert!(of_code(&always, Code::Fc401).is_empty(), "{always}");
    assert_eq!(of_code(&always, Code::Fc902).len(), 1, "{always}");
    let on_some = said(
        &with_external(),
        &["X[COMP OFF FRICT]\n$IF V.E.A == 1\nL probe.ecy\n$ENDIF\nM30"],
    );
    let left = of_code(&on_some, Code::Fc401);
    let when = "if not V.E.A == 1 (line 2), or if `probe.ecy` leaves X off (line 3);";
    assert!(left.len() == 1 && left[0].contains(when), "{on_some}");
}

#[test]
fn a_motion_that_needs_its_compensation_ends_the_ways_without_it() {
    // R14.5 R1.36
    let required = "[[axis]]\nname = \"X\"\nfrict_comp = true\nrequired = [\"FRICT\"]\n\
                    value = { mode = 3, table = [[0, 1]] }\n";
    let bench = Bench::on(required);
    let before = "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\n";
    let on_some = said(&bench, &[&format!("{before}G01 X5 F100\nM30")]);
    let refused = of_code(&on_some, Code::PErr70435);
    let when = "which P-AXIS-00465 requires, if V.E.A == 1 (line 1)";
    assert!(
        refused.len() == 1 && refused[0].ends_with(when),
        "{on_some}"
    );
    assert!(refused[0].starts_with("error"), "{on_some}");
    // R18.10: the way has ended, with the state that it has.
    let left = of_code(&on_some, Code::Fc401);
    let when = "is left inactive after the error in line 4 if V.E.A == 1 (line 1)";
    assert!(left.len() == 1 && left[0].contains(when), "{on_some}");
    let on_all = said(&bench, &["X[COMP OFF FRICT]\nG01 X5 F100\nM30"]);
    let refused = of_code(&on_all, Code::PErr70435);
    assert!(refused[0].ends_with("requires"), "{on_all}");
}

#[test]
fn a_program_end_that_is_missing_on_some_ways_says_on_which() {
    // R14.5 R2.8
    let ends = said(
        &Bench::new(),
        &["G00 X1\n$IF V.E.A == 1\nM30\n$ENDIF\nG00 X2\n"],
    );
    let missing = of_code(&ends, Code::Fc310);
    assert!(
        missing.len() == 1 && missing[0].ends_with(", if not V.E.A == 1 (line 2)"),
        "{ends}"
    );
}

#[test]
fn the_switch_of_a_level_that_is_read_once_has_one_answer_on_all_ways() {
    // R14.1 R2.90
    let program = "$IF V.E.A == 1\n/X[COMP OFF FRICT]\n$ELSE\n/X[COMP OFF FRICT]\n$ENDIF\n/X[COMP ON FRICT]\nM30";
    let said = said(&Bench::new(), &[program]);
    assert!(of_code(&said, Code::Fc401).is_empty(), "{said}");
}
