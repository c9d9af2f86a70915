//! Questions to the control, and the agreed behaviour as data.

mod basis;
mod control;
mod machine;
mod notes;
mod pages;
mod recorded;

use std::fmt::Write as _;
use std::fs;

use crate::folder::{Bench, json, one_line};
use crate::workspace::root;
use control::Control;
use frictcomp::readings::{Question, Way};
use frictcomp_host::conformance::{Case, find_cases};

const MACHINE: &str = "[machine]\ncnc_build = \"3.1.3081.5\"\n\n[[axis]]\nname = \"X\"\nnumber = 1\n\
    enable = true\n";

fn bench() -> Bench {
    let bench = Bench::new(&[]);
    bench.write("frictcomp.toml", MACHINE);
    bench
}

/// Returns the programs of a question, in their order.
fn programs(bench: &Bench, rule: &str) -> Vec<String> {
    let names = [
        format!("ask/ask-{rule}.nc"),
        format!("ask/ask-{rule}-1.nc"),
        format!("ask/ask-{rule}-2.nc"),
    ];
    let there = names
        .iter()
        .filter(|name| bench.folder().join(name).exists());
    there.map(|name| bench.read(name)).collect()
}

/// Returns the answers of a control that follows a reading, with the notes of its operator.
fn answered(bench: &Bench, rule: &'static str, second: bool) -> String {
    let mut control = Control::new(rule, second);
    for (at, program) in programs(bench, rule).iter().enumerate() {
        match rule {
            "R1.28" if at > 0 => control.reset(),
            "R1.29" if at > 0 => control.restart(),
            _ => {}
        }
        let search = (rule == "R2.96").then_some("200");
        let stopped = control.start(program, search);
        let begin = control
            .messages
            .lines()
            .next()
            .unwrap_or_default()
            .to_owned();
        if let Some(number) = stopped {
            let note = begin.replace("begin", &format!("error {number}"));
            writeln!(control.messages, "{note}").expect("text");
        }
        if search.is_some() {
            let note = begin.replace("begin", "searched 1");
            writeln!(control.messages, "{note}").expect("text");
        }
    }
    control.messages
}

/// R15.1, R15.2, R15.4: each question that a program answers is put to a control of either kind, and
/// the answer is that of the control.
#[test]
fn a_control_of_either_kind_is_read_rightly() {
    let asked = Question::ALL.into_iter();
    let asked = asked.filter(|question| question.facts().way == Way::Program);
    for question in asked {
        let facts = question.facts();
        for (second, name) in facts.readings.into_iter().enumerate() {
            let bench = bench();
            assert_eq!(
                bench.status(&["ask", "write", "--axis", "X", "--into", "ask"]),
                Some(0)
            );
            let messages = answered(&bench, facts.rule, second == 1);
            bench.write("message.txt", &messages);
            let said = bench.stdout(&["ask", "read", "message.txt"]);
            assert!(said.starts_with("1 question answered\n"), "{said}");
            let head = said.lines().nth(2).unwrap_or_default().to_owned();
            assert!(
                head.starts_with(facts.rule) && head.ends_with(&format!(": {name}")),
                "{} {name}: {said}\n{messages}",
                facts.rule
            );
            let written = bench.read("frictcomp.toml");
            assert!(written.starts_with(MACHINE), "{written}");
            let line = format!("\"{}\" = \"{name}\"", facts.rule);
            assert!(written.contains(&line), "{written}");
            let readings = frictcomp::machine::Machine::from_toml(&written)
                .expect("TOML")
                .readings;
            let confirmed = readings.confirmation(question).expect("a confirmation");
            assert_eq!(Ok(confirmed.build), "3.1.3081.5".parse());
            assert!(confirmed.date.starts_with("20"), "{}", confirmed.date);
            assert_eq!(bench.status(&["config", "show"]), Some(0));
        }
    }
}

/// R15.1, R15.2: what an operator sees is a line in a note.
#[test]
fn a_note_answers_what_no_program_does() {
    let bench = bench();
    bench.stdout(&["ask", "write", "--into", "ask"]);
    let readme = bench.read("ask/README.txt");
    for question in Question::ALL {
        let facts = question.facts();
        if facts.way == Way::Program {
            continue;
        }
        let line = |name: &str| {
            let mut lines = readme.lines().map(str::trim);
            let begin = format!("frictcomp-ask {} ", facts.rule);
            let end = format!(" reading {name}");
            let found = lines.find(|line| line.starts_with(&begin) && line.ends_with(&end));
            found
                .unwrap_or_else(|| panic!("{} {name}", facts.rule))
                .to_owned()
        };
        for name in facts.readings {
            bench.write("note.txt", &line(name));
            let said = bench.stdout(&["ask", "read", "note.txt"]);
            assert!(said.contains(&format!(": {name}\n")), "{said}");
        }
    }
}

