//! The friction of one axis in several states, and over the years (R16.6).

use std::fmt::Write as _;
use std::path::Path;

use crate::folder::answer;
use crate::workspace::root;

const CHANNELS: [&str; 4] = ["--velocity", "SetVelo", "--torque", "ActTorque"];

/// Returns the recording of the demo with its torque multiplied and an offset added.
fn recording(factor: f64, more: f64) -> String {
    let demo = std::fs::read_to_string(root().join("programs/demo/recordings/friction_x.csv"));
    let mut text = String::new();
    for line in demo.expect("a recording").lines() {
        let cells: Vec<&str> = line.split('\t').collect();
        match &cells[..] {
            [time, velocity, torque] if time.parse::<f64>().is_ok() => {
                let torque: f64 = torque.parse().expect("a torque");
                let torque = (torque * factor + more).round();
                writeln!(text, "{time}\t{velocity}\t{torque}").expect("text");
            }
            _ => writeln!(text, "{line}").expect("text"),
        }
    }
    text
}

fn folder(files: &[(&str, f64, f64)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("r")).expect("a folder");
    for (name, factor, more) in files {
        std::fs::write(
            folder.path().join("r").join(name),
            recording(*factor, *more),
        )
        .expect("written");
    }
    folder
}

fn call(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    answer(folder, &[arguments, &CHANNELS].concat())
}

/// R16.6: recordings of several states are shown side by side with their spread, and the list is that of the
/// working state of the machine.
#[test]
fn states_stand_side_by_side() {
    let folder = folder(&[("cold.csv", 1.2, 0.0), ("warm.csv", 1.0, 0.0)]);
    let recorded = ["identify", "--states", "cold=r/cold.csv", "warm=r/warm.csv"];
    let (status, said) = call(
        folder.path(),
        &[&recorded[..], &["--write-list", "x.lis", "--svg", "x.svg"]].concat(),
    );
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("speed cold warm spread"), "{said}");
    assert!(
        said.contains("differs between the states by up to 20.")
            && said.contains("the list is for `warm` alone"),
        "{said}"
    );
    let list = std::fs::read_to_string(folder.path().join("x.lis")).expect("a list");
    let outputs = |list: &str| {
        let lines = list
            .lines()
            .filter(|it| it.contains(".out"))
            .map(str::to_owned);
        lines.collect::<Vec<_>>()
    };
    assert!(list.contains("differs between the states"), "{list}");
    let (status, said) = call(
        folder.path(),
        &["identify", "r/warm.csv", "--write-list", "alone.lis"],
    );
    assert_eq!(status, Some(0), "{said}");
    let alone = std::fs::read_to_string(folder.path().join("alone.lis")).expect("a list");
    assert_eq!(outputs(&list), outputs(&alone));
    let svg = std::fs::read_to_string(folder.path().join("x.svg")).expect("a picture");
    roxmltree::Document::parse(&svg).expect("well-formed");
    assert!(svg.contains("cold") && svg.contains("warm"));
    let (status, said) = call(
        folder.path(),
        &[&recorded[..], &["--working", "cold", "--format", "json"]].concat(),
    );
    assert_eq!(status, Some(0), "{said}");
    let record: serde_json::Value = serde_json::from_str(&said).expect("a record");
    assert_eq!(record["working"], "cold");
    let spread = record["spread"].as_f64().expect("a spread");
    assert!((spread - 1.0 / 6.0).abs() < 0.005, "{spread}");
    assert_eq!(record["states"].as_array().expect("states").len(), 2);
}

/// R16.6: the working state is named where none is called warm, and each state has its own name.
#[test]
fn a_state_that_is_not_there_is_refused() {
    let folder = folder(&[("a.csv", 1.0, 0.0)]);
    for (arguments, words) in [
        (
            &["--states", "cold=r/a.csv"][..],
            "no recording of the state `warm`",
        ),
        (
            &["--states", "warm=r/a.csv", "warm=r/a.csv"],
            "`warm` was given twice",
        ),
        (
            &["--states", "r/a.csv"],
            "write the state and its recording",
        ),
        (&["--states", "warm=r/a.csv", "--circles"], "--circles"),
        (&["--states", "warm=r/b.csv"], "r/b.csv"),
        (&["--working", "warm", "r/a.csv"], "--working"),
    ] {
        let (status, said) = call(
            folder.path(),
            &[&["identify"], arguments, &["--write-list", "x.lis"]].concat(),
        );
        assert_eq!(status, Some(2), "{said}");
        assert!(said.contains(words), "{words}: {said}");
        assert!(!folder.path().join("x.lis").exists());
    }
}

