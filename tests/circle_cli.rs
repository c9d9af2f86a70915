//! The circular test through the command line: its formats, files and refusals.

#![cfg(feature = "cli")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn tool(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_frictcomp"))
        .args(arguments)
        .output()
        .expect("the tool starts")
}

fn json(arguments: &[&str]) -> Value {
    let output = tool(arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn refusal(arguments: &[&str]) -> String {
    let output = tool(arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    String::from_utf8(output.stderr).expect("text")
}

/// A small fast circle, so that the test is short.
const QUICK: [&str; 4] = ["circle", "--radius=20", "--feed=4000", "--format=json"];

#[test]
fn the_document_has_the_promised_keys() {
    // R5.20 R5.21 R5.22
    let document = json(&QUICK);
    assert_eq!(document["schema"], 1);
    for side in ["off", "on"] {
        for key in ["G_b", "H", "glitch_max"] {
            assert!(document[side][key].is_f64(), "{side} {key}");
        }
        for direction in ["ccw", "cw"] {
            let path = &document[side][direction];
            for key in ["G_mz", "G_lsc", "F_max", "F_min", "D"] {
                assert!(path[key].is_f64(), "{side} {direction} {key}");
            }
            for crossing in ["X+", "Y+", "X-", "Y-"] {
                assert!(path["glitch"][crossing].is_f64(), "{crossing}");
            }
        }
    }
    assert!(document["on"]["glitch_max"].as_f64() < document["off"]["glitch_max"].as_f64());
}

#[test]
fn every_model_and_plant_can_be_named() {
    // R5.10 R5.11 R5.12
    for model in ["lugre", "gms", "stribeck"] {
        for plant in ["stiff", "mid", "soft", "docs/plant.toml"] {
            let document = json(&[&QUICK[..], &["--model", model, "--plant", plant]].concat());
            let glitch = document["off"]["glitch_max"].as_f64().expect("a number");
            assert!((3.0..60.0).contains(&glitch), "{model} {plant}: {glitch}");
        }
    }
}

#[test]
fn what_cannot_be_driven_is_refused() {
    // R5.20
    for (arguments, words) in [
        (["--feed=0", "--radius=100"], "a feed of 0 mm/min"),
        (["--feed=nan", "--radius=100"], "a feed of NaN mm/min"),
        (["--radius=1e9", "--feed=1000"], "a radius of 1000000000 mm"),
        (["--cycle-time=1", "--feed=1000"], "a CNC cycle of 1000 ms"),
        (
            ["--cycle-time=1e-12", "--feed=1000"],
            "a CNC cycle of 0.000000001 ms",
        ),
        (["--feed=1", "--radius=100"], "at most 1500 s are simulated"),
        (["--plant=stif", "--feed=1000"], "did you mean `stiff`"),
        (
            ["--plant=no.toml", "--feed=1000"],
            "there is no file `no.toml`",
        ),
    ] {
        let said = refusal(&[&["circle"][..], &arguments].concat());
        assert!(said.contains(words), "{said}");
    }
    assert!(refusal(&["tune", "--feeds=0"]).contains("a feed of 0"));
}

fn write_circle(path: &Path, header: &str, scale: f64) {
    let mut text = format!("{header}\n");
    for point in 0..=3600 {
        let angle = f64::from(point) * std::f64::consts::TAU / 3600.0;
        let radius = 50.0 + 0.004 * (2.0 * angle).sin();
        let (x, y) = (scale * radius * angle.cos(), scale * radius * angle.sin());
        writeln!(text, "{},{x},{y}", f64::from(point) * 0.001).expect("text");
    }
    fs::write(path, text).expect("written");
}

#[test]
fn recorded_circles_are_read_in_mm_and_in_micrometres() {
    // R5.20 R5.21
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ccw.csv");
    let name = path.to_str().expect("text");
    for (header, scale) in [
        ("t,x,y", 1.0),
        ("t,X_um,Y_um", 1000.0),
        ("t,x [mm],y [mm]", 1.0),
    ] {
        write_circle(&path, header, scale);
        let document = json(&[
            "circle", "--trace", name, "--radius", "50", "--format", "json",
        ]);
        let path = &document["recorded"]["ccw"];
        for (key, expected) in [("G_mz", 8.0), ("F_max", 4.0), ("F_min", -4.0), ("D", 0.0)] {
            let found = path[key].as_f64().expect("a number");
            assert!((found - expected).abs() < 0.01, "{key}: {found}");
        }
        assert!(document["recorded"]["cw"].is_null());
    }
    let text = fs::read_to_string(&path).expect("text");
    fs::write(&path, text.replacen("0.002,", "0.002,nan", 1)).expect("written");
    let said = refusal(&["circle", "--trace", name]);
    assert!(said.contains(":4: column `x [mm]` holds `nan"), "{said}");
    fs::write(&path, "t,a,b\n1,2,3\n").expect("written");
    assert!(refusal(&["circle", "--trace", name]).contains("no columns `x` and `y`, only t, a, b"));
}

#[test]
fn a_tuned_list_is_one_that_the_control_takes() {
    // R5.25
    let folder = tempfile::tempdir().expect("a folder");
    let list = folder.path().join("v.lis");
    let name = list.to_str().expect("text");
    let arguments = [
        "tune", "--feeds", "4000", "--radius", "40", "--format", "json", "--output", name,
    ];
    let document = json(&arguments);
    assert_eq!(document["schema"], 1);
    let position_delay = document["parameters"]["position_delay"].as_i64();
    assert!(
        position_delay.is_some_and(|it| (0..=10).contains(&it)),
        "{document}"
    );
    let row = &document["feeds"][0];
    assert_eq!(row["feed"], 4000.0);
    for key in [
        "glitch_off",
        "glitch_on",
        "glitch_friction_minus20",
        "glitch_friction_plus20",
    ] {
        assert!(row[key].is_f64(), "{key}");
    }
    let lists = tool(&["lists", "--fail-on", "info", name]);
    assert_eq!(lists.status.code(), Some(0), "{lists:?}");
    // R3.24: a build before V3.1.3132.0 takes whole numbers only.
    let old = tool(&[
        "lists",
        "--cnc-build",
        "3.1.3000.0",
        "--fail-on",
        "info",
        name,
    ]);
    assert_eq!(old.status.code(), Some(0), "{old:?}");
    // The circle with this list leaves what the tuning said.
    let circle = json(&[
        "circle",
        "--feed",
        "4000",
        "--radius",
        "40",
        "--value-list",
        name,
        "--format",
        "json",
    ]);
    let left = circle["on"]["glitch_max"].as_f64().expect("a number");
    let said = row["glitch_on"].as_f64().expect("a number");
    assert!((left / said - 1.0).abs() < 0.01, "{left} is not {said}");
}
