//! Every program under `programs/` with its timeline, diagnostics and exit status as a reviewed
//! snapshot; every code with its page and with a program or list that raises it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Output;

use crate::folder::call;
use crate::workspace::{files, root};
use frictcomp::diagnostic::Code;

/// The bound on executed blocks for all programs, so that an endless loop is noticed.
const MAX_BLOCKS: &str = "5000";

/// Codes that neither a program nor a list can raise, and the test of each.
const ELSEWHERE: &[(&str, &[&str])] = &[
    ("tests/rules/language/refusals.md", &["P-ERR-21502"]),
    ("tests/language/budgets.rs", &["FC905", "FC918"]),
    ("tests/rules/states/readings.md", &["FC306"]),
    ("tests/language/lists/drive.rs", &["FC504", "FC505"]),
    ("tests/growth/brief.rs", &["FC908"]),
    ("crates/physics/tests/physics/motion/start.rs", &["FC906"]),
    ("crates/physics/tests/physics/motion/feeds.rs", &["FC907"]),
    (
        "crates/physics/tests/physics/motion/unknown.rs",
        &["FC903", "FC904", "FC915"],
    ),
    (
        "crates/recordings/tests/recordings/identify.rs",
        &[
            "FC511", "FC512", "FC513", "FC514", "FC515", "FC516", "FC517", "FC518",
        ],
    ),
    ("crates/host/tests/host/recordings.rs", &["FC519"]),
    (
        "crates/host/tests/host/identify_faults.rs",
        &[
            "FC520", "FC521", "FC522", "FC523", "FC524", "FC525", "FC526",
        ],
    ),
    ("crates/cli/tests/cases/block_search.md", &["FC413"]),
    ("crates/cli/tests/cases/circle.md", &["FC506"]),
    (
        "crates/cli/tests/command/options/folders.rs",
        &["FC104", "FC105"],
    ),
    ("crates/cli/tests/cases/options.md", &["FC329"]),
    ("crates/cli/tests/cases/records.md", &["P-ERR-110641"]),
];

/// Runs the tool in the root of the repository.
fn frictcomp(arguments: &[&str]) -> Output {
    call(root(), arguments)
}

/// Returns the path from the root of the repository, with forward slashes.
fn shown(path: &Path) -> String {
    let shown = |below: &Path| below.to_string_lossy().replace('\\', "/");
    if let Ok(below) = path.strip_prefix(root()) {
        return shown(below);
    }
    // On Windows the same folder has names of several forms.
    let root = root().canonicalize().expect("it is there");
    shown(path.strip_prefix(root).expect("below the root"))
}

/// Programs about a machine that is not described see no configuration (R1.37).
fn seen_machine(program: &str) -> &'static [&'static str] {
    if program.contains("/undescribed/") {
        &["--isolated"]
    } else {
        &[]
    }
}

fn name(path: &Path) -> String {
    let name = path.file_name().expect("a name");
    name.to_string_lossy().into_owned()
}

/// Returns the output of a call, as kept in a snapshot.
fn transcript(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("text");
    let mut all = text(&output.stdout);
    let said = text(&output.stderr);
    if !said.is_empty() {
        all.push_str("── stderr ──\n");
        all.push_str(&said);
    }
    let status = output.status.code().expect("an exit status");
    writeln!(all, "── exit status {status} ──").expect("text");
    all
}

/// Returns the code at the start of a file name: `FC202-fric.nc` is about FC202.
fn promised(name: &str) -> Option<Code> {
    Code::ALL.iter().copied().find(|code| {
        name.strip_prefix(code.as_str())
            .is_some_and(|rest| rest.starts_with(['-', '.']))
    })
}

/// Returns the codes that a call reports as NDJSON, each with its severity.
fn codes(arguments: &[&str]) -> BTreeMap<String, String> {
    let output = frictcomp(arguments);
    let text = String::from_utf8(output.stdout).expect("text");
    text.lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).expect("a record"))
        .filter(|record| record["record"] == "diagnostic")
        .map(|record| {
            let word = |key: &str| record[key].as_str().expect("a word").to_owned();
            (word("code"), word("severity"))
        })
        .collect()
}

/// Returns the codes of a program when everything possible in it is carried out.
fn program_codes(path: &Path) -> BTreeMap<String, String> {
    let path_text = shown(path);
    let mut arguments = vec!["run", "--keep-going", "--format", "ndjson"];
    arguments.extend(["--max-blocks", MAX_BLOCKS]);
    arguments.extend(seen_machine(&path_text));
    let before = path.with_file_name("before.nc");
    let before_text = shown(&before);
    if before.is_file() && before != path {
        arguments.push(&before_text);
    }
    arguments.push(&path_text);
    codes(&arguments)
}

#[test]
fn forms_of_the_manual_raise_nothing() {
    // R2.70: forms of the manual, one per line, whatever their meaning. No message, and no state changes.
    for path in files("programs/ok/forms", &["nc"]) {
        let name = shown(&path);
        let found = program_codes(&path);
        assert!(found.is_empty(), "{name}: {found:?}");
        let output = frictcomp(&["run", "--format", "ndjson", &name]);
        let text = String::from_utf8(output.stdout).expect("text");
        let last = text.lines().last().expect("a summary");
        assert!(
            last.contains(r#""friction":{"X":"active","Y":"active""#),
            "{name}: {last}"
        );
    }
}

/// Returns the settings of the reviewed snapshots.
fn reviewed() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path("../snapshots");
    settings
}

