//! Programs that are started at a block: `run --from`, under every reading (R2.96).

use crate::folder::{Bench, json, one_line};

/// X is switched off before N100, Y is switched off and on again.
const PROGRAM: &str = "N10 X[COMP OFF FRICT]\nN20 G01 X10 F1000\nN30 Y[COMP OFF FRICT]\n\
    N40 Y[COMP ON FRICT]\nN100 G01 X20 Y10\nN110 M30\n";

const AXES: &str = "[[axis]]\nname = \"X\"\nfrict_comp = true\n\
    [axis.value]\nmode = 3\ntable = [[0, 126], [3000, 112]]\n\
    [[axis]]\nname = \"Y\"\nfrict_comp = true\n\
    [axis.value]\nmode = 3\ntable = [[0, 126], [3000, 112]]\n";

fn bench(program: &str, reading: Option<&str>) -> Bench {
    let bench = Bench::new(&[("p.nc", program)]);
    let reading = reading.map(|it| format!("[reading]\n\"R2.96\" = \"{it}\"\n"));
    bench.write(
        "frictcomp.toml",
        &format!("{AXES}{}", reading.unwrap_or_default()),
    );
    bench
}

/// The timeline of a start, with its exit status.
fn started(bench: &Bench, from: &str) -> (Option<i32>, String) {
    let output = bench.call(&["run", "--from", from, "p.nc"]);
    let text = String::from_utf8(output.stdout).expect("text");
    (output.status.code(), text)
}

/// The rows of blocks in a CSV timeline: line, X, Y.
fn rows(bench: &Bench, from: &str) -> Vec<String> {
    let output = bench.call(&["run", "--format", "ndjson", "--from", from, "p.nc"]);
    let text = String::from_utf8(output.stdout).expect("text");
    let records = text.lines().map(json);
    let blocks = records.filter(|record| record["record"] == "block");
    let state = |record: &serde_json::Value, axis: &str| {
        record["friction"][axis].as_str().unwrap_or("-").to_owned()
    };
    blocks
        .map(|it| format!("{} {} {}", it["line"], state(&it, "X"), state(&it, "Y")))
        .collect()
}

#[test]
fn both_readings_are_shown_where_they_differ() {
    let bench = bench(PROGRAM, None);
    assert_eq!(
        rows(&bench, "N100"),
        ["5 unknown active", "6 unknown active"]
    );
    let (status, text) = started(&bench, "N100");
    assert_eq!(status, Some(0), "{text}");
    for wanted in [
        "FC413",
        "`FRICT` of axis `X` is inactive here if the block search executes",
        "and active if it only decodes them",
        // The way continues to the end of the program.
        "if the block search executes what it passes",
    ] {
        let text = one_line(&text);
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    assert!(!text.contains("axis `Y`"), "{text}");
}

#[test]
fn a_reading_decides() {
    let executed = bench(PROGRAM, Some("executed"));
    assert_eq!(
        rows(&executed, "N100"),
        ["5 inactive active", "6 inactive active"]
    );
    let decoded = bench(PROGRAM, Some("decoded"));
    assert_eq!(
        rows(&decoded, "N100"),
        ["5 active active", "6 active active"]
    );
    for bench in [executed, decoded] {
        let (_, text) = started(&bench, "N100");
        assert!(!text.contains("FC413"), "{text}");
    }
}

#[test]
fn a_line_names_a_block_too_and_the_first_block_is_a_plain_start() {
    let bench = bench(PROGRAM, None);
    assert_eq!(rows(&bench, "5"), rows(&bench, "N100"));
    assert_eq!(rows(&bench, "N10").len(), 6);
    assert!(!started(&bench, "1").1.contains("FC413"));
}

/// Neither a missing block nor one that the program jumps over is an all-clear.
#[test]
fn a_block_that_is_never_reached_is_an_error() {
    for program in [PROGRAM, "N10 $GOTO N30:\nN20 X[COMP OFF FRICT]\nN30: M30\n"] {
        let from = if program == PROGRAM { "N999" } else { "N20" };
        let (status, text) = started(&bench(program, None), from);
        assert_eq!(status, Some(1), "{text}");
        assert!(
            text.contains("error[FC413]") && text.contains(from),
            "{text}"
        );
    }
    for nothing in ["", "\n(only a comment)\n", "%L SUB\nN100 X1\nM17\n"] {
        let (status, text) = started(&self::bench(nothing, None), "N100");
        assert!(
            status == Some(1) && text.contains("error[FC413]"),
            "{nothing:?}: {text}"
        );
    }
}

/// Only what stops the search is shown, not the rest of what it passes.
#[test]
fn an_error_before_the_block_stops_the_search() {
    let program = "N10 X[COMP OFF FRICT]\nN20 Q[COMP ON FRICT]\nN30 M30\n";
    let (status, text) = started(&bench(program, None), "N30");
    assert_eq!(status, Some(1), "{text}");
    assert!(
        text.contains("P-ERR-21947") && !text.contains("N10"),
        "{text}"
    );
}

#[test]
fn a_condition_before_the_block_and_the_search_are_ways_together() {
    let program =
        "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 G01 X1 F100\nN50 M30\n";
    let text = started(&bench(program, None), "N40").1;
    let text = one_line(&text);
    assert!(
        text.contains("if V.E.A == 1 (line 1) and the block search executes what it passes"),
        "{text}"
    );
}

#[test]
fn what_names_no_block_is_refused() {
    let bench = bench(PROGRAM, None);
    for from in ["x", "0", "-1", "N", "1.5"] {
        let output = bench.call(&["run", &format!("--from={from}"), "p.nc"]);
        assert_eq!(output.status.code(), Some(2), "{from}");
    }
    let output = bench.call(&["run", "--from", "N10", "p.nc", "p.nc"]);
    assert_eq!(output.status.code(), Some(2));
}
