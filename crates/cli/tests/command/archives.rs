//! Chapter 17 of the rules for archives: main programs, calls, known findings.

use crate::folder::{Bench, json};
use serde_json::Value;

const SUB: &str = "N1 Y[COMP OFF FRICT]\nM17\n";

fn caller(called: &str) -> String {
    format!("N10 X[COMP OFF FRICT]\nN20 L {called}\nN30 M30\n")
}

/// Returns the output on stderr.
fn talk(bench: &Bench, arguments: &[&str]) -> String {
    String::from_utf8(bench.call(arguments).stderr).expect("text")
}

fn findings(bench: &Bench, arguments: &[&str]) -> Vec<Value> {
    let all = [&["check", "--format", "ndjson"], arguments].concat();
    let lines = bench.stdout(&all);
    let records = lines.lines().map(json);
    records.filter(|it| it["record"] == "diagnostic").collect()
}

#[test]
fn deep_and_wide_graphs_end() {
    // R17.2
    let bench = Bench::new(&[]);
    for number in 0..3000 {
        let text = format!("L p{}.nc\nL p{}.nc\nM17\n", number + 1, number + 1);
        bench.write(&format!("p{number}.nc"), &text);
    }
    let shown = bench.stdout(&["show", "calls", "p0.nc"]);
    assert!(shown.len() < 1_000_000, "{}", shown.len());
    assert_eq!(shown.matches("p3000.nc (line").count(), 2);
    assert!(bench.status(&["show", "calls", "-"]) == Some(2));
}

#[test]
fn inserted_lines_bring_no_finding_back() {
    // R17.3
    let program = "\
%MAIN
N10 X[COMP OFF FRICT]
N20 X[COMP OFF FRICT]
N25 $IF V.E.PART == 1
N30 Y[COMP OFF FRICT]
N40 $ENDIF
N50 G1 X10 F100
N60 L sub.nc
N70 Y[COMP ON FRCT]
N80 M30
";
    let bench = Bench::new(&[
        ("a.nc", program),
        ("sub.nc", "N1 X[COMP ON FRICT]\nN2 G900 X1\nM17\n"),
    ]);
    assert!(findings(&bench, &["."]).len() >= 4);
    assert_eq!(
        bench.status(&["check", "--write-baseline", "known.json", "."]),
        Some(0)
    );
    let mut random = fastrand::Rng::with_seed(17);
    // Ten at a time, a hundred times: 1 000 insertions.
    for _ in 0..100 {
        for name in ["a.nc", "sub.nc"] {
            let text = bench.read(name);
            let mut lines: Vec<&str> = text.lines().collect();
            for _ in 0..5 {
                let line = ["", "(inserted)", "; L none.nc", "G4 F1"][random.usize(..4)];
                lines.insert(random.usize(1..lines.len()), line);
            }
            bench.write(name, &(lines.join("\n") + "\n"));
        }
        let new = findings(&bench, &["--baseline", "known.json", "."]);
        assert_eq!(new, Vec::<Value>::new(), "{}", bench.read("a.nc"));
    }
    assert!(
        talk(&bench, &["check", "--baseline", "known.json", "."]).contains(", 0 no longer there")
    );
}

/// Returns the main programs that call three levels deep, with findings in them and in what they call.
fn deep_archive(programs: usize) -> (Bench, Vec<String>) {
    let bench = Bench::new(&[]);
    let mut names = Vec::new();
    let mut add = |name: String, text: &str| {
        bench.write(&name, text);
        names.push(name);
    };
    let levels = (programs / 50).max(1);
    for at in 0..levels {
        let calling = |called: &str| format!("N10 Y[COMP OFF FRICT]\nN20 L {called}{at}.nc\nM17\n");
        add(format!("up{at}.nc"), &calling("mid"));
        add(format!("mid{at}.nc"), &calling("low"));
        add(format!("low{at}.nc"), "N10 Y1\nN20 Z[COMP ON FRICT]\nM17\n");
    }
    for at in 0..programs {
        let called = at % levels;
        let text = format!(
            "%P{at}\nN10 X[COMP OFF FRICT]\nN20 G1 X{at} F100\nN30 L up{called}.nc\nN40 X[COMP OFF FRICT]\nN50 M30\n"
        );
        add(format!("p{at}.nc"), &text);
    }
    (bench, names)
}

/// Takes a baseline of an archive, inserts 1 000 lines anywhere, and expects no new finding.
fn insertions_bring_nothing_back(programs: usize) {
    let (bench, names) = deep_archive(programs);
    let known = findings(&bench, &["."]).len();
    assert!(known >= 2 * programs, "{known}");
    let write = ["check", "--write-baseline", "known.json", "."];
    assert_eq!(bench.status(&write), Some(0));
    let mut random = fastrand::Rng::with_seed(17);
    for _ in 0..1000 {
        let name = &names[random.usize(..names.len())];
        let text = bench.read(name);
        let mut lines: Vec<&str> = text.lines().collect();
        let line = ["", "(inserted)", "; L none.nc", "G4 F1"][random.usize(..4)];
        lines.insert(random.usize(1..lines.len()), line);
        bench.write(name, &(lines.join("\n") + "\n"));
    }
    let new = findings(&bench, &["--baseline", "known.json", "."]);
    assert_eq!(new, Vec::<Value>::new());
    let said = talk(&bench, &["check", "--baseline", "known.json", "."]);
    assert!(said.contains(", 0 no longer there"), "{said}");
}

#[test]
fn lines_inserted_all_over_an_archive_bring_no_finding_back() {
    // R17.3
    insertions_bring_nothing_back(100);
}

#[test]
#[ignore = "takes minutes"]
fn lines_inserted_all_over_a_large_archive_bring_no_finding_back() {
    // R17.3
    insertions_bring_nothing_back(20_000);
}

#[test]
fn a_baseline_that_cannot_be_used_is_refused() {
    // R17.3
    let bench = Bench::new(&[("a.nc", &caller("sub.nc")), ("sub.nc", SUB)]);
    for (text, said) in [
        ("{", "is damaged"),
        ("{}", "has no `schema`"),
        ("{\"schema\":2,\"findings\":[]}", "has schema 2"),
        (
            "{\"schema\":1,\"findings\":[{\"file\":\"a.nc\"}]}",
            "is damaged",
        ),
        ("{\"schema\":1,\"findings\":7}", "is damaged"),
    ] {
        bench.write("known.json", text);
        let output = bench.call(&["check", "--baseline", "known.json", "."]);
        let stderr = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(
            stderr.contains(said) && stderr.contains("--write-baseline"),
            "{stderr}"
        );
    }
    assert_eq!(
        bench.status(&["check", "--baseline", "none.json", "."]),
        Some(2)
    );
    let said = talk(&bench, &["check", "--baseline", ".", "a.nc"]);
    assert!(said.contains("the baseline `.` is a folder"), "{said}");
    assert_eq!(
        bench.status(&["check", "--write-baseline", "a.nc", "."]),
        Some(2)
    );
    assert_eq!(bench.read("a.nc"), caller("sub.nc"));
    // It is an input of the call that reads it.
    bench.write("known.json", "{\"schema\":1,\"findings\":[]}");
    let both = ["check", "--baseline", "known.json", "-o", "known.json", "."];
    assert_eq!(bench.status(&both), Some(2));
}
