//! `frictcomp commission` from the command line (chapter 16 of the rules).

use std::path::Path;

use crate::folder::{answer, call};
use frictcomp_recordings::commission::signature_in;

const MACHINE: &str = r#"
[[axis]]
name = "X"
frict_comp = true
max_velocity = 20000
max_acceleration = 2
max_jerk = 50
value_list = "comp_x.lis"
[[axis]]
name = "Y"
frict_comp = true
max_velocity = 20000
max_acceleration = 2
max_jerk = 50
value_list = "comp_x.lis"
[[axis]]
name = "Z"
max_velocity = 20000
[[axis]]
name = "C"
type = "R"
frict_comp = true
max_velocity = 20000
max_acceleration = 2000
value_list = "comp_x.lis"
[[axis]]
name = "S"
type = "S"
"#;

const LIST: &str = "\
frict_comp.mode 3
frict_comp.position_delay 0
frict_comp.table_entries 2
frict_comp.table[0].in 0
frict_comp.table[0].out 120
frict_comp.table[1].in 10000
frict_comp.table[1].out 100
";

/// Feeds and radius of a small machine, whose programs are short.
const SMALL: [&str; 11] = [
    "plan",
    "--axis",
    "X,Y",
    "--travel",
    "X0..60,Y-50..10",
    "--feeds",
    "500,1000,2000,5000",
    "--slowest",
    "2",
    "--radius",
    "15",
];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("frictcomp.toml"), MACHINE).expect("a machine");
    std::fs::write(folder.path().join("comp_x.lis"), LIST).expect("a list");
    folder
}

fn commission(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    answer(folder, &[&["commission"], arguments].concat())
}

fn programs(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|it| it.expect("an entry").path());
    let programs = paths.filter(|it| it.extension().is_some_and(|it| it == "nc"));
    let names = programs.filter_map(|it| Some(it.file_name()?.to_string_lossy().into_owned()));
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

/// Returns the columns of the commanded trace of a program, in mm and mm/s: positions and speeds of X and Y.
fn driven(folder: &Path, program: &str) -> [Vec<f64>; 4] {
    let axes = ["--axis", "X,Y", "--start", "X30,Y-20", "--cycle-time", "4"];
    let output = call(folder, &[&["current", program], &axes[..]].concat());
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout).expect("text");
    let head: Vec<&str> = text.lines().next().expect("a head").split(',').collect();
    let columns = [("x.X", 1e-4), ("x.Y", 1e-4), ("v.X", 1e-3), ("v.Y", 1e-3)];
    columns.map(|(name, unit)| {
        let at = head.iter().position(|it| *it == name).expect("a column");
        let rows = text.lines().skip(1);
        let cells = rows.map(|row| row.split(',').nth(at).expect("a cell"));
        cells
            .map(|it| it.parse::<f64>().expect("a number") * unit)
            .collect()
    })
}

fn ends(values: &[f64]) -> (f64, f64) {
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &it| {
            (low.min(it), high.max(it))
        })
}

