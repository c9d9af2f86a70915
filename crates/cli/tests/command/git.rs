//! Chapter 17 of the rules with git: what differs from a revision, and what reaches it.

use std::fs;
use std::process::{Command, Stdio};

use crate::folder::{Bench, MACHINE, json};
use serde_json::Value;

const SUB: &str = "N1 Y[COMP OFF FRICT]\nN2 Y[COMP ON FRICT]\nM17\n";
const SUB_NOW: &str = "N1 Y[COMP OFF FRICT]\nM17\n";

fn caller(called: &str) -> String {
    format!("N10 G1 X1 F100\nN20 L {called}\nN30 M30\n")
}

fn git(bench: &Bench, arguments: &[&str]) {
    let config = [
        "-c",
        "user.name=n",
        "-c",
        "user.email=n@example.org",
        "-c",
        "init.defaultBranch=m",
    ];
    let done = Command::new("git")
        .current_dir(bench.folder())
        .args(config)
        .args(arguments)
        .env("GIT_CONFIG_NOSYSTEM", "1")
        .env("GIT_CONFIG_GLOBAL", "/dev/null")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("git starts");
    assert!(done.success(), "git {arguments:?}");
}

fn commit(bench: &Bench) {
    git(bench, &["add", "-A"]);
    git(bench, &["commit", "-q", "--allow-empty", "-m", "state"]);
}

/// a and b call sub, deep.nc reaches it through b, alone.nc does not.
fn repository() -> Bench {
    let bench = Bench::new(&[
        ("a.nc", &caller("sub.nc")),
        ("b.nc", "N1 L sub.nc\nM17\n"),
        ("deep.nc", &caller("b.nc")),
        ("alone.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n"),
        ("sub.nc", SUB),
    ]);
    git(&bench, &["init", "-q"]);
    commit(&bench);
    bench
}

fn talk(bench: &Bench, arguments: &[&str]) -> String {
    String::from_utf8(bench.call(arguments).stderr).expect("text")
}

/// The number of programs that `check --changed` checks, and the codes that it finds.
fn changed(bench: &Bench, arguments: &[&str]) -> (String, Vec<String>) {
    let all = [&["check", "--format", "ndjson", "--changed"], arguments].concat();
    let output = bench.call(&all);
    let said = String::from_utf8(output.stderr).expect("text");
    let first = said
        .lines()
        .find(|it| it.contains("programs differ"))
        .unwrap_or(&said);
    let records = String::from_utf8(output.stdout).expect("text");
    let records = records
        .lines()
        .map(json)
        .filter(|it| it["record"] == "diagnostic");
    let codes = records.map(|it| it["code"].as_str().unwrap_or_default().to_owned());
    (first.to_owned(), codes.collect())
}

/// The programs that `diff --git` compares, with their verdicts.
fn compared(bench: &Bench, arguments: &[&str]) -> Vec<String> {
    let all = [&["diff", "--format", "json"], arguments].concat();
    let output = bench.call(&all);
    let text = String::from_utf8(output.stdout).expect("text");
    let programs = json(&text)["programs"]
        .as_array()
        .cloned()
        .unwrap_or_default();
    let word = |it: &Value, key: &str| it[key].as_str().unwrap_or_default().to_owned();
    let shown = programs.iter();
    shown
        .map(|it| {
            format!(
                "{} {} {}",
                word(it, "old"),
                word(it, "new"),
                word(it, "verdict")
            )
        })
        .collect()
}

#[test]
fn only_what_reaches_a_change_is_checked() {
    // R17.4
    let bench = repository();
    let (said, codes) = changed(&bench, &["HEAD", "."]);
    assert!(
        said.starts_with("none of 5 programs differs from `HEAD`"),
        "{said}"
    );
    assert!(codes.is_empty());
    bench.write("sub.nc", SUB_NOW);
    let (said, codes) = changed(&bench, &["HEAD", "."]);
    assert_eq!(
        said,
        "4 of 5 programs differ from `HEAD` or reach one that does"
    );
    assert_eq!(codes, ["FC401"]);
    // A revision is not required, and a first path is not one.
    assert_eq!(changed(&bench, &[]).1, ["FC401"]);
    assert_eq!(changed(&bench, &["."]).1, ["FC401"]);
    // Programs that git does not track yet count.
    commit(&bench);
    bench.write("new.nc", "N10 Y[COMP OFF FRICT]\nN20 M30\n");
    let (said, codes) = changed(&bench, &["HEAD", "."]);
    assert!(said.starts_with("1 of 6 programs"), "{said}");
    assert_eq!(codes, ["FC401"]);
    assert!(
        changed(&bench, &["HEAD~1", "."])
            .0
            .starts_with("5 of 6 programs")
    );
}

