//! The circular test through the command line: its formats, files and refusals.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Output;

use crate::folder::call;
use crate::workspace::root;
use serde_json::Value;

fn tool(arguments: &[&str]) -> Output {
    call(root(), arguments)
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
const QUICK: [&str; 4] = ["circle", "--radius=40", "--feed=4000", "--format=json"];

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

/// R5.26: three turns, of which the last one leaves more; two turns that are alike.
#[test]
fn the_verdict_comes_first_and_conditions_with_v() {
    // R18.20, R18.26
    let text = |arguments: &[&str]| String::from_utf8(tool(arguments).stdout).expect("text");
    let brief = text(&["circle"]);
    let verdict = "largest glitch 1.2 µm at X- with compensation, 14.8 µm without";
    assert_eq!(brief.lines().next(), Some(verdict));
    assert!(
        !brief.contains("14.843") && !brief.contains("reading:"),
        "{brief}"
    );
    assert!(text(&["circle", "-v"]).contains("reading:"));
    let document = json(&["circle", "--format", "json"]);
    assert_eq!(document["headline"]["text"], verdict);
    assert_eq!(document["headline"]["standing"], "plain");
}

#[test]
fn a_worse_turn_of_a_recording_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("turns.csv");
    let of = |turns: u32, last_um: f64| {
        let turning = 2000.0 / 60.0 / 50.0;
        let mut text = String::from("t,x,y\n");
        for at in 0..turns * 10_000 {
            let time = f64::from(at) / 1000.0;
            let angle = turning * time;
            let after = angle.rem_euclid(std::f64::consts::FRAC_PI_2) / turning;
            let is_last = at >= (turns - 1) * 10_000;
            let bulge_um = if is_last { last_um } else { 5.0 };
            let bulge = 1e-3 * bulge_um * (-(after / 0.03 - 1.0).powi(2)).exp();
            let [x, y] = [angle.cos(), angle.sin()].map(|it| (50.0 + bulge) * it);
            writeln!(text, "{time:.3},{x:.5},{y:.5}").expect("text");
        }
        fs::write(&path, text).expect("a recording");
        let arguments = ["circle", "--recording", path.to_str().expect("a name")];
        let text = String::from_utf8(tool(&arguments).stdout).expect("text");
        let document = json(&[&arguments[..], &["--format=json"]].concat());
        (text, document["worse_turns"].clone())
    };
    let (text, worse) = of(3, 11.0);
    assert!(
        text.contains("not every turn is like the evaluated one: at "),
        "{text}"
    );
    assert_eq!(worse[0]["direction"], "ccw");
    let [height, evaluated] = ["height", "evaluated"].map(|key| worse[0][key].as_f64());
    assert!(height > Some(10.0) && evaluated < Some(6.0), "{worse}");
    let (text, worse) = of(2, 5.0);
    assert!(
        text.contains("of 2 whole turns none leaves more at a crossing"),
        "{text}"
    );
    assert_eq!(worse, Value::Null);
}

#[test]
fn each_axis_has_its_own_list() {
    // R5.25: it is reported which list goes where, and incomplete input is refused.
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, output: u32| {
        let path = folder.path().join(name);
        let text = format!(
            "frict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.position_delay 9\n\
             frict_comp.table[0].in 0\nfrict_comp.table[0].out {output}\nEnde\n"
        );
        fs::write(&path, text).expect("written");
        path.to_str().expect("text").replace('\\', "/")
    };
    let [x, y] = [("a.lis", 110), ("b.lis", 0)].map(|(name, output)| write(name, output));
    let [for_x, for_y] = [format!("--value-list=X={x}"), format!("--value-list=Y={y}")];
    let document = json(&[&QUICK[..], &[&for_y, &for_x]].concat());
    let glitch = |side: &str, crossing: &str| {
        let glitch = &document[side]["ccw"]["glitch"][crossing];
        glitch.as_f64().expect("a number")
    };
    // Y has a list that adds nothing.
    assert!(glitch("on", "X+") < 0.3 * glitch("off", "X+"));
    assert!((glitch("on", "Y+") / glitch("off", "Y+") - 1.0).abs() < 0.02);
    assert_eq!(document["value_list"], format!("X={x}, Y={y}"));
    for (given, words) in [
        (vec![&*for_x], "`--value-list` gives no list of `Y`"),
        (vec![&*for_x, &for_x], "more than once for the same axis"),
        (
            vec!["--value-list=Q=a.lis"],
            "`Q`, which is not an axis here",
        ),
    ] {
        let said = refusal(&[&QUICK[..], &given].concat());
        assert!(said.contains(words), "{said}");
    }
    // One that names no axis is that of the others.
    let others = format!("--value-list={x}");
    let document = json(&[&QUICK[..], &[&for_y, &others]].concat());
    assert_eq!(document["value_list"], format!("X={x}, Y={y}"));
}

#[test]
fn every_model_and_plant_can_be_named() {
    // R5.10 R5.11 R5.12
    for model in ["lugre", "gms", "stribeck"] {
        for plant in ["stiff", "mid", "soft", "docs/assets/plant.toml"] {
            let document = json(&[&QUICK[..], &["--model", model, "--plant", plant]].concat());
            let glitch = document["off"]["glitch_max"].as_f64().expect("a number");
            assert!((3.0..60.0).contains(&glitch), "{model} {plant}: {glitch}");
        }
    }
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
            "circle",
            "--recording",
            name,
            "--radius",
            "50",
            "--format",
            "json",
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
    let said = refusal(&["circle", "--recording", name]);
    assert!(said.contains(":4: column `x [mm]` holds `nan"), "{said}");
    fs::write(&path, "t,a,b\n1,2,3\n").expect("written");
    assert!(
        refusal(&["circle", "--recording", name]).contains("no columns `x` and `y`, only t, a, b")
    );
}

