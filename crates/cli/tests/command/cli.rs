//! The command line from outside: features without a dry run.

use crate::folder::{call, command, stderr, stdout};
use crate::workspace::root;
use std::process::Output;

fn frictcomp(arguments: &[&str]) -> Output {
    call(root(), arguments)
}

/// Returns the output of a call that must fail with status 2 and print nothing on stdout.
fn refused(arguments: &[&str]) -> String {
    let output = frictcomp(arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert_eq!(stdout(&output), "", "{arguments:?}");
    stderr(&output)
}

#[test]
fn explain_prints_the_page() {
    let by_code = frictcomp(&["explain", "P-ERR-70495"]);
    assert_eq!(by_code.status.code(), Some(0));
    assert!(stdout(&by_code).starts_with("# P-ERR-70495"));
    assert_eq!(by_code.stdout, frictcomp(&["explain", "70495"]).stdout);
    let parameter = frictcomp(&["explain", "frict_comp.position_delay"]);
    assert!(stdout(&parameter).starts_with("# P-COMP-00043"));
}

#[test]
fn codes_are_listed() {
    let text = frictcomp(&["explain"]);
    assert!(
        stdout(&text).contains("P-ERR-70495   error    friction compensation is not configured")
    );
    let json = frictcomp(&["explain", "--format", "json"]);
    let document: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    let codes = document["codes"].as_array().expect("a list");
    assert_eq!(codes.len(), stdout(&text).lines().count());
}

#[test]
fn completions_and_the_manual_page_are_printed() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = frictcomp(&["completions", shell]);
        assert_eq!(script.status.code(), Some(0), "{shell}");
        assert!(stdout(&script).contains("frictcomp"), "{shell}");
    }
    assert!(stdout(&frictcomp(&["man"])).contains(".TH frictcomp"));
}

#[test]
fn the_tool_alone_prints_its_commands_in_five_groups() {
    // R9.85
    let output = frictcomp(&[]);
    let list = stderr(&output) + &stdout(&output);
    assert_eq!(list, stdout(&frictcomp(&["-h"])));
    let headings = list.lines().filter(|line| line.ends_with(':'));
    assert_eq!(
        headings.collect::<Vec<_>>(),
        [
            "Programs:",
            "Machine:",
            "Commissioning:",
            "The control:",
            "Help:",
            "Options:",
            "Examples:"
        ]
    );
    assert!(!list.contains("conformance"), "{list}");
    assert!(stdout(&frictcomp(&["conformance", "--help"])).contains("Examples:"));
}

#[test]
fn what_cannot_be_read_is_one_clear_line() {
    // R9.26
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    assert_eq!(
        refused(&["run", "missing.nc"]),
        "error: there is no file `missing.nc`\n\
         help: check the path; it is taken from the current folder\n"
    );
    let said = refused(&["run", &path("")]);
    assert!(said.contains("is a folder, not a program"), "{said}");
    assert!(said.contains("frictcomp check"), "{said}");
    assert!(refused(&["check", &path("")]).contains("there is no program below"));
    assert!(refused(&["lists", "missing.lis"]).contains("there is no file"));
    assert!(refused(&["golden", "missing.nc"]).contains("there is no file"));
    assert!(refused(&["diff", "missing.nc", "b.nc"]).contains("there is no file"));
}

#[test]
fn a_damaged_state_file_stays_as_it_is() {
    // R9.30
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let shown = |name: &str| path(name).display().to_string();
    std::fs::write(path("a.nc"), "N10 M30\n").expect("written");
    std::fs::write(path("s.json"), "{").expect("written");
    let said = refused(&[
        "run",
        "--isolated",
        "--state",
        &shown("s.json"),
        &shown("a.nc"),
    ]);
    assert!(said.contains("is damaged"), "{said}");
    assert_eq!(std::fs::read(path("s.json")).expect("read"), b"{");
}

#[test]
fn colours_are_for_terminals() {
    // R9.27
    let plain = frictcomp(&["explain", "nothing"]);
    assert!(!stderr(&plain).contains('\u{1b}'));
    let styled = frictcomp(&["--color", "always", "explain", "nothing"]);
    assert!(stderr(&styled).contains("\u{1b}["));
}

#[test]
fn text_has_the_width_that_was_asked_for() {
    // R9.72
    let folder = tempfile::tempdir().expect("a folder");
    let program = "N10 X[COMP ON FRICT]\nN20 M30\n";
    std::fs::write(folder.path().join("a.nc"), program).expect("written");
    let widest = |arguments: &[&str], columns: Option<&str>| {
        let mut command = command(folder.path(), arguments);
        command.args(["--isolated", "a.nc"]);
        match columns {
            Some(columns) => command.env("COLUMNS", columns),
            None => command.env_remove("COLUMNS"),
        };
        let output = command.output().expect("the tool starts");
        let text = stdout(&output);
        let lines = text.lines().map(|line| line.chars().count());
        lines.max().expect("a line")
    };
    let hundred = widest(&["check"], None);
    assert!((80..=100).contains(&hundred), "{hundred}");
    assert!(widest(&["check"], Some("60")) <= 60);
    assert!(widest(&["check", "--width", "60"], Some("200")) <= 60);
    assert_eq!(widest(&["check"], Some("wide")), hundred);
    assert!(refused(&["--width", "0", "check", "a.nc"]).contains("from 20 to 1000"));
}

#[test]
fn a_closed_pipe_is_quiet() {
    // R9.26
    let mut child = command(root(), &["completions", "zsh"])
        .spawn()
        .expect("the tool starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stderr(&output), "");
}
