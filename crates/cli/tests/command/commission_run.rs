//! `frictcomp commission run` on recordings of a simulated machine, whose parameters it does not see.

mod fitted;
mod gantry;
mod loops;
mod refused;
mod strokes;

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::LazyLock;

use crate::folder::{answer, call, succeeded};
use frictcomp::lists::{FrictionList, TablePoint};
use frictcomp_host::sha256_of;
use frictcomp_physics::circle::{Circle, CircularTest, Direction, LapRun, Method};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{FrictionModel, Plant, Preset};
use frictcomp_testing::PITCH_MM;
use frictcomp_testing::planned_circles;
use frictcomp_testing::recorded_drive::{Bench, Recorded};

const AXIS: &str = "frict_comp = true\nvalue_list = \"zero.lis\"\nmax_velocity = 20000\nmax_acceleration = 2\nmax_jerk = 50\n";

const ZERO: &str = "\
frict_comp.mode 3
frict_comp.position_delay 0
frict_comp.table_entries 2
frict_comp.table[0].in 0
frict_comp.table[0].out 0
frict_comp.table[1].in 10000
frict_comp.table[1].out 0
";

const PLAN: [&str; 13] = planned_circles("2000,3000,4000,5000", "40");

const FEEDS: [f64; 4] = [2000.0, 3000.0, 4000.0, 5000.0];

/// Returns a folder with the machine and the programs of stage 1 in `m`.
fn planned() -> tempfile::TempDir {
    planned_with(&PLAN)
}

/// Returns a folder with the machine and the programs of another plan.
fn planned_with(plan: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let machine = format!("[[axis]]\nname = \"X\"\n{AXIS}[[axis]]\nname = \"Y\"\n{AXIS}");
    std::fs::write(folder.path().join("frictcomp.toml"), machine).expect("a machine");
    std::fs::write(folder.path().join("zero.lis"), ZERO).expect("a list");
    succeeded(folder.path(), &[plan, &["m"]].concat());
    std::fs::create_dir(folder.path().join("m/recordings")).expect("a folder");
    folder
}

fn put(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join("m/recordings").join(name), text).expect("written");
}

fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    answer(folder, &[&["commission", "run", "m"], arguments].concat())
}

/// Returns positions of X and Y in mm and their speeds in mm/s as a program commands them, one row per ms.
fn driven(folder: &Path, program: &str) -> Vec<[f64; 4]> {
    let arguments = ["--axis", "X,Y", "--start", "X50,Y0", "--cycle-time", "1"];
    let output = succeeded(folder, &[&["current", program], &arguments[..]].concat());
    let text = String::from_utf8(output.stdout).expect("text");
    let head: Vec<&str> = text.lines().next().expect("a head").split(',').collect();
    let columns = [("x.X", 1e-4), ("x.Y", 1e-4), ("v.X", 1e-3), ("v.Y", 1e-3)];
    let at = |name: &str| head.iter().position(|it| *it == name).expect("a column");
    let columns = columns.map(|(name, unit)| (at(name), unit));
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        columns.map(|(at, unit)| cells[at].parse::<f64>().expect("a number") * unit)
    };
    text.lines().skip(1).map(row).collect()
}

/// Returns a recording of the constant speeds of X or Y, with its friction multiplied.
fn friction(axis: usize, factor: f64) -> String {
    static TRACKS: LazyLock<[Recorded; 2]> = LazyLock::new(|| {
        let folder = planned();
        let programs = ["m/01-friction-X.nc", "m/02-friction-Y.nc"];
        [0, 1].map(|axis| constant_speeds(folder.path(), (programs[axis], axis)))
    });
    torque(&TRACKS[axis], factor)
}

/// Returns the constant speeds of X or Y as a program commands them, recorded on a bench.
fn constant_speeds(folder: &Path, (program, axis): (&str, usize)) -> Recorded {
    let rows = driven(folder, program);
    let speeds: Vec<f64> = rows.iter().map(|it| it[axis + 2]).collect();
    let bench = Bench {
        seed: 7,
        noise_n: 20.0,
        ..Bench::default()
    };
    bench.record_along(&speeds)
}

/// Returns a recording as a file, with its friction multiplied.
fn torque(recorded: &Recorded, factor: f64) -> String {
    let mut text = String::from("t,v,x,torque\n");
    for at in 0..recorded.t.len() {
        let torque = (recorded.torque[at] * factor).round();
        writeln!(
            text,
            "{:.3},{:.0},{:.0},{torque}",
            recorded.t[at], recorded.v[at], recorded.x[at]
        )
        .expect("text");
    }
    text
}

