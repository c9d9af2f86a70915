//! The options of the commands: their effect, and refused values.

mod folders;
mod help;

use std::fs;

use crate::folder::{Bench, json, one_line, stderr};
use serde_json::Value;

const LEAVE_OFF: &str = "N10 X[COMP OFF FRICT]\nN20 X1\nN30 X[COMP OFF FRICT]\nN40 M30\n";
const NOT_CONFIGURED: &str = "N10 Z[COMP ON FRICT]\nN20 M30\n";

fn refused(bench: &Bench, arguments: &[&str]) -> String {
    let output = bench.call(arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    said
}

/// Returns a folder without a configuration above it.
fn bare(programs: &[(&str, &str)]) -> Bench {
    let bench = Bench::new(programs);
    fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
    bench
}

#[test]
fn records_end_with_the_verdict_of_the_text() {
    // R18.20
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("l.lis", "frict_comp.mode 0\n")]);
    for arguments in [
        ["check", "a.nc"],
        ["run", "a.nc"],
        ["audit", "a.nc"],
        ["lists", "l.lis"],
    ] {
        let text = bench.stdout(&arguments);
        let lines = bench.stdout(&[&arguments[..], &["--format", "ndjson"]].concat());
        let summary = json(lines.lines().last().expect("a summary"));
        let verdict = summary["headline"]["text"].as_str().expect("a verdict");
        assert!(one_line(&text).contains(verdict), "{verdict}: {text}");
    }
}

#[test]
fn a_state_that_is_not_known_may_fail() {
    // R2.98
    let program = "N10 X[COMP OFF FRICT]\n/N20 X[COMP ON FRICT]\nN30 M30\n";
    let known = "N10 X[COMP OFF FRICT]\n/N20 X[COMP ON FRICT]\nN25 X[COMP ON FRICT]\nN30 M30\n";
    let moved =
        "N10 X[COMP OFF FRICT]\n/N20 X[COMP ON FRICT]\nN22 G0 X5\nN25 X[COMP ON FRICT]\nN30 M30\n";
    let bench = Bench::new(&[("a.nc", program), ("b.nc", known), ("c.nc", moved)]);
    let status = |arguments: &[&str]| bench.call(arguments).status.code();
    for command in ["check", "run"] {
        let strict = [command, "--fail-on", "error,unknown"];
        let of = |rest: &[&str]| status(&[&strict[..], rest].concat());
        let error = [command, "--fail-on", "error", "a.nc"];
        assert_eq!(status(&error), Some(0), "{command}");
        assert_eq!(of(&["a.nc"]), Some(1), "{command}");
        assert_eq!(of(&["--skip", "none", "a.nc"]), Some(0), "{command}");
        assert_eq!(of(&["b.nc"]), Some(0), "{command}");
        assert_eq!(of(&["c.nc"]), Some(1), "{command}");
    }
    let audit = |program| status(&["audit", "--fail-on", "never,unknown", program]);
    assert_eq!((audit("a.nc"), audit("b.nc")), (Some(1), Some(0)));
    let said = stderr(&bench.call(&["check", "--fail-on", "unknown", "a.nc"]));
    assert!(said.contains("`FRICT` of `X`"), "{said}");
}

