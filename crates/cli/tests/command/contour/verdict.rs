//! The verdict on a contour, and what its figures rest on.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use serde_json::Value;

use super::{MACHINE, circle, number};
use crate::folder::{Bench, json};

/// Axes of which only the compensation is known.
const NO_LIMITS: &str = "\
[[axis]]
name = \"X\"
frict_comp = true
[[axis]]
name = \"Y\"
frict_comp = true
[[axis]]
name = \"Z\"
";

/// Returns a circle of 5 mm in lines of 0.1 mm.
fn short_lines(compensation: &str) -> String {
    let mut text = format!(
        "X[COMP {compensation} FRICT] Y[COMP {compensation} FRICT]\r\nN10 G01 X5 Y-5 F2000\r\nY0\r\n"
    );
    for step in 1..=314 {
        let angle = f64::from(step) / 314.0 * TAU;
        let _ = write!(
            text,
            "X{:.5} Y{:.5}\r\n",
            5.0 * angle.cos(),
            5.0 * angle.sin()
        );
    }
    text + "N20 G01 Y5\r\nM30\r\n"
}

fn bench(program: &str, machine: &str) -> Bench {
    let bench = Bench::new(&[("part.nc", program)]);
    bench.write("frictcomp.toml", machine);
    bench
}

const START: [&str; 2] = ["--start", "X5,Y-10,Z0"];

/// Returns the exit status, standard output and standard error.
fn contour(bench: &Bench, arguments: &[&str]) -> (Option<i32>, String, String) {
    let fixed = ["contour", "-v", "part.nc", "--width", "400"];
    let output = bench.call(&[&fixed[..], &START, arguments].concat());
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

fn document(bench: &Bench, arguments: &[&str]) -> Value {
    json(&contour(bench, &[arguments, &["--format", "json"]].concat()).1)
}

#[test]
fn a_feed_that_assumed_limits_do_not_reach_is_not_judged() {
    // R11.23: the assumed jerk nearly stops the path at every corner; the deviation looks fine.
    let bench = bench(&short_lines("OFF"), NO_LIMITS);
    let limit = ["--fail-above", "500"];
    let (status, text, said) = contour(&bench, &limit);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("not judged: "), "{text}");
    assert!(said.contains("because of assumed limits"), "{said}");
    assert!(
        text.contains("limits assumed for X Y: 10000 mm/min, 1 m/s², 20 m/s³; give those"),
        "{text}"
    );
    for key in ["`max_velocity`", "`max_acceleration`", "`max_jerk`"] {
        assert!(text.contains(key), "{text}");
    }
    assert!(text.contains("feed: 2000 mm/min programmed, "), "{text}");
    let found = document(&bench, &limit);
    assert_eq!(found["verdict"], "not judged");
    assert_eq!(found["not_judged"].as_array().expect("reasons").len(), 1);
    let feed = &found["feed"];
    assert!(
        (number(&feed["programmed"]) - 2000.0).abs() < 0.01,
        "{feed}"
    );
    assert!(number(&feed["reached"]) < 400.0, "{feed}");
    assert!(number(&feed["slow_share_assumed"]) > 0.9, "{feed}");
    let assumed = found["assumed_limits"].as_array().expect("limits");
    assert_eq!(assumed.len(), 2, "{assumed:?}");
    assert_eq!(assumed[1]["max_jerk"], 20.0);
    // The other limit does no better.
    let (status, ..) = contour(&bench, &["--fail-above-due", "500"]);
    assert_eq!(status, Some(1));
    // Without a limit it is reported, and nothing fails.
    assert_eq!(contour(&bench, &[]).0, Some(0));
}