#[test]
fn a_tuned_list_is_one_that_the_control_takes() {
    // R5.25
    let folder = tempfile::tempdir().expect("a folder");
    let list = folder.path().join("v.lis");
    let name = list.to_str().expect("text");
    let arguments = [
        "tune",
        "--feeds",
        "4000",
        "--radii",
        "40",
        "--no-shaping",
        "--format",
        "json",
        "--write-list",
        name,
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
    // R3.24: a build before V3.1.3132.0 accepts only whole numbers.
    let old = tool(&[
        "lists",
        "--cnc-build",
        "3.1.3000.0",
        "--fail-on",
        "info",
        name,
    ]);
    assert_eq!(old.status.code(), Some(0), "{old:?}");
    // The circle with this list leaves what the tuning reported.
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

#[test]
fn each_axis_gets_a_list_with_the_name_of_the_machine() {
    // R5.25: `circle` finds with the written lists what `tune` reports.
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).expect("written");
        path.to_str().expect("text").to_owned()
    };
    let plant = write("p.toml", "[y]\nFc = 800\nFs = 900\n");
    let machine = write(
        "frictcomp.toml",
        "[[axis]]\nname = \"X1\"\nnumber = 7\n[[axis]]\nname = \"Y\"\n",
    );
    let lists = folder.path().join("lists");
    let document = json(&[
        "tune",
        "--plant",
        &plant,
        "--accelerations",
        "180",
        "--radii",
        "60",
        "--no-shaping",
        "--config",
        &machine,
        "--into",
        lists.to_str().expect("text"),
        "--format",
        "json",
    ]);
    let [x, y] = ["X1.lis", "Y.lis"].map(|name| lists.join(name));
    let head = |path: &Path| {
        let text = fs::read_to_string(path).expect("a list");
        let head = text.lines().filter(|line| line.starts_with("kopf."));
        let words = head.map(|line| line.split_whitespace().skip(1).collect::<String>());
        words.collect::<Vec<_>>()
    };
    // R3.11: the owner of a list.
    assert_eq!(head(&x), ["7", "X1"]);
    assert_eq!(head(&y), ["Y"]);
    let [x, y] = [("X", x), ("Y", y)].map(|(axis, path)| format!("{axis}={}", path.display()));
    let row = &document["feeds"][0];
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!((number(&row["acceleration"]) - 180.0).abs() < 1e-3);
    let feed = number(&row["feed"]).to_string();
    let circle = json(&[
        "circle",
        "--feed",
        &feed,
        "--radius",
        "60",
        "--plant",
        &plant,
        "--value-list",
        &x,
        "--value-list",
        &y,
        "--format",
        "json",
    ]);
    let left = number(&circle["on"]["glitch_max"]);
    let said = number(&row["glitch_on"]);
    assert!((left / said - 1.0).abs() < 1e-3, "{left} is not {said}");
    assert_ne!(
        document["axes"]["X"]["table"],
        document["axes"]["Y"]["table"]
    );
}

#[test]
fn stiction_compensation_is_reported_in_place_of_a_list() {
    // R8.3 R8.6
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("text").to_owned();
    let plant = path("p.toml");
    let text = "Kv = 16.7\n[stiction]\nmp1511 = 20000\nmp1513 = 2.5\n[x.stiction]\nmp1513 = 4\n";
    fs::write(&plant, text).expect("written");
    let call = |command: &str, more: &[&str]| {
        let circle = if command == "tune" {
            ["--feeds", "3000", "--radii", "20"]
        } else {
            ["--feed", "3000", "--radius", "20"]
        };
        let arguments = [&[command, "--plant", &plant], &circle[..], more].concat();
        tool(&arguments)
    };
    let said = |output: Output| {
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        String::from_utf8(output.stdout).expect("text")
    };
    let text = said(call("circle", &["-v"]));
    let flat: Vec<&str> = text.split_whitespace().collect();
    let flat = flat.join(" ");
    for part in [
        "X: MP1511 20000 µs, MP1512 49 (Δs_a at most 3.828125 µm), GP 20 µm, t_C 3000 µs, MP1513 4 m/min",
        "X: MP1511 is outside the guideline of 5000 to 10000 µs",
        "Y: the feed is above MP1513, nothing is added",
        "raise MP1511",
    ] {
        assert!(flat.contains(part), "{part}\n{text}");
    }
    assert!(!text.contains("scaling_factor"), "{text}");
    let document: Value =
        serde_json::from_str(&said(call("circle", &["--format", "json"]))).expect("JSON");
    assert_eq!(document["stiction"]["X"]["mp1513_m_per_min"], 4.0);
    assert_eq!(document["value_list"], Value::Null);
    // A value list replaces it.
    let list = "frict_comp.mode 3\nfrict_comp.table_entries 1\n\
                frict_comp.table[0].in 0\nfrict_comp.table[0].out 100\n";
    fs::write(path("v.lis"), list).expect("written");
    let listed = said(call("circle", &["-v", "--value-list", &path("v.lis")]));
    assert!(
        listed.contains("v.lis, 1 point\n") && !listed.contains("MP1511"),
        "{listed}"
    );
    let text = said(call("tune", &["-v"]));
    assert!(text.contains("sets of parameters tried\n"), "{text}");
    let document: Value =
        serde_json::from_str(&said(call("tune", &["--format", "json"]))).expect("JSON");
    assert!(document["axes"]["X"]["parameters"]["mp1511_us"].is_number());
    for option in ["--write-list", "--into"] {
        let refused = call("tune", &[option, &path("made")]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(!Path::new(&path("made")).exists());
    }
}
