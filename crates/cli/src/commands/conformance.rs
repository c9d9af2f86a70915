//! `frictcomp conformance`: the agreed behaviour as data, checked on this engine or against a control's answers.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use crate::output::{Console, Failure, Outputs, ResultArgs, ResultFormat, exit, shown, write_text};
use frictcomp::text::shown_path;
use frictcomp_host::conformance::{
    Answers, Case, CaseError, Compared, Mismatch, Totals, export, find_cases, run_case,
};
use frictcomp_host::{FileRegistry, HostError, read_text};
use frictcomp_report::{fitted, to_json};

/// Run the conformance cases on this engine, write them for a control, or compare what a control
/// answered
///
/// A case is a file with programs, a machine and the expected states. One that the
/// documents leave open has the states under both readings.
#[derive(Debug, Args)]
pub(crate) struct ConformanceArgs {
    /// The folder of the cases
    #[arg(value_name = "FOLDER", default_value = "conformance")]
    cases: PathBuf,
    /// Write each case as NC programs and lists for a control to this folder
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["compare", "format", "output"])]
    into: Option<PathBuf>,
    /// Compare the answers that a control left in the files of this folder
    #[arg(long, value_name = "FOLDER")]
    compare: Option<PathBuf>,
    #[command(flatten)]
    result: ResultArgs,
}

/// Verdicts on the answers of a control, in addition to the totals.
#[derive(Default)]
struct Answered {
    unanswered: usize,
    /// Readings that the control follows.
    readings: Vec<(String, &'static str)>,
}

/// Runs the command.
pub(crate) fn run(args: &ConformanceArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let cases = read_cases(&args.cases, &registry)?;
    let mut outputs = Outputs::new(&registry, console);
    if let Some(folder) = &args.into {
        return write_cases(&cases, folder, outputs);
    }
    let mut result = outputs.result(args.result.output.as_deref())?;
    let mut answered = None;
    let totals = match &args.compare {
        None => {
            let mut totals = Totals::default();
            for case in &cases {
                totals.add(run_case(case));
            }
            totals
        }
        Some(folder) => {
            let answers = read_answers(folder, &registry)?;
            let (totals, found) = compare(&cases, &answers);
            answered = Some(found);
            totals
        }
    };
    outputs.check()?;
    let text = match args.result.format {
        ResultFormat::Text => fitted(&text(&totals, answered.as_ref()), result.look.width),
        ResultFormat::Json => to_json(&document(&totals, answered.as_ref())),
    };
    result.text(&text)?;
    outputs.finish()?;
    let failed = !totals.failed.is_empty();
    Ok(if failed { exit::FOUND } else { exit::CLEAN })
}

fn read_cases(folder: &Path, registry: &FileRegistry) -> Result<Vec<Case>, Failure> {
    let files = find_cases(folder).map_err(|error| HostError::read(folder, error))?;
    if files.is_empty() {
        return Err(
            Failure::new(format!("there is no case in `{}`", shown_path(folder)))
                .with_help("name the folder that holds the chapters, each with its `.toml` files"),
        );
    }
    let read = |file: PathBuf| {
        registry.reads("case", &file);
        let failed = |error: CaseError| {
            Failure::new(error.to_string()).with_help("docs/conformance.md says what a case holds")
        };
        Case::read(&file).map_err(failed)
    };
    files.into_iter().map(read).collect()
}

fn write_cases(cases: &[Case], folder: &Path, mut outputs: Outputs) -> Result<u8, Failure> {
    let files: Vec<_> = cases.iter().flat_map(export).collect();
    for file in &files {
        let path = folder.join(&file.path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|error| Failure::writing(parent, error))?;
        }
        let mut target = outputs.file("--into", &path)?;
        write_text(&mut target, &file.text)?;
    }
    outputs.check()?;
    outputs.finish_quietly()?;
    Console::talk(&format!(
        "wrote {} cases to `{}`; each has a `case.txt` that says how it is run",
        cases.len(),
        shown(folder)
    ));
    Ok(exit::CLEAN)
}

/// Reads every file in a folder and below, for lines that are answers.
fn read_answers(folder: &Path, registry: &FileRegistry) -> Result<Answers, Failure> {
    let mut answers = Answers::default();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        let unread = |error| Failure::from(HostError::read(&next, error));
        for entry in fs::read_dir(&next).map_err(unread)? {
            let path = entry.map_err(unread)?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|it| it == "txt")
                && path.file_name().is_none_or(|name| name != "case.txt")
            {
                registry.reads("answers", &path);
                answers.add(&read_text(&path)?);
            }
        }
    }
    if answers.is_empty() {
        return Err(
            Failure::new(format!("there is no answer in `{}`", shown_path(folder))).with_help(
                "put `message.txt` of the control there, and what you wrote down, as `.txt` files",
            ),
        );
    }
    Ok(answers)
}

fn compare(cases: &[Case], answers: &Answers) -> (Totals, Answered) {
    let mut totals = Totals::default();
    let mut answered = Answered::default();
    for case in cases {
        totals.cases += 1;
        match answers.compare(case) {
            Compared::Unanswered => answered.unanswered += 1,
            Compared::Held => totals.held += 1,
            Compared::Undecided => {
                totals.held += 1;
                totals.undecided += 1;
            }
            Compared::Reading(reading) => {
                totals.held += 1;
                if let Some(question) = case.question() {
                    let found = (case.rule.clone(), question.name_of(reading));
                    answered.readings.push(found);
                }
            }
            Compared::Failed(failed) => totals.failed.extend(failed),
        }
    }
    answered.readings.sort();
    answered.readings.dedup();
    (totals, answered)
}

fn text(totals: &Totals, answered: Option<&Answered>) -> String {
    let mut text = String::new();
    for Mismatch {
        file,
        expected,
        found,
    } in &totals.failed
    {
        let _ = writeln!(text, "{}", shown(file));
        let _ = writeln!(text, "  expected: {expected}");
        let _ = writeln!(text, "  found:    {found}");
    }
    let Totals {
        cases,
        held,
        undecided,
        failed,
    } = totals;
    let failed = failed.len();
    match answered {
        None => {
            let _ = writeln!(
                text,
                "{cases} cases: {held} held on this engine, {undecided} of the cases are undecided by the \
                 documents and run under both readings; {failed} expectations failed"
            );
        }
        Some(answered) => {
            for (rule, reading) in &answered.readings {
                let _ = writeln!(text, "{rule}: the control follows `{reading}`");
            }
            let _ = writeln!(
                text,
                "{cases} cases: {held} held on the control, {undecided} of them still undecided, {} without an \
                 answer; {failed} expectations failed",
                answered.unanswered
            );
        }
    }
    text
}

fn document(totals: &Totals, answered: Option<&Answered>) -> Value {
    let failed: Vec<Value> = totals
        .failed
        .iter()
        .map(|it| json!({ "file": shown(&it.file), "expected": it.expected, "found": it.found }))
        .collect();
    let mut document = json!({
        "schema": 1,
        "cases": totals.cases,
        "held": totals.held,
        "undecided": totals.undecided,
        "failed": failed,
    });
    if let Some(answered) = answered {
        let readings = answered.readings.iter();
        let readings: Vec<Value> = readings
            .map(|(rule, reading)| json!({ "rule": rule, "reading": reading }))
            .collect();
        document["unanswered"] = answered.unanswered.into();
        document["readings"] = readings.into();
    }
    document
}
