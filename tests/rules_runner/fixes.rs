//! Results of fixes.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use frictcomp::diagnostic::{Code, Diagnostic, Fix, Fixed};
use frictcomp::machine::check_configuration;
use frictcomp::session::{Findings, allow_here};
use frictcomp::text::SourceFile;

use super::runs::{is_main, message};
use crate::support::{Lists, MACHINE, SourceMode};
use crate::{Case, PLACE};

/// Texts by their names.
pub(crate) type Texts = BTreeMap<String, String>;

/// The name of the configuration.
const CONFIGURATION: &str = "frictcomp.toml";

/// Shows the messages on a program, each with its fixes or with the comment that allows it, and what differs with CRLF.
pub(crate) fn shown(case: &Case, part: &str, parts: &str) -> String {
    let programs = case.programs.iter();
    let mut programs: Vec<String> = programs.map(|it| it.replace(PLACE, part)).collect();
    if programs == case.programs {
        programs.push(part.to_owned());
    }
    let mut texts = case.files.clone();
    let machine = case.machine.as_deref().unwrap_or(MACHINE);
    texts.insert(CONFIGURATION.to_owned(), machine.to_owned());
    let names = ('a'..).map(|letter| format!("{letter}.nc"));
    texts.extend(names.zip(programs));
    let mut shown = of_texts(case, parts, &texts);
    for text in texts.values_mut() {
        *text = text.replace('\n', "\r\n");
    }
    let with_returns = of_texts(case, parts, &texts);
    if with_returns != shown {
        write!(shown, "with CRLF\n{with_returns}").expect("text");
    }
    shown
}

fn of_texts(case: &Case, parts: &str, texts: &Texts) -> String {
    let programs = texts.keys().filter(|name| is_main(name));
    let last = programs.max().expect("a program").as_str();
    let say = |texts: &Texts| messages(case, texts);
    let mut shown = String::new();
    for said in say(texts) {
        if &*said.place.file != last {
            continue;
        }
        writeln!(shown, "{}", message(&said, last)).expect("text");
        let allowing = || allow_here(&said, &SourceFile::new(last, texts[last].as_str()));
        let fixes = match parts {
            "allow" => allowing().into_iter().collect(),
            _ => said.fixes.clone(),
        };
        for fix in &fixes {
            shown.push_str(&mended(&said, fix, texts, &say));
        }
    }
    shown
}

/// Runs the programs among the texts, and returns the messages about them and about the lists.
fn messages(case: &Case, texts: &Texts) -> Vec<Diagnostic> {
    let mut case = case.clone();
    case.machine = texts.get(CONFIGURATION).cloned();
    let programs = texts.iter().filter(|(name, _)| is_main(name));
    let programs: Vec<&str> = programs.map(|(_, text)| text.as_str()).collect();
    case.files.clone_from(texts);
    let bench = case.bench();
    let mut found = Findings::default();
    let handed = (programs.as_slice(), SourceMode::Whole);
    bench.run_into(&mut bench.session(), handed, &mut found);
    let configuration = SourceFile::new(CONFIGURATION, texts[CONFIGURATION].as_str());
    let lists = check_configuration(configuration, &mut Lists(texts)).diagnostics;
    found.diagnostics().cloned().chain(lists).collect()
}

/// Shows the lines that a fix changes, and what is said after it unless only its message is gone.
pub(crate) fn mended(
    said: &Diagnostic,
    fix: &Fix,
    texts: &Texts,
    say: &dyn Fn(&Texts) -> Vec<Diagnostic>,
) -> String {
    let file = &*fix.place.file;
    let before = &texts[file];
    let source = SourceFile::new(file, before.as_str());
    let after = Fixed::new(&source, [fix]).text;
    let name = if file == &*said.place.file { "" } else { file };
    let safety = fix.safety.as_str();
    let mut shown = format!("    {}\n", format!("{safety} {name}").trim_end());
    shown.push_str(&difference(before, &after));
    let mut changed = texts.clone();
    changed.insert(file.to_owned(), after);
    let [was, is] = [texts, &changed].map(|texts| counted(&say(texts)));
    if let (Some(left), Some(all)) = (is.get(&said.code), was.get(&said.code)) {
        writeln!(shown, "    still {left} of {all} {}", said.code).expect("text");
    }
    let codes: BTreeSet<_> = was.keys().chain(is.keys()).collect();
    for code in codes.into_iter().filter(|code| **code != said.code) {
        match is.get(code).cmp(&was.get(code)) {
            Ordering::Less => writeln!(shown, "    without {code}").expect("text"),
            Ordering::Greater => writeln!(shown, "    then {code}").expect("text"),
            Ordering::Equal => {}
        }
    }
    shown
}

/// Counts the messages of each code.
fn counted(said: &[Diagnostic]) -> BTreeMap<Code, usize> {
    let mut counts = BTreeMap::new();
    for said in said {
        *counts.entry(said.code).or_default() += 1;
    }
    counts
}

/// Shows the lines between the first and the last difference, with their numbers.
fn difference(before: &str, after: &str) -> String {
    let line_end = if before.contains("\r\n") {
        "\r\n"
    } else {
        "\n"
    };
    let [old, new] = [before, after].map(|text| text.split(line_end).collect::<Vec<_>>());
    let same = |(one, other): &(&&str, &&str)| one == other;
    let first = old.iter().zip(&new).take_while(same).count();
    let last = old[first..].iter().rev().zip(new[first..].iter().rev());
    let last = last.take_while(same).count();
    let mut shown = String::new();
    for (mark, lines) in [('-', old), ('+', new)] {
        let changed = (1..).zip(&lines[..lines.len() - last]).skip(first);
        for (number, line) in changed {
            let line = if line.is_empty() {
                String::new()
            } else {
                format!(" {line}")
            };
            writeln!(shown, "    {mark} {number}:{line}").expect("text");
        }
    }
    shown
}
