//! Chapter 17 of the rules for archives: main programs, calls, known findings.

use std::fs;

use crate::folder::{Bench, json};
use serde_json::{Value, json as object};

const SUB: &str = "N1 Y[COMP OFF FRICT]\nM17\n";

fn caller(called: &str) -> String {
    format!("N10 X[COMP OFF FRICT]\nN20 L {called}\nN30 M30\n")
}

/// The output on stderr.
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
fn a_called_program_is_checked_in_its_callers() {
    // R17.2: Y is switched off for the caller to switch it on again.
    let on = "N10 L sub.nc\nN20 Y[COMP ON FRICT]\nN30 M30\n";
    let bench = Bench::new(&[("a.nc", on), ("sub.nc", SUB)]);
    assert_eq!(findings(&bench, &["."]), Vec::<Value>::new());
    let said = talk(&bench, &["check", "-v", "."]);
    assert!(said.contains("1 file checked"), "{said}");
    assert!(
        said.contains("1 called program was checked in its callers"),
        "{said}"
    );
    for arguments in [&["--all", "."] as &[&str], &["sub.nc"]] {
        let found = findings(&bench, arguments);
        assert_eq!(found.len(), 1, "{arguments:?}");
        assert_eq!(
            (&found[0]["code"], &found[0]["file"]),
            (&"FC401".into(), &"sub.nc".into())
        );
    }
    // A program that ends itself is a main program, whoever calls it.
    bench.write("sub.nc", "N1 Y[COMP OFF FRICT]\nM30\n");
    assert!(talk(&bench, &["check", "-v", "."]).contains("2 files checked"));
    // So is one from which no main program returns.
    bench.write("sub.nc", SUB);
    bench.write(
        "a.nc",
        "N10 $IF 1 == 2\nN20 L sub.nc\nN30 $ENDIF\nN40 M30\n",
    );
    assert!(talk(&bench, &["check", "-v", "."]).contains("2 files checked"));
}

#[test]
fn blocks_of_a_called_program_that_nobody_executes_are_checked() {
    // R17.2
    let sub = "N1 $IF 1 == 2\nN2 X[COMP ON FRCT]\nN3 $ENDIF\nM17\n";
    let bench = Bench::new(&[("a.nc", "L sub.nc\nM30\n"), ("sub.nc", sub)]);
    let found = findings(&bench, &["."]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        (&found[0]["file"], &found[0]["line"]),
        (&"sub.nc".into(), &2.into())
    );
    assert_eq!(found[0]["reached_from"], object!(["a.nc"]));
}

#[test]
fn programs_that_only_call_each_other_are_checked() {
    // R17.2
    let text = |called: &str| format!("Y[COMP OFF FRICT]\n$IF V.E.A\nL {called}\n$ENDIF\nM17\n");
    let bench = Bench::new(&[("a.nc", &text("b.nc")), ("b.nc", &text("a.nc"))]);
    let found = findings(&bench, &["."]);
    let files = |code: &str| {
        let of_code = found.iter().filter(|it| it["code"] == code);
        of_code.map(|it| it["file"].clone()).collect::<Vec<_>>()
    };
    assert!(files("FC401").contains(&"a.nc".into()), "{found:?}");
    assert!(files("FC401").contains(&"b.nc".into()), "{found:?}");
    assert!(talk(&bench, &["check", "-v", "."]).contains("2 files checked"));
}

/// a calls sub and a missing one, sub calls deep; ring-a and ring-b call each other; two drill.nc.
fn archive() -> Bench {
    let bench = Bench::new(&[
        ("a.nc", "N10 L sub.nc\nL meas.nc\nL V.P.NAME\nM30\n"),
        ("sub.nc", "X1\nL one/drill.nc\nL two/drill.nc\nM17\n"),
        ("ring-a.nc", "L ring-b.nc\nM17\n"),
        ("ring-b.nc", "L ring-a.nc\nM17\n"),
        ("old.nc", "X1\nM17\n"),
    ]);
    for folder in ["one", "two"] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
        bench.write(&format!("{folder}/drill.nc"), "Z1\nM17\n");
    }
    bench
}

