//! The rules by example. Each case of `tests/rules` runs its programs, and what they show is written below them;
//! `UPDATE_DOCS=1` writes it again. `tests/rules/README.md` says how a case is written.

mod rules_runner;
mod support;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use frictcomp::lists::ChannelKey;
use rules_runner::{fixes, lists, runs::Shown};
use support::{Bench, MACHINE, SourceMode};

/// Environment variable that is set to write what the cases show.
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

// R2.105
#[test]
fn each_key_of_a_channel_list_changes_what_its_case_shows() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = folder.join("tests/rules/lists");
    let documents = documents(&path).into_iter();
    let documents: Vec<String> = documents
        .map(|path| fs::read_to_string(path).expect("a document"))
        .collect();
    let mut same = Vec::new();
    for row in ChannelKey::all() {
        let Some(case) = row.case() else { continue };
        let pattern = row.pattern();
        if case.contains('/') {
            let text = fs::read_to_string(folder.join(case)).expect("a test");
            let keys = text.split(['"', ' ', '\n']).map(without_indices);
            assert!(
                keys.into_iter().any(|key| key == pattern),
                "{case}: {pattern}"
            );
            continue;
        }
        let mut texts = documents.iter().filter_map(|text| section(text, case));
        let Some(text) = texts.next() else {
            same.push(format!("`{case}`, which is not there"));
            continue;
        };
        let is_other = |line: &&str| {
            let key = line.split_whitespace().next();
            key.is_none_or(|key| without_indices(key) != pattern)
        };
        let without: Vec<&str> = text.lines().filter(is_other).collect();
        let [with, without] = [&text, &joined(&without)].map(|text| Document::replayed(text));
        let (with, without) = (Document::results(&with), Document::results(&without));
        if with == without {
            same.push(format!("`{case}` without `{pattern}`"));
        }
    }
    assert!(same.is_empty(), "the same is shown by\n{}", same.join("\n"));
}

/// Returns the head of a document and its case with a heading.
fn section(text: &str, heading: &str) -> Option<String> {
    let mut parts = text.split("\n## ");
    let head = parts.next()?;
    let is_it = |part: &&str| {
        part.strip_prefix(heading)
            .is_some_and(|it| it.starts_with(" (R"))
    };
    let case = parts.find(is_it)?;
    Some(format!("{head}\n## {case}\n"))
}

