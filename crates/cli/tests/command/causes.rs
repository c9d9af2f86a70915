//! Chapter 17 of the rules from outside: one finding per cause, one machine for both versions, axes for
//! the programs that have them; and what a session costs (R13.12).

use std::fs;

use crate::folder::{Bench, MACHINE, json};
use serde_json::Value;

const MAIN: &str =
    "N10 X[COMP ON FRICT]\nN11 X[COMP ON FRICT]\nN20 L toolchange.nc\nN30 G01 X10 F100\nN40 M30\n";
const CALLED: &str = "N1 Y[COMP OFF FRICT]\nN2 X[COMP ON FRCT]\nM17\n";
const PROGRAMS: [&str; 5] = ["a.nc", "b.nc", "c.nc", "d.nc", "e.nc"];

fn archive() -> Bench {
    let bench = Bench::new(&[("toolchange.nc", CALLED)]);
    for name in PROGRAMS {
        bench.write(name, MAIN);
    }
    bench
}

fn check(bench: &Bench, format: &str) -> String {
    bench.stdout(&["check", ".", "--format", format])
}

fn of_code(records: &[Value], code: &str) -> Vec<Value> {
    let of_code = records.iter().filter(|it| it["code"] == code);
    of_code.cloned().collect()
}

#[test]
fn a_message_in_a_called_program_is_one_message() {
    // R17.1
    let bench = archive();
    for jobs in ["1", "3"] {
        let lines = bench.stdout(&["check", ".", "--format", "ndjson", "--jobs", jobs]);
        let records: Vec<Value> = lines.lines().map(json).collect();
        for (code, line) in [("FC401", 1), ("FC202", 2)] {
            let said = of_code(&records, code);
            assert_eq!(said.len(), 1, "{lines}");
            assert_eq!(said[0]["file"], "toolchange.nc");
            assert_eq!(said[0]["line"], line);
            let reached = PROGRAMS.map(Value::from).to_vec();
            assert_eq!(said[0]["reached_from"], Value::Array(reached));
            assert!(said[0].get("reached_from_count").is_none());
        }
        let summary = records.last().expect("a summary");
        assert_eq!(
            (&summary["errors"], &summary["warnings"]),
            (&1.into(), &1.into())
        );
        // Separate blocks have separate findings.
        assert_eq!(of_code(&records, "FC402").len(), 5, "{lines}");
    }
}

#[test]
fn every_format_names_the_programs_that_reach_a_message() {
    // R17.1
    let bench = archive();
    let reached = "reached from 5 programs: a.nc, b.nc, c.nc, d.nc, e.nc";
    for format in [
        "text", "concise", "json", "github", "gitlab", "sarif", "junit",
    ] {
        let shown = check(&bench, format);
        let expected = if format == "json" {
            "\"reached_from\":[\"a.nc\","
        } else {
            reached
        };
        assert_eq!(shown.matches(expected).count(), 2, "{shown}");
    }
    let sarif = json(&check(&bench, "sarif"));
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    let left = results.iter().find(|it| it["ruleId"] == "FC401");
    let related = left.expect("FC401")["relatedLocations"].as_array();
    let uris = related.expect("places").iter();
    let uris = uris.map(|it| &it["physicalLocation"]["artifactLocation"]["uri"]);
    assert!(uris.eq(PROGRAMS.map(Value::from).iter()), "{sarif}");
    assert_eq!(
        bench
            .stdout(&["check", ".", "--statistics"])
            .matches("      1  ")
            .count(),
        2
    );
}

#[test]
fn a_fingerprint_belongs_to_a_cause() {
    // R17.1
    let bench = archive();
    let prints = |shown: &str| -> Vec<Value> {
        let entries = json(shown);
        let entries = entries.as_array().expect("entries").iter();
        let left = entries.filter(|it| it["check_name"] == "FC401");
        left.map(|it| it["fingerprint"].clone()).collect()
    };
    let before = prints(&check(&bench, "gitlab"));
    bench.write("f.nc", MAIN);
    assert_eq!(prints(&check(&bench, "gitlab")), before);
    assert_eq!(before.len(), 1);
}

