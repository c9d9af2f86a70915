//! The documents: every console block is run, every rule has a test, every link leads somewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::console::{Stage, replayed};
use crate::workspace::{agree, copy, files, root};
use frictcomp::documents::RULES;
use frictcomp_report::assumptions::{Chapter, chapters};

/// Returns the sources of all packages, with the tests of those in `crates`.
fn sources() -> Vec<PathBuf> {
    let mut sources = files("src", &["rs"]);
    sources.extend(files("crates", &["rs"]));
    sources
}

fn documents() -> Vec<PathBuf> {
    let names = [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
    ];
    let mut documents: Vec<PathBuf> = names.iter().map(|name| root().join(name)).collect();
    let docs = files("docs", &["md"]);
    // The contents of the book list pages that `dist/book` makes, too.
    documents.extend(docs.into_iter().filter(|it| !it.ends_with("SUMMARY.md")));
    documents
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The demo with recordings, into which commands write.
const RECORDED: &str = "programs/demo/recorded";

/// The demo of a project, which the first command of a document describes for the next ones.
const PROJECT: &str = "programs/demo/twincat";

/// Returns a folder with a copy of a demo at its place.
fn copied(demo: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    copy(demo, folder.path());
    folder
}

/// The tree, or a copy of the demo that a command changes.
struct Documents {
    project: tempfile::TempDir,
    recorded: Option<tempfile::TempDir>,
}

impl Stage for Documents {
    fn folder(&mut self, command: &str) -> PathBuf {
        if command.contains(PROJECT) {
            return self.project.path().to_owned();
        }
        if command.contains(RECORDED) {
            return self.recorded.insert(copied(RECORDED)).path().to_owned();
        }
        root().to_owned()
    }
}

/// Returns the rules of a text, in the form `R1.24`.
fn rules(text: &str) -> BTreeSet<String> {
    let number = |text: &str| text.chars().take_while(char::is_ascii_digit).count();
    let found = text.match_indices('R').filter_map(|(at, _)| {
        let preceded =
            text[..at].ends_with(|letter: char| letter.is_alphanumeric() || letter == '-');
        let rest = &text[at + 1..];
        let chapter = number(rest);
        let rule = number(rest.get(chapter..)?.strip_prefix('.')?);
        let whole = !preceded && (1..=2).contains(&chapter) && rule > 0;
        whole.then(|| text[at..=at + chapter + 1 + rule].to_owned())
    });
    found.collect()
}

/// Returns the rules and contradictions of `docs/rules`, each with its text.
fn listed_rules() -> impl Iterator<Item = (&'static str, &'static str)> {
    let items = RULES.split("\n- **").skip(1);
    items.filter_map(|item| {
        let text = item.split("\n\n").next().unwrap_or_default();
        text.split_once("** ")
    })
}

/// Returns the sources with tests, each with its test part.
fn tests() -> BTreeMap<String, String> {
    let mut parts = BTreeMap::new();
    for path in files("tests", &["rs"]) {
        parts.insert(path.display().to_string(), read(&path));
    }
    let cases = ["tests/rules", "crates/cli/tests/cases"];
    for path in cases.into_iter().flat_map(|it| files(it, &["md"])) {
        let text = read(&path).replace("\n## ", "\n// ");
        parts.insert(path.display().to_string(), text);
    }
    for path in files("bindings/python/tests", &["py"]) {
        let text = read(&path).replace("# R", "// R");
        parts.insert(path.display().to_string(), text);
    }
    for path in sources() {
        let text = read(&path);
        let name = path.display().to_string();
        let all_tests = name.replace('\\', "/").contains("/tests/");
        let at = if all_tests {
            Some(0)
        } else {
            text.find("#[cfg(test)]")
        };
        if let Some(at) = at {
            parts.insert(name, text[at..].to_owned());
        }
    }
    parts
}

/// Returns the comments of a source.
fn comments(text: &str) -> String {
    let lines = text.lines().filter_map(|line| line.split_once("//"));
    lines
        .map(|(_, comment)| comment)
        .collect::<Vec<_>>()
        .join("\n")
}

/// Returns the rows of the table of a document that begins with a heading.
fn rows<'a>(text: &'a str, heading: &str) -> Vec<&'a str> {
    let (_, table) = text.split_once(heading).expect("the table");
    let rows = table.lines().skip(2);
    rows.take_while(|line| line.starts_with('|')).collect()
}

#[test]
fn the_architecture_names_rooms_and_files_that_exist() {
    let text = read(&root().join("ARCHITECTURE.md"));
    let packages = fs::read_dir(root().join("crates")).expect("packages");
    let packages: Vec<PathBuf> = packages
        .map(|entry| entry.expect("an entry").path())
        .collect();
    let is_room = |source: &Path, room: &str| {
        source.join(room).is_dir() || source.join(format!("{room}.rs")).is_file()
    };
    for row in rows(&text, "| room | holds |") {
        let room = row.split('`').nth(1).expect("a room");
        let exists = is_room(&root().join("src"), room)
            || packages
                .iter()
                .any(|it| it.ends_with(room) || is_room(&it.join("src"), room));
        assert!(exists, "there is no room `{room}`");
    }
    let guide = read(&root().join("CONTRIBUTING.md"));
    let rows = rows(&guide, "| new | files |");
    assert!(rows.len() > 10);
    for row in rows {
        let words = row.split('`').skip(1).step_by(2);
        let mut files = 0;
        for path in words.filter(|word| word.contains('/')) {
            assert!(root().join(path).exists(), "there is no `{path}`: {row}");
            files += 1;
        }
        assert!(files <= 4, "too many files for one change: {row}");
    }
}