/// R16.6: a trend names a parameter that changed by more than 3 combined errors and 5 %, a slow drift as
/// well as a step, and none that changed by less; files that yield nothing are named with their reason.
#[test]
fn a_trend_says_what_changed() {
    let folder = folder(&[
        ("x-2026-03-01.csv", 1.0, 0.0),
        ("x-2026-09-01.csv", 1.03, 0.0),
        ("x-2027-03-01.csv", 1.06, 0.0),
        ("x-2027-09-01.csv", 1.06, 20.0),
        ("undated.csv", 1.0, 0.0),
    ]);
    std::fs::write(folder.path().join("r/y-2027-10-01.csv"), "t,z\n0,1\n").expect("written");
    let (status, said) = call(
        folder.path(),
        &["commission", "trend", "r", "--axis", "X", "--svg", "x.svg"],
    );
    assert_eq!(status, Some(0), "{said}");
    // R18.20
    let verdict =
        "Fc, Fs, fv, offset changed; offset most, by +20.0 % of Fc between 2026-03-01 and";
    assert!(said.starts_with(verdict), "{said}");
    assert!(said.contains("over 4 recordings"), "{said}");
    for parameter in ["Fc", "Fs", "fv"] {
        let change = format!("{parameter} changed by +");
        assert_eq!(said.matches(&change).count(), 1, "{said}");
    }
    assert!(said.contains("between 2026-03-01 and 2027-03-01"), "{said}");
    assert!(
        said.contains("of Fc between 2026-03-01 and 2027-09-01"),
        "{said}"
    );
    assert!(
        said.contains("left out: r/undated.csv: its name has no date"),
        "{said}"
    );
    assert!(said.contains("left out: r/y-2027-10-01.csv"), "{said}");
    let svg = std::fs::read_to_string(folder.path().join("x.svg")).expect("a picture");
    roxmltree::Document::parse(&svg).expect("well-formed");
    let (status, said) = call(
        folder.path(),
        &["commission", "trend", "r", "--format", "json"],
    );
    assert_eq!(status, Some(0), "{said}");
    let record: serde_json::Value = serde_json::from_str(&said).expect("a record");
    assert_eq!(record["dates"].as_array().expect("dates").len(), 4);
    assert_eq!(record["left_out"].as_array().expect("files").len(), 2);
}

/// R16.6: without a change, this is reported with its basis; one date gives no trend.
#[test]
fn what_did_not_change_is_said_and_one_date_is_no_trend() {
    let steady = folder(&[("2026-03-01.csv", 1.0, 0.0), ("2027-03-01.csv", 1.04, 0.0)]);
    let (status, said) = call(steady.path(), &["commission", "trend", "r"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.contains(
            "no parameter of these 2 recordings changed by more than 3 combined errors and 5 %"
        ),
        "{said}"
    );
    let alone = folder(&[("2026-03-01.csv", 1.0, 0.0), ("undated.csv", 1.0, 0.0)]);
    let (status, said) = call(alone.path(), &["commission", "trend", "r"]);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("1 of the 2 recordings")
            && said.contains("undated.csv: its name has no date"),
        "{said}"
    );
}

/// R18.9: a recording given twice is named and does not count as two.
#[test]
fn a_recording_given_twice_is_no_second_one() {
    let twice = folder(&[("2026-03-01.csv", 1.0, 0.0), ("2027-03-01.csv", 1.0, 0.0)]);
    let (status, said) = call(twice.path(), &["commission", "trend", "r"]);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("2027-03-01.csv: it is a copy of `r/2026-03-01.csv`"),
        "{said}"
    );
    let [one, other] = ["r/2026-03-01.csv", "r/2027-03-01.csv"];
    for (arguments, words) in [
        (
            vec!["identify", "--circles", one, other],
            "`r/2027-03-01.csv` is a copy of `r/2026-03-01.csv`",
        ),
        (
            vec!["identify", "--circles", one, one],
            "`r/2026-03-01.csv` was given twice",
        ),
        (
            vec![
                "identify",
                "--states",
                "cold=r/2026-03-01.csv",
                "warm=r/2027-03-01.csv",
            ],
            "is a copy of",
        ),
    ] {
        let (status, said) = call(twice.path(), &arguments);
        assert!(status == Some(2) && said.contains(words), "{said}");
    }
}
