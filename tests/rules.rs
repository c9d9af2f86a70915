//! The rules by example. Each case of `tests/rules` runs its programs, and what they show is written below them;
//! `UPDATE_DOCS=1` writes it again. `tests/rules/README.md` says how a case is written.

mod support;

use std::fmt::Write as _;
use std::fs;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};

use frictcomp::comp::{Compensation, Kind};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::timeline::{Record, Sink, StateView};
use support::{Bench, SourceMode};

/// Set to write what the cases show.
const UPDATE: &str = "UPDATE_DOCS";

#[test]
fn every_case_shows_what_is_written_below_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/rules");
    let mut changed = Vec::new();
    for path in documents(&folder) {
        let text = fs::read_to_string(&path).expect("a document");
        let fresh = Document::replayed(&text);
        if fresh == text {
            continue;
        }
        if std::env::var_os(UPDATE).is_some() {
            fs::write(&path, fresh).expect("the document is written");
        } else {
            changed.push(format!(
                "{}\n{}",
                path.display(),
                first_difference(&text, &fresh)
            ));
        }
    }
    assert!(
        changed.is_empty(),
        "{UPDATE}=1 writes these again:\n{}",
        changed.join("\n")
    );
}

fn documents(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(documents(&path));
        } else if path.extension().is_some_and(|it| it == "md") && !path.ends_with("README.md") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The lines around the first one that differs.
fn first_difference(text: &str, fresh: &str) -> String {
    let (old, new): (Vec<_>, Vec<_>) = (text.lines().collect(), fresh.lines().collect());
    let at = old
        .iter()
        .zip(&new)
        .take_while(|(one, other)| one == other)
        .count();
    let part = |lines: &[&str], mark: &str| {
        let shown = lines.iter().skip(at).take(5);
        let shown: Vec<String> = shown.map(|line| format!("{mark} {line}\n")).collect();
        shown.concat()
    };
    format!("line {}\n{}{}", at + 1, part(&old, "-"), part(&new, "+"))
}

/// Begins a line of a result.
const RESULT: &str = ">";

/// A document while it is read.
#[derive(Default)]
struct Document {
    /// The machine of all its cases, where it describes one.
    machine: Option<String>,
    in_cases: bool,
    case: Case,
}

/// What the next result is made of: everything since the heading or the last result.
#[derive(Default)]
struct Case {
    machine: Option<String>,
    /// Options that its sentences name.
    options: Vec<String>,
    /// Programs that run before, or that hold the place of the shown ones.
    programs: Vec<String>,
    /// Files that programs may call.
    files: Vec<(String, String)>,
}