#[test]
fn names_may_be_of_any_form() {
    // R17.4: blanks, umlauts, a folder below the top, where the command is called.
    let bench = Bench::new(&[]);
    fs::create_dir_all(bench.folder().join("Werk 1/Pr\u{fc}fung")).expect("folders");
    let deep = |name: &str| format!("Werk 1/Pr\u{fc}fung/{name}");
    bench.write(&deep("Nut fr\u{e4}sen.nc"), &caller("\"sub \u{fc}.nc\""));
    bench.write(&deep("sub \u{fc}.nc"), SUB);
    git(&bench, &["init", "-q"]);
    commit(&bench);
    bench.write(&deep("sub \u{fc}.nc"), SUB_NOW);
    assert!(
        changed(&bench, &["HEAD", "."])
            .0
            .starts_with("2 of 2 programs")
    );
    let below = |arguments: &[&str]| {
        let mut command = bench.command(arguments);
        let output = command
            .current_dir(bench.folder().join("Werk 1/Pr\u{fc}fung"))
            .output();
        let output = output.expect("the tool starts");
        String::from_utf8(output.stdout).expect("text")
    };
    let shown = below(&["diff", "--git", "HEAD"]);
    assert!(
        shown.contains("--- HEAD:Nut fr\u{e4}sen.nc\n+++ Nut fr\u{e4}sen.nc"),
        "{shown}"
    );
    assert!(
        shown.contains("--- HEAD:sub \u{fc}.nc\n+++ sub \u{fc}.nc"),
        "{shown}"
    );
    let checked = below(&["check", "--changed", "--format", "concise"]);
    assert!(checked.starts_with("sub \u{fc}.nc:1:"), "{checked}");
}

#[test]
fn switches_are_compared_with_a_revision() {
    // R17.4
    let bench = repository();
    assert_eq!(compared(&bench, &["--git", "HEAD"]), [""; 0]);
    assert_eq!(bench.status(&["diff", "--git", "HEAD"]), Some(0));
    bench.write("sub.nc", SUB_NOW);
    git(&bench, &["mv", "alone.nc", "renamed.nc"]);
    assert_eq!(
        compared(&bench, &["--git", "HEAD"]),
        [
            "HEAD:a.nc a.nc different",
            "HEAD:b.nc b.nc different",
            "HEAD:deep.nc deep.nc different",
            "HEAD:alone.nc renamed.nc same",
            "HEAD:sub.nc sub.nc different",
        ]
    );
    assert_eq!(bench.status(&["diff", "--git", "HEAD"]), Some(1));
    let text = bench.stdout(&["diff", "--git", "HEAD", "a.nc"]);
    // R18.22
    assert!(
        text.starts_with("Y is now inactive at the end (before: active); "),
        "{text}"
    );
    assert!(
        text.contains("sub.nc:2") && text.contains("N2 Y[COMP ON FRICT]"),
        "{text}"
    );
    let said = talk(&bench, &["diff", "--git", "HEAD"]);
    assert!(
        said.contains("5 programs compared with `HEAD`: 1 switch the same"),
        "{said}"
    );
}

#[test]
fn new_and_deleted_programs_are_compared_with_nothing() {
    // R17.4
    let bench = repository();
    fs::remove_file(bench.folder().join("alone.nc")).expect("removed");
    fs::remove_file(bench.folder().join("sub.nc")).expect("removed");
    bench.write("new.nc", "N10 X[COMP OFF FRICT]\nN20 G1 Y7 F3\nN30 M30\n");
    let shown = compared(&bench, &["--git", "HEAD"]);
    assert!(
        shown.contains(&"/dev/null new.nc different".to_owned()),
        "{shown:?}"
    );
    assert!(
        shown.contains(&"HEAD:alone.nc /dev/null different".to_owned()),
        "{shown:?}"
    );
    // Callers of a removed program reach the change.
    assert!(
        shown.iter().any(|it| it.starts_with("HEAD:a.nc a.nc ")),
        "{shown:?}"
    );
    let (said, codes) = changed(&bench, &["HEAD", "."]);
    assert!(said.starts_with("4 of 4 programs"), "{said}");
    assert!(codes.contains(&"FC320".to_owned()), "{codes:?}");
}