#[test]
fn what_is_slow_for_another_reason_is_judged() {
    // R11.23: the jerk is that of the machine, or the assumed limits do not matter.
    let given = NO_LIMITS.replace(
        "frict_comp = true\n",
        "frict_comp = true\nmax_acceleration = 1.0\nmax_jerk = 20.0\n",
    );
    let limit = ["--fail-above", "500"];
    let slow = bench(&short_lines("OFF"), &given);
    let (status, text, _) = contour(&slow, &limit);
    assert_eq!(status, Some(0), "{text}");
    assert!(
        text.contains("limits assumed for X Y: 10000 mm/min; give"),
        "{text}"
    );
    let found = document(&slow, &limit);
    assert_eq!(found["verdict"], "within");
    assert!(number(&found["feed"]["slow_share"]) > 0.9, "{found}");
    let arc = "N10 G01 X5 Y-5 F2000\nN20 G03 X5 Y-5 I-5 J5\nM30\n";
    let found = document(&bench(arc, &given), &limit);
    assert_eq!(found["verdict"], "within", "{found}");
    // A feed beyond the assumed velocity is never reached, and G194 is a share of it.
    for fast in [
        "G01 X-400 F20000\nX5\nM30\n",
        "G194\nG01 X-400 F50\nX5\nM30\n",
    ] {
        let found = document(&bench(fast, &given), &limit);
        assert_eq!(found["verdict"], "not judged", "{fast}{found}");
    }
    let given = given.replace("max_jerk", "max_velocity = 60000\nmax_jerk");
    let fast = bench("G194\nG01 X-400 F20\nX5\nM30\n", &given);
    assert_eq!(document(&fast, &limit)["verdict"], "within");
}

#[test]
fn only_axes_that_move_have_limits_that_matter() {
    // R11.23: Z has none, and is at standstill.
    let bench = bench(&circle("G03", "OFF"), MACHINE);
    let found = document(&bench, &[]);
    let assumed = found["assumed_limits"].as_array().expect("limits");
    let axes: Vec<&Value> = assumed.iter().map(|it| &it["axis"]).collect();
    assert_eq!(axes, ["X", "Y"]);
    assert_eq!(assumed[0]["max_jerk"], Value::Null);
}