impl Document {
    /// The text with the current results.
    fn replayed(text: &str) -> String {
        let mut document = Self::default();
        let mut fresh = String::new();
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            writeln!(fresh, "{line}").expect("text");
            let Some(info) = line.strip_prefix("```") else {
                document.prose(line);
                continue;
            };
            let block: Vec<&str> = lines.by_ref().take_while(|it| *it != "```").collect();
            fresh.push_str(&document.block(info, &block));
            fresh.push_str("```\n");
        }
        fresh
    }

    fn prose(&mut self, line: &str) {
        if line.starts_with("## ") {
            self.in_cases = true;
            self.case = Case::default();
        }
        let spans = line.split('`').skip(1).step_by(2);
        let options = spans.filter(|span| span.starts_with("--"));
        self.case.options.extend(options.map(str::to_owned));
    }

    /// Takes a block in, and returns it with its current results.
    fn block(&mut self, info: &str, lines: &[&str]) -> String {
        let whole = joined(lines);
        let case = &mut self.case;
        match info.split_once(' ').unwrap_or((info, "")) {
            ("toml", "") if self.in_cases => case.machine = Some(whole.clone()),
            ("toml", "") => self.machine = Some(whole.clone()),
            ("program", "") => case.programs.push(whole.clone()),
            ("file", name) => case.files.push((name.to_owned(), whole.clone())),
            ("nc", parts) => return self.results(lines, parts),
            ("expressions", "") => return self.values(lines),
            _ => panic!("a block of `{info}` is not known"),
        }
        whole
    }

    fn bench(&mut self) -> Bench {
        let mut bench = match self.case.machine.as_ref().or(self.machine.as_ref()) {
            Some(machine) if machine.is_empty() => Bench::undescribed(),
            Some(machine) => Bench::on(machine),
            None => Bench::new(),
        };
        for option in std::mem::take(&mut self.case.options) {
            bench = with_option(bench, &option);
        }
        for (file, text) in std::mem::take(&mut self.case.files) {
            bench = bench.file(&file, &text);
        }
        bench
    }

    fn values(&mut self, lines: &[&str]) -> String {
        let expressions = lines
            .iter()
            .map(|line| line.split(" -> ").next().unwrap_or(line));
        let expressions: Vec<&str> = expressions.collect();
        let programs = std::mem::take(&mut self.case.programs);
        self.bench().values(&programs.concat(), &expressions)
    }

    /// Runs each of the programs between blank lines.
    fn results(&mut self, lines: &[&str], parts: &str) -> String {
        let bench = self.bench();
        let programs = std::mem::take(&mut self.case.programs);
        let shown = lines.split(|line| line.is_empty()).map(|program| {
            let program: Vec<&str> = program
                .iter()
                .copied()
                .filter(|line| !line.starts_with(RESULT))
                .collect();
            let part = joined(&program);
            let mut text = part.clone();
            for line in shown(&bench, &programs, &part, parts).lines() {
                writeln!(text, "{RESULT} {line}").expect("text");
            }
            text
        });
        shown.collect::<Vec<_>>().join("\n")
    }
}

fn joined(lines: &[&str]) -> String {
    lines.iter().flat_map(|line| [line, "\n"]).collect()
}

/// What a program shows, in the place of `@` or after the others, and what it shows handed over line by line where
/// that differs.
fn shown(bench: &Bench, programs: &[String], part: &str, parts: &str) -> String {
    let place = programs
        .iter()
        .find_map(|program| program.lines().position(|it| it == "@"));
    let mut all: Vec<String> = programs.iter().map(|it| it.replace("@\n", part)).collect();
    if place.is_none() && !part.is_empty() {
        all.push(part.to_owned());
    }
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    if parts == "positions" {
        return bench.positions(&all.concat());
    }
    let rows = place.map_or(0..usize::MAX, |at| at..at + part.lines().count());
    let [mut whole, by_line] = [SourceMode::Whole, SourceMode::LineByLine]
        .map(|handed| Shown::of(bench, (&all, handed), parts, &rows));
    if by_line != whole {
        writeln!(whole, "line by line").expect("text");
        for line in by_line.lines() {
            writeln!(whole, "  {line}").expect("text");
        }
    }
    whole
}

fn with_option(bench: Bench, option: &str) -> Bench {
    let (name, value) = option.split_once(' ').unwrap_or((option, ""));
    match name {
        "--keep-going" => bench.keep_going(),
        "--skip" => bench.skip(value),
        "--set" => {
            let (name, value) = value.split_once('=').expect("NAME=VALUE");
            match value.parse() {
                Ok(number) => bench.set(name, number),
                Err(_) => bench.set_text(name, value),
            }
        }
        "--check" => bench.check_all(),
        "--drive" => bench.passing_branches(),
        _ => panic!("the option `{option}` is not known"),
    }
}

/// What a run shows: changes and messages by line, and the state that each program leaves.
struct Shown {
    text: String,
    start_up: Compensation,
    /// Every executed block is shown.
    with_blocks: bool,
    /// Advice and labels are shown.
    with_help: bool,
    is_one_of_several: bool,
    /// The lines that count; of others only messages are shown.
    rows: Range<usize>,
}

impl Shown {
    fn of(
        bench: &Bench,
        (programs, handed): (&[&str], SourceMode),
        parts: &str,
        rows: &Range<usize>,
    ) -> String {
        let mut shown = Self {
            rows: rows.clone(),
            text: String::new(),
            start_up: bench.machine.compensation(),
            with_blocks: parts == "blocks",
            with_help: parts == "help",
            is_one_of_several: programs.len() > 1,
        };
        bench.run_into(&mut bench.session(), (programs, handed), &mut shown);
        shown.text
    }