#[test]
fn many_programs_are_counted() {
    // R17.1
    let bench = Bench::new(&[("toolchange.nc", CALLED)]);
    for number in 0..25 {
        bench.write(&format!("p{number:02}.nc"), MAIN);
    }
    let lines = check(&bench, "ndjson");
    let records: Vec<Value> = lines.lines().map(json).collect();
    let left = &of_code(&records, "FC401")[0];
    assert_eq!(left["reached_from"].as_array().map(Vec::len), Some(20));
    assert_eq!(left["reached_from_count"], 25);
    let text = check(&bench, "text");
    let named = "reached from 25 programs: p00.nc, p01.nc, p02.nc, p03.nc, p04.nc, …";
    assert!(text.contains(named), "{text}");
}

#[test]
fn a_message_about_the_end_names_its_main_program() {
    // R17.1
    let bench = Bench::new(&[("one.nc", MAIN), ("toolchange.nc", CALLED)]);
    let shown = bench.stdout(&["check", "one.nc", "--format", "concise"]);
    let left = shown.lines().find(|line| line.contains("FC401"));
    let left = left.expect("FC401");
    assert!(left.starts_with("toolchange.nc:1:"), "{left}");
    assert!(left.ends_with("(reached from one.nc)"), "{left}");
    // In the report of a run, too.
    let _ = bench.call(&["run", "--keep-going", "one.nc", "--html", "r.html"]);
    assert!(bench.read("r.html").contains("(reached from one.nc)"));
}

