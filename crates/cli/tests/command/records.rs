//! Chapter 9 of the rules from outside: records, exit statuses, the state file.

use std::fs;
use std::time::Duration;

use crate::folder::{Bench, MACHINE, json};
use serde_json::Value;

/// The values of a key, in order.
fn column<'a>(records: &'a [Value], key: &str) -> Vec<&'a Value> {
    records.iter().map(|record| &record[key]).collect()
}

const LEAVE_OFF: &str = "%A\nN10 X[COMP OFF FRICT]\nN20 M30\n";
const SWITCH_ON: &str = "N10 X[COMP ON FRICT]\nN20 M30\n";
const NOT_CONFIGURED: &str = "N10 Z[COMP ON FRICT]\nN20 Y[COMP OFF FRICT]\nN30 M30\n";

#[test]
fn records_have_their_keys_in_order() {
    // R9.10, R9.12, R9.13, R9.14, R15.3
    let bench = Bench::new(&[("a.nc", NOT_CONFIGURED)]);
    let lines = bench.records(&["--keep-going", "a.nc"]);
    let states = r#""friction":{"X":"active","Y":"active","Z":"unconfigured"}}"#;
    let left = r#""friction":{"X":"active","Y":"inactive","Z":"unconfigured"}}"#;
    assert_eq!(lines.len(), 9, "{lines:#?}");
    assert!(lines[0].starts_with(r#"{"record":"session","schema":2,"tool":"frictcomp "#));
    assert!(lines[0].ends_with(&format!(r#""axes":["X","Y","Z"],{states}"#)));
    let program = r#"{"record":"program","program":1,"file":"a.nc","name":null,"#;
    assert_eq!(lines[1], format!("{program}{states}"));
    let block = r#"{"record":"block","program":1,"seq":1,"file":"a.nc","line":1,"n":10,"text":"N10 Z[COMP ON FRICT]","changes":[],"#;
    assert_eq!(lines[2], format!("{block}{states}"));
    let diagnostic = r#"{"record":"diagnostic","program":1,"seq":1,"code":"P-ERR-70495","severity":"error","file":"a.nc","line":1,"column":5,"end_line":1,"end_column":21,"axis":"Z","message":""#;
    assert!(lines[3].starts_with(diagnostic), "{}", lines[3]);
    assert!(lines[3].contains(r#","help":[""#));
    let change = r#""changes":[{"axis":"Y","kind":"FRICT","from":"active","to":"inactive"}],"#;
    assert!(
        lines[4].ends_with(&format!("{change}{left}")),
        "{}",
        lines[4]
    );
    assert!(lines[6].contains(r#""code":"FC401""#), "{}", lines[6]);
    let end = r#"{"record":"end","program":1,"seq":3,"by":"M30","#;
    assert_eq!(lines[7], format!("{end}{left}"));
    let summary =
        r#"{"record":"summary","programs":1,"blocks":3,"errors":1,"warnings":1,"opaque":{},"#;
    let rests_on = r#""rests_on":[{"rule":"R1.28","reading":"kept","meaning":"a reset keeps the state","basis":"assumed"}],"#;
    let verdict = r#","headline":{"standing":"bad","text":"the control stops at the first error: correct it, then check the states again; Y is left off"}}"#;
    let left = left.strip_suffix('}').expect("an object");
    assert_eq!(lines[8], format!("{summary}{rests_on}{left}{verdict}"));
    // The records as one document.
    let document = json(&bench.stdout(&["run", "--keep-going", "--format", "json", "a.nc"]));
    assert!(document.to_string().contains("P-ERR-70495"));
}

#[test]
fn blocks_are_counted_and_named_by_their_lines() {
    // R9.10, R9.11
    let program = "%L SUB\nN5 X1\nN6 M17\n%MAIN\n\n; comment\n/N10 Y1\nN20 X[COMP ON \\\n  FRICT]  \n\
                   G1 X2\n#VAR\nV.L.A = 1\n#ENDVAR\n$FOR P1 = 1, 2, 1\nLL SUB\n$ENDFOR\nM30\n";
    let bench = Bench::new(&[("a.nc", program)]);
    let blocks = bench.blocks(&["--skip", "1", "a.nc"]);
    let seqs: Vec<u64> = blocks.iter().filter_map(|it| it["seq"].as_u64()).collect();
    assert_eq!(seqs, (1..=blocks.len() as u64).collect::<Vec<_>>());
    let lines: Vec<u64> = blocks.iter().filter_map(|it| it["line"].as_u64()).collect();
    assert_eq!(lines, [8, 10, 11, 14, 15, 2, 3, 16, 15, 2, 3, 16, 17]);
    assert_eq!(blocks[0]["text"], "N20 X[COMP ON \\\n  FRICT]");
    assert_eq!(blocks[0]["n"], 20);
    assert!(blocks[1]["n"].is_null());
    let inside = blocks.iter().find(|it| it["line"] == 2).expect("a call");
    assert_eq!(inside["level"], 1);
    assert!(inside.to_string().contains("X1"));
    assert!(blocks[0].get("level").is_none());
}

#[test]
fn other_kinds_have_an_object_of_their_own() {
    // R9.12
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let block = &bench.blocks(&["--kinds", "all", "a.nc"])[0];
    assert_eq!(block["compensation"]["X"]["FRICT"], "inactive");
    assert_eq!(block["compensation"]["X"]["LEAD"], "unconfigured");
    assert!(bench.blocks(&["a.nc"])[0].get("compensation").is_none());
}

#[test]
fn csv_has_a_row_a_block() {
    // R9.15
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let text = bench.stdout(&["run", "--format", "csv", "a.nc"]);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = reader
        .headers()
        .expect("a header")
        .iter()
        .map(str::to_owned)
        .collect();
    let expected = [
        "program", "seq", "file", "line", "n", "text", "X", "Y", "Z", "changes", "codes", "branch",
    ];
    assert_eq!(header, expected);
    assert_eq!(reader.records().count(), 2);
}

/// The rows of `run --format csv`: line, state of X, codes and branch.
fn csv_rows(program: &str) -> Vec<[String; 4]> {
    let bench = Bench::new(&[("a.nc", program)]);
    let text = bench.stdout(&["run", "--format", "csv", "a.nc"]);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let at = |name: &str| header.iter().position(|it| it == name).expect(name);
    let columns = ["line", "X", "codes", "branch"].map(at);
    let rows = reader.records().map(|row| {
        let row = row.expect("as many fields as the header");
        columns.map(|column| row[column].to_owned())
    });
    rows.collect()
}

#[test]
fn csv_names_branches_last_and_has_a_row_where_ways_meet() {
    // R14.2
    let rows = csv_rows(
        "N10 $IF V.E.A == 2\nN20 X[COMP OFF FRICT]\nN30 $ELSE\nN40 X1\nN50 $ENDIF\nN60 Y1\n\
         N70 X[COMP ON FRICT]\nN80 M30\n",
    );
    let branches = rows
        .iter()
        .map(|[line, x, _, branch]| (&**line, &**x, &**branch));
    assert_eq!(
        branches.collect::<Vec<_>>(),
        [
            ("1", "active", ""),
            ("2", "inactive", "V.E.A == 2 (line 1)"),
            ("3", "inactive", "V.E.A == 2 (line 1)"),
            ("3", "active", "not V.E.A == 2 (line 1)"),
            ("4", "active", "not V.E.A == 2 (line 1)"),
            ("5", "active", "not V.E.A == 2 (line 1)"),
            ("6", "unknown", "join"),
            ("6", "unknown", ""),
            ("7", "active", ""),
            ("8", "active", ""),
        ]
    );
}

#[test]
fn ways_that_meet_at_program_end_have_a_last_row() {
    // R14.2, R14.3: the row before is that of one way, on which X is active.
    let rows = csv_rows("$IF V.E.A == 2\nX[COMP OFF FRICT]\nM30\n$ENDIF\nX1\nM30\n");
    let [.., before, last] = &rows[..] else {
        panic!("{rows:?}");
    };
    assert_eq!(before[1..], ["active", "", "not V.E.A == 2 (line 1)"]);
    assert_eq!(last[..2], ["6", "unknown"]);
    assert!(last[2].contains("FC401"), "{last:?}");
    assert_eq!(last[3], "join");
    let decided = csv_rows("X[COMP OFF FRICT]\nM30\n");
    assert!(decided.iter().all(|row| row[3].is_empty()), "{decided:?}");
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    // R9.16
    let bench = Bench::new(&[("a.nc", NOT_CONFIGURED)]);
    for format in ["text", "ndjson", "json", "csv"] {
        let arguments = ["run", "--keep-going", "--format", format, "a.nc"];
        let (one, two) = (bench.stdout(&arguments), bench.stdout(&arguments));
        assert_eq!(one, two);
        assert!(
            !one.contains(&bench.folder().display().to_string()),
            "{one}"
        );
    }
}

#[test]
fn the_first_error_stops_the_session() {
    // R9.14, R9.20
    let bench = Bench::new(&[("a.nc", NOT_CONFIGURED), ("b.nc", SWITCH_ON)]);
    let lines = bench.records(&["a.nc", "b.nc"]);
    assert!(lines.iter().any(|line| line.contains(r#""by":"error""#)));
    assert!(
        !lines.iter().any(|line| line.contains("b.nc")),
        "{lines:#?}"
    );
    let output = bench.call(&["run", "a.nc", "b.nc"]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.contains("1 more program did not run"), "{said}");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(!text.contains("nothing to do"), "{text}");
    let lines = bench.records(&["--keep-going", "a.nc", "b.nc"]);
    assert!(lines.iter().any(|line| line.contains(r#""file":"b.nc""#)));
    let checked = bench.stdout(&["check", "--format", "concise", "a.nc"]);
    assert!(
        checked.contains("P-ERR-70495") && checked.contains("FC401"),
        "{checked}"
    );
    for (text, by) in [("G90\nM02\n", "M02"), ("G90\n", "end-of-file")] {
        bench.write("c.nc", text);
        let lines = bench.records(&["c.nc"]);
        assert!(
            lines
                .iter()
                .any(|line| line.contains(&format!(r#""by":"{by}""#)))
        );
    }
    let lines = bench.records(&["--max-blocks", "1", "b.nc"]);
    assert!(
        lines.iter().any(|line| line.contains(r#""by":"budget""#)),
        "{lines:#?}"
    );
}

#[test]
fn the_exit_status_follows_the_severity() {
    // R9.26, R9.28
    let bench = Bench::new(&[
        ("a.nc", NOT_CONFIGURED),
        ("w.nc", LEAVE_OFF),
        ("i.nc", &SWITCH_ON.repeat(2).replacen("N20 M30", "", 1)),
    ]);
    let status = |level: &str, name: &str| bench.status(&["run", "--fail-on", level, name]);
    assert_eq!(bench.status(&["run", "a.nc"]), Some(1));
    assert_eq!(status("never", "a.nc"), Some(0));
    assert_eq!(bench.status(&["run", "w.nc"]), Some(0));
    assert_eq!(status("warning", "w.nc"), Some(1));
    assert_eq!(status("warning", "i.nc"), Some(0));
    assert_eq!(status("info", "i.nc"), Some(1));
    assert_eq!(bench.status(&["run", "missing.nc"]), Some(2));
    // R18.1: a warning that the control stops.
    bench.write("s.nc", "N10 #ERROR [ID=1 RC=2]\nN20 M30\n");
    assert_eq!(bench.status(&["run", "s.nc"]), Some(1));
    assert_eq!(status("never", "s.nc"), Some(0));
    bench.write(
        "frictcomp.toml",
        &format!("{MACHINE}[lint]\nFC401 = \"error\"\nFC402 = \"off\"\n"),
    );
    assert_eq!(bench.status(&["run", "w.nc"]), Some(1));
    assert_eq!(status("info", "i.nc"), Some(0));
    bench.write("frictcomp.toml", "[lint]\nP-ERR-70495 = \"off\"\n");
    assert_eq!(bench.status(&["run", "w.nc"]), Some(2));
}

#[test]
fn comments_allow_a_lint_and_no_error() {
    // R9.24
    let program = "; frictcomp: allow FC401 on purpose\nN10 X[COMP OFF FRICT]\n\
                   N20 Y[COMP ON FRICT] ; frictcomp: allow FC402 on purpose\n\
                   N30 G90 ; frictcomp: allow FC405 nothing\n\
                   N40 Z[COMP ON FRICT] ; frictcomp: allow P-ERR-70495 no\nN50 M30\n";
    let bench = Bench::new(&[("a.nc", program)]);
    let text = bench.stdout(&["check", "--format", "concise", "a.nc"]);
    assert!(
        !text.contains("[FC401]") && !text.contains("[FC402]"),
        "{text}"
    );
    assert!(
        text.contains("a.nc:4:") && text.contains("[FC490]"),
        "{text}"
    );
    assert!(text.contains("[P-ERR-70495]"), "{text}");
}

#[test]
fn a_remark_in_a_loop_is_made_once_and_counted() {
    // R9.10 R9.13: FC402 once per place, with the number of its occurrences.
    let program = "P1 = 0\n$WHILE P1 < 5\nX[COMP ON FRICT]\nP1 = P1 + 1\n$ENDWHILE\nM30\n";
    let bench = Bench::new(&[("a.nc", program)]);
    let text = bench.stdout(&["run", "a.nc"]);
    assert_eq!(text.matches("info[FC402]").count(), 1, "{text}");
    assert!(text.contains("FC402 at a.nc:3 occurred 4 times"), "{text}");
    let records = bench.records(&["a.nc"]);
    let end = records.iter().find(|record| record.contains("\"end\""));
    let repeated = json(end.expect("an end"))["repeated"].clone();
    let expected = r#"[{"code":"FC402","file":"a.nc","line":3,"column":1,"times":4}]"#;
    assert_eq!(repeated, json(expected));
    let check = bench.stdout(&["check", "--format", "concise", "a.nc"]);
    assert!(check.contains("is already on (4 times)"), "{check}");
}

#[test]
fn check_has_formats_for_every_reader() {
    // R9.21, R9.25, R18.29
    let bench = Bench::new(&[("a.nc", NOT_CONFIGURED), ("b.nc", "N10 X1\nM30\n")]);
    let junit = bench.stdout(&["check", "--format", "junit", "a.nc", "b.nc"]);
    assert!(
        junit.contains("<testsuite name=\"frictcomp\" tests=\"2\" failures=\"1\">"),
        "{junit}"
    );
    assert!(
        junit.contains("name=\"b.nc\">\n</testcase>")
            && junit.contains(
                "<failure type=\"P-ERR-70495\" message=\"friction compensation of axis `Z`"
            ),
        "{junit}"
    );
    let check = |format: &str| bench.stdout(&["check", "--format", format, "a.nc"]);
    assert!(check("text").contains("^^^^^^^^^^^^^^^^"));
    let concise = check("concise");
    assert!(
        concise.starts_with("a.nc:1:5: error[P-ERR-70495] "),
        "{concise}"
    );
    assert!(check("github").starts_with("::error file=a.nc,line=1,"));
    let lines = check("ndjson");
    let first = json(lines.lines().next().expect("a record"));
    assert_eq!(first["record"], "diagnostic");
    assert!(first.get("program").is_none() && first.get("seq").is_none());
    assert_eq!(
        json(lines.lines().last().expect("a record"))["record"],
        "summary"
    );
    assert!(json(&check("json")).to_string().contains("P-ERR-70495"));
    let gitlab = json(&check("gitlab"));
    let issue = &gitlab[0];
    assert_eq!(issue["check_name"], "P-ERR-70495");
    assert_eq!(issue["severity"], "critical");
    assert_eq!(issue["location"]["path"], "a.nc");
    assert_eq!(issue["location"]["lines"]["begin"], 1);
    let sarif = json(&check("sarif"));
    assert_eq!(sarif["version"], "2.1.0");
    let result = &sarif["runs"][0]["results"][0];
    assert_eq!(result["ruleId"], "P-ERR-70495");
    let region = &result["locations"][0]["physicalLocation"]["region"];
    assert_eq!(
        (&region["startLine"], &region["startColumn"]),
        (&1.into(), &5.into())
    );
}

#[test]
fn the_fingerprints_of_gitlab_outlive_a_change_above() {
    // R13.6: a message that occurs twice has two fingerprints, and an additional line above changes neither.
    let fingerprints = |text: &str| -> Vec<String> {
        let bench = Bench::new(&[("a.nc", text)]);
        let report = json(&bench.stdout(&["check", "--format", "gitlab", "a.nc"]));
        let issues = report.as_array().expect("a list").iter();
        let text = |issue: &serde_json::Value| issue["fingerprint"].as_str().map(str::to_owned);
        issues.filter_map(text).collect()
    };
    let twice = "N10 X[COMP OFF FRIKT]\nN20 X[COMP OFF FRIKT]\nN30 M30\n";
    let before = fingerprints(twice);
    assert_eq!(before.len(), 2);
    assert_ne!(before[0], before[1]);
    assert_eq!(fingerprints(&format!("N5 X1\n{twice}")), before);
    assert!(fingerprints("N10 M30\n").is_empty());
}

#[test]
fn only_blocks_with_a_change_or_a_message_are_written() {
    // R13.7
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let short = bench.stdout(&["run", "--format", "ndjson", "--changes-only", "a.nc"]);
    assert_eq!(
        short,
        bench.stdout(&["run", "--format", "ndjson", "--changes", "a.nc"])
    );
    let full = bench.stdout(&["run", "--format", "ndjson", "a.nc"]);
    let switching: Vec<&str> = full
        .lines()
        .filter(|line| {
            !line.starts_with(r#"{"record":"block""#) || line.contains(r#""changes":[{"#)
        })
        .collect();
    assert_eq!(short.lines().collect::<Vec<_>>(), switching);
    assert!(switching.len() < full.lines().count());
}

#[test]
fn data_and_talk_are_apart() {
    // R9.27
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let output = bench.call(&["run", "--format", "ndjson", "a.nc"]);
    assert_eq!(String::from_utf8(output.stderr).expect("text"), "");
    let output = bench.call(&["check", "-v", "a.nc"]);
    assert!(
        String::from_utf8(output.stderr)
            .expect("text")
            .contains("1 file checked")
    );
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_a_run_quietly() {
    // R9.26
    let bench = Bench::new(&[("a.nc", &"G01 X1\nG01 X2\n".repeat(50_000))]);
    let mut child = bench
        .command(&["run", "--format", "ndjson", "a.nc"])
        .spawn()
        .expect("it starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8(output.stderr).expect("text"), "");
}

#[test]
fn a_state_file_carries_a_session_on() {
    // R1.27, R1.29, R9.30
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.nc", "N10 G01 X5\nN20 M30\n")]);
    let together = bench.blocks(&["a.nc", "b.nc"]);
    let mut apart = bench.blocks(&["--state", "s.json", "a.nc"]);
    apart.extend(bench.blocks(&["--state", "s.json", "b.nc"]));
    assert_eq!(column(&together, "friction"), column(&apart, "friction"));
    assert_eq!(bench.blocks(&["b.nc"])[0]["friction"]["X"], "active");
    assert_eq!(json(&bench.read("s.json"))["schema"], 4);
}

#[test]
fn a_state_that_does_not_fit_is_left_alone() {
    // R9.30
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let run = ["run", "--state", "s.json", "a.nc"];
    assert_eq!(bench.status(&run), Some(0));
    let good = bench.read("s.json");
    let other_schema = good.replacen("\"schema\": 4", "\"schema\": 5", 1);
    for wrong in ["", "{\"schema\":", other_schema.as_str()] {
        bench.write("s.json", wrong);
        assert_eq!(bench.status(&run), Some(2), "{wrong}");
        assert_eq!(bench.read("s.json"), wrong);
    }
    bench.write("s.json", &good);
    bench.write("frictcomp.toml", &MACHINE.replace("\"Z\"", "\"C\""));
    assert_eq!(bench.status(&run), Some(2));
    assert_eq!(bench.read("s.json"), good);
}

#[test]
fn another_max_points_is_refused() {
    // R3.22, P-ERR-110641
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let run = ["--state", "s.json", "a.nc"];
    bench.records(&run);
    bench.write(
        "frictcomp.toml",
        &MACHINE.replace("max_points = 20", "max_points = 30"),
    );
    let lines = bench.records(&run);
    let said = lines.iter().find(|line| line.contains("P-ERR-110641"));
    assert_eq!(json(said.expect("the error"))["axis"], "X");
}

#[test]
fn a_second_run_waits_for_the_first() {
    // R9.31
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let lock = fs::File::create(bench.folder().join("s.json.lock")).expect("a lock");
    lock.lock().expect("locked");
    let mut child = bench
        .command(&["run", "--state", "s.json", "a.nc"])
        .spawn()
        .expect("it starts");
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("a state").is_none(), "it waits");
    drop(lock);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
}