/// Returns the plant of the circles: a stiff machine with 10 % more mass on X.
fn machine() -> Plant {
    let mut plant = Preset::Stiff.plant();
    plant.x.mass_kg *= 1.1;
    plant
}

/// A circle driven on a plant, with or without the lists of X and Y.
struct Driven {
    plant: Plant,
    radius: f64,
    feed: f64,
    lists: Option<[FrictionList; 2]>,
}

/// Returns radial deviations in mm over the angle, counter-clockwise and clockwise, with or without a list.
fn deviations(feed: f64, list: Option<&FrictionList>) -> [Vec<f64>; 2] {
    deviations_of(&Driven {
        plant: machine(),
        radius: 40.0,
        feed,
        lists: list.map(|it| [it.clone(), it.clone()]),
    })
}

fn deviations_of(driven: &Driven) -> [Vec<f64>; 2] {
    let on = driven.lists.clone();
    let test = CircularTest {
        circle: Circle {
            radius_mm: driven.radius,
            feed_mm_per_min: driven.feed,
            cycle_time_s: 0.001,
        },
        plant: driven.plant.clone(),
        model: FrictionModel::default(),
        compensation: on.map_or([None, None], |it| it.map(|it| Some(Method::Current(it)))),
        reading: Reading::default(),
    };
    Direction::ALL.map(|direction| {
        let compensation = if driven.lists.is_some() {
            Switched::On
        } else {
            Switched::Off
        };
        let lap = test
            .run(LapRun {
                compensation,
                direction,
            })
            .expect("a lap");
        lap.profile
            .deviations_m()
            .iter()
            .map(|it| it * 1000.0)
            .collect()
    })
}

/// The errors that a recorder adds to positions.
#[derive(Debug, Clone, Copy)]
struct Recorder {
    noise_um: f64,
    /// Error of the screws.
    screw_um: f64,
    seed: u64,
}

impl Default for Recorder {
    fn default() -> Self {
        Self {
            noise_um: 0.3,
            screw_um: 0.0,
            seed: 1,
        }
    }
}

/// Returns a recording of a program of circles: its commanded path with deviations from the circle.
fn circles(folder: &Path, program: &str, deviations: &[Vec<f64>; 2]) -> String {
    circles_of(folder, (program, 40.0), (deviations, Recorder::default()))
}

fn circles_of(
    folder: &Path,
    (program, planned): (&str, f64),
    ([ccw, cw], recorder): (&[Vec<f64>; 2], Recorder),
) -> String {
    let mut random = fastrand::Rng::with_seed(recorder.seed);
    let noise_mm = 0.002 * recorder.noise_um;
    let mut noise = || noise_mm * (random.f64() + random.f64() + random.f64() - 1.5);
    let screw = |at: f64| 1e-3 * recorder.screw_um * (TAU * at / PITCH_MM + 1.0).sin();
    let mut text = String::from("t,x,y\n");
    let mut before = 0.0_f64;
    for (at, [x, y, ..]) in driven(folder, program).iter().enumerate() {
        let (east, north) = (x - 50.0, *y);
        let (radius, angle) = (east.hypot(north), north.atan2(east).rem_euclid(TAU));
        let profile = if (angle - before).rem_euclid(TAU) < TAU / 2.0 {
            ccw
        } else {
            cw
        };
        before = angle;
        let place = (angle / TAU * profile.len() as f64) as usize % profile.len();
        let is_on_circle = (radius - planned).abs() < 0.01;
        let off = if is_on_circle {
            profile[place] / radius
        } else {
            0.0
        };
        let [x, y] = [
            x + off * east + screw(*x) + noise(),
            y + off * north + screw(*y) + noise(),
        ];
        writeln!(text, "{:.3},{x:.4},{y:.4}", at as f64 * 0.001).expect("text");
    }
    text
}

/// Returns the list in a file that the command wrote.
fn list_in(path: &Path) -> FrictionList {
    let text = std::fs::read_to_string(path).expect("a list");
    let value = |key: &str| {
        let mut lines = text
            .lines()
            .filter_map(|line| line.trim().strip_prefix(key));
        lines.next().and_then(|it| it.trim().parse::<f64>().ok())
    };
    let points = (0..).map_while(|at| {
        let [input, output] =
            ["in", "out"].map(|it| value(&format!("frict_comp.table[{at}].{it} ")));
        Some(TablePoint {
            input: input?,
            output: output?,
        })
    });
    FrictionList {
        position_delay: 0,
        reversal_lookahead: 0,
        scaling_factor: 1000,
        delay_cycles: 0,
        max_points: 20,
        table: points.collect(),
    }
}