#[test]
fn axes_are_enabled_for_those_programs_that_have_them() {
    // R17.7
    let bench = Bench::new(&[]);
    for (folder, axes) in [("one", ["X", "Y"]), ("two", ["X", "Z"])] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
        let machine = axes.map(|axis| format!("[[axis]]\nname = \"{axis}\"\n"));
        bench.write(&format!("{folder}/frictcomp.toml"), &machine.concat());
        let switches = axes.map(|axis| format!("{axis}[COMP OFF FRICT]\n{axis}[COMP ON FRICT]\n"));
        bench.write(
            &format!("{folder}/p.nc"),
            &format!("{}M30\n", switches.concat()),
        );
    }
    let check = |axes: &str, folders: &[&str]| {
        let output = bench.call(&[&["check", "--enable", axes], folders].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), said)
    };
    let (status, said) = check("X,Y,Z", &["one", "two"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(!said.contains("--enable"), "{said}");
    // One that no program has is noted, unless none has any.
    let (status, said) = check("X,Y,Z", &["one"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.contains("`--enable Z`: no program has this axis"),
        "{said}"
    );
    let (status, said) = check("X,YY", &["one", "two"]);
    assert_ne!(status, Some(2), "{said}");
    assert!(
        said.contains("`--enable YY`: no program has this axis, did you mean `Y`?"),
        "{said}"
    );
    for axes in ["YY", "Q,YY"] {
        let (status, said) = check(axes, &["one", "two"]);
        assert_eq!(status, Some(2), "{said}");
    }
    for command in ["run", "audit", "golden", "contour", "diff"] {
        let mut arguments = vec![command, "--enable", "X,Q", "one/p.nc"];
        arguments.extend((command == "diff").then_some("one/p.nc"));
        let output = bench.call(&arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            said.contains("`--enable Q`: no program has this axis"),
            "{command}: {said}"
        );
        assert_ne!(output.status.code(), Some(2), "{command}: {said}");
    }
}

#[test]
fn a_file_that_is_no_program_is_named_before_its_axes() {
    // R9.74, R18.6
    let bench = Bench::new(&[]);
    fs::remove_file(bench.folder().join("frictcomp.toml")).expect("a configuration");
    bench.write("a.nc", "PK\u{3}\u{4}");
    for arguments in [
        &["check", "--enable", "X", "a.nc"][..],
        &["check", "--enable", "X", "."],
    ] {
        let (status, said) = crate::folder::said(&bench.call(arguments));
        assert!(status == Some(2) || status == Some(1), "{said}");
        assert!(said.contains("is a ZIP archive"), "{said}");
        assert!(!said.contains("axis"), "{said}");
    }
    bench.write("b.nc", "G0 Y1\nM30\n");
    let (status, said) = crate::folder::said(&bench.call(&["check", "--enable", "X", "."]));
    assert_eq!(status, Some(2), "{said}");
    assert!(said.contains("no program names an axis `X`"), "{said}");
}

#[test]
fn an_axis_that_a_program_only_reads_can_be_enabled() {
    // R17.7
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("p.nc");
    let text = "P1 = V.A.FRICT_COMP_ACTIVE.Y\nG0 X1\nM30\n";
    fs::write(&program, text).expect("written");
    let bench = Bench::new(&[]);
    let program = program.display().to_string();
    let status = |axes| bench.status(&["check", "--isolated", "--enable", axes, &program]);
    assert_eq!(status("X,Y"), Some(0));
    assert_eq!(status("X,Z"), Some(0));
    assert_eq!(status("Z,Q"), Some(2));
}

/// R9.28: the message about a key outside its table names the right table.
#[test]
fn a_key_outside_its_table_is_told_its_header() {
    let bench = Bench::new(&[("p.nc", "M30\n")]);
    for (key, header) in [
        ("program_dirs = [\"sub\"]\n", "[machine]"),
        ("value_list = \"x.lis\"\n", "[[axis]]"),
        ("delay_cycles = 2\n", "[axis.value]"),
    ] {
        bench.write("frictcomp.toml", key);
        let output = bench.call(&["check", "p.nc"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned()
            + &String::from_utf8_lossy(&output.stdout);
        assert!(
            said.contains(&format!("below the header `{header}`")),
            "{said}"
        );
    }
}

#[test]
fn axes_are_enabled_where_only_some_programs_are_described() {
    // R17.7
    let bench = Bench::new(&[("p.nc", "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n")]);
    let bare = tempfile::tempdir().expect("a folder");
    let other = bare.path().join("q.nc");
    fs::write(&other, "G0 C5\nC[COMP OFF FRICT]\nC[COMP ON FRICT]\nM30\n").expect("written");
    let other = other.display().to_string();
    assert_eq!(
        bench.status(&["check", "--enable", "X,C", "p.nc", &other]),
        Some(0)
    );
    assert_eq!(bench.status(&["check", "--enable", "X,C", "p.nc"]), Some(0));
    assert_eq!(bench.status(&["check", "--enable", "C", "p.nc"]), Some(2));
    assert_eq!(
        bench.status(&["check", "--enable", "W", "p.nc", &other]),
        Some(2)
    );
}

const OLD: &str = "N10 L sub.nc\nN20 X[COMP ON FRICT]\nN30 M30\n";
const SUB: &str = "N1 X[COMP OFF FRICT]\nN2 M17\n";

#[test]
fn both_versions_run_on_one_machine() {
    // R17.4
    let bench = Bench::new(&[("p.nc", OLD), ("sub.nc", SUB)]);
    let elsewhere = tempfile::tempdir().expect("a folder");
    let copy = elsewhere.path().join("p.nc");
    fs::write(&copy, OLD).expect("written");
    let copy = copy.display().to_string();
    for (old, new) in [(copy.as_str(), "p.nc"), ("p.nc", copy.as_str())] {
        for machine in [
            &[][..],
            &["--isolated", "--enable", "X"],
            &["--config", "frictcomp.toml"],
        ] {
            let output = bench.call(&[&["diff", old, new], machine].concat());
            let shown = String::from_utf8_lossy(&output.stdout);
            assert_eq!(
                output.status.code(),
                Some(0),
                "{old} {new} {machine:?}: {shown}"
            );
            assert!(shown.contains("no difference: 2 changes"), "{shown}");
        }
    }
}

#[test]
fn a_version_calls_its_own_programs_first() {
    // R17.4: with the programs of the other version, a change in them would not show.
    let bench = Bench::new(&[]);
    for (folder, sub) in [("old", SUB), ("new", "N1 G04 X1\nN2 M17\n")] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
        bench.write(&format!("{folder}/frictcomp.toml"), MACHINE);
        bench.write(&format!("{folder}/p.nc"), OLD);
        bench.write(&format!("{folder}/sub.nc"), sub);
    }
    let output = bench.call(&["diff", "old/p.nc", "new/p.nc"]);
    let shown = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{shown}");
    assert!(
        shown.contains("- old/sub.nc:1  X FRICT: active → inactive"),
        "{shown}"
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("not on that of `old/frictcomp.toml`"),
        "{said}"
    );
}

const CUTS: &str = "N10 X[COMP OFF FRICT]\nN20 G01 X10 F100\nN30 X22.5 Z1\nN40 G00 X99\n\
                    N50 G02 X5 Y5 I3\nN60 G01 X5\nN70 X[COMP ON FRICT] X10\nN80 M30\n";

#[test]
fn feed_moves_without_compensation_are_counted() {
    // R13.12: rapid motion and words without motion do not count, nor does an axis without
    // P-AXIS-00522; commands act before the motion of their block.
    let bench = Bench::new(&[("p.nc", CUTS), ("q.nc", "N10 G01 X10 F100\nN20 M30\n")]);
    let shown = bench.stdout(&["run", "p.nc"]);
    let cost = "X off during 3 feed moves, the longest known 12.5 mm";
    assert!(shown.contains(cost), "{shown}");
    assert!(!shown.contains("nothing to do"), "{shown}");
    assert!(bench.stdout(&["run", "q.nc"]).contains("nothing to do"));
    let records = bench.records(&["p.nc"]);
    let summary = json(records.last().expect("a summary"));
    let x = &summary["uncompensated"]["X"];
    assert_eq!(
        (&x["off"], &x["longest"], &x["unmeasured"]),
        (&3.into(), &12.5.into(), &2.into())
    );
    let statistics = bench.stdout(&["check", ".", "--statistics"]);
    assert!(
        statistics.contains("X off during 3 feed moves, the longest known 12.5 mm, in 1 program\n"),
        "{statistics}"
    );
    let _ = bench.call(&["run", "p.nc", "--html", "r.html"]);
    assert!(bench.read("r.html").contains(cost));
    let html = bench.read("r.html");
    assert!(!html.contains("nothing to do"));
}

#[test]
fn the_closing_line_names_what_the_states_rest_on() {
    // R2.94
    for (program, codes) in [
        (
            "G81 Z5\nX[COMP ON FRICT]\nY[COMP ON FRICT]\nM30\n",
            "see FC325",
        ),
        ("G777\nM30\n", "see FC210"),
        (
            "G777\nG81\nX[COMP ON FRICT]\nY[COMP ON FRICT]\nM30\n",
            "see FC210 and FC325",
        ),
        ("$IF V.E.A\n#ERROR [ID=1 RC=2]\n$ENDIF\nM30\n", "see FC318"),
    ] {
        let bench = Bench::new(&[("p.nc", program)]);
        let shown = bench.stdout(&["run", "p.nc"]);
        assert!(!shown.contains("nothing to do"), "{program}: {shown}");
        assert!(
            shown.contains(&format!("as far as is known: {codes}")),
            "{program}: {shown}"
        );
    }
}

#[test]
fn an_unknown_cycle_leaves_an_unknown_state() {
    // R18.8
    let bench = Bench::new(&[("p.nc", "G81 Z5\nM30\n")]);
    let status = |bench: &Bench| {
        let checked = bench.call(&["check", "--fail-on", "error,unknown", "p.nc"]);
        checked.status.code()
    };
    assert_eq!(status(&bench), Some(1));
    let audit = bench.stdout(&["audit", "p.nc"]);
    assert!(audit.contains("depends  depends"), "{audit}");
    let harmless =
        format!("[machine]\nharmless = [\"G81\", \"G83\"]\nexternal = [\"*.ecy\"]\n{MACHINE}");
    bench.write("frictcomp.toml", &harmless);
    assert_eq!(status(&bench), Some(0));
    let shown = bench.stdout(&["config", "show"]);
    assert!(
        shown.contains("G81, G83") && shown.contains("*.ecy"),
        "{shown}"
    );
}

#[test]
fn the_longest_move_counts_arcs() {
    // R11.31: forth and back along the arc, by either form of its centre, in a plane of its own, and with
    // the depth of a helix; a shift of the origin that only the machine knows changes no length.
    let off = "N10 X[COMP OFF FRICT] Y[COMP OFF FRICT] Z[COMP OFF FRICT]\nN20 G00 X10 Y0 Z0\n";
    for (blocks, lengths) in [
        ("G03 X10 Y0 I-10 J0 F500", [Some(40.0), Some(40.0), None]),
        ("G02 X0 Y-10 I-10 J0 F500", [Some(10.0), Some(10.0), None]),
        ("G03 X0 Y-10 I-10 J0 F500", [Some(30.0), Some(30.0), None]),
        ("G02 X-10 Y0 R10 F500", [Some(20.0), Some(20.0), None]),
        (
            "G02 X10 Y0 Z-3 I-10 J0 F500",
            [Some(40.0), Some(40.0), Some(3.0)],
        ),
        (
            "G01 X12 F500\nG03 X12 Y0 I1 J0",
            [Some(4.0), Some(4.0), None],
        ),
    ] {
        let program = format!("{off}{blocks}\nN90 M30\n");
        let bench = Bench::new(&[("p.nc", &program)]);
        let machine =
            ["X", "Y", "Z"].map(|name| format!("[[axis]]\nname = \"{name}\"\nfrict_comp = true\n"));
        bench.write("frictcomp.toml", &machine.concat());
        let records = bench.records(&["p.nc"]);
        let summary = json(records.last().expect("a summary"));
        for (axis, length) in ["X", "Y", "Z"].iter().zip(lengths) {
            let found = &summary["uncompensated"][axis];
            assert_eq!(
                found["longest"].as_f64(),
                length,
                "{blocks} {axis}: {found}"
            );
            assert!(
                found["unmeasured"].as_u64().unwrap_or(0) == 0,
                "{blocks} {axis}: {found}"
            );
        }
    }
}

#[test]
fn unknown_states_are_counted_apart() {
    // R13.12
    let unknown = "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 G01 X10 F100\nN50 X20\n\
                   N60 X[COMP OFF FRICT]\nN70 X[COMP ON FRICT]\nN80 M30\n";
    let bench = Bench::new(&[("p.nc", unknown)]);
    let shown = bench.stdout(&["run", "p.nc"]);
    assert!(
        shown.contains("X perhaps off during 2 feed moves\n"),
        "{shown}"
    );
    let shown = bench.stdout(&["run", "p.nc", "--set", "V.E.A=1"]);
    assert!(
        shown.contains("X off during 2 feed moves, the longest known 10 mm\n"),
        "{shown}"
    );
}

#[test]
fn motion_without_a_word_counts() {
    // R13.12: what moves an axis by itself or through another one; homing is not a feed move.
    let bench = Bench::new(&[]);
    for (blocks, cost) in [
        (
            "G0 X1\nX[MC_MoveAbsolute POS=10 VEL=5]\n",
            Some("X off during 1 feed move\n"),
        ),
        (
            "$IF V.E.A == 1\nG1 X5 F100\n$ENDIF\n",
            Some("X perhaps off during 1 feed move\n"),
        ),
        ("G0 X1\nG74 X1\n", None),
    ] {
        let text = format!("X[COMP OFF FRICT]\n{blocks}X[COMP ON FRICT]\nM30\n");
        bench.write("p.nc", &text);
        let shown = bench.stdout(&["run", "p.nc"]);
        match cost {
            Some(cost) => assert!(shown.contains(cost), "{shown}"),
            None => assert!(!shown.contains("feed move"), "{shown}"),
        }
    }
}
