//! Sessions without a described machine.

use crate::folder::{Bench, json, one_line};

const OFF: &str = "X[COMP OFF FRICT]\nX1\nX[COMP OFF FRICT]\nY[COMP OFF_ALL]\nM30\n";

fn bench(program: &str) -> Bench {
    let bench = Bench::new(&[("a.nc", program)]);
    std::fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
    bench
}

#[test]
fn what_a_command_leaves_depends_on_the_machine() {
    // R1.37 R1.51
    let bench = bench(OFF);
    let text = bench.stdout(&["check", "--isolated", "--format", "concise", "a.nc"]);
    let codes: Vec<&str> = text
        .lines()
        .filter_map(|line| line.split(' ').nth(1))
        .collect();
    assert_eq!(
        codes,
        ["warning[FC408]", "info[FC402]", "warning[FC408]"],
        "{text}"
    );
    let enabled = [
        "check",
        "--isolated",
        "--enable",
        "X,Y",
        "--format",
        "concise",
        "a.nc",
    ];
    assert!(!bench.stdout(&enabled).contains("FC408"));
}

#[test]
fn nothing_says_that_there_is_nothing_to_do() {
    // R1.37
    for program in [OFF, "X1\nM30\n"] {
        let bench = bench(program);
        let text = bench.stdout(&["run", "--width", "200", "--isolated", "a.nc"]);
        let first = text.lines().next().unwrap_or_default();
        assert!(first.starts_with("no machine is described"), "{text}");
        assert!(text.contains("`frictcomp init`"), "{text}");
        assert!(!text.to_lowercase().contains("nothing to do"), "{text}");
        let page = bench.folder().join("a.html");
        bench.stdout(&["run", "--isolated", "--html", "a.html", "a.nc"]);
        let page = std::fs::read_to_string(page).unwrap();
        assert!(page.contains("No machine is described"));
        assert!(!page.to_lowercase().contains("nothing to do"));
    }
}

#[test]
fn the_session_record_says_it() {
    // R1.37
    let bench = bench(OFF);
    let records = bench.records(&["--isolated", "a.nc"]);
    let session = json(&records[0]);
    assert_eq!(session["record"], "session");
    let remark = session["remark"].as_str().unwrap_or_default();
    assert!(remark.starts_with("no machine is described"), "{remark}");
    let described = json(&bench.records(&["--enable", "X", "a.nc"])[0]);
    assert!(described.get("remark").is_none(), "{described}");
}

#[test]
fn all_axes_are_proposed_once_and_first() {
    // R1.37: in every output that depends on it.
    let text = "X[COMP ON FRICT]\nY [COMP \\\nOFF FRICT]\nC[COMP OFF LEAD]\nM30\n";
    let bench = bench(text);
    for arguments in [
        &["run", "a.nc"][..],
        &["run", "--changes", "a.nc"],
        &["check", "a.nc"],
        &["diff", "a.nc", "a.nc"],
    ] {
        let mut all = arguments.to_vec();
        all.push("--isolated");
        all.extend(["--width", "200"]);
        let shown = bench.stdout(&all);
        let first = shown.lines().next().unwrap_or_default();
        assert!(first.starts_with("no machine is described"), "{shown}");
        assert!(first.ends_with("`--enable X,Y`"), "{shown}");
        assert_eq!(shown.matches("`--enable X").count(), 1, "{shown}");
    }
    let session = json(&bench.records(&["--isolated", "a.nc"])[0]);
    let remark = session["remark"].as_str().unwrap_or_default();
    assert!(remark.ends_with("`--enable X,Y`"), "{remark}");
    for arguments in [
        &["run", "--format", "csv", "a.nc"][..],
        &["check", "--format", "concise", "a.nc"],
        &["check", "--format", "sarif", "a.nc"],
    ] {
        let mut all = arguments.to_vec();
        all.push("--isolated");
        let output = bench.call(&all);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains("`--enable X,Y`"), "{arguments:?}: {said}");
        let data = String::from_utf8(output.stdout).unwrap();
        assert!(!data.contains("no machine is described"), "{data}");
    }
    bench.stdout(&["golden", "--isolated", "--update", "a.nc"]);
    let golden = bench.read("a.nc.timeline");
    assert!(golden.starts_with("no machine is described"), "{golden}");
    // A program that switches nothing does not depend on it.
    bench.write("b.nc", "G01 X1 F100\nM30\n");
    let shown = bench.stdout(&["check", "--isolated", "b.nc"]);
    assert!(!shown.contains("no machine is described"), "{shown}");
}

/// X is described, of Y nothing is known but its name.
const NAMED: &str = "[[axis]]\nname = \"X\"\nenable = true\n[[axis]]\nname = \"Y\"\n";

