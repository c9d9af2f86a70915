//! Recordings whose channels need no options, and those of several axes (R6.3).

use std::fmt::Write as _;

use serde_json::Value;

use crate::folder::{Bench, json, said};
use crate::workspace::root;

/// Returns the recording of the demo, its channels for each of some axes; those of the second axis have twice the
/// torque.
fn recording(axes: &[&str]) -> String {
    let demo = root().join("programs/demo/recordings/friction_x.csv");
    let demo = std::fs::read_to_string(demo).expect("a recording");
    let mut text = String::from("t [ms]");
    for axis in axes {
        write!(text, ",{axis}.SetVelo [\u{b5}m/s],{axis}.ActTorque [0.1%]").expect("text");
    }
    text.push('\n');
    for line in demo.lines() {
        let cells: Vec<f64> = line.split('\t').flat_map(str::parse).collect();
        if let [time, velocity, torque] = cells[..] {
            write!(text, "{time}").expect("text");
            for (at, _) in axes.iter().enumerate() {
                let factor = f64::from(u32::try_from(at).expect("two axes") + 1);
                write!(text, ",{velocity},{}", torque * factor).expect("text");
            }
            text.push('\n');
        }
    }
    text
}

/// Returns a full turn on a circle of 50 mm at 2000 mm/min, with the channels of a controller.
fn circle() -> String {
    let mut text = String::from("t [s],X.ActPos [mm],Y.ActPos [mm],X.SetPos [mm],Y.SetPos [mm]\n");
    for at in 0..12_000 {
        let time = f64::from(at) / 1000.0;
        let angle = 2000.0 / 60.0 / 50.0 * time;
        let [x, y] = [angle.cos(), angle.sin()].map(|it| 50.0 * it);
        let reached = 50.002 / 50.0;
        let (ax, ay) = (x * reached, y * reached);
        writeln!(text, "{time:.3},{ax:.5},{ay:.5},{x:.5},{y:.5}").expect("text");
    }
    text
}

fn bench() -> Bench {
    let bench = Bench::new(&[("a.nc", "N10 G01 X10 F1000\nN20 M30\n")]);
    bench.write("x.csv", &recording(&["X"]));
    bench.write("xy.csv", &recording(&["X", "Y"]));
    bench.write("circle.csv", &circle());
    bench
}

fn points(document: &Value) -> Vec<f64> {
    let points = document["points"].as_array().expect("points");
    points.iter().filter_map(|it| it["out"].as_f64()).collect()
}

#[test]
fn channels_that_are_recognised_need_no_option() {
    let bench = bench();
    let trace = json(&bench.stdout(&["trace", "xy.csv", "--format", "json"]));
    let channels = trace["channels"].as_array().expect("channels");
    let taken = channels.iter().filter(|it| !it["role"].is_null());
    let taken: Vec<String> = taken
        .map(|it| format!("{} {}", it["role"], it["axis"]).replace('"', ""))
        .collect();
    assert_eq!(taken, ["velocity X", "torque X", "velocity Y", "torque Y"]);
    let text = bench.stdout(&["trace", "xy.csv"]);
    assert!(text.contains("torque of Y"), "{text}");

    let alone = json(&bench.stdout(&["identify", "x.csv", "--format", "json"]));
    let named = ["--velocity", "%.SetVelo", "--torque", "%.ActTorque"];
    let named = [
        &["identify", "x.csv", "--axis", "X", "--format", "json"],
        &named[..],
    ]
    .concat();
    assert_eq!(points(&alone), points(&json(&bench.stdout(&named))));
    bench.stdout(&["identify", "x.csv", "--write-list", "x.lis"]);
    let verified = bench.stdout(&["verify", "x.csv", "--value-list", "x.lis"]);
    assert!(
        verified.starts_with("x.lis fits the recorded torque of X from"),
        "{verified}"
    );
    let current = [
        "current",
        "xy.csv",
        "--axis",
        "Y",
        "--value-list",
        "x.lis",
        "--resample",
    ];
    let rows = bench.stdout(&current);
    assert!(rows.lines().count() > 1000, "{rows}");
    let text = bench.stdout(&["circle", "circle.csv"]);
    assert!(text.contains("diameter 100.0040 mm"), "{text}");
}

