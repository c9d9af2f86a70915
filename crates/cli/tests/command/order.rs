//! Chapter 10 of the rules: the effect of the order of programs.

mod archives;
mod roots;
mod variables;
mod ways;

use std::fs;

use crate::folder::Bench;
use archives::{AXES, Program};
use frictcomp_testing::generator::Choices;
use serde_json::Value;

const MACHINE: &str = "\
[[axis]]
name = \"X\"
frict_comp = true
compensations = [\"LEAD\"]
[[axis]]
name = \"Y\"
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
[[axis]]
name = \"C\"
type = \"R\"
frict_comp = true
[[axis]]
name = \"Z\"
frict_comp = false
";

fn bench(programs: &[(&str, &str)]) -> Bench {
    let bench = Bench::new(programs);
    bench.write("frictcomp.toml", MACHINE);
    bench
}

fn text(bench: &Bench, arguments: &[&str]) -> String {
    let output = bench.call(arguments);
    assert_ne!(output.status.code(), Some(2), "{output:?}");
    String::from_utf8(output.stdout).expect("text")
}

fn records(bench: &Bench, arguments: &[&str]) -> Vec<Value> {
    let arguments = [&["audit", "--format", "ndjson"], arguments].concat();
    let text = text(bench, &arguments);
    let records = text
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"));
    records.collect()
}

fn of<'a>(records: &'a [Value], kind: &str) -> Vec<&'a Value> {
    records.iter().filter(|it| it["record"] == kind).collect()
}

fn axis<'a>(records: &'a [Value], file: &str, axis: &str) -> &'a Value {
    let program = of(records, "program")
        .into_iter()
        .find(|it| it["file"] == file);
    &program.expect("the program")["axes"][axis]
}

#[test]
fn random_archives_do_what_they_were_made_to_do() {
    // R10.1, R10.2
    for seed in 1..40 {
        let mut choices = Choices::of_seed(seed);
        let bench = bench(&[]);
        let count = 1 + choices.below(12);
        let programs: Vec<Program> = (0..count)
            .map(|at| Program::random(&mut choices, at))
            .collect();
        for program in &programs {
            fs::write(bench.folder().join(&program.name), &program.bytes).expect("written");
        }
        let records = records(&bench, &[]);
        assert_eq!(records[0]["schema"], 2);
        for program in &programs {
            for (name, expected) in program.expected() {
                let found = axis(&records, &program.name, name);
                let what = format!("seed {seed}, {} {name}: {found}", program.name);
                assert_eq!(found["effect"], expected.effect, "{what}");
                let by = expected.by.map_or(Value::Null, Value::from);
                assert_eq!(found["by"]["line"], by, "{what}");
                match expected.inherits {
                    None => assert_eq!(found["inherits"], "no", "{what}"),
                    Some((line, rapid)) => {
                        assert_eq!(found["inherits"]["line"], line, "{what}");
                        let pace = if rapid { "rapid" } else { "feed" };
                        assert_eq!(found["inherits"]["motion"], pace, "{what}");
                    }
                }
            }
        }
        for (at, name) in AXES.iter().copied().enumerate() {
            let count = |is: &dyn Fn(&archives::Expected) -> bool| {
                programs
                    .iter()
                    .filter(|it| is(&it.expected()[name]))
                    .count()
            };
            let leavers = count(&|it| it.effect == "leaves off");
            let inheritors = count(&|it| it.inherits.is_some());
            let both = count(&|it| it.effect == "leaves off" && it.inherits.is_some());
            let found = of(&records, "axis")[at];
            assert_eq!(found["axis"], name);
            for (key, wanted) in [
                ("leavers", leavers),
                ("inheritors", inheritors),
                ("both", both),
                ("hazards", leavers * inheritors),
                ("unknown", 0),
            ] {
                assert_eq!(found[key], wanted, "seed {seed}, {name} {key}");
            }
            let cure = match (leavers, inheritors) {
                (0, _) | (_, 0) => "none",
                (leavers, inheritors) if leavers <= inheritors => "leavers",
                _ => "inheritors",
            };
            assert_eq!(found["cure"], cure, "seed {seed}, {name}");
        }
    }
}