    fn said(&mut self, said: &Diagnostic) {
        let place = &said.place;
        let (start, end) = (place.start(), place.end());
        let end = if end.line == start.line {
            end.column.to_string()
        } else {
            end.to_string()
        };
        let file = if is_main(&place.file) {
            ""
        } else {
            &*place.file
        };
        let file = if file.is_empty() {
            String::new()
        } else {
            format!("{file}:")
        };
        let (code, message) = (said.code, &said.message);
        let severity = if said.severity == code.severity() {
            String::new()
        } else {
            format!(" {}", said.severity)
        };
        writeln!(
            self.text,
            "    {code}{severity} {file}{start}-{end} {message}"
        )
        .expect("text");
        if self.with_help {
            for help in said.help() {
                writeln!(self.text, "        help: {help}").expect("text");
            }
            for label in &said.labels {
                writeln!(self.text, "        {}: {}", label.place.start(), label.text)
                    .expect("text");
            }
        }
    }

    /// The kinds of axes away from the start of the control, with the ways that lead there.
    fn left(&self, view: StateView<'_>) -> String {
        let mut left = Vec::new();
        for (axis, name) in view.axes() {
            for kind in Kind::ALL {
                let state = view.state(axis, kind);
                if state == self.start_up.state(axis, kind) {
                    continue;
                }
                let words = match view.possible_of(axis, kind) {
                    Some(possible) => possible.in_words("a.nc"),
                    None => state.as_str().to_owned(),
                };
                left.push(format!("{} {words}", of_kind(name, kind)));
            }
        }
        if left.is_empty() {
            left.push("as at the start".to_owned());
        }
        left.join("; ")
    }
}

/// Whether it is one of the programs that are run, not one that they call.
fn is_main(file: &str) -> bool {
    matches!(file.as_bytes(), [b'a'..=b'z', b'.', b'n', b'c'])
}

/// An axis, with the kind of compensation where it is not friction.
fn of_kind(axis: &str, kind: Kind) -> String {
    match kind {
        Kind::Frict => axis.to_owned(),
        kind => format!("{axis} {}", kind.as_str()),
    }
}

impl Sink for Shown {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Machine(said) => self.said(said),
            Record::Program { file, .. } if self.is_one_of_several => {
                writeln!(self.text, "{file}").expect("text");
            }
            Record::Block(row) => {
                let changes: Vec<String> = (row.changes.iter())
                    .map(|change| {
                        let axis = of_kind(row.state.name(change.axis), change.kind);
                        format!("{axis} {}", change.to.as_str())
                    })
                    .collect();
                let file = if is_main(row.file) { "" } else { row.file };
                let counts = !file.is_empty() || self.rows.contains(&(row.line as usize - 1));
                let is_shown = self.with_blocks || !changes.is_empty() && counts;
                if is_shown || !row.diagnostics.is_empty() {
                    let line = format!(
                        "{file}{}{}",
                        if file.is_empty() { "" } else { ":" },
                        row.line
                    );
                    let changes = changes.join(", ");
                    writeln!(self.text, "{}", format!("{line:>3}  {changes}").trim_end())
                        .expect("text");
                }
                for said in row.diagnostics {
                    self.said(said);
                }
            }
            Record::End(end) => {
                for note in end.notes {
                    self.said(&note.diagnostic);
                }
                for repeat in end.repeated {
                    let (code, line, times) = (repeat.code, repeat.line, repeat.times);
                    writeln!(self.text, "    {code} in line {line}, {times} times").expect("text");
                }
                let left = self.left(end.state);
                writeln!(self.text, "{}  {left}", end.by.as_str()).expect("text");
            }
            Record::Summary(summary) => {
                for (word, times) in summary.opaque {
                    writeln!(self.text, "passed over: {word}, {times} times").expect("text");
                }
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}