#[test]
fn several_axes_are_identified_and_verified_in_one_call() {
    let bench = bench();
    let (status, text) = said(&bench.call(&["identify", "xy.csv"]));
    assert_eq!(status, Some(2), "{text}");
    assert!(
        text.contains("X.ActTorque") && text.contains("give the axis"),
        "{text}"
    );

    let call = ["identify", "xy.csv", "--axis", "X,Y"];
    let text = bench.stdout(&call);
    assert!(
        text.starts_with("friction of X from 0.20 to 120.00 mm/s"),
        "{text}"
    );
    assert!(
        text.contains("\n\nfriction of Y from 0.20 to 120.00 mm/s"),
        "{text}"
    );
    let lists = [&call[..], &["--into", "lists", "--format", "json"]].concat();
    let document = json(&bench.stdout(&lists));
    let [x, y] = [0, 1].map(|at| document["axes"][at].clone());
    assert_eq!([&x["axis"], &y["axis"]], ["X", "Y"]);
    let doubled: Vec<f64> = points(&x).iter().map(|it| 2.0 * it).collect();
    assert!(
        points(&y)
            .iter()
            .zip(doubled)
            .all(|(y, x)| (y / x - 1.0).abs() < 0.01),
        "{document}"
    );

    let lists = [
        "--value-list",
        "X=lists/X.lis",
        "--value-list",
        "Y=lists/Y.lis",
    ];
    let verify = [&["verify", "xy.csv", "--axis", "X,Y"], &lists[..]].concat();
    let (status, text) = said(&bench.call(&verify));
    assert_eq!(status, Some(0), "{text}");
    assert!(
        text.contains("lists/Y.lis fits the recorded torque of Y"),
        "{text}"
    );
    let exchanged = [
        "verify",
        "xy.csv",
        "--axis",
        "X,Y",
        "--value-list",
        "lists/X.lis",
    ];
    let (status, text) = said(&bench.call(&exchanged));
    assert_eq!(status, Some(1), "{text}");
    assert!(
        text.contains("does not fit the recorded torque of Y"),
        "{text}"
    );
    let document = json(&bench.stdout(&[&verify[..], &["--format", "json"]].concat()));
    assert_eq!(document["axes"][1]["axis"], "Y");
}

#[test]
fn what_one_axis_has_is_not_taken_for_two() {
    let bench = bench();
    for (arguments, expected) in [
        (
            &["identify", "xy.csv", "--axis", "X,Y", "--svg", "a.svg"][..],
            "`--svg` draws one axis, and `--axis X,Y` names several",
        ),
        (
            &["identify", "--circles", "xy.csv", "x.csv", "--axis", "X,Y"],
            "the circles are those of one axis",
        ),
        (
            &["commission", "trend", ".", "--axis", "X,Y"],
            "a trend is that of one axis",
        ),
        (
            &[
                "identify",
                "xy.csv",
                "--axis",
                "X,Y",
                "--velocity",
                "X.SetVelo",
                "--torque",
                "X.ActTorque",
            ],
            "the channels of Y are those of X",
        ),
        (
            &["identify", "x.csv", "--axis", "Y"],
            "has no torque of Y, only",
        ),
    ] {
        let (status, text) = said(&bench.call(arguments));
        assert_eq!(status, Some(2), "{text}");
        assert!(text.contains(expected), "{text}");
    }
    bench.write("twice.csv", "t,v,torque,torque\n0,0,1,2\n0.001,1,1,2\n");
    let (status, text) = said(&bench.call(&["identify", "twice.csv"]));
    assert_eq!(status, Some(2), "{text}");
    assert!(text.contains("2 channels fit `torque`"), "{text}");
    let (status, text) = said(&bench.call(&["trace", "."]));
    assert_eq!(status, Some(2), "{text}");
    assert!(text.contains("`.` is a folder, not a recording"), "{text}");
}

#[test]
fn a_program_and_a_recording_are_told_by_their_content() {
    let bench = bench();
    let start = ["current", "a.nc", "--start", "X0,Y0,Z0"];
    assert!(bench.stdout(&start).starts_with("t,"));
    for (arguments, expected) in [
        (
            &["current", "a.nc", "--resample"][..],
            "`--resample` has no effect on `a.nc`, which is a program",
        ),
        (
            &[
                "current",
                "x.csv",
                "--value-list",
                "v.lis",
                "--columns",
                "line",
            ],
            "`--columns` has no effect on `x.csv`, which is a recording",
        ),
        (
            &["current", "x.csv"],
            "the current of `x.csv` needs a value list",
        ),
        (
            &["current", "no.nc", "--axis", "X"],
            "there is no file `no.nc`",
        ),
        (
            &["circle", "circle.csv", "--plant", "mid"],
            "cannot be used with",
        ),
    ] {
        let (status, text) = said(&bench.call(arguments));
        assert_eq!(status, Some(2), "{arguments:?}: {text}");
        assert!(text.contains(expected), "{text}");
    }
    std::fs::write(bench.folder().join("broken.csv"), "x y z\n").expect("written");
    let (_, text) = said(&bench.call(&["current", "broken.csv", "--isolated"]));
    assert!(text.contains("was taken as a program"), "{text}");
    // A program without an ending, and a recording that is called like one.
    std::fs::rename(bench.folder().join("x.csv"), bench.folder().join("x.nc")).expect("renamed");
    let (_, text) = said(&bench.call(&["current", "x.nc"]));
    assert!(text.contains("needs a value list"), "{text}");
    let both = ["current", "--recording", "a.nc", "--value-list", "v.lis"];
    assert_eq!(bench.status(&both), Some(2));
}
