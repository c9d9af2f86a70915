//! Chapter 9 of the rules from outside: records, exit statuses, the state file.

use std::fs;
use std::time::Duration;

use crate::folder::{Bench, MACHINE, json};
use serde_json::Value;

/// Returns the values of a key, in order.
fn column<'a>(records: &'a [Value], key: &str) -> Vec<&'a Value> {
    records.iter().map(|record| &record[key]).collect()
}

const LEAVE_OFF: &str = "%A\nN10 X[COMP OFF FRICT]\nN20 M30\n";
const NOT_CONFIGURED: &str = "N10 Z[COMP ON FRICT]\nN20 Y[COMP OFF FRICT]\nN30 M30\n";

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