#[test]
fn every_format_has_the_feed_that_is_reached() {
    // R11.23
    let bench = bench(&short_lines("ON"), NO_LIMITS);
    let run = |format: &str| contour(&bench, &["--format", format]);
    let found = document(&bench, &["--html", "a.html", "--svg", "a.svg"]);
    let reversals = found["reversals"].as_array().expect("reversals");
    let cut: Vec<&Value> = reversals
        .iter()
        .filter(|it| it["movement"] == "feed")
        .collect();
    assert!(cut.len() >= 3, "{reversals:?}");
    for reversal in cut {
        assert!((number(&reversal["feed_programmed"]) - 2000.0).abs() < 0.01);
        assert!(number(&reversal["feed"]) < 400.0);
    }
    let lines: Vec<Value> = run("ndjson").1.lines().map(json).collect();
    let summary = lines.last().expect("a summary");
    assert_eq!(summary["feed"], found["feed"]);
    assert_eq!(lines[0]["feed_programmed"], reversals[0]["feed_programmed"]);
    let (_, csv, said) = run("csv");
    let rows: Vec<&str> = csv.lines().collect();
    assert!(rows[0].ends_with(",feed_programmed"), "{}", rows[0]);
    assert!(rows[1..].iter().all(|row| row.ends_with(",2000")), "{csv}");
    assert!(said.contains("feed: 2000 mm/min programmed"), "{said}");
    assert!(said.contains("limits assumed for X Y"), "{said}");
    let page = bench.read("a.html");
    for words in [
        "feed: 2000 mm/min programmed",
        "limits assumed for X Y",
        "slowest",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(bench.read("a.svg").contains("part.nc, not judged"));
}

#[test]
fn missing_compensation_has_a_limit_of_its_own() {
    // R11.24: the corner deviates whatever is switched; only the arc is due to compensation.
    let with = |compensation: &str| {
        let program = format!("G01 X-15 Y-10 F6000\n{}", circle("G03", compensation));
        bench(&program, MACHINE)
    };
    let status = |bench: &Bench, option: &str, um: &str| contour(bench, &[option, um]).0;
    let (on, off) = (with("ON"), with("OFF"));
    assert_eq!(status(&on, "--fail-above-due", "0"), Some(0));
    assert_eq!(status(&on, "--fail-above", "2"), Some(1));
    assert_eq!(status(&off, "--fail-above-due", "5"), Some(1));
    assert_eq!(status(&off, "--fail-above-due", "100"), Some(0));
    assert_eq!(status(&off, "--fail-above-due", "-1"), Some(2));
    let (_, text, said) = contour(&off, &["--fail-above-due", "5"]);
    assert!(text.contains("missing compensation costs up to "), "{text}");
    assert!(
        said.contains("the cost of missing compensation, "),
        "{said}"
    );
    let found = document(&off, &[]);
    let due = number(&found["due"]["max"]);
    assert!(
        due > 10.0 && due <= number(&found["programmed"]["max"]),
        "{found}"
    );
    assert!((5..=7).contains(&found["due"]["max_at"]["line"].as_u64().expect("a line")));
    assert_eq!(document(&on, &[])["due"]["max_at"], Value::Null);
}

#[test]
fn an_axis_beside_the_plane_is_due_too() {
    // R11.24
    let program = "Z[COMP OFF FRICT]\nG18\nG01 X10 Z0 F2000\nG03 X10 Z0 I-10 K0\nM30\n";
    let machine = MACHINE.replace(
        "name = \"Z\"",
        "name = \"Z\"\nfrict_comp = true\nmax_jerk = 1000.0",
    );
    let (status, text, _) = contour(&bench(program, &machine), &["--fail-above-due", "5"]);
    assert_eq!(status, Some(1), "{text}");
}

#[test]
fn every_figure_has_its_line_and_block() {
    // R11.24
    let program = circle("G02", "OFF").replace("\nG0", "\nN70 G0");
    let bench = bench(&program, MACHINE);
    let found = document(&bench, &[]);
    for run in ["programmed", "all_on", "all_off"] {
        for at in ["max_at", "outermost_at", "innermost_at"] {
            let at = &found[run][at];
            assert_eq!(at["file"], "part.nc", "{run} {at}");
            assert!(at["line"].is_u64() && at["n"] == 70, "{run} {at}");
        }
    }
    for axis in &found["axes"].as_array().expect("axes")[..2] {
        assert_eq!(axis["worst"]["n"], 70, "{axis}");
        assert_eq!(axis["uncompensated_at"]["n"], 70, "{axis}");
    }
    let (_, text, _) = contour(&bench, &[]);
    for figure in [
        "largest deviation at part.nc:",
        "outermost at part.nc:",
        "innermost at ",
    ] {
        let line = text.lines().find(|line| line.starts_with(figure));
        assert!(
            line.is_some_and(|line| line.contains(" N70")),
            "{figure}: {text}"
        );
    }
    assert!(text.contains(" µm with it, at part.nc:"), "{text}");
}

#[test]
fn what_was_left_out_does_not_count_as_no_reversal() {
    // R11.24: it is not known whether X reverses in the motion that is left out.
    let program = "G01 X10 Y5 F1000\nG01 X=V.E.A\nG90 G00 X0 Y0\nG01 X5 Y5\nM30\n";
    let left_out = bench(program, MACHINE);
    let (status, text, said) = contour(&left_out, &["--fail-above-due", "50"]);
    assert_eq!(status, Some(1), "{text}");
    assert!(!text.contains("does not reverse"), "{text}");
    assert!(said.contains("not judged: "), "{said}");
    let (_, text, _) = contour(&bench("G01 X10 Y5 F1000\nM30\n", MACHINE), &[]);
    assert!(text.contains("X does not reverse while cutting"), "{text}");
    let (status, text, said) = contour(&left_out, &["--fail-above", "500", "--max-cycles", "50"]);
    assert_eq!(status, Some(1), "{text}");
    assert!(said.contains("FC915"), "{said}");
}

#[test]
fn feed_moves_that_are_left_out_are_named_and_rapid_ones_are_not() {
    // R18.11: the rapid motion begins where nobody knows, and the circle has no centre.
    let bench = self::bench(
        "G00 X0 Y0 Z0\nG01 X20 F1000\nG03 X0\nG01 X5\nM30\n",
        MACHINE,
    );
    let call = bench.call(&["contour", "part.nc", "--format", "json"]);
    let found = json(&String::from_utf8(call.stdout).expect("text"));
    let reason = "1 motion is left out, whose start, end or feed is not known: part.nc:3";
    assert!(
        found["not_judged"]
            .as_array()
            .expect("reasons")
            .contains(&reason.into()),
        "{found}"
    );
}

#[test]
fn a_program_that_cuts_nothing_is_not_judged() {
    // R11.23: rapid moves have no contour.
    let bench = bench("G90 G00 X20\nG00 X5\nG00 X20\nM30\n", MACHINE);
    for limit in ["--fail-above", "--fail-above-due"] {
        let (status, text, said) = contour(&bench, &[limit, "50"]);
        assert_eq!(status, Some(1), "{text}");
        assert!(
            text.contains("not judged: no feed move is driven"),
            "{text}"
        );
        assert!(said.contains("not judged"), "{said}");
    }
}

#[test]
fn a_reversal_along_the_path_is_called_so() {
    // R11.26: X moves back and forth on its own line, so that it has no component normal to the path.
    let forth_and_back = "G90 G01 X20 F2000\nN20 G01 X5\nN30 G01 X20\nM30\n";
    for command in ["", "X[COMP OFF FRICT] "] {
        let bench = bench(&format!("{command}{forth_and_back}"), MACHINE);
        let (_, text, _) = contour(&bench, &[]);
        let sentence = text
            .lines()
            .find(|line| line.starts_with("X reverses twice"));
        let sentence = sentence.expect("a sentence on X");
        assert!(sentence.contains("N20, along the path"), "{text}");
        assert!(!sentence.contains("0.0 µm"), "{text}");
        let rows = text
            .lines()
            .filter(|line| line.contains("N20") && line.contains("  X "));
        for row in rows {
            assert!(row.ends_with("N20 (along the path)"), "{text}");
        }
        let found = document(&bench, &[]);
        assert_eq!(found["axes"][0]["worst"]["glitch"], 0.0, "{found}");
    }
}

/// Returns a machine whose X has a list with this output at every velocity.
fn listed(output: f64) -> String {
    MACHINE.replacen(
        "max_jerk",
        &format!(
            "value = {{ mode = 3, table_entries = 2, table = [[0, {output}], [200000, {output}]] }}\nmax_jerk"
        ),
        1,
    )
}

#[test]
fn a_list_of_another_machine_is_named() {
    // R11.25: the plant has some 700 N of friction, 140 of its drive units.
    let said = |output: f64| {
        let bench = bench(&circle("G03", "ON"), &listed(output));
        let (_, text, _) = contour(&bench, &[]);
        assert!(
            text.contains("the list of the machine, 5 N a drive unit"),
            "{text}"
        );
        assert!(
            text.contains("friction curve of the plant, 5 N a drive unit"),
            "{text}"
        );
        let found = document(&bench, &[]);
        assert_eq!(found["axes"][0]["newtons_per_unit"], 5.0);
        let lines = text
            .lines()
            .filter(|line| line.contains("do not belong together"));
        let lines = lines.count();
        assert_eq!(found["axes"][0]["belongs"], lines == 0, "{found}");
        assert_eq!(found["axes"][1]["belongs"], true, "{found}");
        lines
    };
    for (output, lines) in [
        (20.0, 1),
        (60.0, 1),
        (80.0, 0),
        (200.0, 0),
        (400.0, 1),
        (-140.0, 1),
    ] {
        assert_eq!(said(output), lines, "{output}");
    }
}

#[test]
fn versions_that_are_not_judged_are_not_compared() {
    // R9.83, R9.84, R11.23
    let bench = bench(&short_lines("ON"), NO_LIMITS);
    let other = short_lines("ON").replace("N20 ", "N30 ");
    bench.write("new.nc", &other);
    let fixed = ["diff", "part.nc", "new.nc", "--contour"];
    let call = bench.call(&[&fixed[..], &START].concat());
    assert_eq!(call.status.code(), Some(1));
    let text = String::from_utf8_lossy(&call.stdout).into_owned();
    assert!(
        text.contains("not comparable: the contour of the old version: "),
        "{text}"
    );
    assert!(text.contains("because of assumed limits"), "{text}");
    assert!(
        text.contains("largest deviation of the new version at new.nc:"),
        "{text}"
    );
    let golden = ["golden", "--contour", "part.nc", "--update"];
    assert_eq!(
        bench.call(&[&golden[..], &START].concat()).status.code(),
        Some(0)
    );
    let agreed = bench.read("part.nc.contour");
    assert!(agreed.contains("not judged: "), "{agreed}");
}

#[test]
fn a_stretch_that_only_the_machine_decides_is_not_judged() {
    // R18.11, R14.8: the branch is not driven, and the rapid after it starts anywhere.
    let start = "G90 G17 G01 X5 Y0 F2000\n";
    let rest = "G00 X5 Y0\nG01 X6\nM30\n";
    let cut = "N20 G03 X5 Y0 I-5 J0";
    for branch in [
        format!("$IF V.E.A == 1\n{cut}\n$ENDIF\n"),
        format!("$WHILE V.E.A == 1\n{cut}\n$ENDWHILE\n"),
        format!("$SWITCH V.E.A\n$CASE 1\n{cut}\n$BREAK\n$ENDSWITCH\n"),
        format!("$IF V.E.A == 1 $GOTO N30\n{cut}\nN30: "),
        format!("/{cut}\n"),
    ] {
        let bench = bench(&format!("{start}{branch}{rest}"), MACHINE);
        for limit in ["--fail-above", "--fail-above-due"] {
            let (status, text, said) = contour(&bench, &[limit, "50"]);
            assert_eq!(status, Some(1), "{branch}{text}{said}");
            let reason = text.find("not judged: ");
            let figures = text.find("while cutting, in µm");
            assert!(reason.is_some() && reason < figures, "{branch}{text}");
            assert!(text.contains(" at part.nc:2"), "{branch}{text}");
        }
        let (_, _, said) = contour(&bench, &["--format", "csv"]);
        assert!(said.contains("not judged: "), "{branch}{said}");
        let golden = ["golden", "--contour", "part.nc", "--update"];
        bench.call(&[&golden[..], &START].concat());
        let agreed = bench.read("part.nc.contour");
        let reason = agreed.find("not judged: ");
        let figures = agreed.find("largest deviation");
        assert!(reason.is_some() && reason < figures, "{branch}{agreed}");
        let found = document(&bench, &[]);
        assert_eq!(found["verdict"], "not judged", "{branch}");
        let decided = contour(
            &bench,
            &["--fail-above", "500", "--set", "V.E.A=0", "--skip", "none"],
        );
        assert_eq!(decided.0, Some(0), "{branch}{}", decided.1);
    }
}

#[test]
fn an_axis_that_is_cut_in_an_unknown_state_is_not_judged() {
    // R18.11: no motion is left out, and X may be compensated or not.
    let program = "G90 G17 G01 X5 Y0 F2000\n$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nN20 G03 X5 Y0 I-5 J0\nM30\n";
    let bench = bench(program, MACHINE);
    let (status, text, _) = contour(&bench, &["--fail-above", "500"]);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("the state of X is not known for "), "{text}");
    assert!(text.contains(" of cutting, from part.nc:5 on"), "{text}");
    let (status, text, _) = contour(&bench, &["--fail-above", "500", "--set", "V.E.A=1"]);
    assert_eq!(status, Some(0), "{text}");
}

