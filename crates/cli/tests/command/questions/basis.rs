//! Every output names the readings of open questions on which its results rest (R15.3).

use super::machine::LIST;
use super::{MACHINE, bench};
use crate::folder::{Bench, json};
use serde_json::{Value, json as value};

/// Machine on which Y has no friction compensation, Z has no value list, and X and Y are required to be compensated.
const AXES: &str =
    "\n[[axis]]\nname = \"Y\"\nnumber = 2\n\n[[axis]]\nname = \"Z\"\nnumber = 3\nenable = true\n";

/// Returns the readings on which results rest, from the summary of a run.
fn rests_on(bench: &Bench, arguments: &[&str]) -> Vec<(String, String, String)> {
    let records = bench.records(arguments);
    let summary = json(records.last().expect("a summary"));
    let named = summary["rests_on"].as_array().cloned().unwrap_or_default();
    let text = |it: &Value, key: &str| it[key].as_str().unwrap_or_default().to_owned();
    let named = named.iter();
    named
        .map(|it| (text(it, "rule"), text(it, "reading"), text(it, "basis")))
        .collect()
}

/// R15.3: a result rests on a question only where its answer decides something.
#[test]
fn a_result_names_the_readings_that_decide_it() {
    let bench = bench();
    bench.write("frictcomp.toml", &format!("{MACHINE}{AXES}"));
    for (program, rules) in [
        (
            "X[COMP OFF FRICT]\nG1 X1 F100\nX[COMP ON FRICT]\nM30\n",
            &[][..],
        ),
        ("X[COMP OFF FRICT]\nM30\n", &["R1.28"]),
        ("X[comp off frict]\nX[COMP ON FRICT]\nM30\n", &["R1.8"]),
        (
            "X[COMP OFF FRICT] G1 X5 F100\nX[COMP ON FRICT]\nM30\n",
            &["R1.9"],
        ),
        ("Y[COMP OFF FRICT]\nM30\n", &["R1.25"]),
        ("X[COMP OFF FRICT] X[COMP ON FRICT]\nM30\n", &["R1.31"]),
        (
            "G1 X1 F100\nX2\nX[COMP OFF FRICT]\nX3\nX[COMP ON FRICT]\nM30\n",
            &["R1.29", "R1.57"],
        ),
        // The initial state of the control decides how the axis moves, but nothing after the command.
        ("G1 X1 F100\nX[COMP ON FRICT]\nM30\n", &["R1.29"]),
        ("X[COMP ON FRICT]\nG1 X1 F100\nM30\n", &[]),
        ("X[COMP ON FRICT]\nM30\n", &[]),
        ("G1 Y1 F100\nM30\n", &[]),
        (
            "X[COMP OFF FRICT]\n#PUT AX [X]\n#CALL AX [X,1]\nX[COMP ON FRICT]\nM30\n",
            &["R2.70"],
        ),
        // Neither reading is assumed.
        (
            "#MACHINE DATA [AX=X P-AXIS-00001=1]\nX[COMP ON FRICT]\nM30\n",
            &[],
        ),
    ] {
        bench.write("a.nc", program);
        let found = rests_on(&bench, &["a.nc"]);
        let found: Vec<_> = found.iter().map(|(rule, ..)| rule.as_str()).collect();
        assert_eq!(found, rules, "{program}");
    }
}