fn named(programs: &[(&str, &str)]) -> Bench {
    let bench = Bench::new(programs);
    bench.write("frictcomp.toml", NAMED);
    bench
}

#[test]
fn an_axis_that_is_only_named_is_not_known() {
    // R18.2
    let leaver = "Y[COMP OFF FRICT]\nG1 Y5 F100\nM30\n";
    let bench = named(&[("a.nc", leaver), ("b.nc", "G1 Y5 F100\nM30\n")]);
    bench.write("c.nc", leaver);
    let text = bench.stdout(&["check", "--format", "concise", "."]);
    assert_eq!(text.matches("FC408").count(), 1, "{text}");
    assert!(text.starts_with("a.nc:1:1: warning[FC408]"), "{text}");
    for (program, status) in [("a.nc", 1), ("b.nc", 0)] {
        let arguments = [
            "check",
            "--ignore",
            "FC408",
            "--fail-on",
            "unknown",
            program,
        ];
        assert_eq!(bench.status(&arguments), Some(status), "{program}");
        for shown in [
            bench.stdout(&["run", program]),
            bench.stdout(&["check", program]),
        ] {
            assert!(!shown.to_lowercase().contains("nothing to do"), "{shown}");
        }
    }
    let text = bench.stdout(&["audit", "--format", "ndjson", "."]);
    let records: Vec<_> = text.lines().map(json).collect();
    let axis = records
        .iter()
        .find(|it| it["record"] == "axis" && it["axis"] == "Y");
    let axis = axis.expect("a finding");
    assert_eq!((&axis["unknown"], &axis["leavers"]), (&2.into(), &0.into()));
    assert_eq!(
        (&axis["inheritors"], &axis["cure"]),
        (&1.into(), &"none".into())
    );
    assert_eq!(records[0]["axes"]["Y"]["effect"], "unknown", "{text}");
    assert_eq!(records[0]["axes"]["Y"]["reason"]["code"], "FC408", "{text}");
    assert_eq!(
        bench.status(&["audit", "--fail-on", "unknown", "."]),
        Some(1)
    );
    let text = bench.stdout(&["audit", "."]);
    assert!(text.contains("nothing describes axis `Y`"), "{text}");
    assert!(!text.contains("no order of these programs"), "{text}");
    bench.write("order.txt", "a.nc\nb.nc\n");
    let text = bench.stdout(&["audit", "--sequence", "order.txt"]);
    assert_eq!(text.matches("Y stays unknown").count(), 2, "{text}");
}

#[test]
fn an_audit_without_a_machine_knows_nothing_of_what_is_switched() {
    // R18.2 R1.37
    let bench = bench("X[COMP OFF FRICT]\nG1 X5 Y5 F100\nM30\n");
    let text = bench.stdout(&["audit", "--isolated", "--format", "ndjson", "."]);
    let records: Vec<_> = text.lines().map(json).collect();
    let axes: Vec<_> = records.iter().filter(|it| it["record"] == "axis").collect();
    assert_eq!(axes.len(), 1, "{text}");
    assert_eq!(
        (&axes[0]["axis"], &axes[0]["unknown"]),
        (&"X".into(), &1.into())
    );
}

#[test]
fn what_init_assumes_is_said_with_every_result() {
    // R18.2 R9.73
    let bench = bench("G1 X5 Y5 F100\nX[COMP OFF FRICT]\nG1 X9\nX[COMP ON FRICT]\nM30\n");
    let output = bench.call(&["init"]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.contains("nobody knows yet: X, Y"), "{said}");
    let toml = bench.read("frictcomp.toml");
    assert_eq!(toml.matches("\nenable = true   #").count(), 2, "{toml}");
    let line = 1 + toml
        .lines()
        .position(|it| it.starts_with("enable"))
        .expect("a line");
    let assumed = format!("assuming `enable = true`, frictcomp.toml:{line} (X)");
    let run = bench
        .stdout(&["run", "--width", "200", "a.nc"])
        .to_lowercase();
    assert!(run.contains(&assumed.to_lowercase()), "{run}");
    let audit = bench.stdout(&["audit", "."]);
    assert!(audit.contains(&assumed), "{audit}");
    let check = bench.call(&["check", "."]);
    let check = String::from_utf8(check.stdout).expect("text");
    let check = one_line(&check);
    assert!(check.contains(&assumed), "{check}");
    let records = bench.records(&["a.nc"]);
    let summary = json(records.last().expect("a summary"));
    assert_eq!(summary["assuming"][0]["axis"], "X");
    assert_eq!(summary["assuming"][0]["line"], line);
    // A later program that leaves Y off is found.
    bench.write("later.nc", "Y[COMP OFF FRICT]\nG1 Y5 F100\nM30\n");
    let text = bench.stdout(&["check", "--format", "concise", "later.nc"]);
    assert!(text.contains("warning[FC401]"), "{text}");
}