#[test]
fn timelines_are_as_reviewed() {
    reviewed().bind(|| {
        insta::glob!("../../../../programs", "**/*.nc", |path| {
            let program = shown(path);
            let mut arguments = vec!["run", "-v"];
            arguments.extend(["--max-blocks", MAX_BLOCKS]);
            arguments.extend(seen_machine(&program));
            arguments.push(&program);
            insta::assert_snapshot!("timeline", transcript(&frictcomp(&arguments)));
        });
    });
}

#[test]
fn lists_are_judged_as_reviewed() {
    reviewed().bind(|| {
        insta::glob!(
            "../../../../programs/machines/err",
            "*.{lis,toml}",
            |path| {
                let list = shown(path);
                insta::assert_snapshot!("lists", transcript(&frictcomp(&["lists", &list])));
            }
        );
    });
}

#[test]
fn a_session_is_as_reviewed() {
    // R1.27, FC403
    reviewed().bind(|| {
        for [first, second] in [
            ["programs/demo/friction.nc", "programs/demo/next.nc"],
            [
                "programs/err/session/before.nc",
                "programs/err/session/FC403-state-of-another-program.nc",
            ],
        ] {
            let folder = first.rsplit('/').nth(1).expect("a folder");
            let output = frictcomp(&["run", "-v", first, second]);
            insta::assert_snapshot!(format!("session@{folder}"), transcript(&output));
        }
    });
}

#[test]
fn wrong_programs_raise_their_code() {
    // R9.22
    for path in files("programs/err", &["nc"]) {
        let name = name(&path);
        let Some(code) = promised(&name) else {
            assert_eq!(name, "before.nc", "the name begins with a code");
            continue;
        };
        let mut found = program_codes(&path);
        // Only `check` reads blocks that are never executed.
        let path = shown(&path);
        let mut check = vec!["check", "--format", "ndjson"];
        check.extend(seen_machine(&path));
        check.push(&path);
        found.extend(codes(&check));
        assert!(found.contains_key(code.as_str()), "{name}: {found:?}");
    }
}

#[test]
fn wrong_lists_raise_their_code() {
    // R9.22
    for path in files("programs/machines/err", &["lis", "toml"]) {
        let Some(code) = promised(&name(&path)) else {
            assert!(shown(&path).contains("/err/lists/"), "{}", path.display());
            continue;
        };
        let found = codes(&["lists", "--format", "ndjson", &shown(&path)]);
        assert!(found.contains_key(code.as_str()), "{path:?}: {found:?}");
    }
}

#[test]
fn right_programs_raise_no_error() {
    for folder in ["programs/ok", "programs/demo"] {
        for path in files(folder, &["nc"]) {
            if shown(&path).contains("/unset/") {
                continue;
            }
            let errors: Vec<String> = program_codes(&path)
                .into_iter()
                .filter(|(_, severity)| severity == "error")
                .map(|(code, _)| code)
                .collect();
            assert_eq!(errors, [""; 0], "{}", path.display());
        }
    }
}

#[test]
fn code_page_and_program_belong_together() {
    // R9.22
    let mut shown_by_file: BTreeSet<&str> = BTreeSet::new();
    let lists = files("programs/machines/err", &["lis", "toml"]);
    for path in files("programs/err", &["nc"]).iter().chain(&lists) {
        shown_by_file.extend(promised(&name(path)).map(Code::as_str));
    }
    for (file, codes) in ELSEWHERE {
        let test = fs::read_to_string(root().join(file)).expect(file);
        let letters = |text: &str| text.replace('-', "").to_uppercase();
        let test = letters(&test);
        let is_named = |code: &&str| test.contains(&letters(code));
        assert!(codes.iter().all(is_named), "{file}");
    }
    for code in Code::ALL {
        let text = code.as_str();
        let page = fs::read_to_string(root().join(format!("docs/codes/{text}.md")));
        let page = page.unwrap_or_else(|error| panic!("docs/codes/{text}.md: {error}"));
        assert!(
            page.starts_with(&format!("# {text}: ")),
            "{text}: the title"
        );
        for section in ["What happens", "Why", "Example", "What to do", "Source"] {
            let heading = format!("\n## {section}\n");
            assert!(page.contains(&heading), "{text}: no section {section}");
        }
        let explained = frictcomp(&["explain", text]);
        assert_eq!(explained.status.code(), Some(0), "{text}");
        let excused = ELSEWHERE.iter().any(|(_, codes)| codes.contains(&text));
        let has_file = shown_by_file.contains(text);
        assert!(
            has_file != excused,
            "{text}: program {has_file}, excused {excused}"
        );
    }
}

#[test]
fn no_page_is_without_its_code_or_parameter() {
    for page in files("docs/codes", &["md"]) {
        let stem = page.file_stem().expect("a name").to_string_lossy();
        let parameter = stem.starts_with("P-COMP-") || stem.starts_with("P-AXIS-");
        assert!(stem.parse::<Code>().is_ok() || parameter, "{stem}");
        let explained = frictcomp(&["explain", &stem]);
        assert_eq!(explained.status.code(), Some(0), "{stem}");
    }
}
