//! Recordings and lists that `frictcomp commission run` does not accept, each with its reason (R16.9).

use std::f64::consts::TAU;
use std::fmt::Write as _;

use super::{
    FEEDS, PLAN, circles, deviations, driven, friction, list_in, planned, provisional, put, run,
};
use crate::folder::succeeded;

/// Returns a recording with other rows under another header.
fn changed(recording: &str, head: &str, change: &dyn Fn(&[f64]) -> String) -> String {
    let mut text = format!("{head}\n");
    for line in recording.lines().skip(1) {
        let cells: Vec<f64> = line
            .split(',')
            .map(|it| it.parse().expect("a number"))
            .collect();
        writeln!(text, "{}", change(&cells)).expect("text");
    }
    text
}

/// Returns a recording from the end of the strokes on.
fn without_signature(recording: &str) -> String {
    let rows = recording.lines().enumerate();
    let after = rows.filter(|(at, _)| *at == 0 || *at > 18_000);
    after.map(|(_, it)| it).collect::<Vec<_>>().join("\n")
}

/// R16.9: recordings that do not fit together make no list, each with its reason.
#[test]
fn what_speaks_against_a_list_is_named() {
    let good = friction(0, 1.0);
    let rows = |change: &dyn Fn(&[f64]) -> String, head: &str| changed(&good, head, change);
    let head = "t,v,x,torque";
    let slow = rows(
        &|it| format!("{:.5},{},{},{}", it[0] / 0.9, it[1] * 0.9, it[2], it[3]),
        head,
    );
    let switched = rows(
        &|it| format!("{},{},{},{},1", it[0], it[1], it[2], it[3]),
        "t,v,x,torque,comp",
    );
    let still = rows(
        &|it| format!("{},{},{},{}", it[0], it[1], it[2], (it[0] * 1e6) as i64 % 7),
        head,
    );
    let unsigned = without_signature(&good);
    let torqueless = rows(&|it| format!("{},{},{}", it[0], it[1], it[2]), "t,v,x");
    // One direction is heavier the faster it moves; friction rises by a third from row to row.
    let heavier = |it: &[f64]| 1.0 + 0.8 * (-it[1] / 50_000.0).clamp(0.0, 1.0);
    let uneven = rows(
        &|it| format!("{},{},{},{}", it[0], it[1], it[2], it[3] * heavier(it)),
        head,
    );
    let elsewhere = rows(
        &|it| format!("{},{},{},{},{:.0}", it[0], it[1], it[2], it[3], 0.4 * it[2]),
        "t,v,x,torque,x_act",
    );
    let short = good.lines().take(good.lines().count() * 9 / 10);
    let short = short.collect::<Vec<_>>().join("\n");
    let seconds = good.lines().count() as f64 / 1000.0;
    let drifting = rows(
        &|it| {
            let torque = it[3] * (1.0 + it[0] / seconds / 3.0);
            format!("{},{},{},{torque:.0}", it[0], it[1], it[2])
        },
        head,
    );
    for (files, words) in [
        (
            vec![("a.csv", &slow)],
            "not used: it was driven at 90.0 % of the planned speeds",
        ),
        (
            vec![("a.csv", &switched)],
            "not used: its program has compensation of X off, and the recording says otherwise at",
        ),
        (vec![("a.csv", &still)], "not used:"),
        (
            vec![("a.csv", &elsewhere)],
            "not used: the actual position does not follow the commanded one",
        ),
        (
            vec![("a.csv", &short)],
            "s of the program are missing: after the strokes",
        ),
        (
            vec![("a.csv", &unsigned)],
            "not used: it has no signature; say `--role a.csv=NUMBER`",
        ),
        (vec![("a.csv", &torqueless)], "torque"),
        (
            vec![("a.csv", &uneven)],
            "of the friction beyond a constant offset: one list fits neither",
        ),
        (
            vec![("a.csv", &drifting)],
            "while it was recorded: repeat it warm",
        ),
        (
            vec![("a.csv", &good), ("b.csv", &friction(0, 1.2))],
            "b.csv and a.csv differ by",
        ),
    ] {
        let folder = planned();
        for (name, text) in files {
            put(folder.path(), name, text);
        }
        let (status, text) = run(folder.path(), &[]);
        assert_eq!(status, Some(1), "{words}: {text}");
        assert!(
            text.contains(words) && text.contains("X: no list"),
            "{words}: {text}"
        );
        assert!(!folder.path().join("m/lists").exists(), "{words}");
    }
}