/// The lines of a file without their ends, and the ends.
fn lines(bytes: &[u8]) -> Vec<(String, String)> {
    let lines = bytes.split_inclusive(|byte| *byte == b'\n');
    let split = |line: &[u8]| {
        let text: String = line.iter().copied().map(char::from).collect();
        let bare = text.trim_end_matches(['\r', '\n']).to_owned();
        let end = text[bare.len()..].to_owned();
        (bare, end)
    };
    lines.map(split).collect()
}

/// The blocks that were inserted; everything else has to be what it was.
fn inserted(before: &[u8], after: &[u8]) -> Vec<String> {
    let (before, after) = (lines(before), lines(after));
    let usual = before.first().map_or("\n", |(_, end)| end.as_str());
    let mut blocks = Vec::new();
    let mut old = before.iter().peekable();
    for (at, (line, end)) in after.iter().enumerate() {
        let is_last = at + 1 == after.len();
        if let Some((text, was)) = old.next_if(|(text, _)| text == line) {
            assert_eq!(text, line);
            // A last line without an end gets one when a block follows it.
            assert!(was == end || (was.is_empty() && end == usual), "{line:?}");
        } else {
            assert!(end == usual || is_last, "{line:?} {end:?}");
            blocks.push(line.clone());
        }
    }
    assert_eq!(old.next(), None, "a line is gone");
    blocks
}

fn number(line: &str) -> Option<u64> {
    let digits = line.strip_prefix('N')?;
    let end = digits
        .find(|it: char| !it.is_ascii_digit())
        .unwrap_or(digits.len());
    digits[..end].parse().ok()
}

#[test]
fn every_cure_ends_every_hazard_and_changes_nothing_else() {
    // R10.3
    let mut mended = 0;
    for seed in 1..20 {
        for fix in ["leavers", "inheritors", "smaller"] {
            let mut choices = Choices::of_seed(seed);
            let bench = bench(&[]);
            let count = 2 + choices.below(8);
            let programs: Vec<Program> = (0..count)
                .map(|at| Program::random(&mut choices, at))
                .collect();
            for program in &programs {
                fs::write(bench.folder().join(&program.name), &program.bytes).expect("written");
            }
            let shown = text(&bench, &["audit", &format!("--diff={fix}")]);
            for program in &programs {
                let now = fs::read(bench.folder().join(&program.name)).expect("read");
                assert_eq!(now, program.bytes, "a diff changes nothing");
            }
            text(&bench, &["audit", &format!("--fix={fix}")]);
            let mut all = 0;
            for program in &programs {
                let now = fs::read(bench.folder().join(&program.name)).expect("read");
                let blocks = inserted(&program.bytes, &now);
                let old: Vec<u64> = lines(&program.bytes)
                    .iter()
                    .filter_map(|(line, _)| number(line))
                    .collect();
                // A block after a remark at the end of the text has no number, since the remark has none.
                let before = lines(&program.bytes);
                let last = before.iter().rfind(|(line, _)| !line.is_empty());
                let is_remark = last.is_some_and(|(line, _)| line.starts_with(';'));
                let mut new = Vec::new();
                for block in &blocks {
                    let command = block.rsplit(' ').next_back();
                    assert!(
                        command.is_some() && block.ends_with("[COMP ON FRICT]"),
                        "{block}"
                    );
                    assert!(
                        shown.contains(&format!("+{block}\n")),
                        "{block} in\n{shown}"
                    );
                    let number = number(block);
                    let is_numbered = number.is_some() != old.is_empty();
                    assert!(is_numbered || is_remark, "seed {seed}: {block}");
                    if let Some(number) = number {
                        assert!(!old.contains(&number) && !new.contains(&number), "{block}");
                        new.push(number);
                    }
                }
                all += blocks.len();
            }
            let plus = shown
                .lines()
                .filter(|it| it.starts_with('+') && !it.starts_with("+++"));
            assert!(plus.count() >= all, "{shown}");
            let after = records(&bench, &["--fail-on", "warning"]);
            for axis in of(&after, "axis") {
                assert_eq!(axis["hazards"], 0, "seed {seed}, {fix}: {axis}");
            }
            // Some of the programs have only comments (R18.6).
            let arguments = ["audit", "--fail-on", "warning", "--ignore", "FC103"];
            assert_eq!(bench.status(&arguments), Some(0), "seed {seed}, {fix}");
            mended += all;
        }
    }
    assert!(mended > 100, "only {mended} blocks");
}