#[test]
fn calls_are_shown_as_a_tree() {
    // R17.2
    let bench = archive();
    let shown = bench.stdout(&["show", "calls", "."]);
    assert_eq!(
        shown,
        "\
7 programs, 4 main programs, 2 that no program calls; 1 call of missing programs

a.nc
  meas.nc (line 2): missing
  a program known only at run time (line 3)
  sub.nc (line 1)
    one/drill.nc (line 2)
    two/drill.nc (line 3)
old.nc
ring-a.nc
  ring-b.nc (line 1)
    ring-a.nc (line 1), see above
call each other in a cycle: ring-a.nc, ring-b.nc
one name in several folders: one/drill.nc, two/drill.nc
"
    );
    let dot = bench.stdout(&["show", "calls", "--format", "dot", "sub.nc"]);
    assert!(dot.starts_with("digraph calls {"), "{dot}");
    assert!(
        dot.contains("\"sub.nc\" -> \"one/drill.nc\" [label=\"2\"]"),
        "{dot}"
    );
}

#[test]
fn calls_are_a_document() {
    // R17.2
    let bench = archive();
    let graph = json(&bench.stdout(&["show", "calls", "--format", "json", "."]));
    assert_eq!(graph["schema"], 1);
    let programs = graph["programs"].as_array().expect("programs");
    let of = |name: &str| {
        programs
            .iter()
            .find(|it| it["file"] == name)
            .expect("a program")
    };
    assert_eq!(
        *of("a.nc"),
        object!({
            "file": "a.nc", "main": true, "open": [3], "called_by": [],
            "calls": [{ "file": "sub.nc", "line": 1 }],
        })
    );
    assert_eq!(
        (&of("sub.nc")["main"], &of("old.nc")["main"]),
        (&false.into(), &true.into())
    );
    assert_eq!(of("one/drill.nc")["called_by"], object!(["sub.nc"]));
    assert_eq!(
        graph["missing"],
        object!([{ "file": "a.nc", "line": 2, "name": "meas.nc" }])
    );
    assert_eq!(graph["circles"], object!([["ring-a.nc", "ring-b.nc"]]));
    assert_eq!(
        graph["same_name"],
        object!([["one/drill.nc", "two/drill.nc"]])
    );
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
fn known_findings_are_not_listed() {
    // R17.3
    let bench = Bench::new(&[("a.nc", &caller("sub.nc")), ("sub.nc", SUB)]);
    bench.write("bad.nc", "N10 Q[COMP ON FRICT]\nN20 M30\n");
    let all = findings(&bench, &["."]);
    let errors = all.iter().filter(|it| it["severity"] == "error").count();
    assert!(errors > 0 && all.len() > errors, "{all:?}");
    let written = bench.call(&["check", "--write-baseline", "known.json", "."]);
    assert_eq!((written.status.code(), written.stdout.len()), (Some(0), 0));
    let said = String::from_utf8(written.stderr).expect("text");
    assert!(
        said.contains(&format!("baseline: {} findings written", all.len())),
        "{said}"
    );

    let known = ["check", "--baseline", "known.json", "."];
    let output = bench.call(&known);
    let shown = String::from_utf8_lossy(&output.stdout);
    let verdict = "2 programs are clean beyond the baseline\n";
    assert_eq!((output.status.code(), &*shown), (Some(0), verdict));
    // Errors of the control are counted even if nothing else is reported.
    for quiet in [&known[..], &[&known[..], &["-q"]].concat()] {
        let said = talk(&bench, quiet);
        let expected = format!(
            "baseline: {} known findings ({errors} error{} of the control), 0 no longer there",
            all.len(),
            if errors == 1 { "" } else { "s" },
        );
        assert!(said.contains(&expected), "{said}");
    }
    // One more of the same is new, on the line of the last one.
    bench.write(
        "bad.nc",
        "N10 Q[COMP ON FRICT]\nN10 Q[COMP ON FRICT]\nN20 M30\n",
    );
    let new = findings(&bench, &["--baseline", "known.json", "."]);
    assert_eq!(new.len(), 1, "{new:?}");
    assert_eq!(
        (&new[0]["line"], bench.status(&known)),
        (&2.into(), Some(1))
    );
    // Findings that are gone are reported, even if their program is gone.
    fs::remove_file(bench.folder().join("bad.nc")).expect("removed");
    assert!(talk(&bench, &known).contains("no longer there"));
    assert!(!talk(&bench, &known).contains(", 0 no longer there"));
    // A call about other programs does not report it as missing.
    bench.write("bad.nc", "M30\n");
    assert!(talk(&bench, &["check", "--baseline", "known.json", "a.nc"]).contains(", 0 no longer"));
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

/// Main programs that call three levels deep, with findings in them and in what they call.
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