/// R16.5: a recorded state that matches the program is named, and so is a unit that only the user gives.
#[test]
fn what_is_recorded_and_what_is_said_are_told_apart() {
    let recording = changed(&friction(0, 1.0), "t,v,x,torque,comp", &|it| {
        format!("{},{},{},{},0", it[0], it[1] / 1000.0, it[2], it[3])
    });
    let folder = planned();
    put(folder.path(), "a.csv", &recording);
    let unit = ["--unit", "v=mm/s", "--html", "report.html"];
    let (_, text) = run(folder.path(), &unit);
    let shown = "compensation of X is recorded, and off";
    assert!(
        text.contains(shown) && text.contains("X: provisional list"),
        "{text}"
    );
    let page = std::fs::read_to_string(folder.path().join("report.html")).expect("a report");
    for words in [
        shown,
        "Stated, but shown by no recording: one unit of <code>v</code> is 1000 µm/s or 0.001°/s.",
    ] {
        assert!(page.contains(words), "{words}");
    }
    put(folder.path(), "a.csv", &friction(0, 1.0));
    let (_, text) = run(folder.path(), &[]);
    assert!(!text.contains("is recorded, and off"), "{text}");
}

/// R16.1, R16.2: an option names the program of a recording without a signature; a signature takes precedence, and the
/// recording has to exist.
#[test]
fn a_role_is_said_of_a_recording_without_a_signature() {
    let good = friction(0, 1.0);
    let unsigned = without_signature(&good);
    let folder = planned();
    put(folder.path(), "a.csv", &unsigned);
    let (_, text) = run(folder.path(), &["--role", "a.csv=1"]);
    assert!(text.contains("X: provisional list"), "{text}");
    put(folder.path(), "a.csv", &good);
    let (status, text) = run(folder.path(), &["--role", "b.csv=1"]);
    assert!(
        status == Some(2)
            && text.contains("`--role` names `b.csv`, and there is no such recording"),
        "{text}"
    );
    let (_, text) = run(folder.path(), &["--role", "a.csv=2"]);
    assert!(
        text.contains("its strokes give the number 1, but `--role` says 2")
            && text.contains("Y: no list"),
        "{text}"
    );
}

/// R16.8, R16.9: neither does a recording with missing samples, nor one whose directions differ by a share of the
/// friction, which is not weight.
#[test]
fn gaps_and_leaning_friction_make_no_list() {
    let good = friction(0, 1.0);
    // Ten seconds in the middle are missing.
    let half = good.lines().count() / 2;
    let pierced = good.lines().enumerate();
    let pierced = pierced.filter(|(at, _)| !(half..half + 10_000).contains(at));
    let pierced = pierced.map(|(_, it)| it).collect::<Vec<_>>().join("\n");
    // One direction has a quarter more friction than the mean, the other a quarter less.
    let leaning = changed(&good, "t,v,x,torque", &|it| {
        let torque = it[3] * (1.0 + 0.25 * it[1].signum());
        format!("{},{},{},{torque}", it[0], it[1], it[2])
    });
    for (text, words) in [
        (pierced, "s of the program are missing: after the strokes"),
        (
            leaning,
            "the directions differ by 25 % of the friction, and by more where there is more friction",
        ),
    ] {
        let folder = planned();
        put(folder.path(), "a.csv", &text);
        let (status, text) = run(folder.path(), &[]);
        assert!(
            status == Some(1) && text.contains(words) && text.contains("X: no list"),
            "{words}: {text}"
        );
        assert!(!folder.path().join("m/lists").exists(), "{words}");
    }
}

/// R16.2, R16.9: channels of both axes in one file are distinguished by the axis name; swapped channels of two
/// axes are found by the strokes.
#[test]
fn channels_of_the_wrong_axis_are_found() {
    let track = friction(0, 1.0);
    let mut text = String::from("t;A.v [mm/s];A.torque;B.v [mm/s];B.torque\n");
    for line in track.lines().skip(1) {
        let cells: Vec<f64> = line
            .split(',')
            .map(|it| it.parse().expect("a number"))
            .collect();
        writeln!(text, "{};{};{};0;0", cells[0], cells[1] / 1000.0, cells[3]).expect("text");
    }
    for ([a, b], words) in [
        (["X", "Y"], "X: provisional list"),
        (["Y", "X"], "the channels of two axes are swapped"),
    ] {
        let folder = planned();
        put(
            folder.path(),
            "both.csv",
            &text
                .replace("A.", &format!("{a}."))
                .replace("B.", &format!("{b}.")),
        );
        let channels = ["--velocity", "%.v", "--torque", "%.torque"];
        let (status, said) = run(folder.path(), &channels);
        assert!(status == Some(1) && said.contains(words), "{said}");
    }
}