#[test]
fn the_selection_counts_whatever_the_parameterisation() {
    // R10.1: C has no value list, Z is not configured.
    let bench = bench(&[
        ("a.nc", "C[COMP OFF FRICT]\nG0 C1 Z1\nM30\n"),
        ("b.nc", "G0 C1 Z1\nM30\n"),
    ]);
    let records = records(&bench, &[]);
    assert_eq!(axis(&records, "a.nc", "C")["effect"], "leaves off");
    assert_eq!(axis(&records, "b.nc", "C")["inherits"]["line"], 1);
    assert!(axis(&records, "a.nc", "Z").is_null());
    assert_eq!(of(&records, "axis").len(), 3);
}

#[test]
fn what_is_not_known_has_its_reason_or_its_ways() {
    // R10.1 R14.6
    let bench = bench(&[
        (
            "value.nc",
            "X[COMP ON FRICT]\n$IF V.E.SENSOR == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30\n",
        ),
        ("error.nc", "Z[COMP ON FRICT]\nX1\nM30\n"),
        (
            "budget.nc",
            "X[COMP ON FRICT]\n$WHILE 1\nX1\n$ENDWHILE\nM30\n",
        ),
        (
            "toggle.nc",
            "$IF V.A.FRICT_COMP_ACTIVE.Y == 1\nX[COMP OFF FRICT]\n$ELSE\nX[COMP ON FRICT]\n$ENDIF\nM30\n",
        ),
        (
            "region.nc",
            "$IF V.E.SENSOR == 1\nG01 F1 X1\n$ENDIF\nX[COMP ON FRICT]\nM30\n",
        ),
        (
            "jump.nc",
            "$IF V.E.SENSOR == 1\n$GOTO N90\n$ENDIF\nX[COMP ON FRICT]\nN90: G01 F1 X1\nX[COMP ON FRICT]\nM30\n",
        ),
    ]);
    let records = records(&bench, &[]);
    let x = |file| axis(&records, file, "X");
    assert_eq!(x("value.nc")["effect"], "depends");
    let way = &x("value.nc")["possible"][0]["ways"][0][0];
    assert_eq!(
        (&way["text"], &way["line"]),
        (&"V.E.SENSOR == 1".into(), &2.into())
    );
    assert_eq!(x("error.nc")["reason"]["code"], "P-ERR-70495");
    assert_eq!(x("error.nc")["inherits"], "unknown");
    assert_eq!(x("budget.nc")["effect"], "unknown");
    assert_eq!(x("budget.nc")["inherits"], "no");
    assert_eq!(x("toggle.nc")["effect"], "depends");
    assert_eq!(x("region.nc")["effect"], "leaves on");
    assert_eq!(x("region.nc")["inherits"]["perhaps"], true);
    assert_eq!(x("jump.nc")["inherits"]["line"], 5);
    assert_eq!(x("jump.nc")["inherits"]["perhaps"], true);
}

