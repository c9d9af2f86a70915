//! `diff --contour` and `golden --contour`.

use super::MACHINE;
use crate::folder::{Bench, json};

const OLD: &str = "\
N10 X[COMP ON FRICT] Y[COMP ON FRICT]
N20 G01 X25 Y0 F3000
N30 G03 X25 Y0 I-25 J0
N40 G03 X25 Y0 I-25 J0
N50 G01 Y10
N60 M30
";

fn bench(new: &str) -> Bench {
    let bench = Bench::new(&[("old.nc", OLD), ("new.nc", new)]);
    bench.write("frictcomp.toml", MACHINE);
    bench
}

const START: [&str; 2] = ["--start", "X25,Y-20"];

fn diff(bench: &Bench, arguments: &[&str]) -> (Option<i32>, String) {
    let fixed = ["diff", "old.nc", "new.nc", "--contour"];
    let output = bench.call(&[&fixed[..], arguments].concat());
    let text = String::from_utf8(output.stdout).expect("text");
    (output.status.code(), text)
}

#[test]
fn a_block_that_deviates_more_is_named_with_its_worst_place() {
    // R9.83: X is off in the second turn, which is two lines lower in the new version.
    let new = OLD.replace(
        "N40 G03",
        "; a comment\n; another\nN35 X[COMP OFF FRICT]\nN40 G03",
    );
    let bench = bench(&new);
    let (status, text) = diff(&bench, &[&START[..], &["--format", "json"]].concat());
    assert_eq!(status, Some(1));
    let found = &json(&text)["contour"];
    assert_eq!(found["verdict"], "more");
    let more = found["more"].as_array().expect("blocks");
    let turn = more
        .iter()
        .find(|it| it["n"] == 40)
        .unwrap_or_else(|| panic!("{found:#}"));
    assert_eq!((&turn["line"], &turn["old_line"]), (&7.into(), &4.into()));
    let um = |value: &serde_json::Value| value.as_f64().expect("a number");
    assert!(um(&turn["new"]) > um(&turn["old"]) + 10.0, "{turn}");
    // X reverses at the left.
    let place = turn["position"].as_array().expect("a place");
    assert!(um(&place[0]) < -24.0 && um(&place[1]).abs() < 3.0, "{turn}");
    assert!(more.iter().all(|it| it["n"] != 30), "{found:#}");
    let (_, text) = diff(&bench, &START);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("more by more than 0.5 µm, line 7 of new.nc most"),
        "{text}"
    );
    let page = [&START[..], &["--html", "d.html"]].concat();
    assert_eq!(diff(&bench, &page).0, Some(1));
    let page = bench.read("d.html");
    assert!(
        page.contains("line 7 of new.nc") && page.contains("deviates more"),
        "{page}"
    );
}