fn without_indices(key: &str) -> String {
    let mut inside = false;
    let is_kept = |it: &char| {
        inside = matches!(it, '[') || inside && *it != ']';
        !inside || *it == '['
    };
    key.chars().filter(is_kept).collect()
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

/// Returns the lines around the first one that differs.
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

/// The line in whose place each text of a block stands.
const PLACE: &str = "@\n";

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

/// Parts of the next result: everything since the heading or the last result.
#[derive(Debug, Clone, Default)]
struct Case {
    machine: Option<String>,
    /// Options that its sentences name.
    options: Vec<String>,
    /// Programs that run before, or that hold the place of the shown ones.
    programs: Vec<String>,
    /// Programs that may be called, and lists.
    files: BTreeMap<String, String>,
}

impl Case {
    fn bench(&self) -> Bench {
        let bench = match self.machine.as_deref() {
            Some("") => {
                let mut bench = Bench::undescribed();
                bench.files.clone_from(&self.files);
                bench
            }
            machine => Bench::configured(machine.unwrap_or(MACHINE), self.files.clone()),
        };
        self.options
            .iter()
            .fold(bench, |bench, option| with_option(bench, option))
    }
}

impl Document {
    /// Returns the text with the current results.
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

    /// Returns the lines of the results of a text.
    fn results(text: &str) -> Vec<&str> {
        text.lines()
            .filter(|line| line.starts_with(RESULT))
            .collect()
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
        let (kind, parts) = info.split_once(' ').unwrap_or((info, ""));
        let case = &mut self.case;
        match kind {
            "toml" if self.in_cases => case.machine = Some(whole.clone()),
            "toml" => self.machine = Some(whole.clone()),
            "program" => case.programs.push(whole.clone()),
            "file" => {
                case.files.insert(parts.to_owned(), whole.clone());
            }
            "nc" => {
                let case = self.taken();
                if ["fixes", "allow"].contains(&parts) {
                    return results(lines, |program| fixes::shown(&case, program, parts));
                }
                let bench = case.bench();
                return results(lines, |program| {
                    shown(&bench, &case.programs, program, parts)
                });
            }
            "list" => {
                let case = self.taken();
                return results(lines, |list| lists::shown(&case, list, parts));
            }
            "expressions" => return self.values(lines),
            _ => panic!("a block of `{info}` is not known"),
        }
        whole
    }

    /// Takes what the next result is made of; the machine holds for the whole case.
    fn taken(&mut self) -> Case {
        let machine = self.case.machine.clone();
        let kept = Case {
            machine: machine.clone(),
            ..Case::default()
        };
        let mut case = std::mem::replace(&mut self.case, kept);
        case.machine = machine.or_else(|| self.machine.clone());
        case
    }

    fn values(&mut self, lines: &[&str]) -> String {
        let expressions = lines
            .iter()
            .map(|line| line.split(" -> ").next().unwrap_or(line));
        let expressions: Vec<&str> = expressions.collect();
        let case = self.taken();
        case.bench().values(&case.programs.concat(), &expressions)
    }
}

/// Writes below each of the texts between blank lines what it shows.
fn results(lines: &[&str], show: impl Fn(&str) -> String) -> String {
    let shown = lines.split(|line| line.is_empty()).map(|part| {
        let is_own = |line: &&str| !line.starts_with(RESULT);
        let part: Vec<&str> = part.iter().copied().filter(is_own).collect();
        let part = joined(&part);
        let mut text = part.clone();
        for line in show(&part).lines() {
            writeln!(text, "{RESULT} {line}").expect("text");
        }
        text
    });
    shown.collect::<Vec<_>>().join("\n")
}

fn joined(lines: &[&str]) -> String {
    lines.iter().flat_map(|line| [line, "\n"]).collect()
}

/// Shows what a program does, in the place of `@` or after the others, and what it does handed over line by line or
/// with other line ends where that differs.
fn shown(bench: &Bench, programs: &[String], part: &str, parts: &str) -> String {
    let place = programs
        .iter()
        .find_map(|program| program.lines().position(|it| it == "@"));
    let mut all: Vec<String> = programs.iter().map(|it| it.replace(PLACE, part)).collect();
    if place.is_none() && !part.is_empty() {
        all.push(part.to_owned());
    }
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    if parts == "positions" {
        return bench.positions(&all.concat());
    }
    let rows = place.map_or(0..usize::MAX, |at| at..at + part.lines().count());
    let shown_of = |programs: &[&str], handed| Shown::of(bench, (programs, handed), parts, &rows);
    let mut whole = shown_of(&all, SourceMode::Whole);
    let [with_crlf, with_cr] = ["\r\n", "\r"].map(|line_end| {
        let texts: Vec<String> = all.iter().map(|it| it.replace('\n', line_end)).collect();
        let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
        shown_of(&texts, SourceMode::Whole)
    });
    let others = [
        ("line by line", shown_of(&all, SourceMode::LineByLine)),
        ("with CRLF", with_crlf),
        ("with CR", with_cr),
    ];
    let alone = whole.clone();
    for (how, other) in others.iter().filter(|(_, other)| *other != alone) {
        writeln!(whole, "{how}").expect("text");
        for line in other.lines() {
            writeln!(whole, "  {line}").expect("text");
        }
    }
    whole
}

fn with_option(bench: Bench, option: &str) -> Bench {
    let (name, value) = option.split_once(' ').unwrap_or((option, ""));
    match name {
        "--keep-going" => bench.keep_going(),
        "--reset" => bench.reset_after_error(),
        "--skip" => bench.skip(value),
        "--set" => {
            let (name, value) = value.split_once('=').expect("NAME=VALUE");
            match value.parse() {
                Ok(number) => bench.set(name, number),
                Err(_) => bench.set_text(name, value),
            }
        }
        "--check" => bench.check_all(),
        "--build" => bench.build(value),
        "--drive" => bench.passing_branches(),
        _ => panic!("the option `{option}` is not known"),
    }
}