/// R16.2: without a plan, or without recordings, nothing is invented.
#[test]
fn without_a_plan_there_is_nothing_to_read() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("m")).expect("a folder");
    let (status, text) = run(folder.path(), &[]);
    assert!(
        status == Some(2) && text.contains("has no `plan-1.json`"),
        "{text}"
    );
    std::fs::write(folder.path().join("m/plan-1.json"), "{}").expect("written");
    let (status, text) = run(folder.path(), &[]);
    assert!(status == Some(2) && text.contains("not a plan"), "{text}");
    let folder = planned();
    std::fs::remove_dir(folder.path().join("m/recordings")).expect("removed");
    let (status, text) = run(folder.path(), &[]);
    assert!(
        status == Some(2) && text.contains("make the folder, and put the recordings into it"),
        "{text}"
    );
}

/// R16.8: what is the same in both directions, such as weight, is reported and kept out of the list.
#[test]
fn a_weight_is_no_part_of_the_list() {
    let table_of = |recording: &str| {
        let folder = planned();
        put(folder.path(), "a.csv", recording);
        let (_, text) = run(folder.path(), &[]);
        let list = list_in(&folder.path().join(provisional(folder.path(), "X")));
        (list.table, text)
    };
    let level = friction(0, 1.0);
    let (expected, _) = table_of(&level);
    // The bench itself has 35.
    let heavy = changed(&level, "t,v,x,torque", &|it| {
        format!("{},{},{},{}", it[0], it[1], it[2], it[3] + 300.0)
    });
    let (found, text) = table_of(&heavy);
    assert_eq!(found, expected);
    assert!(
        text.contains("the offset of 335") && text.contains("it is not part of the list"),
        "{text}"
    );
}

/// R16.2: what the programs switch is not given on the command line.
#[test]
fn the_programs_say_whether_compensation_is_on() {
    let folder = planned();
    let (status, text) = run(folder.path(), &["--compensation", "off"]);
    assert!(
        status == Some(2) && text.contains("unexpected argument '--compensation'"),
        "{text}"
    );
}