/// Returns the provisional list of an axis in `m/lists`.
fn provisional(folder: &Path, axis: &str) -> String {
    let entries = std::fs::read_dir(folder.join("m/lists")).expect("lists");
    let names = entries.map(|it| {
        it.expect("an entry")
            .file_name()
            .to_string_lossy()
            .into_owned()
    });
    let mut names: Vec<String> = names.filter(|it| it.starts_with(axis)).collect();
    assert_eq!(names.len(), 1, "{names:?}");
    format!("m/lists/{}", names.remove(0))
}

/// R16.2, R16.9, R16.13: from the recordings of stage 1 to provisional lists, from those of stage 2 to their
/// judgement, which takes more than positions alone; missing recordings are named, known results are kept, a changed recording is read again.
#[test]
fn from_recordings_to_judged_lists() {
    let folder = planned();
    let folder = folder.path();
    first_stage(folder);
    second_stage(folder);
    let (status, text) = run(folder, &[]);
    assert!(text.contains("10 recordings, 2 of them known"), "{text}");
    assert!(
        text.contains(
            "not proven, the earlier lists stay: neither torque nor positions show that the list of X was on"
        ),
        "{text}"
    );
    assert!(
        text.contains("missing: a recording of 64-friction-X.nc"),
        "{text}"
    );
    assert_eq!(status, Some(1), "two recordings are missing: {text}");
    let output = call(folder, &["commission", "run", "m", "--format", "json"]);
    let record: serde_json::Value = serde_json::from_slice(&output.stdout).expect("a record");
    let compared = record["rounds"][0]["recorded"].as_array().expect("feeds");
    assert_eq!(compared.len(), 4);
    for circle in compared {
        let [off, on] = ["off", "on"].map(|key| circle[key].as_f64().expect("a number"));
        assert!(off > 15.0 && on < 0.6 * off, "{circle}");
    }
    let report = [
        "--html",
        "report.html",
        "--machine",
        "M <1>",
        "--before",
        "X=zero.lis",
    ];
    let (_, text) = run(folder, &report);
    assert!(text.contains("10 recordings, 10 of them known"), "{text}");
    let (_, text) = run(folder, &["--plant", "stiff"]);
    assert!(
        text.contains("no plant is fitted: the fastest recorded feed is 2.5 times the slowest; a decade is needed"),
        "{text}"
    );
    check_report(folder);
    one_feed_without_effect(folder);
    other_recordings(folder);
}

/// Drives the first stage, friction only: provisional lists, and all circles are missing.
fn first_stage(folder: &Path) {
    let (status, text) = run(folder, &[]);
    assert_eq!(status, Some(1), "{text}");
    assert!(
        text.contains("missing: a recording of 01-friction-X.nc") && text.contains("X: no list"),
        "{text}"
    );
    // The content counts, not the names.
    put(folder, "a.csv", &friction(1, 1.0));
    put(folder, "b.csv", &friction(0, 1.0));
    let (status, text) = run(folder, &[]);
    assert_eq!(status, Some(1), "{text}");
    assert!(
        text.contains("X: provisional list m/lists/X-provisional-")
            && text.contains(".lis, from b.csv"),
        "{text}"
    );
    assert!(
        text.contains("missing: a recording of 03-circle-2000.nc"),
        "{text}"
    );
    assert!(
        text.starts_with(
            "no list is accepted yet: the motion with compensation on is not recorded"
        ),
        "{text}"
    );
}

/// Drives the second stage: the provisional lists are the friction of the machine; circles without and with them are
/// recorded.
fn second_stage(folder: &Path) {
    let lists = ["X", "Y"].map(|axis| provisional(folder, axis));
    succeeded(folder, &["lists", &lists[0]]);
    // Fc 512.5 N, Fs 632.5 N, fv 4 N s/mm at 5 N a drive unit.
    let list = list_in(&folder.join(&lists[0]));
    assert!(list.table.len() > 4);
    for point in &list.table {
        let speed = point.input / 1000.0;
        let expected = (512.5 + 120.0 * (-speed.max(0.5) / 3.0).exp() + 4.0 * speed) / 5.0;
        assert!(
            (point.output / expected - 1.0).abs() < 0.03,
            "{point:?}: {expected}"
        );
    }
    let [x, y] = [0, 1].map(|at| format!("{}={}", ["X", "Y"][at], lists[at]));
    let stage_2 = [&PLAN[..], &["m", "--value-list", &x, "--value-list", &y]].concat();
    succeeded(folder, &stage_2);
    for (at, feed) in FEEDS.into_iter().enumerate() {
        let off = format!("m/{:02}-circle-{feed}.nc", at + 3);
        put(
            folder,
            &format!("off{feed}.csv"),
            &circles(folder, &off, &deviations(feed, None)),
        );
        let on = format!("m/{:02}-circle-{feed}.nc", at + 66);
        put(
            folder,
            &format!("on{feed}.csv"),
            &circles(folder, &on, &deviations(feed, Some(&list))),
        );
    }
}