/// R15.1, R15.4: the programs pass the check, and move no farther than they say.
#[test]
fn the_programs_pass_the_check_under_either_reading() {
    let bench = bench();
    bench.stdout(&["ask", "write", "--travel", "4", "--into", "ask"]);
    // That the axis is not configured is what this one requires.
    fs::remove_file(bench.folder().join("ask/ask-R1.25.nc")).expect("removed");
    let output = bench.call(&["check", "ask"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    for question in Question::ALL {
        let facts = question.facts();
        let second = format!(
            "{MACHINE}[reading]\n\"{}\" = \"{}\"\n",
            facts.rule, facts.readings[1]
        );
        bench.write("frictcomp.toml", &second);
        let is_said = matches!(
            question,
            Question::LowerCase
                | Question::RemedyClass
                | Question::ContinueInSwitch
                | Question::Undeclared
                | Question::JumpInto
                | Question::Described
                | Question::ProgramNumber
        );
        let wanted = i32::from(is_said);
        assert_eq!(
            bench.status(&["check", "ask"]),
            Some(wanted),
            "{}",
            facts.rule
        );
        let (mut at, mut farthest) = (0.0_f64, 0.0_f64);
        for program in programs(&bench, facts.rule) {
            let code = program.lines().filter(|line| !line.starts_with(';'));
            for word in code.flat_map(str::split_whitespace) {
                if let Some(by) = word.strip_prefix('X').and_then(|it| it.parse::<f64>().ok()) {
                    at += by;
                    farthest = farthest.max(at);
                    assert!(at > -1e-9, "{}", facts.rule);
                }
            }
            let says_nothing = program.contains("; Moves: nothing\n");
            assert_eq!(says_nothing, farthest == 0.0, "{}", facts.rule);
        }
        assert!(
            at.abs() < 1e-9 && farthest <= 4.0,
            "{}: {farthest}",
            facts.rule
        );
    }
}

/// R15.2: nothing is concluded from answers that cannot carry it.
#[test]
fn what_cannot_be_told_is_not_decided() {
    let bench = bench();
    bench.stdout(&["ask", "write", "--into", "ask"]);
    let messages = answered(&bench, "R1.28", true);
    let cases = [
        (
            messages.replace("start 1", "start 0"),
            "was not active before",
        ),
        (messages.replace("off 0", "off 1"), "had no effect"),
        (
            messages.replace(" answer 1", " nothing 1"),
            "there is no line with `answer`",
        ),
        (
            messages.replace("frictcomp-ask R1.28 ", "frictcomp-ask R1.28 0"),
            "have the fingerprint",
        ),
    ];
    for (text, reason) in cases {
        bench.write("message.txt", &text);
        let said = bench.stdout(&["ask", "read", "message.txt"]);
        assert!(
            said.starts_with("no question answered, 1 left open\n\nR1.28 not decidable\n"),
            "{said}"
        );
        let joined = one_line(&said);
        assert!(joined.contains(reason), "{said}");
        assert_eq!(bench.read("frictcomp.toml"), MACHINE);
    }
    let refused = answered(&bench, "R1.26", true).replace("error 70998", "error 70495");
    bench.write("message.txt", &refused);
    let said = bench.stdout(&["ask", "read", "message.txt"]);
    assert!(said.contains("\n\nR1.26 not decidable\n"), "{said}");
    bench.write("message.txt", "12:00 nothing of ours\n");
    let output = bench.call(&["ask", "read", "message.txt"]);
    assert_eq!(output.status.code(), Some(2));
}

/// R15.2: an answer without a build selects a reading and confirms nothing; files that contradict each
/// other are refused.
#[test]
fn an_answer_without_a_build_confirms_nothing() {
    let bench = bench();
    let unbuilt = MACHINE.replace("[machine]\ncnc_build = \"3.1.3081.5\"\n\n", "");
    bench.write("frictcomp.toml", &unbuilt);
    bench.stdout(&["ask", "write", "--into", "ask"]);
    bench.write("first.txt", &answered(&bench, "R1.28", true));
    bench.write("other.txt", &answered(&bench, "R1.28", false));
    let output = bench.call(&["ask", "read", "first.txt", "other.txt"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(bench.read("frictcomp.toml"), unbuilt);
    assert_eq!(bench.status(&["ask", "read", "first.txt"]), Some(0));
    let written = bench.read("frictcomp.toml");
    assert!(written.contains("\"R1.28\" = \"start-up\""), "{written}");
    assert!(!written.contains("[confirmed]"), "{written}");
}

/// R15.3: a report gives for an assumption the selected reading, and the build on which it was confirmed.
#[test]
fn a_report_says_what_was_confirmed() {
    let bench = bench();
    let confirmed = "[reading]\n\"R1.29\" = \"start-up\"\n[confirmed]\n\
        \"R1.29\" = { build = \"3.1.3081.5\", date = \"2026-01-31\" }\n";
    bench.write("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
    bench.stdout(&["run", "--html", "plain.html", "a.nc"]);
    assert!(!bench.read("plain.html").contains("confirmed on"));
    bench.write("frictcomp.toml", &format!("{MACHINE}{confirmed}"));
    bench.stdout(&["run", "--html", "report.html", "a.nc"]);
    let report = bench.read("report.html");
    assert!(
        report.contains("confirmed on") && report.contains("2026-01-31"),
        "{report}"
    );
    let other = format!("{MACHINE}{confirmed}").replacen("3081.5", "3132.0", 1);
    bench.write("frictcomp.toml", &other);
    bench.stdout(&["run", "--html", "other.html", "a.nc"]);
    assert!(
        bench
            .read("other.html")
            .contains("not confirmed on this build")
    );
}

/// R15.2, R4.2, R4.6: the additive current follows the configuration, and an option takes precedence over it.
#[test]
fn the_current_follows_the_selected_readings() {
    let bench = bench();
    let machine = "[[axis]]\nname = \"X\"\nfrict_comp = true\n[axis.value]\nmode = 3\n\
        reversal_lookahead = 4\ntable = [[0, 100]]\n";
    let readings = "[reading]\n\"R4.6\" = \"zero\"\n\"R4.2\" = \"step\"\n";
    bench.write("a.nc", "N10 G90 G01 F600 X0\nN20 X1\nN30 X0\nN40 M30\n");
    let said = |arguments: &[&str]| {
        let all = ["current", "-v", "a.nc", "--axis", "X", "--start", "X0"];
        let output = bench.call(&[&all, arguments].concat());
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{text}");
        let weights = String::from_utf8(output.stdout).expect("text");
        let weights = weights
            .lines()
            .skip(1)
            .filter_map(|row| row.split(',').nth(3));
        let between = weights.filter(|it| *it != "0" && *it != "1").count();
        (text, between)
    };
    bench.write("frictcomp.toml", machine);
    let (text, between) = said(&[]);
    assert!(
        text.contains("reading: standstill=hold,below=hold"),
        "{text}"
    );
    assert_eq!(between, 3);
    bench.write("frictcomp.toml", &format!("{readings}{machine}"));
    let (text, between) = said(&[]);
    assert!(
        text.contains("standstill=zero") && text.contains("decay=step"),
        "{text}"
    );
    assert_eq!(between, 0);
    let (text, between) = said(&["--reading", "standstill=hold,decay=linear"]);
    assert!(
        text.contains("standstill=hold") && !text.contains("decay"),
        "{text}"
    );
    assert_eq!(between, 3);
}

/// R15.1, R15.3: the list shows each question, both readings, and what the one in force rests on.
#[test]
fn the_list_says_what_is_answered() {
    let bench = bench();
    let document = json(&bench.stdout(&["ask", "list", "--format", "json"]));
    assert_eq!(document["schema"], 1);
    let questions = document["questions"].as_array().expect("questions");
    assert_eq!(questions.len(), Question::ALL.len());
    let reset = questions
        .iter()
        .find(|it| it["rule"] == "R1.28")
        .expect("R1.28");
    assert_eq!(reset["readings"], serde_json::json!(["kept", "start-up"]));
    assert_eq!(reset["assumed"], "kept");
    assert_eq!(
        (&reset["confirmed"], &reset["way"]),
        (&serde_json::Value::Null, &"program".into())
    );
    let confirmed = "[reading]\n\"R1.28\" = \"start-up\"\n[confirmed]\n\
        \"R1.28\" = { build = \"3.1.3081.5\", date = \"2026-01-31\" }\n";
    bench.write("frictcomp.toml", &format!("{MACHINE}{confirmed}"));
    let text = bench.stdout(&["ask", "list"]);
    assert!(text.contains("reading: start-up, confirmed on"), "{text}");
    let text = bench.stdout(&["ask", "list", "--cnc-build", "3.1.3132.0"]);
    assert!(
        text.contains("reading: start-up, selected, not confirmed"),
        "{text}"
    );
    assert!(text.contains("open, taken as unknown"), "{text}");
}

fn cases() -> Vec<Case> {
    let files = find_cases(&root().join("conformance")).expect("cases");
    let read = |file: &std::path::PathBuf| Case::read(file).unwrap_or_else(|it| panic!("{it}"));
    files.iter().map(read).collect()
}

/// R15.11: cases become programs for a control, and its answers are compared.
#[test]
fn answers_of_a_control_are_compared() {
    let bench = bench();
    let folder = root().join("conformance");
    let folder = folder.to_str().expect("text");
    assert_eq!(
        bench.status(&["conformance", folder, "--into", "cases"]),
        Some(0)
    );
    let program = bench.read("cases/1/reset/next.nc");
    assert!(
        program.contains("#MSG SAVE EXCLUSIVE [\"frictcomp 1/reset next.nc 1 X FRICT %d\""),
        "{program}"
    );
    let at_end = bench.read("cases/1/off/after-main.nc");
    assert!(at_end.contains("1/off main.nc end X FRICT %d"), "{at_end}");
    let compare = |answers: &str| {
        bench.write("cases/message.txt", answers);
        let output = bench.call(&[
            "conformance",
            folder,
            "--compare",
            "cases",
            "--format",
            "json",
        ]);
        let status = output.status.code();
        (
            status,
            json(&String::from_utf8(output.stdout).expect("text")),
        )
    };
    let (status, document) = compare(
        "frictcomp 1/off main.nc 1 X FRICT 0\nfrictcomp 1/reset next.nc 1 X FRICT 1\n\
         frictcomp 1/on-not-configured refused 70495\n",
    );
    assert_eq!(status, Some(0), "{document}");
    assert_eq!(document["held"], 3);
    let reading = serde_json::json!([{ "rule": "R1.28", "reading": "start-up" }]);
    assert_eq!(document["readings"], reading);
    let (status, document) = compare("frictcomp 1/off main.nc 1 X FRICT 1\n");
    assert_eq!(status, Some(1));
    assert_eq!(document["failed"][0]["found"], "active");
    let (status, document) = compare("frictcomp 1/on-not-configured refused 12345\n");
    assert_eq!(status, Some(1));
    assert_eq!(document["failed"][0]["found"], "12345");
    let asked = bench.read("cases/4/cycles-decay-two/case.txt");
    let line = "frictcomp 4/cycles-decay-two currents X CURRENT CURRENT";
    assert!(asked.contains(line), "{asked}");
    assert!(!asked.contains("message.txt"), "{asked}");
    assert!(asked.contains("no dead band"), "{asked}");
    let computed = bench.stdout(&[
        "current",
        "--recording",
        "cases/4/cycles-decay-two/cycles-X.csv",
        "--value-list",
        "cases/4/cycles-decay-two/values-X.lis",
        "--dead-band",
        "0",
        "--reading",
        "decay=step",
    ]);
    let currents = computed
        .lines()
        .skip(1)
        .filter_map(|row| row.split(',').nth(5));
    let currents: Vec<&str> = currents.collect();
    let (status, document) = compare(&format!(
        "frictcomp 4/cycles-decay-two currents X {}\nfrictcomp 4/at-a-point current X 1000 50.0\n",
        currents.join(" ")
    ));
    assert_eq!(status, Some(0), "{document}");
    let reading = serde_json::json!([{ "rule": "R4.2", "reading": "step" }]);
    assert_eq!(
        (&document["readings"], &document["held"]),
        (&reading, &2.into())
    );
    let (status, document) = compare("frictcomp 4/at-a-point current X 1000 50.1\n");
    assert_eq!(status, Some(1));
    assert_eq!(document["failed"][0]["found"], "50.1 drive units");
    let (status, document) =
        compare("frictcomp 4/cycles-direction currents X 100 -100 100 100 -100\n");
    assert_eq!(status, Some(1));
    assert_eq!(document["failed"][0]["found"], "100 drive units in cycle 3");
}