#[test]
fn another_configuration_concerns_all_its_programs() {
    // R17.4
    let bench = repository();
    bench.write(
        "frictcomp.toml",
        &MACHINE.replace("mode = 3, table", "mode = 0, table"),
    );
    assert!(
        changed(&bench, &["HEAD", "."])
            .0
            .starts_with("5 of 5 programs")
    );
    let said = talk(&bench, &["diff", "--git", "HEAD"]);
    assert!(
        said.contains("both versions run on the current machine"),
        "{said}"
    );
    git(&bench, &["checkout", "-q", "frictcomp.toml"]);
    // A list that the configuration names, and one that is gone.
    bench.write("x.lis", "frict_comp.mode 3\nEnde\n");
    bench.write(
        "frictcomp.toml",
        "[[axis]]\nname = \"X\"\nfrict_comp = true\nvalue_list = \"x.lis\"\n",
    );
    commit(&bench);
    assert!(changed(&bench, &["HEAD", "."]).0.starts_with("none of 5"));
    bench.write("x.lis", "frict_comp.mode 0\nEnde\n");
    assert!(
        changed(&bench, &["HEAD", "."])
            .0
            .starts_with("5 of 5 programs")
    );
}

#[test]
fn before_the_first_commit_everything_is_new() {
    // R17.4
    let bench = Bench::new(&[("a.nc", "M30\n"), ("b.nc", "M30\n")]);
    git(&bench, &["init", "-q"]);
    git(&bench, &["add", "a.nc"]);
    assert!(
        changed(&bench, &["HEAD", "."])
            .0
            .starts_with("2 of 2 programs")
    );
    assert_eq!(bench.status(&["diff", "--git", "HEAD"]), Some(0));
}

#[test]
fn what_git_cannot_say_is_an_error() {
    // R17.4
    let bench = Bench::new(&[("a.nc", "M30\n")]);
    let refused = |arguments: &[&str]| {
        let output = bench.call(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).expect("text")
    };
    for command in [
        &["diff", "--git", "HEAD"] as &[&str],
        &["check", "--changed"],
    ] {
        assert!(
            refused(command).contains("is in no git repository"),
            "{command:?}"
        );
    }
    git(&bench, &["init", "-q"]);
    assert!(refused(&["check", "--changed=gone"]).contains("there is no revision `gone`"));
    commit(&bench);
    let said = refused(&["diff", "--git", "gone"]);
    assert!(
        said.contains("there is no revision `gone`") && said.contains("git log"),
        "{said}"
    );
    assert!(refused(&["diff", "--git=--output=x"]).contains("there is no revision"));
    assert!(!bench.folder().join("x").exists());
    let mut command = bench.command(&["check", "--changed"]);
    let output = command
        .env("PATH", bench.folder())
        .output()
        .expect("the tool starts");
    let said = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("the command `git`, which is not installed"),
        "{said}"
    );
    assert!(refused(&["diff", "a.nc"]).contains("frictcomp diff OLD NEW"));
}

#[test]
fn what_git_does_not_follow_is_named() {
    // R17.4
    let bench = repository();
    bench.write(".gitignore", "made.nc\n");
    bench.write("made.nc", SUB);
    bench.write("a.nc", &caller("made.nc"));
    let said = talk(&bench, &["check", "--changed", "."]);
    assert!(
        said.contains("git does not track `made.nc`: changes there are not seen"),
        "{said}"
    );
    commit(&bench);
    let said = talk(&bench, &["diff", "--git", "HEAD", "."]);
    assert!(said.contains("git does not track `made.nc`"), "{said}");
    assert!(!talk(&bench, &["check", "--changed", "b.nc"]).contains("does not follow"));
}