/// R16.1: programs of both stages, which `check` and `audit` accept and which leave each axis in its start-up
/// state; R16.8: everything that they drive stays in the inner 90 % of the travel, and reaches its feed.
#[test]
fn programs_stay_in_the_travel_and_carry_their_number() {
    let folder = folder();
    let (status, said) = commission(folder.path(), &[&SMALL[..], &["--into", "one"]].concat());
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.contains("6 programs") && said.contains(" min"),
        "{said}"
    );
    let json = [&["commission"], &SMALL[..], &["--format", "json"]].concat();
    let plan = crate::folder::document(folder.path(), &json);
    let headline = plan["headline"]["text"].as_str().expect("a verdict");
    assert!(
        said.starts_with(headline) && headline.starts_with("stage 1, friction compensation off"),
        "{headline}"
    );
    let one = programs(&folder.path().join("one"));
    assert_eq!(
        one,
        [
            "01-friction-X.nc",
            "02-friction-Y.nc",
            "03-circle-500.nc",
            "04-circle-1000.nc",
            "05-circle-2000.nc",
            "06-circle-5000.nc"
        ]
    );
    let lists = [
        "--value-list",
        "X=comp_x.lis",
        "--value-list",
        "Y=comp_x.lis",
        "--into",
        "two",
    ];
    let (status, said) = commission(folder.path(), &[&SMALL[..], &lists].concat());
    assert_eq!(status, Some(0), "{said}");
    for stage in ["one", "two"] {
        let (status, said) = answer(folder.path(), &["check", "--fail-on", "info", stage]);
        assert_eq!(status, Some(0), "{said}");
        let (status, said) = answer(folder.path(), &["audit", stage]);
        assert!(
            status == Some(0) && said.contains("in no order does one move an axis"),
            "{said}"
        );
        for (name, number) in programs(&folder.path().join(stage))
            .iter()
            .zip(if stage == "one" { 1.. } else { 64.. })
        {
            let [x, y, vx, vy] = driven(folder.path(), &format!("{stage}/{name}"));
            let ((x_low, x_high), (y_low, y_high)) = (ends(&x), ends(&y));
            assert!(
                x_low >= 3.0 - 1e-6 && x_high <= 57.0 + 1e-6,
                "{name}: {x_low} {x_high}"
            );
            assert!(
                y_low >= -47.0 - 1e-6 && y_high <= 7.0 + 1e-6,
                "{name}: {y_low} {y_high}"
            );
            let signed = if name.contains("friction-Y") { &y } else { &x };
            let found: Vec<u16> = signature_in(signed, 0.004)
                .iter()
                .map(|it| it.0.number())
                .collect();
            assert_eq!(found, [number], "{name}");
            let (fastest, feed) = (
                ends(&vx).1.max(ends(&vy).1),
                if name.contains("friction") {
                    5000.0
                } else {
                    0.0
                },
            );
            let feed = name
                .trim_end_matches(".nc")
                .rsplit('-')
                .next()
                .and_then(|it| it.parse().ok())
                .unwrap_or(feed);
            let expected = if stage == "two" && name.contains("friction") {
                20.0
            } else {
                feed / 60.0
            };
            assert!(
                fastest >= expected - 0.01,
                "{name}: {fastest} of {expected}"
            );
        }
    }
    let text =
        std::fs::read_to_string(folder.path().join("two/66-circle-500.nc")).expect("a program");
    // The output of `sha256sum` for the list.
    let sum =
        "(value list X: SHA-256 a07fceb4b20732f1fc9f093ed3ffb53e967f0e110bb15fce0fb9688757ea1e0e)";
    assert!(
        text.contains("X[COMP ON FRICT]") && !text.contains("COMP OFF"),
        "{text}"
    );
    assert!(text.contains(sum), "{text}");
    assert!(!text.contains("G00"), "{text}");
}

/// R16.9: a plan that may already have recordings is not replaced by another one.
#[test]
fn a_plan_is_not_replaced_by_another_one() {
    let folder = folder();
    let one = [&SMALL[..], &["--into", "one"]].concat();
    let (status, said) = commission(folder.path(), &one);
    assert_eq!(status, Some(0), "{said}");
    let other = ["--approach", "500"];
    let (status, said) = commission(folder.path(), &[&one[..], &other].concat());
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("`one/plan-1.json` holds another plan"),
        "{said}"
    );
    let (status, said) = commission(folder.path(), &[&one[..], &other, &["--force"]].concat());
    assert_eq!(status, Some(0), "{said}");
}

/// R16.1: the page for the operator is one page of plain letters, and lists what has to be recorded.
#[test]
fn the_page_of_the_operator_is_one_page() {
    let folder = folder();
    let (status, said) = commission(folder.path(), &[&SMALL[..], &["--into", "one"]].concat());
    assert_eq!(status, Some(0), "{said}");
    let page = std::fs::read_to_string(folder.path().join("one/README.txt")).expect("a page");
    assert!(page.is_ascii());
    assert!(page.lines().count() <= 60, "{page}");
    assert!(page.lines().all(|line| line.len() <= 78), "{page}");
    for words in [
        "tool out",
        "Z clear",
        "10 percent override",
        "Record both",
        "every ms",
        "MOTOR or of the LOAD",
    ] {
        assert!(page.contains(words), "{words}: {page}");
    }
}

/// R16.1: a single axis, or a rotary one, has strokes, and they are labelled as such.
#[test]
fn an_axis_alone_has_strokes() {
    let folder = folder();
    let arguments = [
        "plan",
        "--axis",
        "C",
        "--travel",
        "C=-90..270",
        "--feeds",
        "500,1000,2000,5000",
        "--into",
        "c",
    ];
    let (status, said) = commission(folder.path(), &arguments);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("motor side, not contour"), "{said}");
    assert_eq!(
        programs(&folder.path().join("c")),
        ["01-friction-C.nc", "02-strokes-C.nc"]
    );
    let (status, said) = answer(folder.path(), &["check", "--fail-on", "info", "c"]);
    assert_eq!(status, Some(0), "{said}");
    let text = std::fs::read_to_string(folder.path().join("c/02-strokes-C.nc")).expect("a program");
    assert!(
        text.is_ascii() && !text.contains("G02") && !text.contains("G03"),
        "{text}"
    );
}
