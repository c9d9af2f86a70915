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

/// A folder without a configuration above it.
fn bare(programs: &[(&str, &str)]) -> Bench {
    let bench = Bench::new(programs);
    fs::remove_file(bench.folder().join("frictcomp.toml")).expect("removed");
    bench
}

#[test]
fn only_what_counts_is_said_where_that_is_wanted() {
    // R9.72, R18.20
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.nc", NOT_CONFIGURED)]);
    for (command, verdict) in [
        ("check", "a.nc leaves an axis off\n"),
        ("run", "X is left off\n"),
    ] {
        let output = bench.call(&[command, "-q", "--fail-on", "error", "a.nc"]);
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(
            (&*String::from_utf8_lossy(&output.stdout), &*stderr(&output)),
            (verdict, ""),
            "{command}"
        );
        let output = bench.call(&[command, "--quiet", "b.nc"]);
        assert_eq!(output.status.code(), Some(1));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(text.starts_with("error[P-ERR-70495]"), "{text}");
        let output = bench.call(&[command, "-q", "--fail-on", "warning", "a.nc"]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            text.contains("[FC401]") && !text.contains("[FC402]"),
            "{text}"
        );
    }
    assert_eq!(
        stderr(&bench.call(&["golden", "-q", "--update", "a.nc"])),
        ""
    );
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
fn a_warning_fails_the_commands_that_judge() {
    // R18.1
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.nc", "N10 G0 X5\nN20 M30\n")]);
    for (arguments, status) in [
        (&["check", "a.nc"][..], 1),
        (&["check", "b.nc"], 0),
        (&["check"], 1),
        (&["check", "--fail-on", "unknown", "a.nc"], 1),
        (&["check", "--fail-on", "error,unknown", "a.nc"], 0),
        (&["check", "--fail-on", "never", "a.nc"], 0),
        (&["audit"], 1),
        (&["audit", "--fail-on", "error"], 0),
        (&["run", "a.nc"], 0),
        (&["run", "--fail-on", "warning", "a.nc"], 1),
        (&["check", "--write-baseline", "known.json"], 0),
        (&["check", "--baseline", "known.json"], 0),
    ] {
        assert_eq!(bench.status(arguments), Some(status), "{arguments:?}");
    }
    bench.write("c.nc", LEAVE_OFF);
    assert_eq!(
        bench.status(&["check", "--baseline", "known.json"]),
        Some(1)
    );
}

#[test]
fn codes_are_counted() {
    // R9.72
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    let text = bench.stdout(&["check", "--statistics", "a.nc"]);
    assert!(
        text.lines()
            .any(|line| line.starts_with("      1  warning  FC401")),
        "{text}"
    );
    assert!(text.ends_with("\na.nc leaves an axis off\n"), "{text}");
    let document = json(&bench.stdout(&["check", "--statistics", "--format", "json", "a.nc"]));
    let records = document["records"].as_array().expect("records");
    assert!(
        records
            .iter()
            .any(|it| it["code"] == "FC401" && it["count"] == 1)
    );
    assert!(
        refused(
            &bench,
            &["check", "--statistics", "--format", "sarif", "a.nc"]
        )
        .contains("sarif")
    );
}

#[test]
fn codes_are_left_out_and_weighed_for_one_call() {
    // R9.72
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.nc", NOT_CONFIGURED)]);
    let codes = |arguments: &[&str]| {
        let all = [&["check", "--format", "ndjson"], arguments].concat();
        let text = bench.stdout(&all);
        let records: Vec<Value> = text.lines().map(json).collect();
        let said = records.iter().filter(|it| it["record"] == "diagnostic");
        let mut codes: Vec<String> = said
            .map(|it| format!("{} {}", it["code"], it["severity"]).replace('"', ""))
            .collect();
        codes.sort();
        codes.dedup();
        codes
    };
    let all = codes(&["a.nc"]);
    assert!(all.contains(&"FC401 warning".to_owned()), "{all:?}");
    assert!(!codes(&["--ignore", "FC401", "a.nc"]).contains(&"FC401 warning".to_owned()));
    assert_eq!(codes(&["--select", "FC401", "a.nc"]), ["FC401 warning"]);
    // The control's own errors are always reported (R9.24).
    assert!(codes(&["--select", "FC401", "b.nc"]).contains(&"P-ERR-70495 error".to_owned()));
    let weighed = codes(&["--severity", "FC401=error", "a.nc"]);
    assert!(weighed.contains(&"FC401 error".to_owned()), "{weighed:?}");
    assert_eq!(
        bench.status(&["run", "--severity", "FC401=error", "a.nc"]),
        Some(1)
    );
    assert_eq!(
        bench.status(&["check", "--severity", "FC401=error", "a.nc"]),
        Some(1)
    );
    for wrong in [
        &["check", "--ignore", "FC4O1", "a.nc"][..],
        &["check", "--ignore", "P-ERR-70495", "a.nc"],
        &["check", "--severity", "FC401=fatal", "a.nc"],
        &[
            "check",
            "--ignore",
            "FC401",
            "--severity",
            "FC401=error",
            "a.nc",
        ],
        &["check", "--ignore", "FC401", "--select", "FC402", "a.nc"],
    ] {
        refused(&bench, wrong);
    }
}

#[test]
fn lists_are_weighed_too() {
    // R9.72
    let bench = Bench::new(&[]);
    let list = "frict_comp.mode 3\nfrict_comp.mode 3\nfrict_comp.table_entries 1\n\
                frict_comp.table[0].in 0\nfrict_comp.table[0].out 10\n";
    bench.write("v.lis", list);
    assert!(bench.stdout(&["lists", "v.lis"]).contains("FC121"));
    assert!(
        !bench
            .stdout(&["lists", "--ignore", "FC121", "v.lis"])
            .contains("FC121")
    );
    assert_eq!(
        bench.status(&["lists", "--severity", "FC121=error", "v.lis"]),
        Some(1)
    );
}

#[test]
fn commands_without_a_path_take_the_current_folder() {
    // R9.72
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("notes.txt", "X")]);
    let output = bench.call(&["check", "-v"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("a.nc"));
    let said = stderr(&output);
    assert!(
        said.contains("1 file checked") && said.contains("1 other file passed over"),
        "{said}"
    );
    assert_eq!(bench.status(&["golden"]), Some(1));
    assert!(bench.stdout(&["lists"]).contains("in 1 file"));
    let bare = bare(&[]);
    assert!(refused(&bare, &["lists"]).contains("no frictcomp.toml"));
}

