//! Export of cases as programs for a control, which leaves its answers in a file (R15.11).

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use super::case::{Case, Expectation, Moment, is_between};
use super::run::{configuration, current_of};
use frictcomp::comp::Kind;
use frictcomp::lists::{ListHead, Points, write_value_list};

/// A file of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Exported {
    /// Path below the export folder.
    pub path: PathBuf,
    /// Text.
    pub text: String,
}

/// The word with which each answer begins.
pub(super) const TAG: &str = "frictcomp";

/// Returns the programs, lists and instructions of a case.
pub fn export(case: &Case) -> Vec<Exported> {
    let folder = PathBuf::from(&case.name);
    let mut files: Vec<Exported> = case
        .files
        .iter()
        .map(|file| Exported {
            path: folder.join(&file.name),
            text: with_answers(case, &file.name, &file.text),
        })
        .collect();
    for program in programs(case).filter(|program| asks_at_end(case, program)) {
        files.push(Exported {
            path: folder.join(end_program(program)),
            text: answers(case, program, &Moment::End) + "M30\n",
        });
    }
    files.extend(
        inputs_of_currents(case)
            .into_iter()
            .map(|(name, text)| Exported {
                path: folder.join(name),
                text,
            }),
    );
    files.push(Exported {
        path: folder.join("case.txt"),
        text: instructions(case),
    });
    files
}

/// Returns every expectation, under any reading.
fn expectations(case: &Case) -> impl Iterator<Item = &Expectation> {
    let under = case.readings.iter().flat_map(|(_, expected)| expected);
    case.expected.iter().chain(under)
}

/// Returns the value list of each axis whose currents are expected, and its commanded cycles, by file name.
fn inputs_of_currents(case: &Case) -> BTreeMap<String, String> {
    let machine = configuration(case).map(|it| it.machine);
    let mut files = BTreeMap::new();
    for it in expectations(case) {
        let axis = match it {
            Expectation::Current { axis, .. } => axis,
            Expectation::Currents(cycles) => {
                files.insert(format!("cycles-{}.csv", cycles.axis), cycles.table());
                &cycles.axis
            }
            _ => continue,
        };
        let current = machine.as_ref().ok().and_then(|it| current_of(it, axis));
        if let Some((_, list)) = current {
            let head = ListHead {
                name: Some(axis),
                ..ListHead::default()
            };
            let text = write_value_list(list, Points::Real, &head);
            files.insert(format!("values-{axis}.lis"), text);
        }
    }
    files
}

/// Returns the lines that answer expected currents.
fn asked_currents(case: &Case) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for it in expectations(case) {
        let asked = match it {
            Expectation::Current { axis, velocity, .. } => {
                format!("current {axis} {velocity} CURRENT")
            }
            Expectation::Currents(cycles) => format!("currents {} CURRENT CURRENT …", cycles.axis),
            _ => continue,
        };
        let line = format!("{TAG} {} {asked}", case.name);
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines
}

fn programs(case: &Case) -> impl Iterator<Item = &String> {
    let mut seen = Vec::new();
    let programs = case.run.iter().filter(|step| !is_between(step));
    programs.filter(move |program| {
        let is_new = !seen.contains(program);
        seen.push(program);
        is_new
    })
}

/// Returns all states that a case asks for, under any reading.
fn asked(case: &Case) -> impl Iterator<Item = (&String, &Moment, &String, Kind)> {
    expectations(case).filter_map(|it| match it {
        Expectation::State {
            program,
            after,
            axis,
            kind,
            ..
        } => Some((program, after, axis, *kind)),
        _ => None,
    })
}

fn asks_at_end(case: &Case, program: &str) -> bool {
    asked(case).any(|(of, after, ..)| of == program && *after == Moment::End)
}

/// Returns the name of the program that answers the queries after the end of another one.
fn end_program(program: &str) -> String {
    format!("after-{program}")
}

/// Returns the blocks that record the states at a moment. The first read waits until all blocks before it are
/// executed; the text is written when its block is decoded.
fn answers(case: &Case, program: &str, moment: &Moment) -> String {
    let mut text = String::new();
    let mut done: Vec<(&String, Kind)> = Vec::new();
    for (of, after, axis, kind) in asked(case) {
        if of != program || after != moment || done.contains(&(axis, kind)) {
            continue;
        }
        done.push((axis, kind));
        let variable = format!("V.A.{kind}_COMP_ACTIVE.{axis}");
        let name = &case.name;
        let _ = writeln!(text, "P99 = {variable}");
        let _ = writeln!(
            text,
            "#MSG SAVE EXCLUSIVE [\"{TAG} {name} {program} {moment} {axis} {kind} %d\", {variable}]"
        );
    }
    text
}

/// Returns a program with the blocks that leave its answers.
fn with_answers(case: &Case, program: &str, text: &str) -> String {
    let mut made = String::new();
    let mut begun = 1;
    for (at, line) in (1_u32..).zip(text.lines()) {
        made.push_str(line);
        made.push('\n');
        let code = line.split(';').next().unwrap_or_default().trim_end();
        if !code.ends_with('\\') {
            made.push_str(&answers(case, program, &Moment::Line(begun)));
            begun = at + 1;
        }
    }
    made
}

fn instructions(case: &Case) -> String {
    let mut text = format!("{}: {}\n{}\n", case.name, case.rule, case.about);
    match &case.source {
        Some(source) => {
            let _ = writeln!(text, "Source: {source}");
        }
        None => text.push_str("No document states this.\n"),
    }
    let _ = writeln!(
        text,
        "\nThe machine, as a frictcomp.toml:\n\n{}",
        case.machine
    );
    if !case.run.is_empty() {
        text.push_str(&steps(case));
    }
    let currents = asked_currents(case);
    if !currents.is_empty() {
        text.push_str(
            "\nCompute the additive current before it is rounded for the drive: for `current` long after the \
             last reversal at that velocity, for `currents` in each cycle of the table next to this file. \
             There every velocity but 0 is motion, however small: no dead band, or one of 0. Write to a text \
             file in this folder:\n",
        );
        text.push_str(&(currents.join("\n") + "\n"));
    }
    text.push_str("\nExpected:\n");
    for expected in &case.expected {
        let _ = writeln!(text, "- {expected}");
    }
    let question = case.question();
    for (reading, expected) in &case.readings {
        let name = question.map_or("", |question| question.name_of(*reading));
        for expected in expected {
            let _ = writeln!(text, "- if {name}: {expected}");
        }
    }
    text
}

/// Returns the steps to take with the programs of a case.
fn steps(case: &Case) -> String {
    let mut text = "Restart the control. Then run, with message.txt empty before:\n".to_owned();
    for step in &case.run {
        let _ = match step.as_str() {
            "reset" => writeln!(text, "- press reset"),
            "restart" => writeln!(text, "- restart the control"),
            program if asks_at_end(case, program) => {
                writeln!(text, "- {program}, then {}", end_program(program))
            }
            program => writeln!(text, "- {program}"),
        };
    }
    let _ = writeln!(
        text,
        "\nIf the control shows an error, add this line to message.txt:\n{TAG} {} refused NUMBER",
        case.name
    );
    text
}