/// R15.3, R4.2 to R4.7: a current rests on the readings that its list makes relevant, and on what switched it; an
/// option that selects otherwise is not a reading of the machine.
#[test]
fn currents_and_contours_name_the_readings_that_decide_them() {
    let bench = bench();
    bench.write("a.nc", "X[COMP ON FRICT]\nG1 X10 F1000\nX0\nM30\n");
    let current = |list: &str, arguments: &[&str]| {
        bench.write("frictcomp.toml", &format!("{MACHINE}{list}"));
        let all = [
            &[
                "current", "-v", "--axis", "X", "--start", "X0", "-o", "c.csv", "a.nc",
            ],
            arguments,
        ];
        String::from_utf8(bench.call(&all.concat()).stderr).expect("text")
    };
    let rules = |said: &str| -> Vec<String> {
        let line = said.split("Rests on ").nth(1).unwrap_or_default();
        let words = line.split_whitespace().map(|it| it.trim_end_matches(','));
        words
            .filter(|it| it.starts_with("R4."))
            .map(str::to_owned)
            .collect()
    };
    let all = ["R4.2", "R4.3", "R4.5", "R4.6", "R4.7"];
    assert_eq!(rules(&current(LIST, &[])), all);
    let said = current(LIST, &["--reading", "decay=step"]);
    assert_eq!(rules(&said), all[1..], "{said}");
    let plain = "[axis.value]\nmode = 3\ntable = [[0, 200], [1000, 300]]\n";
    assert_eq!(rules(&current(plain, &[])), ["R4.6"]);
    let second = "\n[[axis]]\nname = \"Y\"\nnumber = 2\nenable = true\n";
    let of_two = format!("{MACHINE}{plain}{second}{plain}");
    bench.write("frictcomp.toml", &of_two);
    let contour = ["contour", "-v", "--start", "X0,Y0", "a.nc"];
    let text = bench.stdout(&contour);
    assert_eq!(rules(&text), ["R4.6"], "{text}");
    let found = json(&bench.stdout(&[&contour[..], &["--format", "json"]].concat()));
    assert_eq!(
        found["rests_on"][0]["rule"], "R4.6",
        "{}",
        found["rests_on"]
    );
}

/// R15.3, R2.90: a selected reading of a level that two blocks depend on decides what follows.
#[test]
fn a_selected_reading_of_a_turned_level_is_named() {
    let bench = bench();
    let two = "/2 X[COMP OFF FRICT]\nG04 1\n/2 X[COMP ON FRICT]\nM30\n";
    bench.write("two.nc", two);
    bench.write("one.nc", "/2 X[COMP OFF FRICT]\nX[COMP ON FRICT]\nM30\n");
    let turned = |arguments: &[&str]| {
        let mut found = rests_on(&bench, arguments);
        found.retain(|(rule, ..)| rule == "R2.90");
        found
    };
    assert_eq!(turned(&["two.nc"]), []);
    for reading in ["at-start", "at-once"] {
        let selected = format!("{MACHINE}[reading]\n\"R2.90\" = \"{reading}\"\n");
        bench.write("frictcomp.toml", &selected);
        let own = ("R2.90".into(), reading.into(), "selected".into());
        assert_eq!(turned(&["two.nc"]), [own]);
        assert_eq!(turned(&["one.nc"]), []);
        assert_eq!(turned(&["--skip", "2", "two.nc"]), []);
    }
}

/// R15.3: text, JSON and SARIF of `check` show whether a reading is assumed, selected or confirmed, and
/// on which build.
#[test]
fn every_format_says_the_basis() {
    let bench = bench();
    bench.write("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
    let said = |bench: &Bench| {
        String::from_utf8(bench.call(&["check", "-v", "a.nc"]).stderr).expect("text")
    };
    let assumed =
        "Rests on R1.28, assumed: a reset keeps the state (`frictcomp ask` writes the test)";
    assert!(said(&bench).contains(assumed), "{}", said(&bench));
    let run = bench.stdout(&["run", "-v", "a.nc"]);
    assert!(run.contains(assumed), "{run}");
    let answer = "[reading]\n\"R1.28\" = \"kept\"\n[confirmed]\n\
        \"R1.28\" = { build = \"3.1.3081.5\", date = \"2026-01-31\" }\n";
    bench.write("frictcomp.toml", &format!("{MACHINE}{answer}"));
    assert!(
        said(&bench)
            .contains("Rests on R1.28, confirmed on V3.1.3081.05: a reset keeps the state\n")
    );
    let confirmed = value!([{
        "basis": "confirmed", "rule": "R1.28", "reading": "kept",
        "meaning": "a reset keeps the state",
        "build": "V3.1.3081.05", "date": "2026-01-31",
    }]);
    let check = |format: &str| json(&bench.stdout(&["check", "--format", format, "a.nc"]));
    let records = check("json");
    let records = records["records"].as_array().expect("records").clone();
    assert_eq!(records.last().expect("a summary")["rests_on"], confirmed);
    let sarif = check("sarif");
    assert_eq!(sarif["runs"][0]["tool"]["properties"]["restsOn"], confirmed);
}