#[test]
fn a_message_that_is_allowed_decides_nothing() {
    // R18.11
    let lint = format!("{MACHINE}\n[lint]\nFC901 = \"off\"\n");
    for (comment, machine) in [(" ; frictcomp: allow FC901", MACHINE), ("", lint.as_str())] {
        let program = format!(
            "G90 G17 G01 X5 Y0 F2000\n$IF V.E.A == 1{comment}\nN20 G03 X5 Y0 I-5 J0\n$ENDIF\nG00 X5 Y0\nG01 X6\nM30\n"
        );
        let bench = bench(&program, machine);
        let (status, text, said) = contour(&bench, &["--fail-above", "50"]);
        assert_eq!(status, Some(1), "{text}{said}");
        assert!(text.contains(" at part.nc:2"), "{text}");
    }
}

#[test]
fn a_bore_under_tool_radius_compensation_is_judged() {
    // R11.30: without the radius as programmed, which is said; with it as the tool runs.
    let bore = |side: &str, radius: f64| {
        format!(
            "X[COMP OFF FRICT] Y[COMP OFF FRICT]\nG01 X0 Y0 F1000\n{side} X{radius} Y0\nG03 I-{radius}\nI-{radius}\n\
             G40 G01 X0\nM30\n"
        )
    };
    let compensated = self::bench(&bore("G41", 20.0), MACHINE);
    let figures = |bench: &Bench, arguments: &[&str]| {
        let arguments = [&["--fail-above", "500"], arguments].concat();
        let document = document(bench, &arguments);
        assert_eq!(document["verdict"], "within", "{document}");
        let glitches = document["reversals"].as_array().expect("reversals").iter();
        let figures = glitches.filter_map(|it| it["glitch"].as_f64());
        let figures: Vec<f64> = figures.collect();
        assert!(figures.len() >= 4, "{document}");
        figures
    };
    let programmed = figures(&compensated, &[]);
    assert_eq!(
        programmed,
        figures(&self::bench(&bore("", 20.0), MACHINE), &[])
    );
    let (status, _, said) = contour(&compensated, &["--fail-above", "500"]);
    assert_eq!(status, Some(0));
    assert!(
        said.contains("programmed contour") && said.contains("--tool-radius"),
        "{said}"
    );
    let tool = figures(&compensated, &["--tool-radius", "8"]);
    let smaller = figures(&self::bench(&bore("", 12.0), MACHINE), &[]);
    for (tool, smaller) in tool.iter().zip(&smaller) {
        assert!((tool - smaller).abs() <= 0.05 * smaller, "{tool} {smaller}");
    }
    assert_ne!(tool, programmed);
}

#[test]
fn an_origin_that_only_the_machine_knows_is_judged() {
    // R11.30
    for origin in ["G54", "#PSET[X10]", "M123"] {
        let program = format!("{origin}\nG00 X0 Y0 Z0\nG01 X20 F1000\nG03 I-20\nM30\n");
        let bench = self::bench(&program, MACHINE);
        let document = document(&bench, &["--fail-above", "500"]);
        assert_eq!(document["verdict"], "within", "{origin}: {document}");
    }
    let turned = "#ROTATION ON [ANGLE 30]\nG00 X0 Y0 Z0\nG01 X20 F1000\nG03 I-20\nM30\n";
    let document = document(&self::bench(turned, MACHINE), &["--fail-above", "500"]);
    assert_eq!(document["verdict"], "not judged");
}