#[test]
fn console_blocks_show_what_the_tool_prints() {
    for path in documents() {
        let mut stage = Documents {
            project: copied(PROJECT),
            recorded: None,
        };
        agree(&path, &replayed(&read(&path), &mut stage));
    }
}

/// Returns the list of assumptions with its tables made from the code; the text above them is prose.
fn assumptions(text: &str) -> String {
    let prose = text.split("\n## ").next().unwrap_or_default();
    let mut fresh = prose.trim_end().to_owned();
    fresh.push('\n');
    for Chapter {
        title, assumptions, ..
    } in chapters()
    {
        let _ = write!(
            fresh,
            "\n## {title}\n\n| rule | assumption | what it changes | how it shows |\n|---|---|---|---|\n"
        );
        for it in assumptions {
            let cells = [&*it.rule, &it.sentence, &it.changes, &it.shows];
            let _ = writeln!(fresh, "| {} |", cells.join(" | "));
        }
    }
    fresh
}

#[test]
fn the_list_of_assumptions_is_that_of_the_code() {
    let path = root().join("docs/assumptions.md");
    agree(&path, &assumptions(&read(&path)));
}

#[test]
fn every_rule_that_is_an_assumption_is_in_the_list() {
    let all = chapters().iter().flat_map(|chapter| &chapter.assumptions);
    let named: BTreeSet<&str> = all.flat_map(|it| it.rule.split(", ")).collect();
    let mut listed = BTreeSet::new();
    for (rule, rest) in listed_rules() {
        listed.insert(rule);
        let source = rest.rsplit_once("*(").map_or("", |(_, source)| source);
        assert!(
            !source.contains("assumption") || named.contains(rule),
            "{rule} is an assumption that `report/assumptions` does not have"
        );
    }
    // A number without a letter is a section.
    let rules = named
        .iter()
        .filter(|rule| !rule.starts_with(|it: char| it.is_ascii_digit()));
    let unknown: Vec<_> = rules.filter(|rule| !listed.contains(*rule)).collect();
    assert!(unknown.is_empty(), "docs/rules has no {unknown:?}");
}

#[test]
fn every_rule_has_a_test() {
    let rule_numbers = listed_rules().filter(|(rule, _)| rule.starts_with('R'));
    let listed: BTreeSet<String> = rule_numbers.map(|(rule, _)| rule.to_owned()).collect();
    let mut named = BTreeSet::new();
    for (file, text) in tests() {
        if file.ends_with("docs.rs") {
            continue;
        }
        let here = rules(&comments(&text));
        let unknown: Vec<_> = here.difference(&listed).collect();
        assert!(
            unknown.is_empty(),
            "{file} names rules that docs/rules does not have: {unknown:?}"
        );
        named.extend(here);
    }
    let bare: Vec<_> = listed.difference(&named).collect();
    assert!(bare.is_empty(), "no test names these rules: {bare:?}");
}

#[test]
fn every_named_rule_exists() {
    let listed = rules(RULES);
    for path in documents().into_iter().chain(sources()) {
        let here = rules(&read(&path));
        // Pages may mention chapters that are not built yet.
        let chapter = |rule: &str| rule.split('.').next().map(|chapter| format!("{chapter}."));
        let built = |rule: &str| {
            let chapter = chapter(rule).unwrap_or_default();
            listed.iter().any(|other| other.starts_with(&chapter))
        };
        let unknown: Vec<_> = here
            .difference(&listed)
            .filter(|rule| built(rule))
            .collect();
        assert!(unknown.is_empty(), "{}: {unknown:?}", path.display());
    }
}

#[test]
fn links_lead_to_files() {
    for path in documents() {
        let text = read(&path);
        for (at, _) in text.match_indices("](") {
            let target = text[at + 2..].split([')', '#']).next().unwrap_or_default();
            let here = path.parent().expect("a folder").join(target);
            let outside = target.starts_with("http");
            assert!(outside || here.exists(), "{}: {target}", path.display());
        }
    }
}

#[test]
fn a_rule_is_found_in_a_text() {
    let found = rules("// R1.24, R3.2 (R2.50) but not CR1.2, P-R3.1 or R7");
    assert_eq!(
        found.into_iter().collect::<Vec<_>>(),
        ["R1.24", "R2.50", "R3.2"]
    );
}

/// R17.8: "home" is a position to a machinist; the state at the start of the control has one name.
#[test]
fn no_text_calls_the_start_up_state_home() {
    let names_home = |text: &str| {
        let lines = text.lines().enumerate();
        let named = lines.filter(|(_, line)| {
            let line = line.to_lowercase();
            [
                "at home",
                "from home",
                "home state",
                "brings home",
                "is home",
            ]
            .iter()
            .any(|phrase| line.contains(phrase))
        });
        named.map(|(at, _)| at + 1).collect::<Vec<_>>()
    };
    let sources = sources().into_iter().filter(|it| !it.ends_with("docs.rs"));
    for file in documents().into_iter().chain(sources) {
        let lines = names_home(&read(&file));
        assert!(lines.is_empty(), "{}: {lines:?}", file.display());
    }
}