#[test]
fn what_may_be_left_is_no_all_clear() {
    // R10.2, R10.5, R18.23
    let maybe = "X[COMP ON FRICT]\n$IF V.E.SENSOR == 1\nX[COMP OFF FRICT]\n$ENDIF\nM30\n";
    let bench = bench(&[("maybe.nc", maybe), ("moves.nc", "X1\nM30\n")]);
    let output = bench.call(&["audit", "--fail-on", "warning"]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stdout).expect("text");
    assert!(
        said.contains("1 program leaves X off, 1 runs with it off"),
        "{said}"
    );
    text(&bench, &["audit", "--fix=smaller"]);
    assert!(
        bench
            .read("maybe.nc")
            .ends_with("$ENDIF\nX[COMP ON FRICT]\nM30\n")
    );
    let output = bench.call(&["audit", "--fail-on", "warning"]);
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn hazards_are_warnings() {
    // R10.5
    let bench = bench(&[("a.nc", "N10 X1\nN20 X[COMP OFF FRICT]\nN30 M30\n")]);
    for (fail_on, status) in [("error", 0), ("warning", 1), ("info", 1), ("never", 0)] {
        let output = bench.call(&["audit", "--fail-on", fail_on]);
        assert_eq!(output.status.code(), Some(status), "{fail_on}");
    }
    let said = text(&bench, &["audit"]);
    // R1.53 comes first.
    assert!(
        said.contains(
            "the second run differs from the first:\n    a.nc:2, a.nc:1 (moves in rapid)"
        ),
        "{said}"
    );
}

#[test]
fn the_block_stands_where_every_way_comes_by() {
    // R10.3: the end is a jump target, in a branch, in a subprogram, or after other programs.
    for (before, after) in [
        (
            "X[COMP OFF FRICT]\n$GOTO N90\nX5\nN90: M30\n",
            "X[COMP OFF FRICT]\nX[COMP ON FRICT]\n$GOTO N90\nX5\nN90: M30\n",
        ),
        (
            "X[COMP OFF FRICT]\n$IF 1\n  M30\n$ENDIF\nM30\n",
            "X[COMP OFF FRICT]\n$IF 1\n  X[COMP ON FRICT]\n  M30\n$ENDIF\nM30\n",
        ),
        (
            "%L S\nX[COMP OFF FRICT]\nM17\n%MAIN\nLL S\nM30\n",
            "%L S\nX[COMP OFF FRICT]\nM17\n%MAIN\nLL S\nX[COMP ON FRICT]\nM30\n",
        ),
        (
            "X[COMP OFF FRICT]\nG0 Y1 M30\n",
            "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nG0 Y1 M30\n",
        ),
        ("X[COMP OFF FRICT]", "X[COMP OFF FRICT]\nX[COMP ON FRICT]"),
        (
            "n8 X[COMP OFF FRICT]\nn9 m30\n",
            "n8 X[COMP OFF FRICT]\nN10 X[COMP ON FRICT]\nn9 m30\n",
        ),
    ] {
        let bench = bench(&[
            ("a.nc", before),
            ("b.nc", "X1\nM30\n"),
            ("c.nc", "X1\nM30\n"),
        ]);
        text(&bench, &["audit", "--fix=leavers"]);
        assert_eq!(bench.read("a.nc"), after);
        let found = records(&bench, &[]);
        assert_eq!(of(&found, "axis")[0]["hazards"], 0);
    }
}

#[test]
fn nothing_is_written_that_cannot_be_undone() {
    // R10.3: what no block corrects remains and is reported; a refusal writes nothing.
    let error = "X1\nX[COMP OFF FRICT]\nM30\n";
    let bench = bench(&[("a.nc", error)]);
    for arguments in [
        &["audit", "--write"][..],
        &["audit", "--fix=all"],
        &["audit", "--fix", "--diff"],
        &["audit", "--diff=smaller", "--format", "json"],
        &["audit", "-"],
        &["audit", "--sequence", "none.txt"],
        &["audit", "--sequence", "a.nc", "--html", "a.html"],
        &["audit", "--html", "a.nc"],
        &["audit", "none.nc"],
        &["audit", "--kinds", "FRIKT"],
    ] {
        let output = bench.call(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
        assert_eq!(bench.read("a.nc"), error);
    }
}

#[test]
fn every_kind_can_be_audited() {
    // R10.1
    let bench = bench(&[("a.nc", "X[COMP OFF LEAD]\nM30\n"), ("b.nc", "X1\nM30\n")]);
    let records = records(&bench, &["--kinds"]);
    let lead: Vec<_> = of(&records, "program")
        .into_iter()
        .filter(|it| it["kind"] == "LEAD")
        .collect();
    assert_eq!(lead.len(), 2);
    assert_eq!(lead[0]["axes"]["X"]["effect"], "leaves off");
    let axes = of(&records, "axis");
    let lead = axes
        .iter()
        .find(|it| it["axis"] == "X" && it["kind"] == "LEAD")
        .expect("LEAD");
    assert_eq!(lead["hazards"], 1);
    let frict = axes
        .iter()
        .find(|it| it["axis"] == "X" && it["kind"] == "FRICT")
        .expect("FRICT");
    assert_eq!(frict["hazards"], 0);
    assert!(
        text(&bench, &["audit", "--kinds", "LEAD"]).contains("X LEAD: 1 program leaves it off")
    );
}

#[test]
fn the_order_of_the_shop_is_followed() {
    // R10.6
    let bench = bench(&[
        ("off.nc", "X[COMP OFF FRICT]\nG01 F1 X1\nM30\n"),
        ("moves.nc", "G0 X1 Y1\nM30\n"),
        ("stops.nc", "X[COMP ON FRICT]\nZ[COMP ON FRICT]\nM30\n"),
        (
            "order.txt",
            "# Monday\noff.nc\n\nmoves.nc\nstops.nc\nmoves.nc\n",
        ),
    ]);
    let said = text(
        &bench,
        &["audit", "--sequence", "order.txt", "--width", "200"],
    );
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(
        lines[..2],
        [
            "off.nc: X on → off at line 1, moves outside its start-up state at line 2 (feed)",
            "moves.nc: X stays off, moves outside its start-up state at line 1 (rapid), left so by off.nc",
        ]
    );
    assert!(
        lines[2].starts_with("stops.nc: X off → on at line 1; stops, P-ERR-70495: "),
        "{said}"
    );
    assert_eq!(lines[3], "moves.nc: every axis in its start-up state");
    let records = text(
        &bench,
        &["audit", "--sequence", "order.txt", "--format", "ndjson"],
    );
    let second: Value =
        serde_json::from_str(records.lines().nth(1).expect("a line")).expect("JSON");
    assert_eq!(second["position"], 2);
    assert_eq!(second["axes"]["X"]["left_by"], "off.nc");
    let status = |order: &str| {
        bench.write("order.txt", order);
        let output = bench.call(&["audit", "--sequence", "order.txt", "--fail-on", "warning"]);
        output.status.code()
    };
    assert_eq!(status("moves.nc\noff.nc\n"), Some(0));
    assert_eq!(status("off.nc\nmoves.nc\n"), Some(1));
    assert_eq!(status("\n"), Some(2));
}

#[test]
fn the_page_leads_to_the_lines() {
    // R10.5
    let bench = bench(&[
        ("a.nc", "N10 X1\nN20 X[COMP OFF FRICT] ; <b>\nN30 M30\n"),
        ("b.nc", "X1\nM30\n"),
    ]);
    text(&bench, &["audit", "--html", "audit.html"]);
    let page = bench.read("audit.html");
    assert!(!page.contains("<b>") && page.contains("&lt;b&gt;"));
    for link in page.split("href=\"#").skip(1) {
        let id = link.split('"').next().expect("an identifier");
        assert!(page.contains(&format!("id=\"{id}\"")), "{id}");
    }
    assert!(page.matches("href=\"#f").count() >= 4, "{page}");
}

#[test]
fn long_archives_are_folded_and_never_paired() {
    // R10.4, R10.5
    let bench = bench(&[]);
    for at in 0..300 {
        let text = if at % 2 == 0 {
            "X[COMP OFF FRICT]\nM30\n"
        } else {
            "X1\nM30\n"
        };
        bench.write(&format!("p{at:03}.nc"), text);
    }
    let found = records(&bench, &[]);
    assert_eq!(of(&found, "axis")[0]["hazards"], 150 * 150);
    assert_eq!(found.len(), 300 + 3 + 1);
    let said = text(&bench, &["audit"]);
    assert!(said.lines().count() < 100, "{said}");
    assert!(
        said.contains("… 260 more programs: 110 leaves, 150 inherits"),
        "{said}"
    );
    assert!(text(&bench, &["audit", "--all"]).lines().count() > 600);
}

#[test]
fn the_state_at_an_error_of_one_way_reaches_the_next_program() {
    // R18.10 R2.100
    let bench = bench(&[
        (
            "guard.nc",
            "X[COMP OFF FRICT]\n$IF V.E.A\n#ERROR [ID=5 RC=2]\n$ENDIF\nX[COMP ON FRICT]\nM30\n",
        ),
        (
            "stops.nc",
            "X[COMP OFF FRICT]\n#ERROR [RC=2]\nX[COMP ON FRICT]\nM30\n",
        ),
        ("moves.nc", "G01 X1 F100\nM30\n"),
        ("order.txt", "guard.nc\nmoves.nc\n"),
        ("certain.txt", "stops.nc\nmoves.nc\n"),
    ]);
    let records = records(&bench, &[]);
    let x = |file| axis(&records, file, "X");
    assert_eq!(x("guard.nc")["effect"], "depends");
    assert_eq!(x("guard.nc")["by"]["line"], 1);
    let way = &x("guard.nc")["possible"][0]["ways"][0][0];
    assert_eq!((&way["text"], &way["line"]), (&"V.E.A".into(), &2.into()));
    assert_eq!(x("stops.nc")["effect"], "leaves off");
    let order = |name: &str| text(&bench, &["audit", "--sequence", name, "--width", "200"]);
    let said = order("order.txt");
    assert!(said.contains("if V.E.A"), "{said}");
    let said = order("certain.txt");
    assert!(said.contains("stops, FC318: "), "{said}");
    assert!(said.contains("moves outside its start-up state"), "{said}");
    // What a run saves is what the next one starts with.
    bench.call(&["run", "--state", "s.json", "guard.nc"]);
    let next = text(
        &bench,
        &["run", "--state", "s.json", "moves.nc", "--width", "200"],
    );
    assert!(
        next.contains("inactive if V.E.A (guard.nc:2), else ineffective"),
        "{next}"
    );
    let fixed = bench.call(&["audit", "--fix=leavers"]);
    assert!(fixed.status.code().is_some());
    let mended = bench.read("guard.nc");
    assert!(mended.contains("X[COMP ON FRICT]\n#ERROR"), "{mended}");
}

#[test]
fn axes_of_one_name_are_told_apart_by_their_machines() {
    // R18.23
    let leaves = "X[COMP OFF FRICT]\nM30\n";
    let bench = Bench::new(&[]);
    for (folder, axes) in [("one", "X"), ("two", "XY")] {
        fs::create_dir(bench.folder().join(folder)).expect("a folder");
        let axis = |axis| format!("[[axis]]\nname = \"{axis}\"\nfrict_comp = true\n");
        let machine: String = axes.chars().map(axis).collect();
        bench.write(&format!("{folder}/frictcomp.toml"), &machine);
        bench.write(&format!("{folder}/leaves.nc"), leaves);
        bench.write(&format!("{folder}/moves.nc"), "X1 Y1\nM30\n");
    }
    bench.write("two/other.nc", "Y[COMP OFF FRICT]\nM30\n");
    let said = text(&bench, &["audit", "one", "two"]);
    let said = crate::folder::one_line(&said);
    for cause in [
        "1 program leaves X (one/frictcomp.toml) off, 1 runs with it off",
        "1 program leaves X (two/frictcomp.toml) off, 1 runs with it off",
        "1 program leaves Y off, 1 runs with it off",
    ] {
        assert!(said.contains(cause), "{said}");
    }
}