#[test]
fn ten_thousand_changed_files_are_compared() {
    // R17.4
    let bench = Bench::new(&[]);
    for number in 0..10_000 {
        bench.write(
            &format!("p{number:05}.nc"),
            &format!("N10 X{number}\nN20 M30\n"),
        );
    }
    git(&bench, &["init", "-q"]);
    commit(&bench);
    for number in 0..10_000 {
        bench.write(
            &format!("p{number:05}.nc"),
            &format!("N10 X{number} F1\nN20 M30\n"),
        );
    }
    bench.write("p00007.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
    let output = bench.call(&["diff", "--git", "HEAD"]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(
        said.contains("10000 programs compared with `HEAD`: 9999 switch the same"),
        "{said}"
    );
}

#[test]
fn a_renamed_program_concerns_those_that_call_its_old_name() {
    // R17.4
    let bench = repository();
    git(&bench, &["mv", "sub.nc", "part.nc"]);
    let (said, codes) = changed(&bench, &["HEAD", "."]);
    assert!(said.starts_with("4 of 5 programs"), "{said}");
    assert_eq!(codes, ["FC320", "FC320"]);
    // The callers follow: nothing switches differently.
    bench.write("a.nc", &caller("part.nc"));
    bench.write("b.nc", "N1 L part.nc\nM17\n");
    let shown = compared(&bench, &["--git", "HEAD"]);
    assert!(
        shown.contains(&"HEAD:sub.nc part.nc same".to_owned()),
        "{shown:?}"
    );
    assert!(shown.iter().all(|it| it.ends_with(" same")), "{shown:?}");
    // The control does not distinguish the cases.
    commit(&bench);
    git(&bench, &["mv", "part.nc", "PART.NC"]);
    assert_eq!(changed(&bench, &["HEAD", "."]).1, [""; 0]);
    assert_eq!(bench.status(&["diff", "--git", "HEAD"]), Some(0));
}

#[test]
fn programs_of_one_name_concern_their_own_callers() {
    // R17.4
    let bench = Bench::new(&[]);
    for folder in ["one", "two"] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
        bench.write(&format!("{folder}/a.nc"), &caller("sub.nc"));
        bench.write(&format!("{folder}/sub.nc"), SUB);
    }
    git(&bench, &["init", "-q"]);
    commit(&bench);
    bench.write("two/sub.nc", SUB_NOW);
    let (said, codes) = changed(&bench, &["HEAD", "."]);
    assert!(said.starts_with("2 of 4 programs"), "{said}");
    assert_eq!(codes, ["FC401"]);
    assert_eq!(
        compared(&bench, &["--git", "HEAD"]),
        [
            "HEAD:two/a.nc two/a.nc different",
            "HEAD:two/sub.nc two/sub.nc different",
        ]
    );
}

#[test]
fn a_change_in_a_circle_of_calls_concerns_all_of_it() {
    // R17.4
    let ring = |called: &str| format!("N10 L {called}\nM17\n");
    let bench = Bench::new(&[
        ("ring-a.nc", &ring("ring-b.nc")),
        ("ring-b.nc", &ring("ring-c.nc")),
        ("ring-c.nc", &ring("ring-a.nc")),
        ("alone.nc", "M30\n"),
    ]);
    git(&bench, &["init", "-q"]);
    commit(&bench);
    bench.write("ring-b.nc", "N5 X1\nN10 L ring-c.nc\nM17\n");
    let (said, codes) = changed(&bench, &["HEAD", "."]);
    assert!(said.starts_with("3 of 4 programs"), "{said}");
    assert!(
        !codes.is_empty() && codes.iter().all(|it| it == "FC911"),
        "{codes:?}"
    );
    let shown = compared(&bench, &["--git", "HEAD"]);
    assert_eq!(shown.len(), 3, "{shown:?}");
    assert!(
        shown.iter().all(|it| it.ends_with(" not-comparable")),
        "{shown:?}"
    );
}

#[test]
fn a_called_program_above_the_folder_concerns_its_callers_there() {
    // R17.4: the work tree is larger than the project.
    let bench = Bench::new(&[]);
    for folder in ["parts", "shared"] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
    }
    let machine = format!("[machine]\nprogram_dirs = [\"../shared\"]\n{MACHINE}");
    bench.write("parts/frictcomp.toml", &machine);
    bench.write("parts/a.nc", &caller("sub.nc"));
    bench.write("shared/sub.nc", SUB);
    git(&bench, &["init", "-q"]);
    commit(&bench);
    git(&bench, &["worktree", "add", "-q", "second", "HEAD"]);
    for top in ["", "second/"] {
        bench.write(&format!("{top}shared/sub.nc"), SUB_NOW);
        let below = |arguments: &[&str]| {
            let mut command = bench.command(arguments);
            let folder = bench.folder().join(format!("{top}parts"));
            let output = command.current_dir(folder).output();
            String::from_utf8(output.expect("the tool starts").stdout).expect("text")
        };
        let checked = below(&["check", "--changed", "--format", "concise"]);
        assert!(checked.starts_with("../shared/sub.nc:1:"), "{checked}");
        let shown = below(&["diff", "--git", "HEAD"]);
        assert!(shown.contains("\n--- HEAD:a.nc\n+++ a.nc\n"), "{shown}");
        assert!(shown.contains("- ../shared/sub.nc:2"), "{shown}");
    }
}

#[test]
fn a_configuration_that_cannot_be_read_is_an_error_only_today() {
    // R17.4
    let bench = Bench::new(&[("a.nc", "N10 X1\nN20 M30\n")]);
    bench.write("frictcomp.toml", "[[axis\n");
    git(&bench, &["init", "-q"]);
    commit(&bench);
    bench.write("frictcomp.toml", MACHINE);
    bench.write("a.nc", "N10 X2\nN20 M30\n");
    assert_eq!(
        compared(&bench, &["--git", "HEAD"]),
        ["HEAD:a.nc a.nc same"]
    );
    commit(&bench);
    bench.write("frictcomp.toml", "[[axis\n");
    for command in [
        &["diff", "--git", "HEAD"] as &[&str],
        &["check", "--changed"],
    ] {
        assert_eq!(bench.status(command), Some(2), "{command:?}");
        assert!(talk(&bench, command).contains("FC110"), "{command:?}");
    }
}