/// Returns the rows of a recording of circles up to the first clockwise one.
fn counter_clockwise(recording: &str) -> String {
    let mut angle = 0.0_f64;
    let mut turned = 0.0;
    let mut kept = String::new();
    for line in recording.lines() {
        let cells: Vec<f64> = line.split(',').filter_map(|it| it.parse().ok()).collect();
        if let [_, x, y] = cells[..] {
            let now = y.atan2(x - 50.0);
            let step = (now - angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            angle = now;
            if ((x - 50.0).hypot(y) - 40.0).abs() < 0.05 {
                turned += step;
            }
            if turned > TAU && step < -1e-4 {
                break;
            }
        }
        writeln!(kept, "{line}").expect("text");
    }
    kept
}

/// R16.9: circles of one direction or that end early, with swapped columns, about another centre, too coarse, with
/// a changed override, and copies are not used; those at another feed count with the driven feed.
#[test]
fn circles_count_with_what_was_driven() {
    let folder = planned();
    let folder = folder.path();
    let of = |program: &str, feed: f64| circles(folder, program, &deviations(feed, None));
    let whole = of("m/03-circle-2000.nc", 2000.0);
    let other = of("m/04-circle-3000.nc", 3000.0);
    let row = |change: &dyn Fn(&[f64]) -> [f64; 3]| {
        let text = |it: &[f64]| {
            let [t, x, y] = change(it);
            format!("{t:.5},{x:.4},{y:.4}")
        };
        changed(&whole, "t,x,y", &text)
    };
    let rows = |keeps: &dyn Fn(usize) -> bool| {
        let kept = whole.lines().enumerate();
        let kept = kept.filter(|(at, _)| *at == 0 || keeps(*at));
        kept.map(|(_, it)| it).collect::<Vec<_>>().join("\n")
    };
    let count = whole.lines().count();
    // In the standstill between both directions, and in the middle of the first one.
    let direction_s = 3.0 * TAU * 40.0 / (2000.0 / 60.0);
    let middle_s = count as f64 / 1000.0 - direction_s - 1.5;
    let pierced = ((middle_s - direction_s / 2.0) * 1000.0) as usize;
    let exchanged = row(&|it| [it[0], it[2] + 50.0, it[1] - 50.0]);
    // In the last turn the crossings leave three times as much as in the others.
    let worse = row(&|it| {
        let before_s = (middle_s - it[0]) / (direction_s / 3.0);
        let (x, y) = (it[1] - 50.0, it[2]);
        let radius = x.hypot(y);
        let scale = if (0.3..0.9).contains(&before_s) {
            (40.0 + 3.0 * (radius - 40.0)) / radius
        } else {
            1.0
        };
        [it[0], 50.0 + scale * x, scale * y]
    });
    let missing = "missing: a recording of 03-circle-2000.nc that can be used";
    for (text, words) in [
        (counter_clockwise(&whole), "one direction is missing"),
        (exchanged.clone(), "not used: it has no signature"),
        (
            row(&|it| [it[0], it[1] + 3.0, it[2]]),
            "is of another place or machine",
        ),
        (
            rows(&|at| at % 4 == 0),
            "not used: a sample every 4.0 ms does not show what a reversal does",
        ),
        (other.clone(), "not used: it is a copy of `b.csv`"),
        (row(&|it| [it[0] * 10.0, it[1], it[2]]), missing),
        (
            // In the evaluated turn, as wide as the effect of a reversal.
            rows(&|at| !(pierced..pierced + 60).contains(&at)),
            "not used: 61 ms without a sample in a turn ccw: what a reversal does may be missing",
        ),
        (
            driven(folder, "m/03-circle-2000.nc")
                .iter()
                .enumerate()
                .fold("t,x,y\n".to_owned(), |text, (at, [x, y, ..])| {
                    format!("{text}{:.3},{x:.4},{y:.4}\n", at as f64 / 1000.0)
                }),
            "not used: it deviates from a circle by 0.1 µm: its positions are commanded ones",
        ),
        (
            rows(&|at| at < count * 4 / 5),
            "turns cw are in it: it begins late or ends early",
        ),
        (
            row(&|it| [it[0] + (it[0] - middle_s).max(0.0) * 0.1, it[1], it[2]]),
            "not used: one direction was driven at 1818 mm/min and the other at 2000: the override was turned",
        ),
    ] {
        put(folder, "b.csv", &other);
        put(folder, "c.csv", &text);
        let (status, said) = run(folder, &[]);
        assert!(
            status == Some(1) && said.contains(words) && said.contains(missing),
            "{words}: {said}"
        );
    }
    // R16.11: turns that differ are said, and the largest counts.
    put(folder, "c.csv", &worse);
    let (_, said) = run(folder, &[]);
    let is_counted = said.contains("turns ccw differ by") && said.contains("the largest of 3");
    assert!(is_counted && !said.contains(missing), "{said}");
    put(folder, "c.csv", &exchanged);
    let (_, said) = run(folder, &["--role", "c.csv=3"]);
    let words = "not used: it begins clockwise and its program counter-clockwise";
    assert!(said.contains(words) && said.contains(missing), "{said}");
    put(folder, "c.csv", &row(&|it| [it[0] / 0.9, it[1], it[2]]));
    let (status, said) = run(folder, &[]);
    let words = "driven at 1800 mm/min in place of 2000: 22.50 mm/s² count";
    assert!(
        status == Some(1) && said.contains(words) && !said.contains(missing),
        "{said}"
    );
}

/// R16.9: a list that adds too much, that has changed since, that shows no effect, whose friction or feeds are not
/// recorded.
#[test]
fn lists_that_are_not_accepted_say_why() {
    let folder = planned();
    let folder = folder.path();
    put(folder, "x.csv", &friction(0, 1.0));
    run(folder, &[]);
    let mut strong = std::fs::read_to_string(folder.join(provisional(folder, "X"))).expect("text");
    for (at, point) in list_in(&folder.join(provisional(folder, "X")))
        .table
        .iter()
        .enumerate()
    {
        let key = format!("frict_comp.table[{at}].out");
        let lines = strong.lines().map(|line| {
            if line.trim().starts_with(&key) {
                format!("{key} {}", (point.output * 2.0).round())
            } else {
                line.to_owned()
            }
        });
        strong = lines.collect::<Vec<_>>().join("\n");
    }
    std::fs::write(folder.join("strong.lis"), &strong).expect("written");
    let lists = ["--value-list", "X=strong.lis", "--value-list", "Y=zero.lis"];
    succeeded(folder, &[&PLAN[..], &["m"], &lists[..]].concat());
    let feed = FEEDS[0];
    for (name, program) in [
        ("off.csv", "m/03-circle-2000.nc"),
        ("on.csv", "m/66-circle-2000.nc"),
    ] {
        put(
            folder,
            name,
            &circles(folder, program, &deviations(feed, None)),
        );
    }
    let (status, text) = run(folder, &[]);
    assert_eq!(status, Some(1), "{text}");
    for words in [
        "the list of X adds 2.0",
        "times the measured friction; the limit is 1.3",
        "the friction of Y is not known",
        "F3000 is not recorded both off and on",
        "off and on hardly differ on X at any feed: its list was not on, or on in both",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    std::fs::write(folder.join("strong.lis"), strong + "\n# changed\n").expect("written");
    let (_, text) = run(folder, &[]);
    let words = "the list of X that was recorded is no longer `strong.lis`";
    assert!(text.contains(words), "{text}");
}