#[test]
fn every_format_holds_what_the_text_holds() {
    // R9.71
    let program = "N10 X=V.E.PART\nN20 #FLUSH\nN30 M30\n";
    let bench = Bench::new(&[("a.nc", program)]);
    for shown in ["values", "passed-over"] {
        let text = bench.stdout(&["show", shown, "a.nc"]);
        let lines = bench.stdout(&["show", shown, "--format", "ndjson", "a.nc"]);
        let document = json(&bench.stdout(&["show", shown, "--format", "json", "a.nc"]));
        let records = document["records"].as_array().expect("records");
        let headline = text.lines().next().unwrap_or_default();
        let summary = records.last().expect("a summary");
        assert_eq!(summary["headline"]["text"], headline);
        let places: Vec<&str> = text.lines().skip(2).collect();
        assert_eq!(places.len() + 1, lines.lines().count());
        assert_eq!(places.len() + 1, records.len());
        for (line, record) in places.into_iter().zip(records) {
            let place = format!("a.nc:{}:{}", record["line"], record["column"]);
            assert!(line.starts_with(record["name"].as_str().expect("a name")));
            assert!(line.ends_with(&place), "{line} {place}");
        }
    }
    let table = bench.stdout(&["lists", "--show", "frictcomp.toml"]);
    let lines = bench.stdout(&["lists", "--show", "--format", "ndjson", "frictcomp.toml"]);
    let records: Vec<Value> = lines.lines().map(json).collect();
    let parameters = records.iter().filter(|it| it["record"] == "parameter");
    let rows = table
        .lines()
        .filter(|line| line.starts_with("  P-"))
        .count();
    assert!(rows > 0 && parameters.clone().count() == rows, "{table}");
    for parameter in parameters {
        let key = parameter["key"].as_str().expect("a key");
        assert!(table.contains(key), "{key}");
    }
}

#[test]
fn colour_is_there_where_it_is_asked_for() {
    // R9.27
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.nc", NOT_CONFIGURED)]);
    for arguments in [
        &["run", "b.nc"][..],
        &["check", "b.nc"],
        &["golden", "a.nc"],
        &["diff", "a.nc", "b.nc"],
        &["lists", "--show", "frictcomp.toml"],
        &["config", "show"],
        &["explain"],
        &["explain", "FC401"],
    ] {
        let plain = bench.stdout(arguments);
        let styled = bench.stdout(&[&["--color", "always"], arguments].concat());
        let is_golden = arguments[0] == "golden";
        assert!(
            is_golden || styled.contains('\u{1b}'),
            "{arguments:?}: {styled}"
        );
        assert!(!plain.contains('\u{1b}'));
    }
}

/// Returns a text as UTF-16 with its byte order mark.
fn utf16(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
    let units = std::iter::once(0xfeff).chain(text.encode_utf16());
    units.flat_map(order).collect()
}

#[test]
fn texts_in_utf_16_are_read() {
    // R2.1
    let list = "kopf.achs_nr 1\n";
    let program = "N10 G1 X1 F100 (größe)\nN20 X[COMP OFF FRICT]\nN30 $IF 1 == 1\nN40 X2\nN50 $ENDIF\nN60 M30\n";
    let straight = "N10 X1\nN20 X[COMP OFF FRICT]\nN30 M30\n";
    let bench = Bench::new(&[
        ("a.nc", program),
        ("b.nc", straight),
        ("call.nc", "L a.nc\nM30\n"),
    ]);
    let outputs = |bench: &Bench| {
        let calls = [
            ["run", "a.nc"],
            ["run", "b.nc"],
            ["run", "call.nc"],
            ["lists", "x.lis"],
        ];
        calls.map(|call| bench.stdout(&call))
    };
    let write =
        |name: &str, bytes: &[u8]| fs::write(bench.folder().join(name), bytes).expect("written");
    write("x.lis", list.as_bytes());
    let plain = outputs(&bench);
    for order in [u16::to_le_bytes, u16::to_be_bytes] {
        write("a.nc", &utf16(program, order));
        write("b.nc", &utf16(straight, order));
        write("x.lis", &utf16(list, order));
        assert_eq!(outputs(&bench), plain);
    }
}