#[test]
fn the_configuration_names_the_extensions_of_programs() {
    // R9.72
    let bench = Bench::new(&[("a.nc", LEAVE_OFF), ("b.prg", LEAVE_OFF)]);
    let configuration = bench.read("frictcomp.toml") + "[check]\nextensions = [\".PRG\"]\n";
    bench.write("frictcomp.toml", &configuration);
    let text = bench.stdout(&["check", "--format", "concise", "."]);
    assert!(text.contains("b.prg:") && !text.contains("a.nc:"), "{text}");
    bench.write("frictcomp.toml", "[check]\nextensions = [\"*.nc\"]\n");
    let said = refused(&bench, &["check", "a.nc"]);
    assert!(said.contains("is not a file extension"), "{said}");
}

#[test]
fn options_without_effect_are_refused() {
    // R9.71
    let bench = Bench::new(&[
        ("a.nc", LEAVE_OFF),
        ("v.lis", "frict_comp.mode 0\n"),
        ("t.csv", "t,x\n0,0\n"),
    ]);
    let trace = ["current", "--recording", "t.csv", "--value-list", "v.lis"];
    for arguments in [
        &["run", "--changes", "--full", "a.nc"][..],
        &["run", "--full", "--format", "ndjson", "a.nc"],
        &["run", "--columns", "position", "a.nc"],
        &["run", "--quiet", "--changes", "a.nc"],
        &["run", "--quiet", "--format", "csv", "a.nc"],
        &["run", "-qv", "a.nc"],
        &["-v", "check", "-q", "a.nc"],
        &["audit", "-q", "--verbose", "a.nc"],
        &["run", "--isolated", "--config", "frictcomp.toml", "a.nc"],
        &["show", "values", "--format", "sarif", "a.nc"],
        &["show", "passed-over", "--format", "github", "a.nc"],
        &["lists", "--show", "--format", "concise", "v.lis"],
        &["lists", "--show", "--format", "sarif", "v.lis"],
        &[&trace[..], &["--enable", "X"]].concat(),
        &[&trace[..], &["--skip", "1"]].concat(),
        &[&trace[..], &["--max-cycles", "5"]].concat(),
        &[&trace[..], &["--isolated"]].concat(),
        &[&trace[..], &["--axis", "X"]].concat(),
        &["circle", "--recording", "t.csv", "--feed", "100"],
        &["circle", "--recording", "t.csv", "--cycle-time", "1"],
    ] {
        let said = refused(&bench, arguments);
        assert!(said.starts_with("error: "), "{arguments:?}: {said}");
    }
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
fn axes_are_known_from_the_first_line() {
    // R9.74
    let bench = bare(&[(
        "a.nc",
        "N10 G90\nN20 X1 (Y5)\nN30 C[COMP OFF FRICT]\nN40 M30\n",
    )]);
    let text = bench.stdout(&["run", "a.nc"]);
    let headers = text
        .lines()
        .filter(|line| line.contains("line  block"))
        .count();
    assert_eq!(headers, 1, "{text}");
    let header = text
        .lines()
        .find(|line| line.contains("line  block"))
        .expect("a header");
    assert!(
        header.contains('X') && header.contains('C') && !header.contains('Y'),
        "{text}"
    );
    let records = bench.records(&["a.nc"]);
    assert!(records[0].contains(r#""axes":["X","C"]"#), "{}", records[0]);
    assert_eq!(bench.status(&["golden", "--update", "a.nc"]), Some(0));
    let golden = bench.read("a.nc.timeline");
    assert_eq!(golden.matches("line  block").count(), 1, "{golden}");
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

#[test]
fn variables_are_set_whole_and_read() {
    // R9.74
    let bench = Bench::new(&[("a.nc", "N10 X=V.E.PART\nN20 M30\n")]);
    for wrong in ["V.E.PART=", "PART=1", "=1", "V.E.PART"] {
        refused(&bench, &["run", "--set", wrong, "a.nc"]);
    }
    let said = stderr(&bench.call(&["run", "--set", "V.E.PRT=1", "a.nc"]));
    assert!(
        said.contains("`--set V.E.PRT`: no program reads it, did you mean `V.E.PART`?"),
        "{said}"
    );
    for command in ["run", "check"] {
        let said = stderr(&bench.call(&[command, "--set", "V.E.PART=1", "a.nc"]));
        assert!(!said.contains("no program reads it"), "{said}");
    }
}

#[test]
fn numbers_have_units_and_ranges() {
    // R9.78
    let bench = Bench::new(&[("a.nc", LEAVE_OFF)]);
    for (arguments, words) in [
        (
            &["circle", "--radius", "-5"][..],
            "a radius of -5 mm is not possible; it must be between",
        ),
        (
            &["circle", "--feed", "-5"],
            "a feed of -5 mm/min is not possible",
        ),
        (&["circle", "--radius", "1e308"], "a radius of 1e308 mm"),
        (
            &["circle", "--cycle-time", "-1"],
            "a CNC cycle of -1 ms is not possible",
        ),
        (
            &["circle", "--cycle-time", "0.3"],
            "whole multiple of 0.25 ms",
        ),
        (&["tune", "--feeds", "-5"], "a feed of -5 mm/min"),
        (&["tune", "--feeds", "0"], "write feeds in mm/min"),
        (&["tune", "--radii", "-1"], "a radius of -1 mm"),
        (
            &["current", "a.nc", "--axis", "X", "--cycle-time", "0"],
            "must be between 0.001 and 1000 ms",
        ),
    ] {
        let said = refused(&bench, arguments);
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    let fast = bench.stdout(&["current", "a.nc", "--axis", "X", "--cycle-time", "2"]);
    let slow = bench.stdout(&["current", "a.nc", "--axis", "X", "--cycle-time", "2000us"]);
    assert_eq!(fast, slow);
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

/// A text as UTF-16 with its byte order mark.
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
fn stiction_is_computed_from_what_is_given() {
    // R8.5
    let bench = bare(&[]);
    let document = bench.stdout(&[
        "stiction",
        "--kv",
        "25 1/s",
        "--tc",
        "3ms",
        "--mp1511",
        "8000",
        "--delta-sa",
        "-2um",
        "--mp1050",
        "9",
        "--mp1010",
        "10000mm/min",
        "--format",
        "json",
    ]);
    let document: serde_json::Value = serde_json::from_str(&document).expect("JSON");
    let value = |name: &str| document["values"][name]["value"].as_f64().expect("a value");
    assert!((value("f_add") + 0.008).abs() < 1e-12);
    assert!((value("v_add") + 0.0072).abs() < 1e-12);
    assert_eq!(document["schema"], 1);
    for (arguments, words) in [
        (&["stiction"][..], "no quantity is given"),
        (&["stiction", "--tc", "3000mm"], "`mm` is not a unit of t_C"),
        (
            &["stiction", "--gp", "0", "--mp1512", "5"],
            "GP must be more than 0",
        ),
    ] {
        let output = bench.call(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            stderr(&output).contains(words),
            "{arguments:?}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn what_describes_no_axis_is_no_drive_in_order() {
    // R7.5
    let bench = bare(&[
        ("trace.csv", "t,x\n0,1\n"),
        ("hochlauf.lis", "achs_mds[0] missing.lis\nEnde\n"),
    ]);
    let output = bench.call(&["drive", "trace.csv"]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("`trace.csv` describes no axis"), "{said}");
    let output = bench.call(&["drive", "hochlauf.lis"]);
    assert_ne!(output.status.code(), Some(0));
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(shown.contains("FC123"), "{shown}");
}
