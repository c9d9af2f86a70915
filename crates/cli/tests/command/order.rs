//! Chapter 10 of the rules: the effect of the order of programs.

mod archives;
mod roots;

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

/// Returns the lines of a file without their ends, and the ends.
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

/// Returns the blocks that were inserted; everything else has to be what it was.
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