#[test]
fn configured_programs_and_harmless_words_are_shown() {
    // R2.75 R2.70
    let bench = Bench::new(&[("a.nc", "N10 X1\nN20 M30\n"), ("begin.nc", "M17\n")]);
    bench.write(
        "frictcomp.toml",
        "[machine]\nstart_program = \"begin.nc\"\nharmless = [\"#mycmd on\", \"M100\"]\n[machine.programs]\nM6 = \"change.nc\"\n[[axis]]\nname = \"X\"\n",
    );
    let shown = bench.stdout(&["config", "show"]);
    for part in [
        "harmless       #MYCMD ON, M100",
        "P-CHAN-00119",
        "begin.nc",
        "programs.M6",
        "change.nc",
    ] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    bench.call(&["run", "a.nc", "--html", "report.html"]);
    let page = bench.read("report.html");
    for part in [
        "Programs and macros of the machine",
        "begin.nc",
        "programs.M6",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn statistics_hold_counts_only_and_lists_show_the_folder_of_their_configuration() {
    // R1.37 R9.72
    let bench = bare(&[("a.nc", "N10 X[COMP ON FRICT]\nN20 M30\n")]);
    let output = bench.call(&["check", "--statistics", "a.nc"]);
    let counts = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(counts.trim_start().starts_with("1  error"), "{counts}");
    assert!(stderr(&output).contains("no machine is described"));
    bench.write("frictcomp.toml", "[machine]\nstartup = \"x.lis\"\n");
    bench.write("x.lis", "kanal_anzahl foo\n");
    fs::create_dir(bench.folder().join("below")).expect("a folder");
    let mut lists = bench.command(&["lists"]);
    let output = lists.current_dir(bench.folder().join("below")).output();
    let text = output.expect("a run").stdout;
    let text = String::from_utf8_lossy(&text);
    assert!(text.contains("1 | kanal_anzahl foo"), "{text}");
}

#[test]
fn only_axes_that_occur_are_enabled() {
    // R9.74
    let bench = bare(&[
        ("a.nc", "N10 X[COMP ON FRICT]\nN20 AX2=5 Y1\nN30 M30\n"),
        ("call.nc", "N10 L a.nc\nN20 M30\n"),
    ]);
    let said = refused(&bench, &["run", "--enable", "x", "a.nc"]);
    assert!(said.contains("no program names an axis `x`"), "{said}");
    assert!(said.contains("did you mean `X`?"), "{said}");
    assert!(refused(&bench, &["check", "--enable", "Z", "a.nc"]).contains("they name X, Y"));
    for names in ["X", "X,Y", "X,AX2"] {
        assert_eq!(
            bench.status(&["run", "--enable", names, "a.nc"]),
            Some(0),
            "{names}"
        );
    }
    // A later run with the same state may name it, and one run may assume more than the last.
    let open = ["run", "--state", "s", "--enable"];
    let run = |names, file| bench.status(&[&open[..], &[names, file]].concat());
    assert_eq!(run("X", "a.nc"), Some(0));
    assert_eq!(run("X,Z", "a.nc"), Some(0));
    let mistyped = [&open[..], &["x", "a.nc"]].concat();
    assert!(refused(&bench, &mistyped).contains("did you mean `X`?"));
    assert!(bench.read("s").contains("axis Z number - type"));
    // A called program may have more axes.
    assert_eq!(bench.status(&["run", "--enable", "X", "call.nc"]), Some(0));
    let configured = Bench::new(&[("a.nc", LEAVE_OFF)]);
    assert!(refused(&configured, &["run", "--enable", "W", "a.nc"]).contains("no axis `W`"));
    // A mistake in the only command of an axis is reported, not that the axis is missing.
    bench.write("typo.nc", "N10 X[COMP OF FRICT]\nN20 M30\n");
    let said = bench.stdout(&["check", "--enable", "X", "typo.nc"]);
    assert!(said.contains("FC202"), "{said}");
    // No word means all axes, whatever the programs call.
    for all in ["all", "ALL", "all,x"] {
        for program in ["a.nc", "call.nc"] {
            let said = refused(&bench, &["check", "--enable", all, program]);
            assert!(said.contains("no program names an axis `"), "{said}");
        }
        let said = refused(&bench, &["config", "show", "--enable", all]);
        assert!(said.contains("is not an axis name"), "{said}");
        let said = refused(&configured, &["run", "--enable", all, "a.nc"]);
        assert!(said.contains("its axes are X"), "{said}");
    }
    assert!(refused(&bench, &["run", "--enable", "all", "a.nc"]).contains("they name X, Y"));
}