/// Checks that lists without effect at one feed are reported.
fn one_feed_without_effect(folder: &Path) {
    let path = folder.join("m/recordings/on3000.csv");
    let whole = std::fs::read(&path).expect("a recording");
    let off = circles(folder, "m/67-circle-3000.nc", &deviations(3000.0, None));
    put(folder, "on3000.csv", &off);
    let (status, text) = run(folder, &[]);
    let words = "at F3000 off and on hardly differ on X, and at the next feeds they do";
    assert!(status == Some(1) && text.contains(words), "{text}");
    std::fs::write(path, whole).expect("written");
    // Nor at the fastest feed, which has neighbouring feeds on one side only.
    let path = folder.join("m/recordings/on5000.csv");
    let whole = std::fs::read(&path).expect("a recording");
    let off = circles(folder, "m/69-circle-5000.nc", &deviations(5000.0, None));
    put(folder, "on5000.csv", &off);
    let (status, text) = run(folder, &[]);
    let words = "at F5000 off and on hardly differ on X, and at the next feeds they do";
    assert!(status == Some(1) && text.contains(words), "{text}");
    std::fs::write(path, whole).expect("written");
}

/// Drives another round, then a recording that changed.
fn other_recordings(folder: &Path) {
    // Other lists are another round: no recording of round 2 is mistaken for one of round 3.
    let zero = ["--value-list", "X=zero.lis", "--value-list", "Y=zero.lis"];
    succeeded(folder, &[&PLAN[..], &["m"], &zero[..]].concat());
    let (_, text) = run(folder, &[]);
    assert!(
        !text.contains("round 3") && text.contains("missing: a recording of 82-circle-2000.nc"),
        "{text}"
    );
    put(
        folder,
        "zero2000.csv",
        &circles(folder, "m/82-circle-2000.nc", &deviations(2000.0, None)),
    );
    let (status, text) = run(folder, &[]);
    let (_, third) = text.split_once("round 3: ").expect("a round");
    assert!(
        third.contains("not accepted") && third.contains("F3000 is not recorded"),
        "{text}"
    );
    assert_eq!(status, Some(1), "{text}");
    std::fs::remove_file(folder.join("m/plan-3.json")).expect("removed");
    std::fs::remove_file(folder.join("m/recordings/zero2000.csv")).expect("removed");
    put(
        folder,
        "off2000.csv",
        &std::fs::read_to_string(folder.join("m/recordings/on2000.csv")).expect("text"),
    );
    let (_, text) = run(folder, &[]);
    assert!(text.contains("10 recordings, 9 of them known"), "{text}");
    assert!(
        text.contains(
            "not accepted, the earlier lists stay: F2000 is not recorded both off and on"
        ),
        "{text}"
    );
}

/// R16.5: the report is a page with machine, verdict, circles, one page per axis, the change of a list, and the
/// SHA-256 of each recording; it states that nothing in it is predicted.
fn check_report(folder: &Path) {
    let page = std::fs::read_to_string(folder.join("report.html")).expect("a report");
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    roxmltree::Document::parse_with_options(&page, options).expect("well-formed");
    for words in [
        "Friction compensation of M &lt;1&gt;",
        "date not stated",
        "none is predicted",
        "The lists of round 2 are not proven, the earlier ones stay: ",
        "neither torque nor positions show that the list of Y was on",
        "64-friction-X.nc",
        "Axis X",
        "Axis Y",
        "+++ m/lists/X-provisional-",
        "No earlier list was given",
        "class=\"own-page\"",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let results = std::fs::read_to_string(folder.join("m/results.json")).expect("results");
    let results: serde_json::Value = serde_json::from_str(&results).expect("a record");
    for recording in results["recordings"].as_array().expect("recordings") {
        assert!(page.contains(recording["sha256"].as_str().expect("a sum")));
    }
    let lists = ["X", "Y"].map(|axis| provisional(folder, axis));
    let others = ["m/plan-1.json", "m/plan-2.json", "zero.lis"].map(str::to_owned);
    for file in others.iter().chain(&lists) {
        let sum = sha256_of(&folder.join(file)).expect("a sum");
        let row = page
            .split("<tr>")
            .find(|it| it.contains(file.as_str()) && it.contains(&sum));
        assert!(row.is_some(), "{file}");
    }
    let (status, text) = run(folder, &["--html", "r.html", "--before", "Z=zero.lis"]);
    assert!(
        status == Some(2) && text.contains("`--before` names `Z`"),
        "{text}"
    );
}
